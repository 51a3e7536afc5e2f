// What pointer and wheel do on the canvas, by tool.

import { say } from "../model/scene.ts";
import { now } from "../model/store.ts";
import { flood, fillLasso, stroke, type Brush, type Touch } from "./brush.ts";
import { camera } from "./camera.ts";
import { overlay, redraw } from "./engine.ts";
import { canvasToPaint, maskPainted, sendSoon, setVisible } from "./masks.ts";
import { apply, inverse, photographToSheet } from "./photograph.ts";
import { addCorner, endLine, lineBrush } from "./line.ts";
import { dragPart, settlePart } from "./part.ts";
import { dropPicture, liftPicture, movePicture } from "./placing.ts";

type Action = { kind: "pan" } | { kind: "part"; from: { x: number; y: number } } | { kind: "place" } | { kind: "paint"; last: Touch; hasMoved: boolean } | { kind: "lasso"; points: Touch[] };

const TOO_EARLY = "The mask is not there yet; wait a moment";

const pointers = new Map<number, { x: number; y: number }>();
let action: Action | null = null;

function at(event: PointerEvent | WheelEvent): { x: number; y: number } {
  const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
  const x = (event.clientX - box.left) * camera.density;
  const origin = now().mode === "side" && x > camera.width ? box.width * camera.density - camera.width : 0;
  return { x: x - origin, y: (event.clientY - box.top) * camera.density };
}

/** A point of the pane in pixels of the mask. */
function touchOf(event: PointerEvent): Touch {
  const { x, y } = at(event);
  const { pixels, affine } = photographToSheet(camera.page);
  const size = now().maskSize ?? pixels;
  const [px, py] = apply(inverse(affine), ...camera.toSheet(x, y));
  const { usesPressure } = now().mask;
  const pressure = event.pointerType === "pen" && usesPressure ? Math.max(0.1, event.pressure) : 1;
  return { x: (px * size[0]) / pixels[0], y: (py * size[1]) / pixels[1], pressure };
}

export function brushOf(isErasing: boolean): Brush {
  const { role, size, feather } = now().mask;
  return { role, size, feather, isErasing };
}

/** The brush's diameter on the screen, in pixels of the page's layout. */
export function brushOnScreen(): number {
  const { pixels, affine } = photographToSheet(camera.page);
  const size = now().maskSize ?? pixels;
  return (now().mask.size * pixels[0] * Math.hypot(affine[0], affine[1]) * camera.scale) / size[0] / camera.density;
}

function isErasing(event: PointerEvent): boolean {
  return now().tool === "eraser" || event.altKey || event.buttons === 32;
}

