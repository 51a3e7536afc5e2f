// Reads the words in which a style's table gives ranges and defaults.

import type { Parameter } from "../server/shapes.ts";

export type Kind =
  | { kind: "choice"; choices: string[] }
  | { kind: "number"; least: number; most: number; isWhole: boolean; unit: "mm" | "" }
  | { kind: "text"; hint: string };

export function kindOf(range: string): Kind {
  const choice = /^one of (.+)$/.exec(range);
  if (choice) return { kind: "choice", choices: choice[1]!.split(/,\s*/) };
  const number = /^(length|number|whole number), (-?[\d.]+) to (-?[\d.]+)/.exec(range);
  if (!number) return { kind: "text", hint: range };
  const [least, most] = [Number(number[2]), Number(number[3])];
  return { kind: "number", least, most, isWhole: number[1] === "whole number", unit: number[1] === "length" ? "mm" : "" };
}

/** The default as a number; lengths given in pitches follow the pitch. */
export function defaultNumber(parameter: Parameter, pitch: number): number | null {
  const found = /^(-?[\d.]+)\s*(mm|pitches)?$/.exec(parameter.default);
  if (!found) return null;
  return Number(found[1]) * (found[2] === "pitches" ? pitch : 1);
}

/** A value of the scene as a number: 0.5, "0.5", "0.5mm", "2cm". */
export function asNumber(value: unknown): number | null {
  if (typeof value === "number") return value;
  const found = /^\s*(-?[\d.]+(?:e-?\d+)?)\s*(mm|cm|in|pt)?\s*$/.exec(String(value ?? ""));
  if (!found) return null;
  return Number(found[1]) * { mm: 1, cm: 10, in: 25.4, pt: 25.4 / 72 }[(found[2] ?? "mm") as "mm"]!;
}

export function rounded(value: number): number {
  const digits = Math.abs(value) >= 100 ? 1 : Math.abs(value) >= 10 ? 2 : 3;
  return Number(value.toFixed(digits));
}

/** The part of a range that a slider covers: wide ranges around the default, in equal ratios where that is how one thinks. */
export interface Track {
  least: number;
  most: number;
  isRatio: boolean;
}

export function trackOf(kind: Extract<Kind, { kind: "number" }>, usual: number, value: number): Track {
  const { least, most, isWhole } = kind;
  const isWide = most - least > 40 * Math.max(Math.abs(usual), 0.05) && usual !== 0;
  if (!isWide || least < 0) {
    const reach = least < -360 ? 4 * Math.max(1, Math.abs(usual)) : Infinity;
    return { least: Math.min(value, Math.max(least, usual - reach)), most: Math.max(value, Math.min(most, usual + reach)), isRatio: false };
  }
  if (isWhole) return { least, most: Math.max(value, Math.min(most, 8 * usual)), isRatio: false };
  const low = Math.max(least, usual / 8);
  return { least: Math.min(low, value > 0 ? value : low), most: Math.max(value, Math.min(most, usual * 8)), isRatio: true };
}

/** Sliders run from 0 to 1000. */
export function toTrack(track: Track, value: number): number {
  if (track.most <= track.least) return 0;
  const share = track.isRatio
    ? Math.log(Math.max(value, track.least) / track.least) / Math.log(track.most / track.least)
    : (value - track.least) / (track.most - track.least);
  return Math.round(1000 * Math.min(1, Math.max(0, share)));
}

export function fromTrack(track: Track, place: number, isWhole: boolean): number {
  const share = place / 1000;
  const value = track.isRatio ? track.least * (track.most / track.least) ** share : track.least + (track.most - track.least) * share;
  if (isWhole) return Math.round(value);
  // Three significant digits: as exact as a hand on a slider.
  return value === 0 ? 0 : Number(value.toPrecision(3));
}
