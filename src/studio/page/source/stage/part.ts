// The part of the sheet that is to be plotted: a box dragged on the sheet, or what is in view.

import { say } from "../model/scene.ts";
import { now, set, type Box } from "../model/store.ts";
import { camera } from "./camera.ts";
import { redraw } from "./engine.ts";

/** Smaller boxes are a slip of the hand, in millimetres. */
const LEAST = 0.5;

function between(a: [number, number], b: [number, number]): Box {
  const [width, height] = camera.page;
  const inside = (v: number, most: number) => Math.min(most, Math.max(0, v));
  const [x0, x1] = [inside(Math.min(a[0], b[0]), width), inside(Math.max(a[0], b[0]), width)];
  const [y0, y1] = [inside(Math.min(a[1], b[1]), height), inside(Math.max(a[1], b[1]), height)];
  return [x0, y0, x1 - x0, y1 - y0];
}

/** While it is dragged, between two points of the pane. */
export function dragPart(from: { x: number; y: number }, to: { x: number; y: number }): void {
  set({ part: between(camera.toSheet(from.x, from.y), camera.toSheet(to.x, to.y)) });
  redraw();
}

export function settlePart(): void {
  const { part, playback, plot } = now();
  if (!part) return;
  const isBox = part[2] >= LEAST && part[3] >= LEAST;
  set({ part: isBox ? part : null, playback: plot ? { ...playback, isOn: true } : playback });
  const size = part.slice(2).map((v) => v.toFixed(1)).join(" × ");
  say(isBox ? `The part of ${size} mm is plotted alone; M sends it` : "The whole is plotted");
  redraw();
}

/** By keyboard: what is in view is the part. */
export function partInView(): void {
  set({ part: between(camera.toSheet(0, 0), camera.toSheet(camera.width, camera.height)) });
  settlePart();
}
