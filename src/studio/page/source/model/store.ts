// One place for what the page knows. Parts of the page subscribe to what they show.

import { useEffect, useReducer, useRef } from "preact/hooks";
import type { Drawing, Exported, PenUse, Photograph, Quality, Scene, Start, Value } from "../server/shapes.ts";

export type ViewMode = "drawing" | "divider" | "side" | "photograph";
export type Tool = "line" | "hand" | "part" | "place" | "brush" | "eraser" | "lasso" | "fill";
export type Panel = "masks" | "regions" | "sheet" | "scene";

/** What is on the sheet now, without its marks: the worker has those. */
export interface Shown extends Omit<Drawing, "id" | "marks"> {
  id: string;
  page: [number, number];
  paper: string;
  count: number;
  layers: { name: string; pen: number; color: string; count: number }[];
}

export interface PlotShown {
  machine: string;
  seconds: number;
  summary: string;
  paths: number;
  revision: number;
  pens: PenUse[];
}

export interface Playback {
  isOn: boolean;
  isPlaying: boolean;
  time: number;
  speed: number;
  hasTravel: boolean;
  /** A jump to this path, for stepping. */
  path: number;
}

export interface MaskTools {
  role: string;
  size: number;
  feather: number;
  opacity: number;
  usesPressure: boolean;
  isErasing: boolean;
}

export interface Film {
  isOpen: boolean;
  stages: { file: string; name: string }[];
  /** Of the scene from which they were made. */
  revision: number;
  isBusy: boolean;
  fault: string | null;
  chosen: string | null;
}

/** What the sender last said of the drawing that is on its way to a machine. */
export interface Sending {
  state: string;
  file: string;
  port: string;
  machine: string;
  fraction?: number;
  seconds_left?: number;
  paths?: number;
  paths_in_all?: number;
  pen?: number;
  name?: string;
  fault?: string | null;
}

export type Box = [number, number, number, number];

export interface State {
  start: Start | null;
  scene: Scene | null;
  shown: Shown | null;
  work: { quality: Quality; revision: number; stage: string } | null;
  failure: { revision: number; message: string } | null;
  sight: { state: string; message: string } | null;
  isConnected: boolean;
  fault: string | null;
  note: string;
  mode: ViewMode;
  divider: number;
  showsPhotograph: boolean;
  tool: Tool;
  panel: Panel;
  isLeftOpen: boolean;
  isRightOpen: boolean;
  dialog: null | "send" | "export" | "help" | "calibrate";
  exported: Exported | null;
  zoom: number;
  masks: { role: string; isThere: boolean; isPainted: boolean; isVisible: boolean }[];
  maskSize: [number, number] | null;
  mask: MaskTools;
  plot: PlotShown | null;
  isPlotting: boolean;
  plotFault: string | null;
  playback: Playback;
  film: Film;
  /** The error of tone over the drawing: its picture, and of which state of the scene. */
  tone: { isOn: boolean; isBusy: boolean; fault: string | null; file: string | null; revision: number };
  sending: Sending | null;
  /** The part of the sheet that is to be plotted: x, y, width, height in millimetres. */
  part: Box | null;
  hasPresets: boolean;
  other: string | null;
  /** Changes that are on their way, so that a slider does not jump back meanwhile. */
  pending: { [path: string]: Value };
}

const state: State = {
  start: null,
  scene: null,
  shown: null,
  work: null,
  failure: null,
  sight: null,
  isConnected: true,
  fault: null,
  note: "",
  mode: "drawing",
  divider: 0.5,
  showsPhotograph: false,
  tool: "hand",
  panel: "masks",
  isLeftOpen: true,
  isRightOpen: true,
  dialog: null,
  exported: null,
  zoom: 1,
  masks: [],
  maskSize: null,
  mask: { role: "hair", size: 60, feather: 0.3, opacity: 0.45, usesPressure: true, isErasing: false },
  plot: null,
  isPlotting: false,
  plotFault: null,
  playback: { isOn: false, isPlaying: false, time: 0, speed: 100, hasTravel: true, path: 0 },
  hasPresets: false,
  tone: { isOn: false, isBusy: false, fault: null, file: null, revision: -1 },
  sending: null,
  part: null,
  film: { isOpen: false, stages: [], revision: -1, isBusy: false, fault: null, chosen: null },
  other: null,
  pending: {},
};

type Listener = () => void;
const listeners = new Set<Listener>();

export function now(): Readonly<State> {
  return state;
}

export function set(change: Partial<State>): void {
  Object.assign(state, change);
  for (const listener of [...listeners]) listener();
}

export function subscribe(listener: Listener): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** A value of the state; the component is drawn again only when it changes. */
export function useStudio<T>(select: (state: Readonly<State>) => T): T {
  const [, redraw] = useReducer((count: number) => count + 1, 0);
  const selected = select(state);
  const last = useRef({ select, selected });
  last.current = { select, selected };
  useEffect(
    () =>
      subscribe(() => {
        const next = last.current.select(state);
        if (!Object.is(next, last.current.selected)) redraw(0 as never);
      }),
    [],
  );
  return selected;
}

export function photograph(): Photograph | null {
  return state.scene?.photograph ?? null;
}
