// Marks in typed arrays, so that 100,000 of them cost no object each, with a grid over the page that finds those of a tile.

import type { Layer, Marks } from "../server/shapes.ts";

/** A run of marks of one kind and colour within a layer. Later runs lie over earlier ones. */
export interface Run {
  kind: "dots" | "shapes" | "strokes";
  color: string;
  /** Dots: x, y, radius. Strokes: x, y, half width, of every point. Shapes: x, y. */
  numbers: Float32Array;
  /** Where each mark begins, in points, with the end of the last; dots need none. */
  begins: Uint32Array;
  /** Strokes: 1 closed; 2 of one width throughout. Shapes: 1 where a new shape begins, so that its rings are filled together. */
  flags: Uint8Array;
  count: number;
  grid: Grid;
}

/** Cells of the page with the marks that touch them. */
export interface Grid {
  columns: number;
  rows: number;
  cell: number;
  starts: Uint32Array;
  members: Uint32Array;
}

export interface Packed {
  page: [number, number];
  paper: string;
  runs: Run[];
  count: number;
}

export function pack(marks: Marks): Packed {
  const runs: Run[] = [];
  let count = 0;
  for (const layer of marks.layers) {
    count += layer.dots.length + layer.strokes.length + layer.areas.length;
    runs.push(...packLayer(layer, marks.page_mm));
  }
  return { page: marks.page_mm, paper: marks.paper, runs, count };
}

function packLayer(layer: Layer, page: [number, number]): Run[] {
  const shaped = new Map<number, [number, number][][]>();
  for (const [index, ring] of layer.outlines ?? []) {
    const rings = shaped.get(index);
    if (rings) rings.push(ring);
    else shaped.set(index, [ring]);
  }
  const round = new Groups<number>();
  const shapes = new Groups<[number, number][][]>();
  const strokes = new Groups<number>();
  const colors = layer.colors ?? {};
  layer.areas.forEach((area, index) => shapes.add(colors["areas"]?.[index] ?? layer.color, area));
  layer.dots.forEach((_, index) => {
    const color = colors["dots"]?.[index] ?? layer.color;
    const rings = shaped.get(index);
    if (rings) shapes.add(color, rings);
    else round.add(color, index);
  });
  layer.strokes.forEach((_, index) => strokes.add(colors["strokes"]?.[index] ?? layer.color, index));
  return [
    ...shapes.map((color, items) => packShapes(color, items, page)),
    ...round.map((color, items) => packDots(color, items, layer, page)),
    ...strokes.map((color, items) => packStrokes(color, items, layer, page)),
  ];
}

class Groups<Item> {
  private readonly byColor = new Map<string, Item[]>();

  add(color: string, item: Item): void {
    const items = this.byColor.get(color);
    if (items) items.push(item);
    else this.byColor.set(color, [item]);
  }

  map<Result>(turn: (color: string, items: Item[]) => Result): Result[] {
    return [...this.byColor].map(([color, items]) => turn(color, items));
  }
}

function packDots(color: string, items: number[], layer: Layer, page: [number, number]): Run {
  const numbers = new Float32Array(items.length * 3);
  items.forEach((item, index) => numbers.set(layer.dots[item]!, 3 * index));
  const box = (index: number, out: Float64Array) => {
    const [x, y, r] = [numbers[3 * index]!, numbers[3 * index + 1]!, numbers[3 * index + 2]!];
    out.set([x - r, y - r, x + r, y + r]);
  };
  const none = new Uint32Array(0);
  return { kind: "dots", color, numbers, begins: none, flags: new Uint8Array(0), count: items.length, grid: gridOf(items.length, box, page) };
}

function packShapes(color: string, items: [number, number][][][], page: [number, number]): Run {
  const rings = items.flatMap((item) => item.map((ring, index) => ({ ring, isFirst: index === 0 })));
  const begins = new Uint32Array(rings.length + 1);
  rings.forEach(({ ring }, index) => (begins[index + 1] = begins[index]! + ring.length));
  const numbers = new Float32Array(2 * begins[rings.length]!);
  rings.forEach(({ ring }, index) => ring.forEach((point, i) => numbers.set(point, 2 * (begins[index]! + i))));
  const flags = Uint8Array.from(rings, ({ isFirst }) => (isFirst ? 1 : 0));
  const firsts = rings.flatMap(({ isFirst }, index) => (isFirst ? [index] : []));
  firsts.push(rings.length);
  // A shape is found by its first ring; its other rings follow.
  const box = (index: number, out: Float64Array) => boxOf(numbers, 2, begins[firsts[index]!]!, begins[firsts[index + 1]!]!, 0, out);
  const grid = gridOf(firsts.length - 1, box, page);
  grid.members.forEach((member, index) => (grid.members[index] = firsts[member]!));
  return { kind: "shapes", color, numbers, begins, flags, count: rings.length, grid };
}

