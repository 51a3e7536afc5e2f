// Regions: parts of the picture in styles of their own. Later ones lie over earlier ones, so the list shows the last on top.

import { useState } from "preact/hooks";
import { change, valueAt } from "../model/scene.ts";
import { useStudio } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { Pick } from "../parts/pick.tsx";
import { ParameterRow } from "../parts/parameter.tsx";
import { ChoiceRow, TextRow } from "../parts/row.tsx";
import type { Path, Table, Value } from "../server/shapes.ts";
import { colorOf } from "../stage/masks.ts";
import { currentPitch } from "./right.tsx";

const ROLES = ["hair", "clothing", "face", "skin", "headwear", "facial-hair", "subject"];

function regions(): Table[] {
  const list = valueAt(["region"]);
  return Array.isArray(list) ? (list as Table[]) : [];
}

function replace(label: string, list: Table[]): void {
  change(label, { path: ["region"], value: list.length > 0 ? list : null });
}

export function RegionsPanel() {
  useStudio((state) => state.scene?.values);
  useStudio((state) => state.pending);
  const [open, setOpen] = useState(-1);
  const list = regions();
  const add = (mask: string) => {
    replace("add region", [...list, { mask, style: "charcoal" }]);
    setOpen(list.length);
  };
  const move = (index: number, by: number) => {
    const next = [...list];
    [next[index], next[index + by]] = [next[index + by]!, next[index]!];
    replace("reorder regions", next);
    setOpen(open === index ? index + by : open);
  };
  return (
    <>
      <p class="lead">Parts of the picture drawn in a style of their own. The upper ones lie over the lower ones.</p>
      <ol class="regions" reversed>
        {list
          .map((region, index) => (
            <li key={index} class={open === index ? "is-open" : ""}>
              <div class="region-head">
                <button class="mask-name" aria-expanded={open === index} onClick={() => setOpen(open === index ? -1 : index)}>
                  <span class="swatch" style={{ background: colorOf(String(region["mask"])) }} aria-hidden="true" />
                  {String(region["mask"])}
                  <span class="state">{String(region["style"] ?? "as the drawing")}</span>
                </button>
                <IconButton icon="up" name={`Raise ${region["mask"]}`} isDisabled={index === list.length - 1} act={() => move(index, 1)} />
                <IconButton icon="down" name={`Lower ${region["mask"]}`} isDisabled={index === 0} act={() => move(index, -1)} />
                <IconButton icon="remove" name={`Remove ${region["mask"]}`} act={() => (setOpen(-1), replace("remove region", list.filter((_, other) => other !== index)))} />
              </div>
              {open === index && <Region index={index} />}
            </li>
          ))
          .reverse()}
      </ol>
      <Pick title="Add" label="Add a region for" hint="A region for…" choices={ROLES.map((role) => ({ value: role, text: role }))} act={add} />
    </>
  );
}

function Region({ index }: { index: number }) {
  const start = useStudio((state) => state.start)!;
  const base: Path = ["region", index];
  const act = (key: string) => (value: Value) => change(`region: ${key}`, { path: [...base, key], value });
  const text = (key: string, hint: string, help: string) => (
    <TextRow
      name={key}
      help={help}
      hint={hint}
      isSet={valueAt([...base, key]) !== undefined}
      reset={() => act(key)(null)}
      value={String(valueAt([...base, key]) ?? "")}
      act={(value) => act(key)(value === "" ? null : key === "pen" || key === "seed" ? Number(value) || value : value)}
    />
  );
  const own = String(valueAt(["style"]) ?? "hedcut");
  const chosen = String(valueAt([...base, "style"]) ?? "");
  const name = chosen || own;
  const style = start.styles.find((one) => one.name === name);
  const pitch = currentPitch(style?.parameters ?? []);
  const chooseStyle = (value: string) =>
    change("region: style", { path: [...base, "style"], value: value || null }, { path: [...base, "set"], value: null });
  return (
    <div class="region-body">
      <ChoiceRow
        name="style"
        help="Its style; without one, the drawing's own with its parameters"
        isSet={chosen !== ""}
        reset={() => chooseStyle("")}
        choices={["", ...start.styles.map((one) => one.name)]}
        value={chosen}
        none="as the drawing"
        act={chooseStyle}
      />
      {text("pen", "1", "The number of its pen, from 1")}
      {text("ink", "as the drawing", "Its ink: a CSS colour, k or spot:NAME")}
      {text("gap", "0mm", "Bare paper on its side of its border, a length")}
      {text("fade", "0mm", "The band in which its marks thin out towards its border, a length")}
      {style && (
        <details class="more">
          <summary>Parameters of {style.name}</summary>
          {style.parameters.map((parameter) => (
            <ParameterRow key={parameter.name} parameter={parameter} table={[...base, "set"]} pitch={pitch} />
          ))}
        </details>
      )}
    </div>
  );
}
