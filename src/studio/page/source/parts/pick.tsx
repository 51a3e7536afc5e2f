// A list from which one thing is taken, after which it stands at its first line again.

import { useRef } from "preact/hooks";
import { say } from "../model/scene.ts";

interface Props {
  title: string;
  label?: string;
  hint: string;
  choices: { value: string; text: string; help?: string }[];
  act: (value: string) => void;
}

export function Pick({ title, label, hint, choices, act }: Props) {
  // A closed list changes with every letter and arrow: by keyboard only Enter takes what is chosen.
  const isByKey = useRef(false);
  const take = (select: HTMLSelectElement) => {
    if (select.value) act(select.value);
    select.value = "";
  };
  const key = (event: KeyboardEvent & { currentTarget: HTMLSelectElement }) => {
    isByKey.current = ![" ", "Enter", "Tab"].includes(event.key);
    if (event.key === "Enter" && event.currentTarget.value) (event.preventDefault(), say(""), take(event.currentTarget));
  };
  return (
    <label class="preset">
      <span>{title}</span>
      <select
        aria-label={label}
        onPointerDown={() => (isByKey.current = false)}
        onKeyDown={key}
        onChange={(event) => (isByKey.current ? say("Enter takes what is chosen") : take(event.currentTarget))}
        onBlur={(event) => ((isByKey.current = false), (event.currentTarget.value = ""))}
      >
        <option value="">{hint}</option>
        {choices.map(({ value, text, help }) => (
          <option value={value} title={help}>
            {text}
          </option>
        ))}
      </select>
    </label>
  );
}
