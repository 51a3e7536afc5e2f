// The worker: loads drawings, packs their marks and paints tiles, so that the page itself never waits for them.

import type { FromWorker, ToWorker } from "./marks/messages.ts";
import { pack, type Packed } from "./marks/pack.ts";
import { paintTile, SIDE } from "./marks/paint.ts";
import { Player } from "./marks/player.ts";
import { penUses, sequence, summaryOf } from "./marks/sequence.ts";
import type { Drawing, Plot } from "./server/shapes.ts";

const drawings = new Map<string, Packed>();
let queue: { id: string; scale: number; tiles: [number, number][] } | null = null;
let player: Player | null = null;
let wanted: Extract<ToWorker, { kind: "playback" }> | null = null;
let isWorking = false;

const canvas = new OffscreenCanvas(SIDE, SIDE);
const context = canvas.getContext("2d", { alpha: false })!;

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

async function fetchJson<T>(path: string, token: string): Promise<T> {
  const answer = await fetch(path, { headers: { "X-Drypoint-Token": token } });
  const said = (await answer.json()) as T & { error?: string };
  if (!answer.ok) throw new Error(said.error ?? `the server answered ${answer.status}`);
  return said;
}

async function load(id: string, path: string, token: string): Promise<void> {
  const { marks, ...told } = await fetchJson<Drawing>(path, token);
  const packed = pack(marks);
  drawings.set(id, packed);
  const layers = marks.layers.map(({ name, pen, color, dots, strokes, areas }) => ({ name, pen, color, count: dots.length + strokes.length + areas.length }));
  tell({ kind: "loaded", shown: { ...told, id, page: packed.page, paper: packed.paper, count: packed.count, layers } });
}

async function loadPlot(path: string, token: string, revision: number): Promise<void> {
  const plot = await fetchJson<Plot>(path, token);
  const played = sequence(plot);
  player = new Player(played);
  const pens = penUses(plot, played);
  const { machine, seconds } = plot;
  tell({ kind: "plotted", plot: { machine, seconds, summary: summaryOf(plot, pens), paths: played.count, revision, pens }, ends: played.ends });
}

/** One tile at a time with a pause between, so that a newer wish replaces what is left of the older. */
function work(): void {
  if (isWorking) return;
  isWorking = true;
  const channel = new MessageChannel();
  channel.port1.onmessage = async () => {
    if (await workOnce()) channel.port2.postMessage(0);
    else {
      isWorking = false;
      channel.port1.close();
    }
  };
  channel.port2.postMessage(0);
}

async function workOnce(): Promise<boolean> {
  if (wanted && player) {
    const { view, time, hasTravel } = wanted;
    wanted = null;
    const bitmap = await player.paint(view, time, hasTravel);
    tell({ kind: "played", view, time, bitmap }, [bitmap]);
    return true;
  }
  const tile = queue?.tiles.shift();
  const packed = queue && drawings.get(queue.id);
  if (!queue || !tile || !packed) return false;
  const { id, scale } = queue;
  const [column, row] = tile;
  paintTile(context, packed, scale, column, row);
  const bitmap = canvas.transferToImageBitmap();
  tell({ kind: "tile", id, scale, column, row, bitmap }, [bitmap]);
  return true;
}

self.onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  const failed = (of: "load" | "plot", id: string) => (error: unknown) =>
    tell({ kind: "failed", of, id, message: error instanceof Error ? error.message : String(error) });
  if (message.kind === "load") void load(message.id, message.path, message.token).catch(failed("load", message.id));
  else if (message.kind === "plot") void loadPlot(message.path, message.token, message.revision).catch(failed("plot", ""));
  else if (message.kind === "forget") drawings.delete(message.id);
  else {
    if (message.kind === "tiles") queue = { id: message.id, scale: message.scale, tiles: message.tiles };
    else wanted = message;
    work();
  }
};
