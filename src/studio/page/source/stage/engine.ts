// Holds worker, tiles and canvas together: what is told by the server becomes frames.

import type { FromWorker, ToWorker, View } from "../marks/messages.ts";
import { accessToken } from "../server/requests.ts";
import type { Quality } from "../server/shapes.ts";
import { now, set, type Shown } from "../model/store.ts";
import { camera } from "./camera.ts";
import { compose, type Overlay, type Played } from "./compose.ts";
import { Tiles } from "./tiles.ts";

export const overlay: Overlay = { lasso: [], brush: null, shift: [0, 0], guides: { x: null, y: null } };

const worker = new Worker("/worker.js", { type: "module" });
const post = (message: ToWorker) => worker.postMessage(message);
const loaded = new Map<string, Shown>();
let wanted = "";
let canvas: HTMLCanvasElement | null = null;
let isAsked = false;
let played: Played | null = null;
let pathEnds = new Float64Array(0);
let isPlayed = true;

const tiles = new Tiles(post, redraw, (id) => {
  const shown = loaded.get(id);
  if (!shown) return;
  loaded.clear();
  overlay.shift = [0, 0];
  set({ shown });
});

export function redraw(): void {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(frame);
}

function frame(): void {
  isAsked = false;
  const context = canvas?.getContext("2d");
  if (!canvas || !context) return;
  if (canvas.width === 0) return;
  compose(context, tiles, overlay, played);
  const isWaiting = tiles.update();
  if (now().playback.isOn) askPlayback();
  if (isWaiting) setTimeout(redraw, 40);
}

camera.whenMoved(redraw);

export function attach(to: HTMLCanvasElement | null): void {
  canvas = to;
  redraw();
}

/** Fetches a finished drawing. A full one is never replaced by a coarse one of the same revision. */
export function showDrawing(id: string, quality: Quality, revision: number): void {
  const { shown } = now();
  if (shown && (revision < shown.revision || (revision === shown.revision && shown.quality === "full" && quality === "coarse"))) return;
  wanted = id;
  post({ kind: "load", id, path: `/api/drawing/${encodeURIComponent(id)}`, token: accessToken() });
}

export function clearDrawing(): void {
  tiles.clear();
  wanted = "";
  camera.isFitted = true;
  set({ shown: null, part: null });
  redraw();
}

export function askPlot(profile: string): void {
  set({ isPlotting: true, plotFault: null });
  post({ kind: "plot", path: `/api/plot?profile=${encodeURIComponent(profile)}`, token: accessToken(), revision: now().scene?.revision ?? 0 });
}

let lastAsked = "";

function askPlayback(): void {
  const { time, hasTravel } = now().playback;
  const view: View = { scale: camera.scale, x: camera.x, y: camera.y, width: camera.width, height: canvas?.height ?? 1 };
  const asked = JSON.stringify([view, time, hasTravel]);
  if (asked === lastAsked || !isPlayed) return;
  lastAsked = asked;
  isPlayed = false;
  post({ kind: "playback", view, time, hasTravel });
}

/** The second at which a path of the plot is done. */
export function pathEnd(path: number): number {
  return pathEnds[Math.min(pathEnds.length - 1, Math.max(0, path))] ?? 0;
}

/** How many paths are done at a moment. */
export function pathsDone(time: number): number {
  let [low, high] = [0, pathEnds.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (pathEnds[middle]! <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

function hear(message: FromWorker): void {
  if (message.kind === "tile") tiles.receive(message);
  else if (message.kind === "loaded") {
    const { shown } = message;
    if (shown.id !== wanted) {
      post({ kind: "forget", id: shown.id });
      return;
    }
    loaded.set(shown.id, shown);
    camera.showPage(shown.page);
    tiles.show(shown.id, shown.page);
    redraw();
  } else if (message.kind === "plotted") {
    pathEnds = new Float64Array(message.ends);
    lastAsked = "";
    set({ plot: message.plot, isPlotting: false, playback: { ...now().playback, isOn: true, isPlaying: false, time: message.plot.seconds } });
    redraw();
  } else if (message.kind === "played") {
    played?.bitmap.close();
    played = message;
    isPlayed = true;
    redraw();
  } else if (message.of === "plot") set({ isPlotting: false, plotFault: message.message });
  else if (message.id === wanted) set({ fault: message.message });
}

worker.onmessage = (event: MessageEvent<FromWorker>) => hear(event.data);
worker.onerror = (event) => set({ fault: `The page's worker stopped: ${event.message}` });
