// One value of the scene as a row: name, control, unit, reset, help. A value that is the default is shown fainter.

import type { ComponentChildren } from "preact";
import { useId, useState } from "preact/hooks";
import { asNumber, fromTrack, rounded, toTrack, trackOf, type Kind } from "../style/range.ts";
import { IconButton } from "./button.tsx";

export interface RowProps {
  name: string;
  help: string;
  isSet: boolean;
  reset: () => void;
  isIdle?: boolean;
}

export function Row({ name, help, isSet, reset, isIdle, id, children }: RowProps & { id: string; children: ComponentChildren }) {
  return (
    <div class={`row ${isSet ? "is-set" : ""} ${isIdle ? "is-idle" : ""}`}>
      <div class="row-head">
        <label for={id} title={help}>
          {name}
        </label>
        {isSet && <IconButton icon="reset" name={`Reset ${name} to its default`} act={reset} />}
      </div>
      <div class="row-control">{children}</div>
      <p class="row-help" id={`${id}-help`}>
        {help}
      </p>
    </div>
  );
}

interface NumberProps extends RowProps {
  kind: Extract<Kind, { kind: "number" }>;
  value: number;
  usual: number;
  act: (value: number) => void;
}

export function NumberRow({ kind, value, usual, act, ...row }: NumberProps) {
  const id = useId();
  const track = trackOf(kind, usual, value);
  const slide = (event: Event) => act(fromTrack(track, Number((event.currentTarget as HTMLInputElement).value), kind.isWhole));
  const share = toTrack(track, value);
  return (
    <Row {...row} id={id}>
      <input
        type="range"
        class="slider"
        min={0}
        max={1000}
        step={1}
        value={share}
        style={{ "--share": `${share / 10}%`, "--usual": `${toTrack(track, usual) / 10}%` }}
        title={row.help}
        aria-label={row.name}
        aria-describedby={`${id}-help`}
        aria-valuetext={`${rounded(value)}${kind.unit ? ` ${kind.unit}` : ""}`}
        onInput={slide}
        onDblClick={row.reset}
      />
      <Entry id={id} value={value} unit={kind.unit} name={row.name} least={kind.least} most={kind.most} act={act} />
    </Row>
  );
}

interface EntryProps {
  id: string;
  value: number;
  unit: string;
  name: string;
  least: number;
  most: number;
  act: (value: number) => void;
}

/** Exact entry: sent with Enter or on leaving; arrows step by a hundredth of the value's size. */
function Entry({ id, value, unit, name, least, most, act }: EntryProps) {
  const [text, setText] = useState<string | null>(null);
  const number = text === null ? value : asNumber(text);
  const isWrong = number === null || number < least || number > most;
  const settle = () => {
    if (text !== null && !isWrong) act(number);
    setText(null);
  };
  const key = (event: KeyboardEvent) => {
    if (event.key === "Enter") settle();
    else if (event.key === "Escape") setText(null);
    else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      event.preventDefault();
      const step = 10 ** Math.floor(Math.log10(Math.max(Math.abs(value), 0.01))) / (event.shiftKey ? 1 : 10);
      const next = value + (event.key === "ArrowUp" ? step : -step);
      act(Math.min(most, Math.max(least, Number(next.toPrecision(6)))));
      setText(null);
    }
  };
  return (
    <span class="entry">
      <input
        id={id}
        type="text"
        inputMode="decimal"
        value={text ?? String(rounded(value))}
        aria-describedby={`${id}-help`}
        aria-invalid={isWrong}
        title={isWrong ? `${name} goes from ${least} to ${most} ${unit}` : `${least} to ${most} ${unit}`}
        onInput={(event) => setText(event.currentTarget.value)}
        onBlur={settle}
        onKeyDown={key}
      />
      <span class="unit" aria-hidden="true">
        {unit}
      </span>
    </span>
  );
}

interface ChoiceProps extends RowProps {
  choices: string[];
  value: string;
  /** What the empty choice is called. */
  none?: string;
  act: (value: string) => void;
}

export function ChoiceRow({ choices, value, none = "default", act, ...row }: ChoiceProps) {
  const id = useId();
  return (
    <Row {...row} id={id}>
      <select id={id} value={value} title={row.help} aria-describedby={`${id}-help`} onChange={(event) => act(event.currentTarget.value)}>
        {choices.map((choice) => (
          <option value={choice}>{choice === "" ? none : choice}</option>
        ))}
      </select>
    </Row>
  );
}

interface TextProps extends RowProps {
  value: string;
  hint: string;
  suggestions?: string[];
  act: (value: string) => void;
}

/** Sent with Enter or on leaving: what is being written stays when the scene changes beneath it. */
export function TextRow({ value, hint, suggestions = [], act, ...row }: TextProps) {
  const id = useId();
  const [text, setText] = useState<string | null>(null);
  const settle = () => {
    if (text !== null && text.trim() !== value) act(text.trim());
    setText(null);
  };
  return (
    <Row {...row} id={id}>
      <input
        id={id}
        class="text"
        type="text"
        value={text ?? value}
        placeholder={hint}
        title={row.help}
        list={suggestions.length > 0 ? `${id}-list` : undefined}
        aria-describedby={`${id}-help`}
        onInput={(event) => setText(event.currentTarget.value)}
        onBlur={settle}
        onKeyDown={(event) => (event.key === "Enter" ? settle() : event.key === "Escape" && setText(null))}
      />
      {suggestions.length > 0 && (
        <datalist id={`${id}-list`}>
          {suggestions.map((one) => (
            <option value={one} />
          ))}
        </datalist>
      )}
    </Row>
  );
}

export function SwitchRow({ value, act, ...row }: RowProps & { value: boolean; act: (value: boolean) => void }) {
  const id = useId();
  return (
    <Row {...row} id={id}>
      <input id={id} class="switch" type="checkbox" role="switch" checked={value} title={row.help} aria-describedby={`${id}-help`} onChange={(event) => act(event.currentTarget.checked)} />
    </Row>
  );
}
