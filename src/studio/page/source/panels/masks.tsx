// Masks: which are seen, which is painted on, and with what.

import { useId } from "preact/hooks";
import { deleteMask } from "../model/scene.ts";
import { now, set, useStudio, type MaskTools } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { colorOf, exportMask, importMask, isTaken, LINE_ROLES, reloadMasks, setVisible } from "../stage/masks.ts";
import { redraw } from "../stage/engine.ts";

export function changeMaskTools(tools: Partial<MaskTools>): void {
  set({ mask: { ...now().mask, ...tools } });
  redraw();
}

export function MasksPanel() {
  const masks = useStudio((state) => state.masks).filter((mask) => isTaken(mask.role));
  useStudio((state) => state.scene?.values["style"]);
  const role = useStudio((state) => state.mask.role);
  const sight = useStudio((state) => state.sight);
  const choose = (name: string) => (changeMaskTools({ role: name }), setVisible(name, true));
  return (
    <>
      <p class="lead">What was found in the photograph. Choose a part and paint where it was seen wrong.</p>
      {sight && sight.state !== "found" && <p class="remark">{sight.state === "looking" ? "Looking for its parts…" : sight.message}</p>}
      <ul class="masks">
        {masks.map((mask) => (
          <li class={mask.role === role ? "is-chosen" : ""} key={mask.role}>
            <button class="mask-name" aria-pressed={mask.role === role} onClick={() => choose(mask.role)}>
              <span class="swatch" style={{ background: colorOf(mask.role) }} aria-hidden="true" />
              {mask.role}
              <span class="state">{mask.isPainted ? "painted" : mask.isThere ? "" : "none"}</span>
            </button>
            <IconButton
              icon={mask.isVisible ? "eye" : "hidden"}
              name={`${mask.isVisible ? "Hide" : "Show"} ${mask.role}`}
              isPressed={mask.isVisible}
              act={() => setVisible(mask.role, !mask.isVisible)}
            />
          </li>
        ))}
      </ul>
      {LINE_ROLES.includes(role) && isTaken(role) && (
        <p class="remark">
          Draw with the pen (N): click for corners, or drag.{" "}
          {role === "directions" ? "Near these lines marks run along them." : "Rows follow these lines instead of those that are detected."} As found takes them all away.
        </p>
      )}
      {role === "highlights" && <p class="remark">Paint where the paper shall stay open. As found takes it all away.</p>}
      <Brush />
      <Files role={role} />
    </>
  );
}

function Brush() {
  const mask = useStudio((state) => state.mask);
  return (
    <section class="sub" aria-label="Brush">
      <Slide name="Opacity" value={mask.opacity} least={0.05} most={1} step={0.05} show={(value) => `${Math.round(100 * value)} %`} act={(opacity) => changeMaskTools({ opacity })} />
      <Slide name="Size" value={mask.size} least={2} most={400} step={1} show={(value) => `${value} px`} act={(size) => changeMaskTools({ size })} />
      <Slide name="Feather" value={mask.feather} least={0} most={1} step={0.05} show={(value) => `${Math.round(100 * value)} %`} act={(feather) => changeMaskTools({ feather })} />
      <label class="check">
        <input type="checkbox" checked={mask.usesPressure} onChange={(event) => changeMaskTools({ usesPressure: event.currentTarget.checked })} />
        The pen's pressure sets the size
      </label>
    </section>
  );
}

interface SlideProps {
  name: string;
  value: number;
  least: number;
  most: number;
  step: number;
  show: (value: number) => string;
  act: (value: number) => void;
}

export function Slide({ name, value, least, most, step, show, act }: SlideProps) {
  const id = useId();
  return (
    <div class="slide">
      <label for={id}>{name}</label>
      <input
        id={id}
        type="range"
        class="slider"
        min={least}
        max={most}
        step={step}
        value={value}
        style={{ "--share": `${(100 * (value - least)) / (most - least)}%` }}
        aria-valuetext={show(value)}
        onInput={(event) => act(Number(event.currentTarget.value))}
      />
      <output for={id}>{show(value)}</output>
    </div>
  );
}

function Files({ role }: { role: string }) {
  const mask = useStudio((state) => state.masks.find((one) => one.role === role));
  const choose = (event: Event) => {
    const input = event.currentTarget as HTMLInputElement;
    if (input.files?.[0]) void importMask(role, input.files[0]);
    input.value = "";
  };
  return (
    <div class="buttons">
      <label class="button">
        Import PNG
        <input type="file" accept="image/png" class="unseen" onChange={choose} />
      </label>
      <button disabled={!mask?.isThere} onClick={() => void exportMask(role)}>
        Export PNG
      </button>
      <button disabled={!mask?.isPainted} title="Forget what was painted; use what is found" onClick={() => void deleteMask(role).then(reloadMasks)}>
        As found
      </button>
    </div>
  );
}
