// The right panel: style, preset, the style's parameters, the scene's options.

import { useState } from "preact/hooks";
import { change, valueAt } from "../model/scene.ts";
import { useStudio } from "../model/store.ts";
import { isIdle, ParameterRow } from "../parts/parameter.tsx";
import { OptionRow } from "../parts/option.tsx";
import type { Parameter } from "../server/shapes.ts";
import { asNumber, defaultNumber } from "../style/range.ts";
import { PresetChooser } from "./presets.tsx";

/** How many parameters stand above the fold: tables are in the order that matters. */
const MAIN = 8;

const GROUPS: { name: string; keys: string[] }[] = [
  { name: "Picture", keys: ["crop", "background", "tone", "tone-strength", "gamma", "black", "white", "mirror", "seed"] },
  { name: "Press and colour", keys: ["ink", "paper", "min-mark", "dot-gain", "dot-gain-screen", "colours", "colours-simplify", "black-pen"] },
  { name: "Depth and sight", keys: ["depth", "depth-far-white", "sight"] },
];

export function Right() {
  const start = useStudio((state) => state.start);
  const isOpen = useStudio((state) => state.isRightOpen);
  useStudio((state) => state.scene?.values);
  useStudio((state) => state.pending);
  if (!start || !isOpen) return null;
  const name = String(valueAt(["style"]) ?? "hedcut");
  const style = start.styles.find((one) => one.name === name) ?? start.styles[0]!;
  return (
    <aside class="panel right" id="right" aria-label="Style and parameters" tabIndex={-1}>
      <StyleChooser name={style.name} summary={style.summary} />
      <Parameters parameters={style.parameters} key={style.name} />
      {GROUPS.map((group) => (
        <OptionGroup name={group.name} keys={group.keys} key={group.name} />
      ))}
    </aside>
  );
}

function StyleChooser({ name, summary }: { name: string; summary: string }) {
  const start = useStudio((state) => state.start)!;
  const presets = start.presets.filter((preset) => preset.values);
  return (
    <section class="group chooser" aria-labelledby="style-title">
      <h2 id="style-title">Style</h2>
      <div class="styles" role="radiogroup" aria-labelledby="style-title">
        {start.styles.map((style) => (
          <label class={`style ${style.name === name ? "is-chosen" : ""}`} title={style.summary}>
            <input type="radio" name="style" value={style.name} checked={style.name === name} onChange={() => chooseStyle(style.name)} />
            {style.name}
          </label>
        ))}
      </div>
      <p class="summary">{summary}</p>
      {presets.length > 0 && <PresetChooser presets={presets} />}
    </section>
  );
}

/** Parameters of another style mean something else or nothing: they go, but the pitch stays. */
function chooseStyle(name: string): void {
  const pitch = valueAt(["set", "pitch"]);
  change("style", { path: ["style"], value: name }, { path: ["set"], value: pitch === undefined ? null : { pitch } });
}

export function currentPitch(parameters: Parameter[]): number {
  const parameter = parameters.find((one) => one.name === "pitch");
  const usual = parameter ? (defaultNumber(parameter, 1) ?? 0.6) : 0.6;
  return asNumber(valueAt(["set", "pitch"])) ?? asNumber(valueAt(["pitch"])) ?? usual;
}

function Parameters({ parameters }: { parameters: Parameter[] }) {
  const [query, setQuery] = useState("");
  const pitch = currentPitch(parameters);
  const rows = (some: Parameter[]) =>
    some.map((parameter) => <ParameterRow key={parameter.name} parameter={parameter} table={["set"]} pitch={pitch} isIdle={isIdle(parameter, parameters, ["set"])} />);
  const words = query.toLowerCase();
  const found = parameters.filter((one) => one.name.replaceAll("_", " ").includes(words) || one.meaning.toLowerCase().includes(words));
  return (
    <section class="group" aria-labelledby="parameters-title">
      <div class="group-head">
        <h2 id="parameters-title">Parameters</h2>
        <input class="search" type="search" placeholder="Find" aria-label="Find a parameter" value={query} onInput={(event) => setQuery(event.currentTarget.value)} />
      </div>
      {words ? rows(found) : rows(parameters.slice(0, MAIN))}
      {words && found.length === 0 && <p class="empty">No parameter says “{query}”.</p>}
      {!words && parameters.length > MAIN && (
        <details class="more">
          <summary>{parameters.length - MAIN} more</summary>
          {rows(parameters.slice(MAIN))}
        </details>
      )}
    </section>
  );
}

function OptionGroup({ name, keys }: { name: string; keys: string[] }) {
  const schema = useStudio((state) => state.start?.schema.properties)!;
  const count = keys.filter((key) => valueAt([key]) !== undefined).length;
  return (
    <details class="group">
      <summary>
        <h2>{name}</h2>
        {count > 0 && <span class="count" title={`${count} changed`}>{count}</span>}
      </summary>
      {keys.flatMap((key) => (schema[key] ? [<OptionRow key={key} name={key} option={schema[key]} />] : []))}
    </details>
  );
}
