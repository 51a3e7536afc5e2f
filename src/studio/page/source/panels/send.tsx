// Sending to the machine: what will be drawn, where, and, once it moves, how far it is, with pause and stop at hand.

import { useEffect, useState } from "preact/hooks";
import { fetchPorts, isSending, isWaiting, startSending, tell, type Port } from "../model/sending.ts";
import { attemptQuietly } from "../model/scene.ts";
import { now, set, useStudio, type Box, type Sending } from "../model/store.ts";
import { get } from "../server/requests.ts";
import { askPlot, redraw } from "../stage/engine.ts";
import { clock } from "./bottom.tsx";
import { chosenProfile } from "./sheet.tsx";

export function openSend(): void {
  set({ dialog: "send" });
}

export function SendView() {
  const sending = useStudio((state) => state.sending);
  return isSending(sending) ? <Progress sending={sending} /> : <Form last={sending} />;
}

const WORDS: { [state: string]: string } = {
  meeting: "Meeting the machine…",
  drawing: "Drawing",
  paused: "Paused with the pen up",
  waiting: "Waiting with the pen up",
  "ink wanted": "Fill or dip the pen, then go on",
};

export function sendingInWords(sending: Sending): string {
  if (sending.state === "pen wanted") return `Put in ${sending.name ?? `pen ${sending.pen}`}, then go on`;
  return WORDS[sending.state] ?? sending.state;
}

function Progress({ sending }: { sending: Sending }) {
  const [fault, setFault] = useState<string | null>(null);
  const act = async (path: string) => setFault(await tell(path));
  const share = Math.round(1000 * (sending.fraction ?? 0)) / 10;
  return (
    <div class="send">
      <p role="status">
        <strong>{sendingInWords(sending)}</strong>: {sending.file} on {sending.machine} at {sending.port}
      </p>
      <progress max={100} value={share} aria-label="Share that is drawn" />
      <p class="figure">
        {share.toFixed(1)} %{sending.seconds_left !== undefined && `, ${clock(sending.seconds_left)} left`}
        {sending.paths_in_all !== undefined && `, path ${Math.min((sending.paths ?? 0) + 1, sending.paths_in_all)} of ${sending.paths_in_all}`}
        {sending.pen !== undefined && `, pen ${sending.pen}`}
      </p>
      <p class="lead">The machine goes on if this dialog or the page is closed. If the studio ends, it stops and lifts its pen.</p>
      {fault && (
        <p class="failure" role="alert">
          {fault}
        </p>
      )}
      <div class="buttons end">
        <button disabled={sending.state === "meeting"} onClick={() => void act("/api/send/pause")}>
          {isWaiting(sending) ? "Go on" : "Pause"}
        </button>
        <button class="danger" onClick={() => void act("/api/send/stop")}>
          Stop now
        </button>
      </div>
    </div>
  );
}

function Last({ last }: { last: Sending }) {
  const words = last.state === "done" ? `${last.file} is drawn.` : last.state === "stopped" ? `${last.file} was stopped with the pen up.` : (last.fault ?? "The drawing failed.");
  return (
    <div class={last.state === "failed" ? "failure" : "written"} role="status">
      <p>{words}</p>
      {last.state !== "done" && (
        <div class="buttons">
          <button type="button" onClick={() => void tell("/api/send/continue").then((fault) => fault && set({ fault }))}>Go on where it stopped</button>
        </div>
      )}
    </div>
  );
}

let lastPort = "";

