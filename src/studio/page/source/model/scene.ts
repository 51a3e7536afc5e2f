// Changes to the scene. The server's answer is the truth; what is on its way is remembered in `pending` until then.

import { get, Refusal, request, send, sendBytes } from "../server/requests.ts";
import type { Exported, Path, Scene, Table, Value } from "../server/shapes.ts";
import { now, set } from "./store.ts";

export interface Change {
  path: Path;
  value: Value;
}

/** While a slider moves, changes go out at most this often, in milliseconds. */
const EVERY = 60;

let waiting: { label: string; changes: Map<string, Change> } | null = null;
let isSending = false;
let lastSent = 0;
let timer: ReturnType<typeof setTimeout> | undefined;

/** The answers of requests may overtake each other: an older revision never replaces a newer one. */
export function accept(scene: Scene): void {
  const known = now().scene;
  if (known && scene.file === known.file && scene.folder === known.folder && scene.revision < known.revision) return;
  set({ scene, fault: null });
}

export function say(note: string): void {
  set({ note });
}

/** Runs a request whose failure is told in the server's words. */
export async function attempt<T>(work: () => Promise<T>): Promise<T | null> {
  try {
    return await work();
  } catch (error) {
    const message = error instanceof Refusal ? error.message : String(error);
    set({ fault: message, note: "" });
    return null;
  }
}

/** Runs a request whose failure is told where it was asked for. */
export async function attemptQuietly<T>(work: () => Promise<T>): Promise<{ value: T | null; fault: string | null }> {
  try {
    return { value: await work(), fault: null };
  } catch (error) {
    return { value: null, fault: error instanceof Error ? error.message : String(error) };
  }
}

export function change(label: string, ...changes: Change[]): void {
  if (waiting && waiting.label !== label) void flush();
  waiting ??= { label, changes: new Map() };
  const pending = { ...now().pending };
  for (const one of changes) {
    const key = JSON.stringify(one.path);
    waiting.changes.set(key, one);
    pending[key] = one.value;
  }
  set({ pending });
  schedule();
}

function schedule(): void {
  if (isSending || timer !== undefined) return;
  const wait = Math.max(0, lastSent + EVERY - performance.now());
  timer = setTimeout(() => {
    timer = undefined;
    void flush();
  }, wait);
}

let tail: Promise<void> = Promise.resolve();

/** Sends what waits; resolves when all that was sent has been answered. */
export function flush(): Promise<void> {
  const batch = waiting;
  waiting = null;
  if (!batch) return tail;
  isSending = true;
  lastSent = performance.now();
  tail = tail.then(async () => {
    const changes = [...batch.changes.values()];
    const scene = await attempt(() => send<Scene>("POST", "/api/scene", { label: batch.label, changes }));
    isSending = false;
    settle(changes);
    if (scene) accept(scene);
    if (waiting) schedule();
  });
  return tail;
}

function settle(changes: Change[]): void {
  const pending = { ...now().pending };
  for (const one of changes) {
    const key = JSON.stringify(one.path);
    if (pending[key] === one.value && !waiting?.changes.has(key)) delete pending[key];
  }
  set({ pending });
}

/** The value of the scene at a path, with what is on its way; undefined means its default. */
export function valueAt(path: Path): Value | undefined {
  const key = JSON.stringify(path);
  const { pending, scene } = now();
  if (key in pending) return pending[key] ?? undefined;
  let value: Value | undefined = scene?.values;
  for (const step of path) {
    if (value === null || typeof value !== "object") return undefined;
    value = (value as { [key: string]: Value })[step as string];
  }
  return value ?? undefined;
}

export function tableAt(path: Path): Table {
  const value = valueAt(path);
  return value && typeof value === "object" && !Array.isArray(value) ? value : {};
}

export async function reload(): Promise<void> {
  const scene = await attempt(() => get<Scene>("/api/scene"));
  if (scene) accept(scene);
}

let travelled: () => void = () => {};

/** What must be fetched anew after an undo or redo, because the scene's text does not tell that it changed: masks. */
export function whenTravelled(act: () => void): void {
  travelled = act;
}

export async function undo(): Promise<void> {
  await flush();
  const label = now().scene?.undo_label;
  const scene = await attempt(() => send<Scene>("POST", "/api/undo"));
  if (scene) (accept(scene), travelled(), say(`Undone${label ? `: ${label}` : ""}`));
}

export async function redo(): Promise<void> {
  await flush();
  const label = now().scene?.redo_label;
  const scene = await attempt(() => send<Scene>("POST", "/api/redo"));
  if (scene) (accept(scene), travelled(), say(`Done again${label ? `: ${label}` : ""}`));
}

/** Replaces the scene's text; the error is returned, to be shown beside the text. */
export async function replaceText(toml: string): Promise<string | null> {
  await flush();
  try {
    accept(await send<Scene>("PUT", "/api/scene", { toml }));
    return null;
  } catch (error) {
    return error instanceof Error ? error.message : String(error);
  }
}

export async function openPhotograph(file: File): Promise<void> {
  say(`Opening ${file.name}`);
  const path = `/api/photograph?name=${encodeURIComponent(file.name)}`;
  const scene = await attempt(() => sendBytes<Scene>("POST", path, file));
  if (scene) (set({ shown: null, failure: null }), accept(scene), say(`${file.name} is open`));
}

export async function openScene(file: string): Promise<void> {
  const scene = await attempt(() => send<Scene>("POST", "/api/open", { file }));
  if (scene) (set({ shown: null, failure: null, scene: null }), accept(scene), say(`${file} is open`));
}

/** Two recipes side by side: the text of one is in the scene, that of the other is kept here. */
export async function swapRecipes(): Promise<void> {
  const { scene, other } = now();
  if (!scene) return;
  if (other === null) {
    set({ other: scene.toml, note: "This recipe is kept as B; change the drawing and press X to compare" });
    return;
  }
  const error = await replaceText(other);
  set(error ? { fault: error } : { other: scene.toml, note: "Swapped with the other recipe" });
}

export async function copyCommand(): Promise<void> {
  await flush();
  await reload();
  const command = now().scene?.command;
  if (!command) return;
  try {
    await navigator.clipboard.writeText(command);
    say("The command is in the clipboard");
  } catch {
    set({ fault: `The browser does not let the page copy; the command is: ${command}` });
  }
}

export async function exportFile(file: string, profile: string | null): Promise<string | null> {
  await flush();
  try {
    const exported = await send<Exported>("POST", "/api/export", { file, profile });
    set({ exported, note: `${exported.file} is written` });
    // The command to copy is now the one that makes this file.
    await reload();
    return null;
  } catch (error) {
    return error instanceof Error ? error.message : String(error);
  }
}

export async function deleteMask(role: string): Promise<void> {
  const scene = await attempt(async () => (await request("DELETE", `/api/mask/${role}`)).json() as Promise<Scene>);
  if (scene) accept(scene);
}
