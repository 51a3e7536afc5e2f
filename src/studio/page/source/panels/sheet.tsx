// Sheet and machine: page, margins, place of the picture; the plotter, its pens and what they take.

import { change, valueAt } from "../model/scene.ts";
import { set, useStudio } from "../model/store.ts";
import { OptionRow } from "../parts/option.tsx";
import { ChoiceRow } from "../parts/row.tsx";
import { askPlot } from "../stage/engine.ts";
import { placeAt, pictureBox } from "../stage/placing.ts";
import { camera } from "../stage/camera.ts";
import { clock } from "./bottom.tsx";

const PAGES = ["", "a6", "a5", "a4", "a3", "a2", "a1", "a0", "letter", "legal", "tabloid"];
const PLACING = ["margin", "size", "fit", "at", "center", "rotate"];
/** Names that say more than the key alone: the style has a "size" too, and pens have numbers. */
const TITLES: { [name: string]: string } = { size: "size of the picture", pen: "width of the pen" };
const MACHINE = ["pen", "max-time", "order", "speed", "clip"];

export function SheetPanel() {
  const schema = useStudio((state) => state.start?.schema.properties)!;
  useStudio((state) => state.scene?.values);
  useStudio((state) => state.pending);
  const page = useStudio((state) => state.shown?.page);
  const rows = (keys: string[]) => keys.flatMap((key) => (schema[key] ? [<OptionRow key={key} name={key} title={TITLES[key]} option={schema[key]} />] : []));
  return (
    <>
      <section class="sub" aria-label="Sheet">
        {page && (
          <p class="lead">
            The sheet is {page[0]} × {page[1]} mm.
          </p>
        )}
        <PageRow help={schema["page"]?.description ?? ""} />
        {rows(PLACING)}
        <div class="buttons">
          <button disabled={!valueAt(["page"])} onClick={centre}>
            Centre
          </button>
          <button onClick={() => set({ tool: "place" })} title="Then drag, or use the arrows (G)">
            Place by dragging
          </button>
        </div>
      </section>
      <Machine />
      <section class="sub" aria-label="Machine's options">
        {rows(MACHINE)}
      </section>
    </>
  );
}

function centre(): void {
  const [, , width, height] = pictureBox();
  placeAt((camera.page[0] - width) / 2, (camera.page[1] - height) / 2);
}

function PageRow({ help }: { help: string }) {
  const value = String(valueAt(["page"]) ?? "");
  const base = value.replace("-landscape", "");
  const isLandscape = value.endsWith("-landscape");
  const act = (next: string) => change("page", { path: ["page"], value: next || null });
  const choices = PAGES.includes(base) ? PAGES : [...PAGES, value];
  return (
    <>
      <ChoiceRow name="page" help={help} isSet={value !== ""} reset={() => act("")} choices={choices} none="the picture alone" value={PAGES.includes(base) ? base : value} act={(next) => act(next && isLandscape ? `${next}-landscape` : next)} />
      {value !== "" && PAGES.includes(base) && (
        <label class="check">
          <input type="checkbox" checked={isLandscape} onChange={(event) => act(event.currentTarget.checked ? `${base}-landscape` : base)} />
          Landscape
        </label>
      )}
    </>
  );
}

export function chosenProfile(): string {
  return String(valueAt(["profile"]) ?? "");
}

function Machine() {
  const profiles = useStudio((state) => state.start?.profiles ?? []);
  const isPlotting = useStudio((state) => state.isPlotting);
  const fault = useStudio((state) => state.plotFault);
  const profile = chosenProfile();
  const help = profiles.find((one) => one.name === profile)?.description ?? "The plotter for which the tool paths are planned";
  const act = (next: string) => change("machine", { path: ["profile"], value: next || null });
  return (
    <section class="sub" aria-label="Machine">
      <h2>Machine</h2>
      <ChoiceRow name="machine" help={help} isSet={profile !== ""} reset={() => act("")} choices={["", ...profiles.map((one) => one.name)]} none="none" value={profile} act={act} />
      <p class="lead">{profile ? help : "Choose a plotter to see its paths, time and ink."}</p>
      <div class="buttons">
        <button class="primary" disabled={!profile || isPlotting} onClick={() => askPlot(profile)}>
          {isPlotting ? "Planning…" : "Plan the plot"}
        </button>
      </div>
      <div class="buttons">
        <button title="Then drag a box on the sheet; Enter takes what is in view (R)" disabled={!profile} onClick={() => set({ tool: "part" })}>
          Plot a part
        </button>
        <button title="To a machine that is connected (M)" disabled={!profile} onClick={() => set({ dialog: "send" })}>
          Send…
        </button>
      </div>
      {fault && (
        <p class="failure" role="alert">
          {fault}
        </p>
      )}
      <Pens />
    </section>
  );
}

function Pens() {
  const plot = useStudio((state) => state.plot);
  const revision = useStudio((state) => state.scene?.revision);
  if (!plot) return null;
  return (
    <>
      {plot.revision !== revision && <p class="remark">This plan is older than the drawing; plan again.</p>}
      <table class="pens">
        <caption>
          {plot.summary}; {clock(plot.seconds)} in all
        </caption>
        <thead>
          <tr>
            <th scope="col">Pen</th>
            <th scope="col">Time</th>
            <th scope="col">Ink</th>
            <th scope="col">Lifts</th>
          </tr>
        </thead>
        <tbody>
          {plot.pens.map((pen) => (
            <tr title={pen.name}>
              <th scope="row">
                <span class="swatch" style={{ background: pen.color }} aria-hidden="true" />
                {pen.pen}
              </th>
              <td>{clock(pen.seconds)}</td>
              <td>{pen.ink_m.toFixed(1)} m</td>
              <td>{pen.lifts}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}
