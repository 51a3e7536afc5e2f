// Presets as pictures of this very portrait. They are drawn one after the other, only while they are looked at and nothing else is.

import { useEffect, useState } from "preact/hooks";
import { change } from "../model/scene.ts";
import { now, set, useStudio } from "../model/store.ts";
import { request } from "../server/requests.ts";
import type { Preset } from "../server/shapes.ts";

interface Picture {
  address: string;
  revision: number;
}

const pictures = new Map<string, Picture | "none">();

export function togglePresets(): void {
  const isOpen = !now().hasPresets;
  set({ hasPresets: isOpen, isRightOpen: true });
  // Once the grid is there.
  if (isOpen) setTimeout(() => document.querySelector<HTMLElement>(".preset-picture")?.focus());
}

function apply(preset: Preset): void {
  const { purpose: _, photograph: __, ...values } = preset.values ?? {};
  change(`preset ${preset.name}`, { path: ["set"], value: null }, ...Object.entries(values).map(([key, value]) => ({ path: [key], value })));
  set({ note: `${preset.name}: ${preset.purpose}` });
}

/** Fetches what is not there yet; `told` hears of each. Ends when the signal says so. */
async function fetchAll(presets: Preset[], revision: number, signal: AbortSignal, told: () => void): Promise<void> {
  for (const { name } of presets) {
    const known = pictures.get(name);
    if (known && known !== "none" && known.revision === revision) continue;
    try {
      const answer = await request("GET", `/api/thumbnail/${encodeURIComponent(name)}`, undefined, undefined, signal);
      const address = URL.createObjectURL(await answer.blob());
      if (known && known !== "none") URL.revokeObjectURL(known.address);
      pictures.set(name, { address, revision });
    } catch {
      if (signal.aborted) return;
      pictures.set(name, "none");
    }
    told();
  }
}

export function PresetChooser({ presets }: { presets: Preset[] }) {
  const isOpen = useStudio((state) => state.hasPresets);
  const revision = useStudio((state) => state.scene?.revision ?? 0);
  const isDrawn = useStudio((state) => state.shown?.revision === state.scene?.revision && state.shown?.quality === "full");
  const [, redraw] = useState(0);
  useEffect(() => {
    if (!isOpen || !isDrawn) return;
    const giveUp = new AbortController();
    void fetchAll(presets, revision, giveUp.signal, () => redraw((count) => count + 1));
    return () => giveUp.abort();
  }, [isOpen, isDrawn, revision]);
  return (
    <div class="presets">
      <button class="presets-head" aria-expanded={isOpen} aria-keyshortcuts="Y" title="Start from a preset (Y)" onClick={togglePresets}>
        Presets
      </button>
      {isOpen && (
        <ul class="preset-pictures" aria-label="Presets">
          {presets.map((preset) => (
            <li key={preset.name}>
              <button class="preset-picture" title={preset.purpose} onClick={() => apply(preset)}>
                <PresetPicture picture={pictures.get(preset.name)} revision={revision} />
                <strong>{preset.name}</strong>
                <span>{preset.purpose}</span>
              </button>
            </li>
          ))}
        </ul>
      )}
    </div>
  );
}

function PresetPicture({ picture, revision }: { picture: Picture | "none" | undefined; revision: number }) {
  if (!picture || picture === "none") return <span class="preset-empty">{picture ? "no picture" : "…"}</span>;
  return <img src={picture.address} alt="" class={picture.revision === revision ? "" : "is-old"} />;
}
