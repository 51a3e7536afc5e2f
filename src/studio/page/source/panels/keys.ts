// Every key, once: the list that acts is the list that the help shows.

import { copyCommand, redo, swapRecipes, undo } from "../model/scene.ts";
import { now, set, type Tool } from "../model/store.ts";
import { camera } from "../stage/camera.ts";
import { redraw } from "../stage/engine.ts";
import { toggleToneError } from "../stage/film.ts";
import { paintInMiddle } from "../stage/gestures.ts";
import { endLine } from "../stage/line.ts";
import { partInView } from "../stage/part.ts";
import { nudge } from "../stage/placing.ts";
import { setDivider, showBrushAfterKey } from "../stage/stage.tsx";
import { changePlayback, play, step } from "./bottom.tsx";
import { toggleFilm } from "./film.tsx";
import { chooseTool } from "./left.tsx";
import { changeMaskTools } from "./masks.tsx";
import { togglePresets } from "./presets.tsx";
import { openSend } from "./send.tsx";
import { setMode } from "./top.tsx";

interface Key {
  keys: string;
  name: string;
  act: () => void;
}

const STEP = 60;

function arrow(dx: number, dy: number): void {
  if (now().tool === "place") nudge(dx, dy);
  else camera.pan(-dx * STEP * camera.density, -dy * STEP * camera.density);
}

const tool = (keys: string, which: Tool, name: string): Key => ({ keys, name, act: () => chooseTool(which) });

function resizeBrush(factor: number): void {
  changeMaskTools({ size: Math.min(400, Math.max(2, Math.round(now().mask.size * factor))) });
}

function featherBrush(by: number): void {
  changeMaskTools({ feather: Math.min(1, Math.max(0, Math.round(20 * (now().mask.feather + by)) / 20)) });
}

function enter(): void {
  const { tool } = now();
  if (tool === "part") partInView();
  else if (tool !== "hand" && tool !== "place") paintInMiddle();
}

const PARTS = ["left", "stage", "right", "film", "bottom"];

/** To the next part of the page: tools, drawing, parameters, playback. */
function nextPart(): void {
  const current = PARTS.findIndex((id) => document.getElementById(id)?.contains(document.activeElement));
  for (let more = 1; more <= PARTS.length; more++) {
    const part = document.getElementById(PARTS[(current + more) % PARTS.length]!);
    const target = part?.querySelector<HTMLElement>("canvas, button:not(:disabled), input");
    if (target) return target.focus();
  }
}

