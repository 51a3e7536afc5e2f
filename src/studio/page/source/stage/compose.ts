// Puts a frame together: desk, sheet, drawing or photograph, masks, plot. Only when something has changed.

import type { View } from "../marks/messages.ts";
import { now } from "../model/store.ts";
import { camera } from "./camera.ts";
import { drawStage, drawToneError, isStageShown } from "./film.ts";
import { mergedMasks } from "./masks.ts";
import { photographPicture, photographToSheet } from "./photograph.ts";
import type { Tiles } from "./tiles.ts";

type Context = CanvasRenderingContext2D;

export interface Overlay {
  /** A lasso under way, and the brush's outline, in pixels of the photograph or of the pane. */
  lasso: [number, number][];
  brush: { x: number; y: number; radius: number } | null;
  /** How far the drawing is being dragged, in millimetres. */
  shift: [number, number];
  guides: { x: number | null; y: number | null };
}

export interface Played {
  view: View;
  bitmap: ImageBitmap;
}

export function compose(context: Context, tiles: Tiles, overlay: Overlay, played: Played | null): void {
  const { mode, showsPhotograph, divider } = now();
  const { width, height } = context.canvas;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, width, height);
  if (showsPhotograph || mode === "photograph") pane(context, 0, 0, width, () => photograph(context));
  else if (mode === "divider") {
    const cut = Math.round(width * divider);
    pane(context, 0, 0, cut, () => photograph(context));
    pane(context, 0, cut, width, () => drawing(context, tiles, overlay, played));
  } else if (mode === "side") {
    pane(context, 0, 0, camera.width, () => photograph(context));
    pane(context, width - camera.width, width - camera.width, width, () => drawing(context, tiles, overlay, played));
  } else pane(context, 0, 0, width, () => drawing(context, tiles, overlay, played));
}

/** A part of the canvas from `left` to `right`; the camera's corner lies at `origin`. */
function pane(context: Context, origin: number, left: number, right: number, paint: () => void): void {
  context.save();
  context.beginPath();
  context.rect(left, 0, right - left, context.canvas.height);
  context.clip();
  context.translate(origin, 0);
  const [page, scale] = [camera.page, camera.scale];
  const sheet = [camera.x, camera.y, Math.round(page[0] * scale), Math.round(page[1] * scale)] as const;
  shadow(context, sheet);
  context.fillStyle = now().shown?.paper ?? "#ffffff";
  context.fillRect(...sheet);
  context.beginPath();
  context.rect(...sheet);
  context.clip();
  paint();
  context.restore();
}

function shadow(context: Context, [x, y, width, height]: readonly [number, number, number, number]): void {
  const density = camera.density;
  context.fillStyle = "rgba(0, 0, 0, 0.10)";
  context.fillRect(x - density, y, width + 2 * density, height + 2 * density);
  context.fillStyle = "rgba(0, 0, 0, 0.06)";
  context.fillRect(x - 2 * density, y + density, width + 4 * density, height + 4 * density);
}

function withPhotograph(context: Context, paint: (pixels: [number, number]) => void): void {
  const { pixels, affine } = photographToSheet(camera.page);
  context.save();
  context.translate(camera.x, camera.y);
  context.scale(camera.scale, camera.scale);
  context.transform(...affine);
  paint(pixels);
  context.restore();
}

function photograph(context: Context): void {
  const picture = photographPicture();
  if (picture) withPhotograph(context, (pixels) => ((context.imageSmoothingEnabled = true), context.drawImage(picture, 0, 0, ...pixels)));
  masks(context);
}

function masks(context: Context): void {
  // Beside sheet and text they would only be in the way.
  if (now().panel === "sheet" || now().panel === "scene") return;
  const merged = mergedMasks();
  if (!merged) return;
  context.globalAlpha = now().mask.opacity;
  withPhotograph(context, (pixels) => context.drawImage(merged, 0, 0, ...pixels));
  context.globalAlpha = 1;
}

function drawing(context: Context, tiles: Tiles, overlay: Overlay, played: Played | null): void {
  const [dx, dy] = overlay.shift;
  context.save();
  context.translate(Math.round(dx * camera.scale), Math.round(dy * camera.scale));
  if (isStageShown()) drawStage(context);
  else if (now().playback.isOn && played) plot(context, played);
  else if (tiles.hasDrawing()) tiles.draw(context);
  else if (now().scene?.photograph) faintPhotograph(context);
  context.restore();
  if (!isStageShown()) (drawToneError(context), masks(context));
  part(context);
  guides(context, overlay);
  if (overlay.lasso.length > 1) lasso(context, overlay.lasso);
}

/** Until the first drawing is there, the photograph stands in for it, faint. */
function faintPhotograph(context: Context): void {
  context.globalAlpha = 0.25;
  photograph(context);
  context.globalAlpha = 1;
}

function plot(context: Context, { view, bitmap }: Played): void {
  const ratio = camera.scale / view.scale;
  context.imageSmoothingEnabled = ratio !== 1;
  context.drawImage(bitmap, camera.x - view.x * ratio, camera.y - view.y * ratio, view.width * ratio, view.height * ratio);
}

function guides(context: Context, { guides }: Overlay): void {
  context.fillStyle = "#c44c1c";
  const line = Math.max(1, Math.round(camera.density));
  if (guides.x !== null) context.fillRect(camera.x + guides.x * camera.scale, 0, line, context.canvas.height);
  if (guides.y !== null) context.fillRect(0, camera.y + guides.y * camera.scale, context.canvas.width, line);
}

/** What is not in the part that is plotted is veiled. */
function part(context: Context): void {
  const { part } = now();
  if (!part) return;
  const { x, y, scale, page } = camera;
  const [left, top, width, height] = part.map((v) => v * scale) as [number, number, number, number];
  context.beginPath();
  context.rect(x, y, page[0] * scale, page[1] * scale);
  context.rect(x + left, y + top, width, height);
  context.fillStyle = "rgba(120, 110, 95, 0.35)";
  context.fill("evenodd");
  context.strokeStyle = "#c44c1c";
  context.lineWidth = 1.5 * camera.density;
  context.strokeRect(x + left, y + top, width, height);
}

function lasso(context: Context, points: [number, number][]): void {
  context.strokeStyle = "#c44c1c";
  context.lineWidth = 1.5 * camera.density;
  context.setLineDash([5, 4]);
  context.beginPath();
  points.forEach(([x, y], index) => (index === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
  context.setLineDash([]);
}
