// The strip of stages: every step between photograph and drawing as a picture, explained.

import { useEffect, useRef } from "preact/hooks";
import { valueAt } from "../model/scene.ts";
import { now, useStudio, type Film } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { changeFilm, chooseStage, fetchStages, stageAddress } from "../stage/film.ts";
import { explanation } from "../style/stages.ts";

export function toggleFilm(): void {
  const isOpen = !now().film.isOpen;
  // The focus would vanish with the strip.
  if (document.getElementById("film")?.contains(document.activeElement)) document.querySelector("canvas")?.focus();
  changeFilm({ isOpen });
  if (isOpen) void fetchStages();
}

export function FilmStrip() {
  const film = useStudio((state) => state.film);
  const revision = useStudio((state) => state.scene?.revision ?? 0);
  const hasPhotograph = useStudio((state) => Boolean(state.scene?.photograph));
  if (!film.isOpen) return null;
  const isOld = film.stages.length > 0 && film.revision !== revision;
  return (
    <section class="film" id="film" aria-label="Stages between photograph and drawing" tabIndex={-1}>
      <div class="film-told">
        <div class="film-head">
          <h2>Stages</h2>
          {isOld && <span class="count">out of date</span>}
          <IconButton icon="remove" name="Close the stages" keys="I" act={toggleFilm} />
        </div>
        <Told film={film} hasPhotograph={hasPhotograph} />
        {(isOld || film.fault) && (
          <button disabled={film.isBusy} onClick={() => void fetchStages()}>
            {film.isBusy ? "Making them…" : "Make them anew"}
          </button>
        )}
      </div>
      {film.stages.length > 0 && <Frames film={film} isOld={isOld} />}
    </section>
  );
}

function Told({ film, hasPhotograph }: { film: Film; hasPhotograph: boolean }) {
  const chosen = film.stages.find((stage) => stage.file === film.chosen);
  if (film.fault) {
    return (
      <p class="failure" role="alert">
        {film.fault}
      </p>
    );
  }
  const text = chosen
    ? explanation(String(valueAt(["style"]) ?? "hedcut"), chosen.name)
    : film.isBusy
      ? "Making the pictures; it takes some seconds…"
      : hasPhotograph
        ? "Every step of the coarse drawing. Choose one to see it on the sheet."
        : "Open a photograph first.";
  return (
    <p class="film-text" role="status">
      {chosen && <strong>{chosen.name}: </strong>}
      {text}
    </p>
  );
}

function Frames({ film, isOld }: { film: Film; isOld: boolean }) {
  const list = useRef<HTMLOListElement>(null);
  const index = Math.max(0, film.stages.findIndex((stage) => stage.file === film.chosen));
  useEffect(() => {
    // Whoever opened the strip by its key goes on with the arrows.
    if (document.activeElement?.tagName !== "INPUT") list.current?.querySelector<HTMLElement>("button")?.focus({ preventScroll: true });
  }, []);
  const go = (to: number) => {
    const button = list.current?.querySelectorAll<HTMLElement>("button")[Math.min(film.stages.length - 1, Math.max(0, to))];
    button?.focus();
    button?.scrollIntoView({ block: "nearest", inline: "nearest" });
  };
  const key = (event: KeyboardEvent, at: number) => {
    const to = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: film.stages.length - 1 }[event.key];
    if (to === undefined && event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    if (to === undefined) chooseStage(null);
    else go(to);
  };
  return (
    <ol class={`frames ${isOld ? "is-old" : ""}`} ref={list}>
      {film.stages.map((stage, at) => (
        <li key={stage.file}>
          <button
            class="frame"
            tabIndex={at === index ? 0 : -1}
            aria-pressed={stage.file === film.chosen}
            onClick={() => chooseStage(stage.file === film.chosen ? null : stage.file)}
            onKeyDown={(event) => key(event, at)}
          >
            <img src={stageAddress(stage.file, film.revision)} alt="" loading="lazy" />
            <span>{stage.name}</span>
          </button>
        </li>
      ))}
    </ol>
  );
}
