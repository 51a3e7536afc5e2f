// The shapes of what the server says.

export type Value = string | number | boolean | null | Value[] | { [key: string]: Value };
export type Table = { [key: string]: Value };
export type Path = (string | number)[];

export interface Parameter {
  name: string;
  range: string;
  default: string;
  meaning: string;
  source: string;
  needs: string;
}

export interface Style {
  name: string;
  summary: string;
  masks: { role: string; meaning: string }[];
  parameters: Parameter[];
}

export interface Preset {
  name: string;
  purpose: string;
  /** What the preset sets; without it the preset cannot be applied from the page. */
  values?: Table;
}

export interface Profile {
  name: string;
  description: string;
  pens: number;
}

export interface Option {
  type?: string | string[];
  enum?: string[];
  default?: string | number | boolean;
  description?: string;
}

export interface Start {
  version: string;
  styles: Style[];
  presets: Preset[];
  profiles: Profile[];
  schema: { properties: { [key: string]: Option } };
}

export interface Photograph {
  name: string;
  width: number;
  height: number;
}

export interface Scene {
  revision: number;
  file: string;
  folder: string;
  toml: string;
  values: Table;
  undo: number;
  redo: number;
  undo_label?: string | null;
  redo_label?: string | null;
  command: string;
  error: string | null;
  photograph: Photograph | null;
}

export type Affine = [number, number, number, number, number, number];

export interface Placement {
  pixels: [number, number];
  to_sheet: Affine;
  /** The picture's box on the sheet: x, y, width, height in millimetres. */
  box?: [number, number, number, number];
}

export type Quality = "coarse" | "full";

export interface Stroke {
  points: [number, number][];
  widths: number[];
  closed: boolean;
}

export interface Layer {
  name: string;
  pen: number;
  pen_mm: number;
  color: string;
  dots: [number, number, number][];
  outlines?: [number, [number, number][]][];
  strokes: Stroke[];
  areas: [number, number][][][];
  colors?: { [kind: string]: { [index: string]: string } };
  /** In a plot: the order of drawing; numbers below dots.length are dots, the others strokes. */
  order?: number[];
  /** In a plot: the second at which each path of the order is done. */
  times?: number[];
}

export interface Marks {
  page_mm: [number, number];
  paper: string;
  layers: Layer[];
}

export interface Drawing {
  id: string | number;
  quality: Quality;
  revision: number;
  seconds: number;
  summary: string;
  warnings: string[];
  placement: Placement | null;
  marks: Marks;
}

export interface PenUse {
  pen: number;
  name: string;
  color: string;
  seconds: number;
  ink_m: number;
  lifts: number;
}

export interface Plot {
  machine: string;
  seconds: number;
  summary?: string;
  marks: Marks;
  pens?: { pen: number; name: string; seconds: number; pen_down_mm: number; pen_lifts: number }[];
  total?: { paths: number; pen_down_mm: number; pen_up_mm: number; pen_lifts: number };
}

export interface Masks {
  roles: { role: string; is_there: boolean; is_painted: boolean }[];
  /** Of their grid; without it the photograph's, its long side at most 2048. */
  size?: [number, number];
}

export interface StageList {
  stages: { file: string; name: string }[];
  revision: number;
}

export interface Exported {
  file: string;
  bytes: number;
  command: string;
}