export const KEYS: { name: string; keys: Key[] }[] = [
  {
    name: "Look",
    keys: [
      { keys: "+", name: "Zoom in", act: () => camera.zoom(1.25) },
      { keys: "-", name: "Zoom out", act: () => camera.zoom(1 / 1.25) },
      { keys: "0", name: "Fit the sheet", act: () => camera.fit() },
      { keys: "1", name: "Print size", act: () => camera.printSize() },
      { keys: "W", name: "Drawing", act: () => setMode("drawing") },
      { keys: "D", name: "Divider; the arrows move it when it has the focus", act: () => setMode("divider") },
      { keys: "S", name: "Side by side", act: () => setMode("side") },
      { keys: "P", name: "Photograph, while held", act: () => (set({ showsPhotograph: true }), redraw()) },
      { keys: "I", name: "Stages between photograph and drawing", act: toggleFilm },
      { keys: "O", name: "Error of tone over the drawing", act: toggleToneError },
      { keys: "<", name: "Divider to the left", act: () => setDivider(now().divider - 0.05) },
      { keys: ">", name: "Divider to the right", act: () => setDivider(now().divider + 0.05) },
    ],
  },
  {
    name: "Recipe",
    keys: [
      { keys: "Ctrl+Z", name: "Undo", act: () => void undo() },
      { keys: "Ctrl+Shift+Z", name: "Redo", act: () => void redo() },
      { keys: "X", name: "Keep as B, then swap A and B", act: () => void swapRecipes() },
      { keys: "Y", name: "Presets as pictures", act: togglePresets },
      { keys: "Ctrl+Shift+C", name: "Copy as command", act: () => void copyCommand() },
      { keys: "Ctrl+E", name: "Export", act: () => set({ dialog: "export" }) },
    ],
  },
  {
    name: "Tools",
    keys: [
      tool("V", "hand", "Move the view"),
      tool("G", "place", "Place the picture; arrows move it by 1 mm"),
      tool("R", "part", "Part to plot; Enter takes what is in view"),
      tool("B", "brush", "Brush"),
      tool("E", "eraser", "Eraser"),
      tool("L", "lasso", "Lasso"),
      tool("N", "line", "Pen for lines: clicks or Enter join corners"),
      { keys: "Escape", name: "End the pen's line", act: endLine },
      tool("F", "fill", "Fill"),
      { keys: "[", name: "Smaller brush", act: () => resizeBrush(1 / 1.2) },
      { keys: "]", name: "Larger brush", act: () => resizeBrush(1.2) },
      { keys: "{", name: "Harder brush", act: () => featherBrush(-0.05) },
      { keys: "}", name: "Softer brush", act: () => featherBrush(0.05) },
      { keys: "Enter", name: "Paint in the middle of the view", act: enter },
    ],
  },
  {
    name: "Plot",
    keys: [
      { keys: "K", name: "Play or pause", act: play },
      { keys: ",", name: "One path back", act: () => step(-1) },
      { keys: ".", name: "One path on", act: () => step(1) },
      { keys: "M", name: "Send to the machine", act: openSend },
      { keys: "T", name: "Travel on or off", act: () => changePlayback({ hasTravel: !now().playback.hasTravel }) },
    ],
  },
  {
    name: "Page",
    keys: [
      { keys: "F6", name: "Next part of the page", act: nextPart },
      { keys: "Q", name: "Left panel open or closed", act: () => set({ isLeftOpen: !now().isLeftOpen }) },
      { keys: "A", name: "Right panel open or closed", act: () => set({ isRightOpen: !now().isRightOpen }) },
      { keys: "?", name: "This list", act: () => set({ dialog: "help" }) },
    ],
  },
];

const ARROWS: { [key: string]: [number, number] } = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const bound = new Map(KEYS.flatMap((group) => group.keys).map((key) => [key.keys.toLowerCase(), key.act]));
bound.set("ctrl+y", bound.get("ctrl+shift+z")!);
bound.set("=", bound.get("+")!);

function nameOf(event: KeyboardEvent): string {
  const key = event.key.toLowerCase();
  if (!event.ctrlKey && !event.metaKey) return key;
  return `ctrl+${event.shiftKey ? "shift+" : ""}${key}`;
}

function isWriting(target: EventTarget | null): boolean {
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  return target instanceof HTMLInputElement && !["checkbox", "radio", "range"].includes(target.type);
}

function pressed(event: KeyboardEvent): void {
  if (event.altKey || now().dialog) return;
  const name = nameOf(event);
  const isChord = name.startsWith("ctrl+") || name === "f6";
  if (isWriting(event.target) && (!isChord || event.target instanceof HTMLTextAreaElement)) return;
  const isOnCanvas = event.target instanceof HTMLCanvasElement || event.target === document.body;
  if ((name in { enter: 0 } || event.key in ARROWS) && !isOnCanvas) return;
  const direction = ARROWS[event.key];
  const act = direction ? () => arrow(...direction) : bound.get(name);
  if (!act) return;
  event.preventDefault();
  if (!event.repeat || direction || "+-=[]{}<>,.".includes(event.key)) act();
  if (document.activeElement instanceof HTMLCanvasElement) showBrushAfterKey(direction !== undefined || name === "enter");
}

export function listenToKeys(): void {
  addEventListener("keydown", pressed);
  const released = () => now().showsPhotograph && (set({ showsPhotograph: false }), redraw());
  addEventListener("keyup", (event) => event.key.toLowerCase() === "p" && released());
  addEventListener("blur", released);
}
