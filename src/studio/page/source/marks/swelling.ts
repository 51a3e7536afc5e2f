// A stroke whose width changes, as a polygon: along its left side and back along its right side, with round ends.

import type { Run } from "./pack.ts";

type Canvas = OffscreenCanvasRenderingContext2D;

const kept: number[] = [];

function keepPoints(run: Run, member: number, least: number): number {
  kept.length = 0;
  const [from, to] = [run.begins[member]!, run.begins[member + 1]!];
  let [x, y] = [NaN, NaN];
  for (let point = from; point < to; point++) {
    const nextX = run.numbers[3 * point]!;
    const nextY = run.numbers[3 * point + 1]!;
    if (point > from && point < to - 1 && (nextX - x) ** 2 + (nextY - y) ** 2 < least) continue;
    if (nextX === x && nextY === y) continue;
    [x, y] = [nextX, nextY];
    kept.push(x, y, run.numbers[3 * point + 2]!);
  }
  return kept.length / 3;
}

export function addSwelling(context: Canvas, run: Run, member: number, least: number, scale: number): void {
  const count = keepPoints(run, member, least);
  if (count === 0) return;
  if (count === 1) {
    context.moveTo(kept[0]! + kept[2]!, kept[1]!);
    context.arc(kept[0]!, kept[1]!, kept[2]!, 0, 2 * Math.PI);
    return;
  }
  const isClosed = (run.flags[member]! & 1) !== 0;
  side(context, count, 0, 1, 1, isClosed, true);
  if (isClosed) context.closePath();
  else cap(context, count - 1, count - 2, scale);
  side(context, count, count - 1, -1, -1, isClosed, isClosed);
  if (!isClosed) cap(context, 0, 1, scale);
  context.closePath();
}

/** One side: the points, each shifted by half its width across the mean direction there. */
function side(context: Canvas, count: number, first: number, step: number, sign: number, isClosed: boolean, begins: boolean): void {
  for (let walked = 0, point = first; walked < count; walked++, point += step) {
    const before = isClosed ? (point + count - 1) % count : Math.max(0, point - 1);
    const after = isClosed ? (point + 1) % count : Math.min(count - 1, point + 1);
    const dx = kept[3 * after]! - kept[3 * before]!;
    const dy = kept[3 * after + 1]! - kept[3 * before + 1]!;
    const shift = (sign * kept[3 * point + 2]!) / (Math.hypot(dx, dy) || 1);
    const x = kept[3 * point]! - dy * shift;
    const y = kept[3 * point + 1]! + dx * shift;
    if (begins && walked === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
}

function cap(context: Canvas, end: number, neighbour: number, scale: number): void {
  const radius = kept[3 * end + 2]!;
  if (radius * scale < 0.6) return;
  const [x, y] = [kept[3 * end]!, kept[3 * end + 1]!];
  const ahead = Math.atan2(y - kept[3 * neighbour + 1]!, x - kept[3 * neighbour]!);
  context.arc(x, y, radius, ahead + 0.5 * Math.PI, ahead - 0.5 * Math.PI, true);
}
