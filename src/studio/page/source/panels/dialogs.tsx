// What stands over the page: export, keys, and the screen's measure. All are native dialogs, which keep the focus inside.

import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { exportFile } from "../model/scene.ts";
import { set, useStudio } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { address } from "../server/requests.ts";
import { camera } from "../stage/camera.ts";
import type { Profile } from "../server/shapes.ts";
import { KEYS } from "./keys.ts";
import { SendView } from "./send.tsx";
import { chosenProfile } from "./sheet.tsx";

export function Dialogs() {
  const dialog = useStudio((state) => state.dialog);
  const hasScene = useStudio((state) => state.scene !== null);
  if (dialog === "export" && hasScene) return <Export />;
  if (dialog === "send" && hasScene) {
    return (
      <Dialog title="Send to the machine">
        <SendView />
      </Dialog>
    );
  }
  if (dialog === "help") return <Help />;
  if (dialog === "calibrate") return <Calibrate />;
  return null;
}

function Dialog({ title, children }: { title: string; children: ComponentChildren }) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  const close = () => set({ dialog: null });
  return (
    <dialog ref={dialog} aria-labelledby="dialog-title" onClose={close} onClick={(event) => event.target === dialog.current && close()}>
      <div class="dialog-head">
        <h2 id="dialog-title">{title}</h2>
        <IconButton icon="remove" name="Close" keys="Esc" act={close} />
      </div>
      {children}
    </dialog>
  );
}

const FORMATS = [
  { name: "svg", purpose: "for print and the web", needsMachine: false },
  { name: "pdf", purpose: "for print and layout", needsMachine: false },
  { name: "json", purpose: "the marks as numbers", needsMachine: false },
  { name: "hpgl", purpose: "for HP-GL plotters", needsMachine: true },
  { name: "gcode", purpose: "for G-code machines", needsMachine: true },
];

/** What the export's form holds: the format, the name, the machine that suits the format, and how writing went. */
function useExport() {
  const file = useStudio((state) => state.scene?.file ?? "drawing.toml");
  const profiles = useStudio((state) => state.start?.profiles ?? []);
  const [format, setFormat] = useState("svg");
  const [stem, setStem] = useState(file.replace(/\.toml$/, ""));
  const [profile, setProfile] = useState(chosenProfile());
  const [fault, setFault] = useState<string | null>(null);
  const [isBusy, setBusy] = useState(false);
  useEffect(() => set({ exported: null }), []);
  const { needsMachine } = FORMATS.find((one) => one.name === format)!;
  const suits = profiles.filter((one) => format === "svg" || format === "json" || fits(one.description, format));
  const machine = suits.some((one) => one.name === profile) ? profile : needsMachine ? (suits[0]?.name ?? "") : "";
  const name = `${stem}.${format}`;
  const write = async () => {
    setBusy(true);
    setFault(await exportFile(name, machine || null));
    setBusy(false);
  };
  return { format, setFormat, stem, setStem, setProfile, needsMachine, suits, machine, name, fault, isBusy, write };
}

function Export() {
  const { format, setFormat, stem, setStem, setProfile, needsMachine, suits, machine, name, fault, isBusy, write } = useExport();
  const exported = useStudio((state) => state.exported);
  return (
    <Dialog title="Export">
      <form onSubmit={(event) => (event.preventDefault(), void write())}>
        <Formats format={format} choose={setFormat} />
        <label class="line">
          <span>Name</span>
          <input class="text" value={stem} required pattern="[^\/\\]+" onInput={(event) => setStem(event.currentTarget.value)} />
        </label>
        {format !== "pdf" && <Machine machine={machine} suits={suits} needsMachine={needsMachine} choose={setProfile} />}
        {fault && (
          <p class="failure" role="alert">
            {fault}
          </p>
        )}
        {exported && !fault && <Written />}
        <div class="buttons end">
          <a class="button" href={address("/api/export", machine ? { file: name, profile: machine } : { file: name })} download={name}>
            Download
          </a>
          <button class="primary" type="submit" disabled={isBusy || !stem}>
            {isBusy ? "Writing…" : "Write beside the scene"}
          </button>
        </div>
      </form>
    </Dialog>
  );
}

interface MachineProps {
  machine: string;
  suits: Profile[];
  needsMachine: boolean;
  choose: (name: string) => void;
}

function Machine({ machine, suits, needsMachine, choose }: MachineProps) {
  return (
    <label class="line">
      <span>Machine</span>
      <select value={machine} onChange={(event) => choose(event.currentTarget.value)}>
        {!needsMachine && <option value="">none: for print</option>}
        {suits.map((one) => (
          <option value={one.name}>
            {one.name}: {one.description}
          </option>
        ))}
      </select>
    </label>
  );
}

function Formats({ format, choose }: { format: string; choose: (format: string) => void }) {
  return (
    <fieldset class="formats">
      <legend>Format</legend>
      {FORMATS.map((one) => (
        <label class={one.name === format ? "is-chosen" : ""}>
          <input type="radio" name="format" autofocus={one.name === format} checked={one.name === format} onChange={() => choose(one.name)} />
          <strong>{one.name}</strong>
          <span>{one.purpose}</span>
        </label>
      ))}
    </fieldset>
  );
}

function fits(description: string, format: string): boolean {
  return format === "gcode" ? description.includes("G-code") : description.includes("HP-GL");
}

function Written() {
  const exported = useStudio((state) => state.exported);
  if (!exported) return null;
  const { file, bytes, command } = exported;
  return (
    <div class="written" role="status">
      <p>
        {file} is written, {bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`}. This command makes the same file:
      </p>
      <pre class="code command" tabIndex={0}>
        {command}
      </pre>
    </div>
  );
}

function Help() {
  return (
    <Dialog title="Keys">
      <div class="keys">
        {KEYS.map((group) => (
          <section key={group.name}>
            <h3>{group.name}</h3>
            <dl>
              {group.keys.map((one) => (
                <div key={one.keys}>
                  <dt>
                    <kbd>{one.keys}</kbd>
                  </dt>
                  <dd>{one.name}</dd>
                </div>
              ))}
            </dl>
          </section>
        ))}
      </div>
      <div class="buttons end">
        <button onClick={() => set({ dialog: "calibrate" })}>Measure the screen…</button>
      </div>
    </Dialog>
  );
}

/** A bar of 100 mm as the page believes; its true length tells how many pixels a millimetre of this screen has. */
function Calibrate() {
  const [believed] = useState(camera.pixelsPerMm());
  const [length, setLength] = useState("100");
  const measured = Number(length.replace(",", "."));
  const isGood = measured > 20 && measured < 500;
  const save = (event: Event) => {
    event.preventDefault();
    if (!isGood) return;
    camera.calibrate((believed * 100) / measured);
    set({ dialog: null, note: "100 % is the print's size on this screen now" });
    camera.printSize();
  };
  return (
    <Dialog title="Measure this bar">
      <p class="lead">Hold a ruler to the bar and enter its length. 100 % is then the size of the print.</p>
      <div class="bar" style={{ width: `${100 * believed}px` }} role="img" aria-label="A bar of about 100 millimetres" />
      <form onSubmit={save}>
        <label class="line">
          <span>Its length in mm</span>
          <input class="text" inputMode="decimal" value={length} aria-invalid={!isGood} onInput={(event) => setLength(event.currentTarget.value)} />
        </label>
        <div class="buttons end">
          <button class="primary" type="submit" disabled={!isGood}>
            Save
          </button>
        </div>
      </form>
    </Dialog>
  );
}
