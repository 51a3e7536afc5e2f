// An option of the scene, made from the schema.

import { change, valueAt } from "../model/scene.ts";
import { useStudio } from "../model/store.ts";
import type { Option, Path, Value } from "../server/shapes.ts";
import { asNumber, type Kind } from "../style/range.ts";
import { ChoiceRow, NumberRow, SwitchRow, TextRow } from "./row.tsx";

/** Ranges that the schema's descriptions end with: "(0 to 1)". */
function rangeOf(option: Option): Extract<Kind, { kind: "number" }> | null {
  const found = /\((-?[\d.]+) to (-?[\d.]+)( mm)?\)/.exec(option.description ?? "");
  if (!found || option.default === undefined || asNumber(option.default) === null) return null;
  return { kind: "number", least: Number(found[1]), most: Number(found[2]), isWhole: false, unit: found[3] ? "mm" : "" };
}

/** What can be written, where the schema's words are too long for the field. */
const EXAMPLES: { [name: string]: string } = { size: "such as 38x50mm", crop: "head, face or X,Y,W,H", at: "such as 20,30mm", "max-time": "such as 2h" };
const SUGGESTIONS: { [name: string]: string[] } = { crop: ["head", "face"] };

function firstSentence(text: string): string {
  return text.length > 220 ? `${text.slice(0, text.indexOf(". ") + 1 || 220)}` : text;
}

export function OptionRow({ name, option, title }: { name: string; option: Option; title?: string }) {
  const path: Path = [name];
  const value = useStudio(() => valueAt(path));
  const act = (next: Value) => change(name, { path, value: next });
  const help = firstSentence(option.description ?? "");
  const row = { name: title ?? name.replaceAll("-", " "), help, isSet: value !== undefined, reset: () => act(null) };
  if (option.enum) {
    const choices = option.default === undefined ? ["", ...option.enum] : option.enum;
    const chosen = String(value ?? option.default ?? "");
    return <ChoiceRow {...row} choices={choices} value={chosen} act={(text) => act(text === "" ? null : text)} />;
  }
  if (option.type === "boolean") return <SwitchRow {...row} value={value === true} act={(on) => act(on ? true : null)} />;
  const range = rangeOf(option);
  const usual = asNumber(option.default);
  if (range && usual !== null) {
    const send = (number: number) => act(range.unit ? `${number}${range.unit}` : number);
    return <NumberRow {...row} kind={range} value={asNumber(value) ?? usual} usual={usual} act={send} />;
  }
  const hint = EXAMPLES[name] ?? (option.default === undefined ? hintOf(option) : String(option.default));
  return <TextRow {...row} value={String(value ?? "")} hint={hint} suggestions={SUGGESTIONS[name]} act={(text) => act(text === "" ? null : text)} />;
}

function hintOf(option: Option): string {
  const said = /\[default: ([^\]]+)\]/.exec(option.description ?? "")?.[1]?.replaceAll("--", "") ?? "not set";
  return said.length > 26 ? "by itself" : said;
}
