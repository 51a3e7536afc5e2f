// The bar at the top: the scene, undo, what is looked at, zoom, and what leaves the page.

import { useEffect, useState } from "preact/hooks";
import { copyCommand, openPhotograph, openScene, redo, swapRecipes, undo } from "../model/scene.ts";
import { set, useStudio, type ViewMode } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { get } from "../server/requests.ts";
import { camera } from "../stage/camera.ts";
import { toggleToneError } from "../stage/film.ts";
import { redraw } from "../stage/engine.ts";

const MODES: { mode: ViewMode; name: string; keys: string }[] = [
  { mode: "drawing", name: "Drawing", keys: "W" },
  { mode: "divider", name: "Divider", keys: "D" },
  { mode: "side", name: "Side by side", keys: "S" },
  { mode: "photograph", name: "Photograph", keys: "hold P" },
];

export function setMode(mode: ViewMode): void {
  set({ mode });
  redraw();
}

export function Top() {
  const undoes = useStudio((state) => state.scene?.undo ?? 0);
  const redoes = useStudio((state) => state.scene?.redo ?? 0);
  const undoLabel = useStudio((state) => state.scene?.undo_label);
  const redoLabel = useStudio((state) => state.scene?.redo_label);
  const other = useStudio((state) => state.other);
  return (
    <header class="top">
      <h1 class="wordmark">drypoint</h1>
      <FileMenu />
      <div class="cluster" role="group" aria-label="History">
        <IconButton icon="undo" name={undoLabel ? `Undo ${undoLabel}` : "Undo"} keys="Ctrl+Z" isDisabled={undoes === 0} act={() => void undo()} />
        <IconButton icon="redo" name={redoLabel ? `Redo ${redoLabel}` : "Redo"} keys="Ctrl+Shift+Z" isDisabled={redoes === 0} act={() => void redo()} />
        <button class="quiet" title={other === null ? "Keep this recipe as B (X)" : "Swap this recipe with the other (X)"} onClick={() => void swapRecipes()}>
          {other === null ? "Keep as B" : "Swap A / B"}
        </button>
      </div>
      <Modes />
      <ToneError />
      <Zoom />
      <div class="cluster last">
        <button class="quiet copies" title="Copy the command that makes this drawing (Ctrl+Shift+C)" onClick={() => void copyCommand()}>
          Copy command
        </button>
        <button class="primary" title="Export (Ctrl+E)" onClick={() => set({ dialog: "export" })}>
          Export
        </button>
        <IconButton icon="help" name="Keys and help" keys="?" act={() => set({ dialog: "help" })} />
      </div>
    </header>
  );
}

function FileMenu() {
  const name = useStudio((state) => state.scene?.photograph?.name ?? state.scene?.file ?? "No scene");
  const file = useStudio((state) => state.scene?.file ?? "");
  const [recent, setRecent] = useState<string[] | null>(null);
  const choose = (event: Event) => {
    const chosen = (event.currentTarget as HTMLInputElement).files?.[0];
    if (chosen) void openPhotograph(chosen);
  };
  const open = async (event: Event) => {
    if (!(event.currentTarget as HTMLDetailsElement).open) return;
    setRecent(await get<{ files: string[] }>("/api/recent").then((told) => told.files, () => []));
  };
  return (
    <details class="file" onToggle={open}>
      <summary title={file}>
        <span class="file-name">{name}</span>
      </summary>
      <div class="menu">
        <label class="menu-item">
          Open a photograph…
          <input type="file" accept="image/*" class="unseen" onChange={choose} />
        </label>
        {recent && recent.length > 0 && <p class="menu-title">Open recent</p>}
        {recent?.map((one) => (
          <button class="menu-item" title={one} onClick={(event) => (event.currentTarget.closest("details")!.removeAttribute("open"), void openScene(one))}>
            {one.split("/").slice(-2).join("/")}
          </button>
        ))}
      </div>
    </details>
  );
}

function Modes() {
  const mode = useStudio((state) => state.mode);
  return (
    <div class="segments" role="radiogroup" aria-label="View">
      {MODES.map((one) => (
        <label class={`segment ${one.mode === mode ? "is-chosen" : ""}`} title={`${one.name} (${one.keys})`}>
          <input type="radio" name="mode" checked={one.mode === mode} onChange={() => setMode(one.mode)} />
          {one.name}
        </label>
      ))}
    </div>
  );
}

function ToneError() {
  const isOn = useStudio((state) => state.tone.isOn);
  return (
    <button class="quiet tone-toggle" aria-pressed={isOn} aria-keyshortcuts="O" title="Where the drawing is too dark or too light (O)" onClick={toggleToneError}>
      Tone error
    </button>
  );
}

function Zoom() {
  const zoom = useStudio((state) => Math.round(100 * state.zoom));
  const [isTold, setTold] = useState(false);
  // The figure follows a moment later, so that zooming itself is not slowed by it.
  useEffect(() => setTold(true), []);
  return (
    <div class="cluster zoom" role="group" aria-label="Zoom">
      <IconButton icon="minus" name="Zoom out" keys="-" act={() => camera.zoom(1 / 1.25)} />
      <button class="quiet figure" title="Show at print size (1); Shift: measure the screen" onClick={(event) => (event.shiftKey ? set({ dialog: "calibrate" }) : camera.printSize())}>
        {isTold ? `${zoom} %` : ""}
      </button>
      <IconButton icon="plus" name="Zoom in" keys="+" act={() => camera.zoom(1.25)} />
      <IconButton icon="fit" name="Fit the sheet" keys="0" act={() => camera.fit()} />
    </div>
  );
}
