// Masks as canvases on the photograph's grid: the colour is the role's, the opacity of a pixel is how far it is inside.

import { accept, attempt, say, valueAt } from "../model/scene.ts";
import { now, set } from "../model/store.ts";
import { get, request, sendBytes } from "../server/requests.ts";
import type { Masks, Scene } from "../server/shapes.ts";

export const ROLE_COLORS: { [role: string]: string } = {
  subject: "#4f7fd1",
  skin: "#e08a4a",
  face: "#d9566b",
  hair: "#8d5fc9",
  "facial-hair": "#b0468f",
  headwear: "#2f9e9a",
  clothing: "#4c9a4a",
  detail: "#c9a21d",
  edges: "#d0337c",
  isophotes: "#2b79c9",
  directions: "#7a8b1f",
  highlights: "#d9a400",
};

/** Roles of lines, which only some styles take. */
export const LINE_ROLES = ["edges", "isophotes", "directions"];

/** True unless the drawing's style takes no lines of this role. */
export function isTaken(role: string): boolean {
  const { start } = now();
  const style = start?.styles.find((one) => one.name === String(valueAt(["style"]) ?? "hedcut"));
  return !LINE_ROLES.includes(role) || Boolean(style?.masks.some((mask) => mask.role === role));
}

/** How long after a stroke the mask is sent, in milliseconds. */
const PAUSE = 400;

const canvases = new Map<string, OffscreenCanvas>();
let merged: OffscreenCanvas | null = null;
let redraw: () => void = () => {};
const timers = new Map<string, ReturnType<typeof setTimeout>>();

export function whenMasksChange(act: () => void): void {
  redraw = act;
}

export function colorOf(role: string): string {
  return ROLE_COLORS[role] ?? "#777777";
}

export function maskCanvas(role: string): OffscreenCanvas | null {
  return canvases.get(role) ?? null;
}

/** The mask to paint on; an empty one if nothing was found. */
export function canvasToPaint(role: string): OffscreenCanvas | null {
  const { maskSize, masks, sight } = now();
  const known = canvases.get(role);
  if (known || !maskSize) return known ?? null;
  // Painted on too early, an empty mask would replace the one that was found or is still looked for.
  const isThere = masks.find((mask) => mask.role === role)?.isThere;
  if (isThere !== false || sight?.state === "looking") return null;
  const canvas = new OffscreenCanvas(...maskSize);
  canvases.set(role, canvas);
  return canvas;
}

/** Forgets what was fetched and fetches what is visible. */
export async function reloadMasks(): Promise<void> {
  if (timers.size > 0) return;
  if (!now().scene?.photograph) {
    canvases.clear();
    merged = null;
    set({ masks: [], maskSize: null });
    redraw();
    return;
  }
  const told = await attempt(() => get<Masks>("/api/masks"));
  if (!told) return;
  const known = new Map(now().masks.map((mask) => [mask.role, mask.isVisible]));
  const masks = told.roles.filter(({ role }) => role in ROLE_COLORS).map(({ role, is_there, is_painted }) => ({ role, isThere: is_there, isPainted: is_painted, isVisible: known.get(role) ?? false }));
  canvases.clear();
  merged = null;
  set({ masks, maskSize: told.size ?? photographGrid() });
  await Promise.all(masks.filter((mask) => mask.isVisible && mask.isThere).map((mask) => fetchMask(mask.role)));
  redraw();
}

/** Masks lie on the photograph's grid, or a smaller one of its proportions. */
function photographGrid(): [number, number] | null {
  const photograph = now().scene?.photograph;
  if (!photograph) return null;
  const { width, height } = photograph;
  const ratio = Math.min(1, 2048 / Math.max(width, height));
  return [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
}

export async function fetchMask(role: string): Promise<void> {
  const answer = await attempt(() => request("GET", `/api/mask/${role}`));
  if (!answer) return;
  canvases.set(role, await tinted(await answer.blob(), role));
  merged = null;
  redraw();
}

/** A grey picture as a mask: its lightness becomes opacity. */
async function tinted(picture: Blob, role: string): Promise<OffscreenCanvas> {
  const bitmap = await createImageBitmap(picture);
  const [width, height] = now().maskSize ?? [bitmap.width, bitmap.height];
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0, width, height);
  bitmap.close();
  const pixels = context.getImageData(0, 0, width, height);
  const color = Number.parseInt(colorOf(role).slice(1), 16);
  for (let at = 0; at < pixels.data.length; at += 4) {
    pixels.data[at + 3] = (pixels.data[at]! * pixels.data[at + 3]!) / 255;
    pixels.data[at] = color >> 16;
    pixels.data[at + 1] = (color >> 8) & 255;
    pixels.data[at + 2] = color & 255;
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

async function greyPicture(canvas: OffscreenCanvas): Promise<Blob> {
  const pixels = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
  for (let at = 0; at < pixels.data.length; at += 4) {
    pixels.data.fill(pixels.data[at + 3]!, at, at + 3);
    pixels.data[at + 3] = 255;
  }
  const grey = new OffscreenCanvas(canvas.width, canvas.height);
  grey.getContext("2d")!.putImageData(pixels, 0, 0);
  return grey.convertToBlob({ type: "image/png" });
}

export function maskPainted(): void {
  merged = null;
  redraw();
}

/** Sends the mask when no stroke has followed for a moment. */
export function sendSoon(role: string): void {
  clearTimeout(timers.get(role));
  timers.set(
    role,
    setTimeout(async () => {
      timers.delete(role);
      const canvas = canvases.get(role);
      if (!canvas) return;
      const picture = await greyPicture(canvas);
      const scene = await attempt(() => sendBytes<Scene>("PUT", `/api/mask/${role}`, picture));
      if (!scene) return;
      accept(scene);
      set({ masks: now().masks.map((mask) => (mask.role === role ? { ...mask, isThere: true, isPainted: true } : mask)) });
      say(`The mask of ${role} is part of the scene`);
    }, PAUSE),
  );
}

export async function importMask(role: string, picture: Blob): Promise<void> {
  const canvas = await attempt(() => tinted(picture, role));
  if (!canvas) return;
  canvases.set(role, canvas);
  maskPainted();
  sendSoon(role);
}

export async function exportMask(role: string): Promise<void> {
  if (!canvases.has(role)) await fetchMask(role);
  const canvas = canvases.get(role);
  if (!canvas) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await greyPicture(canvas));
  link.download = `${role}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** All visible masks in one canvas, made anew only when one changes. */
export function mergedMasks(): OffscreenCanvas | null {
  const visible = now().masks.filter((mask) => mask.isVisible && isTaken(mask.role)).flatMap((mask) => canvases.get(mask.role) ?? []);
  if (visible.length === 0) return null;
  if (visible.length === 1) return visible[0]!;
  if (merged) return merged;
  merged = new OffscreenCanvas(visible[0]!.width, visible[0]!.height);
  const context = merged.getContext("2d")!;
  for (const canvas of visible) context.drawImage(canvas, 0, 0);
  return merged;
}

export function setVisible(role: string, isVisible: boolean): void {
  set({ masks: now().masks.map((mask) => (mask.role === role ? { ...mask, isVisible } : mask)) });
  merged = null;
  const mask = now().masks.find((one) => one.role === role);
  if (isVisible && mask?.isThere && !canvases.has(role)) void fetchMask(role);
  else redraw();
}
