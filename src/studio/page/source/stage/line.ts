// The pen: thin lines on the masks of edges, isophotes and directions. Clicks join into a polyline, dragging draws freehand.

import { say } from "../model/scene.ts";
import { now, set } from "../model/store.ts";
import { stroke, type Brush, type Touch } from "./brush.ts";
import { isTaken, LINE_ROLES, setVisible } from "./masks.ts";

/** Width of a line in pixels of the mask: thinner ones would break where the picture is made smaller. */
const WIDTH = 2.5;

let corner: Touch | null = null;

/** Makes a mask of lines the one that is painted; false if the style takes none. */
export function chooseLines(): boolean {
  const { mask } = now();
  const role = LINE_ROLES.includes(mask.role) && isTaken(mask.role) ? mask.role : LINE_ROLES.find(isTaken);
  if (!role) {
    say("This style takes no drawn lines");
    return false;
  }
  set({ mask: { ...mask, role } });
  setVisible(role, true);
  return true;
}

export function lineBrush(isErasing: boolean): Brush {
  return { role: now().mask.role, size: isErasing ? 4 * WIDTH : WIDTH, feather: 0, isErasing };
}

/** A corner of the polyline: the line from the corner before leads to it. */
export function addCorner(canvas: OffscreenCanvas, to: Touch, isErasing: boolean): void {
  stroke(canvas, lineBrush(isErasing), corner ?? to, to);
  corner = to;
}

/** The next corner begins a line of its own. */
export function endLine(): void {
  corner = null;
}
