// Paints a plot up to a moment. Going forward in the same view only adds what is new, so that playing costs little.

import type { View } from "./messages.ts";
import type { Sequence } from "./sequence.ts";

const TRAVEL_COLOR = "rgba(196, 76, 28, 0.55)";

export class Player {
  private readonly canvas = new OffscreenCanvas(1, 1);
  private readonly context = this.canvas.getContext("2d")!;
  private view: View | null = null;
  private hasTravel = false;
  private done = 0;

  constructor(private readonly sequence: Sequence) {}

  paint(view: View, time: number, hasTravel: boolean): Promise<ImageBitmap> {
    const { ends, count } = this.sequence;
    const isSame = this.view && this.hasTravel === hasTravel && (Object.keys(view) as (keyof View)[]).every((key) => view[key] === this.view![key]);
    const isBehind = this.done > 0 && ends[this.done - 1]! > time;
    if (!isSame || isBehind) this.restart(view, hasTravel);
    let last = this.done;
    while (last < count && ends[last]! <= time) last++;
    this.paintPaths(this.done, last);
    this.done = last;
    return createImageBitmap(this.withPen(time));
  }

  private restart(view: View, hasTravel: boolean): void {
    if (this.canvas.width !== view.width || this.canvas.height !== view.height) {
      this.canvas.width = view.width;
      this.canvas.height = view.height;
    }
    this.view = view;
    this.hasTravel = hasTravel;
    this.done = 0;
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, view.width, view.height);
    this.context.setTransform(view.scale, 0, 0, view.scale, view.x, view.y);
    this.context.lineCap = "round";
    this.context.lineJoin = "round";
  }

  private paintPaths(from: number, to: number): void {
    const { sequence, context } = this;
    for (let start = from; start < to; ) {
      let end = start;
      while (end < to && end - start < 300 && sequence.pens[end] === sequence.pens[start]) end++;
      if (this.hasTravel) this.paintTravel(start, end);
      context.strokeStyle = sequence.colors[sequence.pens[start]!]!;
      context.lineWidth = sequence.widths[start]!;
      context.beginPath();
      for (let path = start; path < end; path++) this.trace(path, 1);
      context.stroke();
      start = end;
    }
  }

  private paintTravel(from: number, to: number): void {
    const { points, begins } = this.sequence;
    this.context.strokeStyle = TRAVEL_COLOR;
    this.context.lineWidth = 0.8 / this.view!.scale;
    this.context.beginPath();
    for (let path = Math.max(1, from); path < to; path++) {
      const at = 2 * begins[path]!;
      this.context.moveTo(points[at - 2]!, points[at - 1]!);
      this.context.lineTo(points[at]!, points[at + 1]!);
    }
    this.context.stroke();
  }

  /** Traces a path, or its first part; returns where the pen is then. */
  private trace(path: number, share: number, context: OffscreenCanvasRenderingContext2D = this.context): [number, number] {
    const { points, begins } = this.sequence;
    const [from, to] = [begins[path]!, begins[path + 1]!];
    let [x, y] = [points[2 * from]!, points[2 * from + 1]!];
    context.moveTo(x, y);
    if (to - from === 1) context.lineTo(x, y + 1e-4);
    const last = from + Math.round((to - from - 1) * share);
    for (let point = from + 1; point <= last; point++) {
      [x, y] = [points[2 * point]!, points[2 * point + 1]!];
      context.lineTo(x, y);
    }
    return [x, y];
  }

  private withPen(time: number): OffscreenCanvas {
    const { sequence, view, done } = this;
    const copy = new OffscreenCanvas(view!.width, view!.height);
    const context = copy.getContext("2d")!;
    context.drawImage(this.canvas, 0, 0);
    if (done >= sequence.count) return copy;
    context.setTransform(view!.scale, 0, 0, view!.scale, view!.x, view!.y);
    context.lineCap = "round";
    context.strokeStyle = sequence.colors[sequence.pens[done]!]!;
    context.lineWidth = sequence.widths[done]!;
    context.beginPath();
    const span = sequence.ends[done]! - sequence.starts[done]!;
    const share = Math.min(1, Math.max(0, span > 0 ? (time - sequence.starts[done]!) / span : 1));
    const [x, y] = this.trace(done, share, context);
    if (share > 0) context.stroke();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.strokeStyle = "#c44c1c";
    context.lineWidth = 2;
    context.beginPath();
    context.arc(x * view!.scale + view!.x, y * view!.scale + view!.y, 7, 0, 2 * Math.PI);
    context.stroke();
    return copy;
  }
}