function Form({ last }: { last: Sending | null }) {
  const profiles = useStudio((state) => state.start?.profiles ?? []);
  const part = useStudio((state) => state.part);
  const [ports, setPorts] = useState<Port[]>([]);
  const [port, setPort] = useState(lastPort);
  const [profile, setProfile] = useState(chosenProfile());
  const [fault, setFault] = useState<string | null>(null);
  const [isBusy, setBusy] = useState(false);
  const look = async () => {
    const found = await fetchPorts();
    setPorts(found.ports);
    setFault(found.fault);
    setPort((given) => given || (found.ports.find((one) => one.usb)?.port ?? found.ports[0]?.port ?? ""));
  };
  useEffect(() => void look(), []);
  const draw = async (event: Event) => {
    event.preventDefault();
    lastPort = port;
    setBusy(true);
    setFault(await startSending(port.trim(), profile, part));
    setBusy(false);
  };
  return (
    <form class="send" onSubmit={draw}>
      {last && <Last last={last} />}
      <label class="line">
        <span>Machine</span>
        <select value={profile} required onChange={(event) => setProfile(event.currentTarget.value)}>
          <option value="">choose one</option>
          {profiles.map((one) => (
            <option value={one.name}>
              {one.name}: {one.description}
            </option>
          ))}
        </select>
      </label>
      <div class="line">
        <label for="send-port">Port</label>
        <span class="with-button">
          <input id="send-port" class="text" list="send-ports" required value={port} placeholder="/dev/ttyUSB0 or tcp://HOST:PORT" onInput={(event) => setPort(event.currentTarget.value)} />
          <button type="button" onClick={() => void look()}>
            Look again
          </button>
        </span>
        <datalist id="send-ports">
          {ports.map((one) => (
            <option value={one.port}>{one.what}</option>
          ))}
        </datalist>
      </div>
      {profile && <Summary profile={profile} part={part} />}
      {fault && (
        <p class="failure" role="alert">
          {fault}
        </p>
      )}
      <p class="lead">Nothing moves before you press Draw. Paper and pen in place, the pen over the machine's zero? Stay beside the machine.</p>
      <div class="buttons end">
        <button class="primary" type="submit" disabled={isBusy || !profile || !port.trim()}>
          {isBusy ? "Making the file…" : part ? "Draw this part" : "Draw"}
        </button>
      </div>
    </form>
  );
}

function Summary({ profile, part }: { profile: string; part: Box | null }) {
  const plot = useStudio((state) => state.plot);
  const revision = useStudio((state) => state.scene?.revision);
  const isPlotting = useStudio((state) => state.isPlotting);
  const fault = useStudio((state) => state.plotFault);
  const page = useStudio((state) => state.shown?.page);
  const isPlanned = plot !== null && plot.machine === profile && plot.revision === revision;
  if (!isPlanned) {
    return (
      <p class="line">
        <span>Plan</span>
        <span>
          {fault && !isPlotting ? `${fault} ` : ""}
          <button type="button" disabled={isPlotting} onClick={() => askPlot(profile)}>
            {isPlotting ? "Planning…" : "Plan size, time and pens"}
          </button>
        </span>
      </p>
    );
  }
  return (
    <>
      <dl class="told">
        <dt>Sheet</dt>
        <dd>{page ? `${page[0]} × ${page[1]} mm` : "as drawn"}</dd>
        <dt>Time</dt>
        <dd>
          {clock(plot.seconds)} for {plot.paths} paths
        </dd>
        <dt>Pens</dt>
        <dd>{plot.pens.map((pen) => `${pen.pen}: ${pen.name}, ${clock(pen.seconds)}`).join("; ")}</dd>
      </dl>
      {part && <Part profile={profile} part={part} />}
    </>
  );
}

export function forgetPart(): void {
  set({ part: null });
  redraw();
}

function Part({ profile, part }: { profile: string; part: Box }) {
  const [command, setCommand] = useState("");
  const [x, y, width, height] = part.map((v) => Math.round(10 * v) / 10) as Box;
  useEffect(() => {
    const path = `/api/part?profile=${encodeURIComponent(profile)}&x=${x}&y=${y}&width=${width}&height=${height}`;
    void attemptQuietly(() => get<{ command: string }>(path)).then(({ value, fault }) => now().part && setCommand(value?.command ?? fault ?? ""));
  }, [profile, x, y, width, height]);
  return (
    <div class="written">
      <p>
        Only the paths that touch {width} × {height} mm at {x}, {y} mm of the sheet. The time is that of the whole. As a command:
      </p>
      <pre class="code command" tabIndex={0} aria-label="The command for this part">
        {command}
      </pre>
      <div class="buttons">
        <button type="button" onClick={forgetPart}>
          Plot the whole
        </button>
      </div>
    </div>
  );
}
