// The strip at the bottom: the plot played back, and the status in one line.

import { isSending } from "../model/sending.ts";
import { now, set, useStudio, type Playback, type PlotShown } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { askPlot, pathEnd, pathsDone, redraw } from "../stage/engine.ts";
import { isOutOfDate } from "../stage/shown.tsx";
import { toggleFilm } from "./film.tsx";
import { openSend, sendingInWords } from "./send.tsx";
import { chosenProfile } from "./sheet.tsx";

const SPEEDS = [1, 10, 100, 1000];

export function clock(seconds: number): string {
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60)];
  const rest = String(whole % 60).padStart(2, "0");
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, "0")}:${rest}` : `${minutes}:${rest}`;
}

export function changePlayback(change: Partial<Playback>): void {
  set({ playback: { ...now().playback, ...change } });
  redraw();
}

export function play(): void {
  const { playback, plot, isPlotting } = now();
  if (!plot) {
    if (chosenProfile() && !isPlotting) askPlot(chosenProfile());
    else set({ panel: "sheet", isLeftOpen: true, note: "Choose a machine first" });
    return;
  }
  const isAtEnd = playback.time >= plot.seconds - 0.01;
  changePlayback({ isOn: true, isPlaying: !playback.isPlaying, time: isAtEnd && !playback.isPlaying ? 0 : playback.time });
  if (now().playback.isPlaying) tick(performance.now());
}

function tick(before: number): void {
  requestAnimationFrame((moment) => {
    const { playback, plot } = now();
    if (!playback.isPlaying || !plot) return;
    const time = playback.time + ((moment - before) / 1000) * playback.speed;
    const isDone = time >= plot.seconds;
    changePlayback({ time: Math.min(time, plot.seconds), isPlaying: !isDone });
    if (!isDone) tick(moment);
  });
}

/** To the end of the next path, or of the one before. */
export function step(by: number): void {
  const { plot, playback } = now();
  if (!plot) return;
  const done = pathsDone(playback.time + 1e-6);
  const time = done + by <= 0 ? 0 : pathEnd(done + by - 1);
  changePlayback({ isOn: true, isPlaying: false, time });
}

export function Bottom() {
  return (
    <footer class="bottom" id="bottom" tabIndex={-1} aria-label="Playback and status">
      <Player />
      <Stages />
      <OnItsWay />
      <Status />
    </footer>
  );
}

function Stages() {
  const isOpen = useStudio((state) => state.film.isOpen);
  return (
    <button class="quiet stages" title="Steps between photograph and drawing (I)" aria-expanded={isOpen} aria-keyshortcuts="I" onClick={toggleFilm}>
      Stages
    </button>
  );
}

/** While a machine draws, how far it is stands here on every page. */
function OnItsWay() {
  const sending = useStudio((state) => state.sending);
  if (!isSending(sending)) return null;
  const left = sending.seconds_left === undefined ? "" : `, ${clock(sending.seconds_left)} left`;
  return (
    <button class="quiet sending" title="Pause or stop (M)" onClick={openSend}>
      <span class="lamp is-working" aria-hidden="true" />
      {sendingInWords(sending)} {Math.round(100 * (sending.fraction ?? 0))} %{left}
    </button>
  );
}

function Player() {
  const plot = useStudio((state) => state.plot);
  const isPlotting = useStudio((state) => state.isPlotting);
  if (!plot) {
    return (
      <div class="player">
        <button class="quiet" disabled={isPlotting} onClick={play}>
          {isPlotting ? "Planning the plot…" : "Play back the plot"}
        </button>
      </div>
    );
  }
  return (
    <div class="player" role="group" aria-label="Playback of the plot">
      <Steps />
      <Time plot={plot} />
      <HowPlayed />
    </div>
  );
}

function Steps() {
  const isPlaying = useStudio((state) => state.playback.isPlaying);
  return (
    <>
      <IconButton icon="back" name="One path back" keys="," act={() => step(-1)} />
      <IconButton icon={isPlaying ? "pause" : "play"} name={isPlaying ? "Pause" : "Play"} keys="K" act={play} />
      <IconButton icon="forward" name="One path on" keys="." act={() => step(1)} />
    </>
  );
}

function Time({ plot }: { plot: PlotShown }) {
  const time = useStudio((state) => state.playback.time);
  const share = plot.seconds > 0 ? (100 * time) / plot.seconds : 0;
  const done = pathsDone(time + 1e-6);
  return (
    <>
      <input
        type="range"
        class="slider time"
        min={0}
        max={plot.seconds}
        step="any"
        value={time}
        style={{ "--share": `${share}%` }}
        aria-label="Time in the plot"
        aria-valuetext={`${clock(time)} of ${clock(plot.seconds)}, path ${done} of ${plot.paths}`}
        onInput={(event) => changePlayback({ isOn: true, time: Number(event.currentTarget.value) })}
      />
      <span class="figure">
        {clock(time)} / {clock(plot.seconds)}
      </span>
      <span class="figure paths">
        path {done} / {plot.paths}
      </span>
    </>
  );
}

function HowPlayed() {
  const { isOn, speed, hasTravel } = useStudio((state) => state.playback);
  return (
    <>
      <select aria-label="Speed" value={String(speed)} onChange={(event) => changePlayback({ speed: Number(event.currentTarget.value) })}>
        {SPEEDS.map((one) => (
          <option value={String(one)}>{one}×</option>
        ))}
      </select>
      <label class="check">
        <input type="checkbox" checked={hasTravel} onChange={(event) => changePlayback({ hasTravel: event.currentTarget.checked })} />
        Travel
      </label>
      <button class="quiet" aria-pressed={isOn} onClick={() => changePlayback({ isOn: !isOn, isPlaying: false })}>
        {isOn ? "Show the drawing" : "Show the plot"}
      </button>
    </>
  );
}

function Status() {
  const summary = useStudio((state) => state.shown?.summary ?? "");
  const seconds = useStudio((state) => state.shown?.seconds);
  const note = useStudio((state) => state.note);
  const isConnected = useStudio((state) => state.isConnected);
  const isOld = useStudio(isOutOfDate);
  return (
    <div class="status">
      {!isConnected && <strong class="lost">drypoint does not answer</strong>}
      <span class="note" role="status" aria-live="polite">
        {note}
      </span>
      <span class={`figure summary ${isOld ? "is-old" : ""}`}>
        {summary}
        {seconds !== undefined && !/ in [\d.]+ s$/.test(summary) ? `, in ${seconds.toFixed(1)} s` : ""}
      </span>
    </div>
  );
}