function packStrokes(color: string, items: number[], layer: Layer, page: [number, number]): Run {
  const begins = new Uint32Array(items.length + 1);
  items.forEach((item, index) => (begins[index + 1] = begins[index]! + layer.strokes[item]!.points.length));
  const numbers = new Float32Array(3 * begins[items.length]!);
  const flags = new Uint8Array(items.length);
  const widest = new Float32Array(items.length);
  items.forEach((item, index) => {
    const { points, widths, closed } = layer.strokes[item]!;
    let [least, most] = [Infinity, 0];
    points.forEach(([x, y], i) => {
      const width = widths[i] ?? widths[0] ?? layer.pen_mm;
      least = Math.min(least, width);
      most = Math.max(most, width);
      numbers.set([x, y, 0.5 * width], 3 * (begins[index]! + i));
    });
    widest[index] = 0.5 * most;
    flags[index] = (closed ? 1 : 0) | (most - least < 1e-4 ? 2 : 0);
  });
  const box = (index: number, out: Float64Array) => boxOf(numbers, 3, begins[index]!, begins[index + 1]!, widest[index]!, out);
  return { kind: "strokes", color, numbers, begins, flags, count: items.length, grid: gridOf(items.length, box, page) };
}

function boxOf(numbers: Float32Array, width: number, from: number, to: number, border: number, out: Float64Array): void {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let point = from; point < to; point++) {
    const x = numbers[width * point]!;
    const y = numbers[width * point + 1]!;
    left = Math.min(left, x);
    top = Math.min(top, y);
    right = Math.max(right, x);
    bottom = Math.max(bottom, y);
  }
  out.set([left - border, top - border, right + border, bottom + border]);
}

/** Counts first and fills then, so that the members of all cells lie in one array. */
function gridOf(count: number, box: (index: number, out: Float64Array) => void, page: [number, number]): Grid {
  const cell = Math.max(page[0], page[1]) / 64;
  const columns = Math.max(1, Math.ceil(page[0] / cell));
  const rows = Math.max(1, Math.ceil(page[1] / cell));
  const grid: Grid = { columns, rows, cell, starts: new Uint32Array(columns * rows + 1), members: new Uint32Array(0) };
  const out = new Float64Array(4);
  const forCells = (index: number, act: (at: number) => void) => {
    box(index, out);
    eachCell(grid, out[0]!, out[1]!, out[2]!, out[3]!, act);
  };
  for (let index = 0; index < count; index++) forCells(index, (at) => grid.starts[at + 1]!++);
  for (let at = 0; at < columns * rows; at++) grid.starts[at + 1]! += grid.starts[at]!;
  const next = grid.starts.slice();
  grid.members = new Uint32Array(grid.starts[columns * rows]!);
  for (let index = 0; index < count; index++) forCells(index, (at) => (grid.members[next[at]!++] = index));
  return grid;
}

export function eachCell(grid: Grid, left: number, top: number, right: number, bottom: number, act: (at: number) => void): void {
  const within = (value: number, most: number) => Math.min(most - 1, Math.max(0, Math.floor(value / grid.cell)));
  const [first, last] = [within(left, grid.columns), within(right, grid.columns)];
  const [above, below] = [within(top, grid.rows), within(bottom, grid.rows)];
  for (let row = above; row <= below; row++) for (let column = first; column <= last; column++) act(row * grid.columns + column);
}

/** The marks of a run that may touch a box, in their order. */
export function within(run: Run, left: number, top: number, right: number, bottom: number): Uint32Array {
  const { grid } = run;
  let total = 0;
  eachCell(grid, left, top, right, bottom, (at) => (total += grid.starts[at + 1]! - grid.starts[at]!));
  const found = new Uint32Array(total);
  let filled = 0;
  eachCell(grid, left, top, right, bottom, (at) => {
    const members = grid.members.subarray(grid.starts[at]!, grid.starts[at + 1]!);
    found.set(members, filled);
    filled += members.length;
  });
  found.sort();
  let kept = 0;
  for (let index = 0; index < total; index++) {
    if (index === 0 || found[index] !== found[index - 1]) found[kept++] = found[index]!;
  }
  return found.subarray(0, kept);
}
