// What the page and its worker say to each other.

import type { PlotShown, Shown } from "../model/store.ts";

export interface View {
  /** Pixels of the canvas per millimetre, and the sheet's corner on the canvas. */
  scale: number;
  x: number;
  y: number;
  width: number;
  height: number;
}

export type ToWorker =
  | { kind: "load"; id: string; path: string; token: string }
  | { kind: "tiles"; id: string; scale: number; tiles: [number, number][] }
  | { kind: "forget"; id: string }
  | { kind: "plot"; path: string; token: string; revision: number }
  | { kind: "playback"; view: View; time: number; hasTravel: boolean };

export type FromWorker =
  | { kind: "loaded"; shown: Shown }
  | { kind: "tile"; id: string; scale: number; column: number; row: number; bitmap: ImageBitmap }
  | { kind: "plotted"; plot: PlotShown; ends: Float64Array }
  | { kind: "played"; view: View; time: number; bitmap: ImageBitmap }
  | { kind: "failed"; of: "load" | "plot"; id: string; message: string };
