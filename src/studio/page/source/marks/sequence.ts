// A plot as a sequence in time: every path with its points and the second at which it is done.

import type { Layer, PenUse, Plot } from "../server/shapes.ts";

export interface Sequence {
  count: number;
  points: Float32Array;
  begins: Uint32Array;
  widths: Float32Array;
  pens: Uint16Array;
  colors: string[];
  /** When each path begins and ends, in seconds. */
  starts: Float64Array;
  ends: Float64Array;
}

/** Where the server gives no times: usual speeds in mm/s and seconds per lift, scaled to its total. */
const [DRAWING, TRAVEL, LIFT] = [30, 80, 0.25];

function order(layer: Layer): number[] {
  return layer.order ?? Array.from({ length: layer.dots.length + layer.strokes.length }, (_, index) => index);
}

function pointsOf(layer: Layer, index: number): [number, number][] {
  const dot = layer.dots[index];
  if (dot) return [[dot[0], dot[1]]];
  const stroke = layer.strokes[index - layer.dots.length]!;
  return stroke.closed ? [...stroke.points, stroke.points[0]!] : stroke.points;
}

export function sequence(plot: Plot): Sequence {
  const paths = plot.marks.layers.flatMap((layer, pen) => order(layer).map((index) => ({ points: pointsOf(layer, index), pen })));
  const count = paths.length;
  const begins = new Uint32Array(count + 1);
  paths.forEach((path, index) => (begins[index + 1] = begins[index]! + path.points.length));
  const points = new Float32Array(2 * begins[count]!);
  paths.forEach((path, index) => path.points.forEach((point, i) => points.set(point, 2 * (begins[index]! + i))));
  const layers = plot.marks.layers;
  const pens = Uint16Array.from(paths, (path) => path.pen);
  const widths = Float32Array.from(paths, (path) => layers[path.pen]!.pen_mm || 0.3);
  const made = { count, points, begins, widths, pens, colors: layers.map((layer) => layer.color) };
  return { ...made, ...times(made, plot) };
}

function times(made: Pick<Sequence, "count" | "points" | "begins">, plot: Plot): Pick<Sequence, "starts" | "ends"> {
  const { count, points, begins } = made;
  const starts = new Float64Array(count);
  const ends = new Float64Array(count);
  let clock = 0;
  for (let index = 0; index < count; index++) {
    const from = begins[index]!;
    if (index > 0) clock += Math.hypot(points[2 * from]! - points[2 * from - 2]!, points[2 * from + 1]! - points[2 * from - 1]!) / TRAVEL;
    starts[index] = clock;
    clock += lengthOf(made, index) / DRAWING + LIFT;
    ends[index] = clock;
  }
  const given = plot.marks.layers.flatMap((layer) => layer.times ?? []);
  const factor = clock > 0 ? plot.seconds / clock : 1;
  for (let index = 0; index < count; index++) {
    starts[index] = given.length === count ? (index > 0 ? given[index - 1]! : 0) : starts[index]! * factor;
    ends[index] = given.length === count ? given[index]! : ends[index]! * factor;
  }
  return { starts, ends };
}

function lengthOf({ points, begins }: Pick<Sequence, "points" | "begins">, index: number): number {
  let length = 0;
  for (let point = begins[index]! + 1; point < begins[index + 1]!; point++) {
    length += Math.hypot(points[2 * point]! - points[2 * point - 2]!, points[2 * point + 1]! - points[2 * point - 1]!);
  }
  return length;
}

/** Time, ink and lifts of each pen, where the server does not give them. */
export function penUses(plot: Plot, played: Sequence): PenUse[] {
  const given = plot.pens;
  if (given) {
    const colors = new Map(plot.marks.layers.map((layer) => [layer.pen, layer.color]));
    return given.map(({ pen, name, seconds, pen_down_mm, pen_lifts }) => ({ pen, name, color: colors.get(pen) ?? "#000000", seconds, ink_m: pen_down_mm / 1000, lifts: pen_lifts }));
  }
  const uses = plot.marks.layers.map((layer) => ({ pen: layer.pen, name: layer.name, color: layer.color, seconds: 0, ink_m: 0, lifts: 0 }));
  for (let index = 0; index < played.count; index++) {
    const use = uses[played.pens[index]!]!;
    use.seconds += played.ends[index]! - (index > 0 ? played.ends[index - 1]! : 0);
    use.ink_m += lengthOf(played, index) / 1000;
    use.lifts += 1;
  }
  return uses;
}

/** The plot in a line, where the server does not say one. */
export function summaryOf(plot: Plot, uses: PenUse[]): string {
  if (plot.summary) return plot.summary;
  const ink = uses.reduce((sum, use) => sum + use.ink_m, 0);
  const travel = plot.total ? `, ${(plot.total.pen_up_mm / 1000).toFixed(1)} m of travel` : "";
  return `${plot.machine}: ${uses.length} ${uses.length === 1 ? "pen" : "pens"}, ${ink.toFixed(1)} m of ink${travel}`;
}
