// A parameter of a style, made from its table.

import { change, valueAt } from "../model/scene.ts";
import { useStudio } from "../model/store.ts";
import type { Parameter, Path, Value } from "../server/shapes.ts";
import { asNumber, defaultNumber, kindOf } from "../style/range.ts";
import { ChoiceRow, NumberRow, TextRow } from "./row.tsx";

function title(name: string): string {
  return name.replaceAll("_", " ").replaceAll("-", " ");
}

export function wordsOf(parameter: Parameter): string {
  const needs = parameter.needs ? ` Counts with ${parameter.needs}.` : "";
  return `${parameter.meaning}; ${parameter.range}; default ${parameter.default}.${needs}`;
}

interface Props {
  parameter: Parameter;
  /** The table of parameters: ["set"], or that of a region. */
  table: Path;
  pitch: number;
  isIdle?: boolean;
}

export function ParameterRow({ parameter, table, pitch, isIdle = false }: Props) {
  const path = [...table, parameter.name];
  const value = useStudio(() => valueAt(path));
  const kind = kindOf(parameter.range);
  const label = table.length > 1 ? `region: ${parameter.name}` : parameter.name;
  const act = (next: Value) => change(label, { path, value: next });
  const row = { name: title(parameter.name), help: wordsOf(parameter), isSet: value !== undefined, isIdle, reset: () => act(null) };
  if (kind.kind === "choice") {
    const chosen = value === true ? "on" : value === false ? "off" : String(value ?? parameter.default);
    return <ChoiceRow {...row} choices={kind.choices} value={chosen} act={act} />;
  }
  const usual = defaultNumber(parameter, pitch);
  const number = value === undefined ? usual : asNumber(value);
  if (kind.kind === "text" || usual === null || number === null) {
    return <TextRow {...row} value={String(value ?? "")} hint={parameter.default} act={(text) => act(text === "" ? null : text)} />;
  }
  return <NumberRow {...row} kind={kind} value={number} usual={usual} act={act} />;
}

/** Whether what a parameter needs is plainly not so: `size=paper` while size is exact. Anything less plain counts as met. */
export function isIdle(parameter: Parameter, parameters: Parameter[], table: Path): boolean {
  const needs = /^(\w+)=(\w+)$/.exec(parameter.needs.split(" and ")[0] ?? "");
  if (!needs || parameter.needs.includes(" or ")) return false;
  const other = parameters.find((one) => one.name === needs[1]);
  const value = valueAt([...table, needs[1]!]) ?? other?.default;
  const said = value === true ? "on" : value === false ? "off" : String(value);
  return other !== undefined && said !== needs[2];
}
