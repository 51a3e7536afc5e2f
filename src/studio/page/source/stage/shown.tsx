// What is on the sheet, in words: coarse or full, out of date or not, what is being drawn, and what went wrong.

import type { State } from "../model/store.ts";
import { fetchToneError } from "./film.ts";
import { now, set, useStudio } from "../model/store.ts";

/** A slider's change that is not answered yet makes the drawing as old as a newer revision does. */
export function isOutOfDate(state: Readonly<State>): boolean {
  const { shown, scene, pending } = state;
  return shown !== null && scene !== null && (shown.revision !== scene.revision || Object.keys(pending).length > 0);
}

function quality(state: Readonly<State>): string {
  if (state.showsPhotograph || state.mode === "photograph") return "Photograph";
  const stage = state.film.isOpen && state.film.stages.find((one) => one.file === state.film.chosen);
  if (stage) return `Stage: ${stage.name}${state.film.revision !== state.scene?.revision ? ", out of date" : ""}`;
  if (state.playback.isOn) return state.plot && state.plot.revision !== state.scene?.revision ? "Plot, out of date" : "Plot";
  if (!state.shown) return state.scene?.photograph ? "No drawing yet" : "No photograph";
  const name = state.shown.quality === "full" ? "Full" : "Coarse";
  return isOutOfDate(state) ? `${name}, out of date` : name;
}

function activity(state: Readonly<State>): string {
  if (state.isPlotting) return "planning the plot…";
  if (!state.work) return "";
  const what = state.work.quality === "full" ? "drawing in full" : "drawing coarsely";
  return `${what}${state.work.stage ? `: ${state.work.stage}` : "…"}`;
}

/** What the colours of the error of tone mean, and of which drawing they are. */
function ToneLegend() {
  const tone = useStudio((state) => state.tone);
  const revision = useStudio((state) => state.scene?.revision);
  if (!tone.isOn) return null;
  const isOld = tone.revision !== revision;
  if (tone.isBusy) return <p class="tone-legend">Comparing tones: the full drawing is made for it…</p>;
  return (
    <p class="tone-legend" role="status">
      {tone.fault ?? (tone.file ? (
        <>
          <span class="swatch too-dark" aria-hidden="true" /> too dark <span class="swatch too-light" aria-hidden="true" /> too light
          <span class="doing">{isOld ? "out of date" : ""}</span>
        </>
      ) : (
        "This drawing has no picture of its tone error: none is made in colours."
      ))}
      {isOld && (
        <button class="quiet" onClick={() => void fetchToneError()}>
          Compare anew
        </button>
      )}
    </p>
  );
}

export function ShownLabel() {
  const what = useStudio(quality);
  const doing = useStudio(activity);
  const isOld = useStudio(isOutOfDate);
  const failure = useStudio((state) => state.fault ?? state.failure?.message ?? state.scene?.error);
  const warnings = useStudio((state) => state.shown?.warnings);
  const sight = useStudio((state) => (state.sight?.state === "looking" || state.sight?.state === "failed" ? state.sight.message : null));
  return (
    <div class="shown">
      <p class={`shown-label ${isOld ? "is-old" : ""}`} data-shown={what}>
        <span class={`lamp ${doing ? "is-working" : ""}`} aria-hidden="true" />
        <strong>{what}</strong>
        {doing && <span class="doing">{doing}</span>}
      </p>
      <ToneLegend />
      {sight && <p class="remark">{sight}</p>}
      {failure && (
        <p class="failure" role="alert">
          {failure}
          <button class="quiet" aria-label="Dismiss the message" onClick={() => set(now().fault ? { fault: null } : { failure: null })}>
            ×
          </button>
        </p>
      )}
      {!failure && warnings && warnings.length > 0 && (
        <details class="remark">
          <summary>
            {warnings.length} {warnings.length === 1 ? "remark" : "remarks"}
          </summary>
          {warnings.map((warning) => (
            <p>{warning}</p>
          ))}
        </details>
      )}
    </div>
  );
}
