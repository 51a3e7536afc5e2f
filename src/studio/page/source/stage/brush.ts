// Painting on a mask: brush and eraser as soft stamps along the way, a lasso's inside, and a fill of what is enclosed.

import { colorOf } from "./masks.ts";

export interface Touch {
  x: number;
  y: number;
  pressure: number;
}

export interface Brush {
  role: string;
  /** Diameter in pixels of the mask. */
  size: number;
  feather: number;
  isErasing: boolean;
}

type Context = OffscreenCanvasRenderingContext2D;

export function stroke(canvas: OffscreenCanvas, brush: Brush, from: Touch, to: Touch): void {
  const context = begin(canvas, brush);
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const count = Math.max(1, Math.ceil(length / Math.max(0.5, 0.08 * brush.size)));
  for (let step = 1; step <= count; step++) {
    const share = step / count;
    const pressure = from.pressure + (to.pressure - from.pressure) * share;
    stamp(context, brush, from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share, pressure);
  }
}

function begin(canvas: OffscreenCanvas, brush: Brush): Context {
  const context = canvas.getContext("2d")!;
  context.globalCompositeOperation = brush.isErasing ? "destination-out" : "source-over";
  context.fillStyle = colorOf(brush.role);
  return context;
}

function stamp(context: Context, brush: Brush, x: number, y: number, pressure: number): void {
  const radius = Math.max(0.5, 0.5 * brush.size * pressure);
  if (brush.feather > 0.02) {
    const color = colorOf(brush.role);
    const soft = context.createRadialGradient(x, y, radius * (1 - brush.feather), x, y, radius);
    soft.addColorStop(0, color);
    soft.addColorStop(1, `${color}00`);
    context.fillStyle = soft;
  }
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

export function fillLasso(canvas: OffscreenCanvas, brush: Brush, points: Touch[]): void {
  if (points.length < 3) return;
  const context = begin(canvas, brush);
  const soft = Math.round(brush.feather * brush.size * 0.25);
  context.filter = soft > 0 ? `blur(${soft}px)` : "none";
  context.beginPath();
  points.forEach(({ x, y }, index) => (index === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.closePath();
  context.fill();
  context.filter = "none";
}

/** Fills the part around a point that is enclosed by what is inside; erasing, it empties the part that the point lies in. */
export function flood(canvas: OffscreenCanvas, brush: Brush, x: number, y: number): void {
  const { width, height } = canvas;
  const context = canvas.getContext("2d")!;
  const pixels = context.getImageData(0, 0, width, height);
  const color = Number.parseInt(colorOf(brush.role).slice(1), 16);
  const isOpen = (at: number) => pixels.data[4 * at + 3]! >= 128 === brush.isErasing;
  const stack = [Math.floor(y) * width + Math.floor(x)];
  while (stack.length > 0) {
    const at = stack.pop()!;
    if (!isOpen(at)) continue;
    let [left, right] = [at, at];
    const row = at - (at % width);
    while (left > row && isOpen(left - 1)) left--;
    while (right < row + width - 1 && isOpen(right + 1)) right++;
    for (let pixel = left; pixel <= right; pixel++) {
      pixels.data.set([color >> 16, (color >> 8) & 255, color & 255, brush.isErasing ? 0 : 255], 4 * pixel);
    }
    for (let pixel = left; pixel <= right; pixel++) {
      if (pixel >= width && isOpen(pixel - width)) stack.push(pixel - width);
      if (pixel < width * (height - 1) && isOpen(pixel + width)) stack.push(pixel + width);
    }
  }
  context.putImageData(pixels, 0, 0);
}
