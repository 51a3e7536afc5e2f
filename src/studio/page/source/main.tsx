// Begins: asks what there is, listens to what happens, shows the page.

import { render } from "preact";
import { accept, attempt, reload, whenTravelled } from "./model/scene.ts";
import { now, set, subscribe } from "./model/store.ts";
import { Bottom } from "./panels/bottom.tsx";
import { Dialogs } from "./panels/dialogs.tsx";
import { listenToKeys } from "./panels/keys.ts";
import { FilmStrip } from "./panels/film.tsx";
import { Left } from "./panels/left.tsx";
import { Right } from "./panels/right.tsx";
import { Top } from "./panels/top.tsx";
import { listen } from "./server/events.ts";
import { get } from "./server/requests.ts";
import type { Scene, Start } from "./server/shapes.ts";
import { hearSending } from "./model/sending.ts";
import { clearDrawing, redraw, showDrawing } from "./stage/engine.ts";
import { whenFilmChanges } from "./stage/film.ts";
import { reloadMasks, whenMasksChange } from "./stage/masks.ts";
import { followPhotograph } from "./stage/photograph.ts";
import { Stage } from "./stage/stage.tsx";

function Studio() {
  return (
    <div class="studio">
      <Top />
      <Left />
      <Stage />
      <Right />
      <FilmStrip />
      <Bottom />
      <Dialogs />
    </div>
  );
}

function listenToServer(): void {
  listen(
    {
      scene: ({ revision }) => revision !== now().scene?.revision && void reload(),
      started: ({ quality, revision }) => set({ work: { quality, revision, stage: "" }, failure: null }),
      stage: ({ stage }) => {
        const { work } = now();
        if (work) set({ work: { ...work, stage } });
      },
      finished: ({ id, quality, revision }) => {
        const { work } = now();
        if (work?.revision === revision && work.quality === quality) set({ work: null });
        showDrawing(String(id), quality, revision);
      },
      failed: ({ revision, message }) => set({ work: null, failure: { revision, message } }),
      sending: hearSending,
      sight: (sight) => {
        if (sight.state === "looking") set({ sight });
        else void reloadMasks().then(() => set({ sight }));
      },
    },
    (isConnected) => set({ isConnected }),
  );
}

let known = { photograph: "", masks: "", revision: 0 };

/** What follows from another scene: its photograph, its masks, no longer the old drawing. */
function followScene(): void {
  const { scene, playback } = now();
  if (!scene || (scene.revision === known.revision && known.photograph === `${scene.folder}/${scene.photograph?.name}`)) return;
  const before = known;
  const photograph = `${scene.folder}/${scene.photograph?.name}`;
  const masks = JSON.stringify([scene.values["mask"], scene.values["sight"]]);
  // Noted before anything is done about it: what is done changes the state again.
  known = { photograph, masks, revision: scene.revision };
  if (photograph !== before.photograph) {
    if (before.photograph) clearDrawing();
    void followPhotograph(redraw);
    void reloadMasks();
  } else if (masks !== before.masks) void reloadMasks();
  // Whoever changes the drawing wants to see it, not the plot of what it was.
  if (playback.isOn) set({ playback: { ...playback, isOn: false, isPlaying: false } });
}

async function begin(): Promise<void> {
  whenMasksChange(redraw);
  whenFilmChanges(redraw);
  whenTravelled(() => void reloadMasks());
  listenToKeys();
  render(<Studio />, document.getElementById("page")!);
  subscribe(followScene);
  const [start, scene] = await Promise.all([attempt(() => get<Start>("/api/start")), attempt(() => get<Scene>("/api/scene"))]);
  if (start) set({ start });
  if (scene) accept(scene);
  listenToServer();
}

void begin();