export function pressed(event: PointerEvent): void {
  (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
  (event.currentTarget as HTMLElement).focus({ preventScroll: true });
  pointers.set(event.pointerId, at(event));
  const { tool } = now();
  if (pointers.size > 1 || event.button === 1 || tool === "hand") action = { kind: "pan" };
  else if (tool === "part") action = { kind: "part", from: at(event) };
  else if (tool === "place") action = liftPicture() ? { kind: "place" } : { kind: "pan" };
  else startPainting(event, tool);
}

function startPainting(event: PointerEvent, tool: string): void {
  const { role } = now().mask;
  const canvas = canvasToPaint(role);
  const touch = touchOf(event);
  if (!now().masks.find((mask) => mask.role === role)?.isVisible) setVisible(role, true);
  if (!canvas) return say(TOO_EARLY);
  if (tool === "fill") {
    if (touch.x < 0 || touch.y < 0 || touch.x >= canvas.width || touch.y >= canvas.height) return;
    flood(canvas, brushOf(isErasing(event)), touch.x, touch.y);
    finishPainting();
  } else if (tool === "line") {
    addCorner(canvas, touch, isErasing(event));
    action = { kind: "paint", last: touch, hasMoved: false };
    maskPainted();
  } else if (tool === "lasso") action = { kind: "lasso", points: [touch] };
  else {
    stroke(canvas, brushOf(isErasing(event)), touch, touch);
    action = { kind: "paint", last: touch, hasMoved: false };
    maskPainted();
  }
}

export function moved(event: PointerEvent): void {
  const last = pointers.get(event.pointerId);
  const point = at(event);
  if (!last || !action) return;
  pointers.set(event.pointerId, point);
  if (pointers.size === 2) return pinch(event.pointerId, last, point);
  if (action.kind === "pan") camera.pan(point.x - last.x, point.y - last.y);
  else if (action.kind === "part") dragPart(action.from, point);
  else if (action.kind === "place") movePicture((point.x - last.x) / camera.scale, (point.y - last.y) / camera.scale, event.altKey);
  else for (const one of event.getCoalescedEvents?.().length ? event.getCoalescedEvents() : [event]) paintOn(event, one);
}

function paintOn(event: PointerEvent, one: PointerEvent): void {
  const canvas = canvasToPaint(now().mask.role);
  if (!canvas) return;
  Object.defineProperty(one, "currentTarget", { value: event.currentTarget, configurable: true });
  const touch = touchOf(one);
  if (action?.kind === "paint") {
    // A hand that trembles while it sets a corner draws nothing.
    if (now().tool === "line" && !action.hasMoved && Math.hypot(touch.x - action.last.x, touch.y - action.last.y) < 3) return;
    stroke(canvas, now().tool === "line" ? lineBrush(isErasing(event)) : brushOf(isErasing(event)), action.last, touch);
    action.last = touch;
    action.hasMoved = true;
    maskPainted();
  } else if (action?.kind === "lasso") {
    action.points.push(touch);
    const { x, y } = at(one);
    overlay.lasso.push([x, y]);
    redraw();
  }
}

function pinch(id: number, last: { x: number; y: number }, point: { x: number; y: number }): void {
  const other = [...pointers].find(([pointer]) => pointer !== id)?.[1];
  if (!other) return;
  const before = Math.hypot(last.x - other.x, last.y - other.y);
  const after = Math.hypot(point.x - other.x, point.y - other.y);
  camera.pan((point.x - last.x) / 2, (point.y - last.y) / 2);
  if (before > 10) camera.zoom(after / before, (point.x + other.x) / 2, (point.y + other.y) / 2);
}

export function released(event: PointerEvent): void {
  pointers.delete(event.pointerId);
  if (!action || pointers.size > 0) return;
  const canvas = canvasToPaint(now().mask.role);
  if (action.kind === "lasso" && canvas) fillLasso(canvas, brushOf(isErasing(event)), action.points);
  if (action.kind === "paint" && action.hasMoved) endLine();
  if (action.kind === "paint" || action.kind === "lasso") finishPainting();
  if (action.kind === "place") dropPicture();
  if (action.kind === "part") settlePart();
  overlay.lasso = [];
  action = null;
  redraw();
}

function finishPainting(): void {
  maskPainted();
  sendSoon(now().mask.role);
}

export function wheeled(event: WheelEvent): void {
  event.preventDefault();
  const { x, y } = at(event);
  const unit = event.deltaMode === 1 ? 18 : 1;
  if (event.shiftKey) camera.pan(-event.deltaY * unit - event.deltaX * unit, 0);
  else camera.zoom(Math.exp(-event.deltaY * unit * (event.ctrlKey ? 0.01 : 0.0016)), x, y);
}

/** Paints or erases by keyboard, in the middle of the view. */
export function paintInMiddle(): void {
  const { tool, mask } = now();
  const canvas = canvasToPaint(mask.role);
  if (!canvas) return (setVisible(mask.role, true), say(TOO_EARLY));
  const { pixels, affine } = photographToSheet(camera.page);
  const [px, py] = apply(inverse(affine), ...camera.toSheet(camera.width / 2, camera.height / 2));
  const touch = { x: (px * canvas.width) / pixels[0], y: (py * canvas.height) / pixels[1], pressure: 1 };
  if (tool === "fill") flood(canvas, brushOf(false), touch.x, touch.y);
  else if (tool === "line") addCorner(canvas, touch, false);
  else stroke(canvas, brushOf(tool === "eraser"), touch, touch);
  setVisible(mask.role, true);
  finishPainting();
}
