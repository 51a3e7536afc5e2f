// Paints the marks of one tile.

import { colorPixels, cover } from "./discs.ts";
import { within, type Packed, type Run } from "./pack.ts";
import { addSwelling } from "./swelling.ts";

type Canvas = OffscreenCanvasRenderingContext2D;

/** Dots below this radius in pixels are set pixel by pixel. */
const SMALL = 4;
/** Arcs in one path: a path costs more than its arcs' sum. */
const ARCS = 400;

export const SIDE = 512;

const coverage = new Float32Array(SIDE * SIDE);
const pixels = new ImageData(SIDE, SIDE);
const dotCanvas = new OffscreenCanvas(SIDE, SIDE);
const dotContext = dotCanvas.getContext("2d")!;

/** Paints the tile in this column and row, `scale` pixels per millimetre. */
export function paintTile(context: Canvas, packed: Packed, scale: number, column: number, row: number): void {
  const [left, top] = [column * SIDE, row * SIDE];
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.fillStyle = packed.paper;
  context.fillRect(0, 0, SIDE, SIDE);
  const border = 1 / scale;
  for (const run of packed.runs) {
    const members = within(run, left / scale - border, top / scale - border, (left + SIDE) / scale + border, (top + SIDE) / scale + border);
    if (members.length === 0) continue;
    if (run.kind === "dots") paintDots(context, run, members, scale, left, top);
    else {
      context.setTransform(scale, 0, 0, scale, -left, -top);
      if (run.kind === "shapes") paintShapes(context, run, members, scale);
      else paintStrokes(context, run, members, scale);
    }
  }
}

function paintDots(context: Canvas, run: Run, members: Uint32Array, scale: number, left: number, top: number): void {
  const small = members.filter((member) => run.numbers[3 * member + 2]! * scale < SMALL);
  if (small.length > 0) {
    coverage.fill(0);
    cover(coverage, SIDE, run, small, scale, left, top);
    colorPixels(pixels.data, coverage, run.color);
    dotContext.putImageData(pixels, 0, 0);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(dotCanvas, 0, 0);
  }
  if (small.length === members.length) return;
  context.setTransform(scale, 0, 0, scale, -left, -top);
  context.fillStyle = run.color;
  let arcs = 0;
  context.beginPath();
  for (const member of members) {
    const radius = run.numbers[3 * member + 2]!;
    if (radius * scale < SMALL) continue;
    const [x, y] = [run.numbers[3 * member]!, run.numbers[3 * member + 1]!];
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
    if (++arcs % ARCS === 0) {
      context.fill();
      context.beginPath();
    }
  }
  context.fill();
}

function paintShapes(context: Canvas, run: Run, members: Uint32Array, scale: number): void {
  context.fillStyle = run.color;
  const least = (0.3 / scale) ** 2;
  for (const first of members) {
    context.beginPath();
    for (let ring = first; ring < run.count && (ring === first || run.flags[ring] === 0); ring++) {
      trace(context, run.numbers, 2, run.begins[ring]!, run.begins[ring + 1]!, least);
      context.closePath();
    }
    context.fill("nonzero");
  }
}

/** Points nearer than a third of a pixel to the last one are left out; the ends stay. */
function trace(context: Canvas, numbers: Float32Array, width: number, from: number, to: number, least: number): void {
  let x = numbers[width * from]!;
  let y = numbers[width * from + 1]!;
  context.moveTo(x, y);
  for (let point = from + 1; point < to; point++) {
    const nextX = numbers[width * point]!;
    const nextY = numbers[width * point + 1]!;
    if (point < to - 1 && (nextX - x) ** 2 + (nextY - y) ** 2 < least) continue;
    [x, y] = [nextX, nextY];
    context.lineTo(x, y);
  }
}

function paintStrokes(context: Canvas, run: Run, members: Uint32Array, scale: number): void {
  const byWidth = new Map<number, number[]>();
  const swelling: number[] = [];
  for (const member of members) {
    if ((run.flags[member]! & 2) === 0) {
      swelling.push(member);
      continue;
    }
    const width = Math.round(2000 * run.numbers[3 * run.begins[member]! + 2]!) / 1000;
    const same = byWidth.get(width);
    if (same) same.push(member);
    else byWidth.set(width, [member]);
  }
  const least = (0.35 / scale) ** 2;
  context.strokeStyle = run.color;
  context.lineCap = "round";
  context.lineJoin = "round";
  for (const [width, same] of byWidth) {
    context.lineWidth = width;
    context.beginPath();
    for (const member of same) {
      trace(context, run.numbers, 3, run.begins[member]!, run.begins[member + 1]!, least);
      if (run.flags[member]! & 1) context.closePath();
    }
    context.stroke();
  }
  paintSwelling(context, run, swelling, scale);
}

function paintSwelling(context: Canvas, run: Run, swelling: number[], scale: number): void {
  context.fillStyle = run.color;
  const least = (0.45 / scale) ** 2;
  for (let from = 0; from < swelling.length; from += ARCS) {
    context.beginPath();
    for (const member of swelling.slice(from, from + ARCS)) addSwelling(context, run, member, least, scale);
    context.fill("nonzero");
  }
}
