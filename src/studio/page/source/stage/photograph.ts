// The photograph as the page shows it, and the way between its pixels and the sheet.

import { address } from "../server/requests.ts";
import type { Affine } from "../server/shapes.ts";
import { now } from "../model/store.ts";

let shownAs = "";
let picture: ImageBitmap | null = null;

export function photographPicture(): ImageBitmap | null {
  return picture;
}

/** Fetches the photograph if the scene has another one now. */
export async function followPhotograph(redraw: () => void): Promise<void> {
  const { scene } = now();
  const photograph = scene?.photograph;
  const name = photograph ? `${scene.folder}/${photograph.name} ${photograph.width}x${photograph.height}` : "";
  if (name === shownAs) return;
  shownAs = name;
  picture?.close();
  picture = null;
  redraw();
  if (!photograph) return;
  const answer = await fetch(address("/api/photograph", { long: 1600 }), { cache: "no-store" });
  if (!answer.ok || shownAs !== name) return;
  picture = await createImageBitmap(await answer.blob());
  redraw();
}

/** From pixels of the upright photograph to the sheet; before the first drawing, the photograph fills the sheet. */
export function photographToSheet(page: [number, number]): { pixels: [number, number]; affine: Affine } {
  const { shown, scene } = now();
  if (shown?.placement) return { pixels: shown.placement.pixels, affine: shown.placement.to_sheet };
  const pixels: [number, number] = [scene?.photograph?.width ?? 1, scene?.photograph?.height ?? 1];
  const scale = Math.min(page[0] / pixels[0], page[1] / pixels[1]);
  return { pixels, affine: [scale, 0, 0, scale, (page[0] - pixels[0] * scale) / 2, (page[1] - pixels[1] * scale) / 2] };
}

export function inverse([a, b, c, d, e, f]: Affine): Affine {
  const area = a * d - b * c || 1;
  return [d / area, -b / area, -c / area, a / area, (c * f - d * e) / area, (b * e - a * f) / area];
}

export function apply([a, b, c, d, e, f]: Affine, x: number, y: number): [number, number] {
  return [a * x + c * y + e, b * x + d * y + f];
}
