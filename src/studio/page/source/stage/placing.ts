// Dragging the picture over the sheet: the scene's `at`, in whole millimetres or at the margins and the middle.

import { change, say, valueAt } from "../model/scene.ts";
import { now } from "../model/store.ts";
import { camera } from "./camera.ts";
import { overlay, redraw } from "./engine.ts";
import { apply, photographToSheet } from "./photograph.ts";
import { isOutOfDate } from "./shown.tsx";

/** Within this distance in pixels a margin or the middle draws the picture to itself. */
const SNAP = 7;

let free: [number, number] = [0, 0];

/** The picture's box on the sheet: x, y, width, height. */
export function pictureBox(): [number, number, number, number] {
  const given = now().shown?.placement?.box;
  if (given) return given;
  const { pixels, affine } = photographToSheet(camera.page);
  const corners = [[0, 0], [pixels[0], 0], [0, pixels[1]], pixels].map(([x, y]) => apply(affine, x!, y!));
  const xs = corners.map(([x]) => x);
  const ys = corners.map(([, y]) => y);
  const [left, top] = [Math.max(0, Math.min(...xs)), Math.max(0, Math.min(...ys))];
  return [left, top, Math.min(camera.page[0], Math.max(...xs)) - left, Math.min(camera.page[1], Math.max(...ys)) - top];
}

/** Where the picture is put by the scene: it may be ahead of the drawing that is shown. */
function corner(): [number, number] {
  const said = /^\s*(-?[\d.]+)\s*,\s*(-?[\d.]+)\s*(mm)?\s*$/.exec(String(valueAt(["at"]) ?? ""));
  const [x, y] = pictureBox();
  return said ? [Number(said[1]), Number(said[2])] : [x, y];
}

export function liftPicture(): boolean {
  if (!valueAt(["page"])) {
    say("Choose a page first; without one the sheet is the picture's own size");
    return false;
  }
  if (!valueAt(["at"]) && isOutOfDate(now())) {
    say("The drawing is not on this sheet yet; wait a moment");
    return false;
  }
  free = [0, 0];
  return true;
}

export function movePicture(dx: number, dy: number, isFree: boolean): void {
  free = [free[0] + dx, free[1] + dy];
  const [, , width, height] = pictureBox();
  const [x, y] = corner();
  const horizontal = snap(x + free[0], width, camera.page[0], isFree);
  const vertical = snap(y + free[1], height, camera.page[1], isFree);
  overlay.shift = [horizontal.place - x, vertical.place - y];
  overlay.guides = { x: horizontal.guide, y: vertical.guide };
  redraw();
}

function snap(place: number, length: number, page: number, isFree: boolean): { place: number; guide: number | null } {
  if (isFree) return { place, guide: null };
  const margin = Number.parseFloat(String(valueAt(["margin"]) ?? "10")) || 0;
  const near = SNAP / (camera.scale / camera.density);
  const ends: [number, number][] = [
    [(page - length) / 2, page / 2],
    [margin, margin],
    [page - margin - length, page - margin],
    [0, 0],
    [page - length, page],
  ];
  const found = ends.find(([end]) => Math.abs(end - place) < near);
  return found ? { place: found[0], guide: found[1] } : { place: Math.round(place), guide: null };
}

export function dropPicture(): void {
  const [x, y] = corner();
  const [dx, dy] = overlay.shift;
  overlay.guides = { x: null, y: null };
  if (dx === 0 && dy === 0) return;
  placeAt(x + dx, y + dy);
}

export function placeAt(x: number, y: number): void {
  const text = `${Math.round(x * 100) / 100},${Math.round(y * 100) / 100}mm`;
  change("place", { path: ["at"], value: text }, { path: ["center"], value: null });
  say(`The picture lies at ${text}`);
}

/** A step by keyboard. */
export function nudge(dx: number, dy: number): void {
  if (!liftPicture()) return;
  const [x, y] = corner();
  placeAt(x + dx, y + dy);
}
