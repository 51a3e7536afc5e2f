// The stage that is shown large: its picture, and where it lies on the sheet.

import { get, address } from "../server/requests.ts";
import type { StageList } from "../server/shapes.ts";
import { attemptQuietly } from "../model/scene.ts";
import { now, set, type Film } from "../model/store.ts";
import { camera } from "./camera.ts";
import { photographToSheet } from "./photograph.ts";
import { pictureBox } from "./placing.ts";

/** Stages that show the whole photograph, whatever part of it is drawn. */
const WHOLE = ["subject", "skin", "hair", "facial hair", "headwear", "clothing", "detail", "faces", "depth"];

let redraw: () => void = () => {};
let picture: { file: string; image: HTMLImageElement } | null = null;

export function whenFilmChanges(act: () => void): void {
  redraw = act;
}

export function changeFilm(change: Partial<Film>): void {
  set({ film: { ...now().film, ...change } });
  redraw();
}

export function stageAddress(file: string, revision: number): string {
  return address(`/api/stage/${file}`, { revision });
}

/** Has the stages made, unless those of the present scene are there. */
export async function fetchStages(): Promise<void> {
  const { film, scene } = now();
  if (film.isBusy || !scene?.photograph || film.revision === scene.revision) return;
  changeFilm({ isBusy: true, fault: null });
  const { value, fault } = await attemptQuietly(() => get<StageList>("/api/stages"));
  if (!value) return changeFilm({ isBusy: false, fault });
  const { chosen } = now().film;
  const isThere = value.stages.some((stage) => stage.file === chosen);
  picture = null;
  changeFilm({ isBusy: false, stages: value.stages, revision: value.revision, chosen: isThere ? chosen : null });
  if (isThere && chosen) chooseStage(chosen);
}

/** Shows a stage over the sheet; null shows the drawing again. */
export function chooseStage(file: string | null): void {
  changeFilm({ chosen: file });
  if (!file) return;
  const image = new Image();
  image.onload = () => {
    picture = { file, image };
    redraw();
  };
  image.src = stageAddress(file, now().film.revision);
}

let toneError: { file: string; revision: number; image: HTMLImageElement } | null = null;

export function toggleToneError(): void {
  set({ tone: { ...now().tone, isOn: !now().tone.isOn } });
  if (now().tone.isOn) void fetchToneError();
  redraw();
}

/** The error is that of the full drawing, so all its stages are made: that takes its time. */
export async function fetchToneError(): Promise<void> {
  const { tone, scene } = now();
  if (tone.isBusy || !scene?.photograph || tone.revision === scene.revision) return;
  set({ tone: { ...tone, isBusy: true, fault: null } });
  const { value, fault } = await attemptQuietly(() => get<StageList>("/api/stages?quality=full"));
  const file = value?.stages.findLast((stage) => stage.name === "tone error")?.file ?? null;
  set({ tone: { ...now().tone, isBusy: false, fault, file, revision: value?.revision ?? -1 } });
  redraw();
}

/** Lays the error of tone over the drawing; its picture is fetched when it is first wanted. */
export function drawToneError(context: CanvasRenderingContext2D): void {
  const { isOn, file, revision } = now().tone;
  if (!isOn || !file) return;
  if (toneError?.file !== file || toneError.revision !== revision) {
    toneError = { file, revision, image: new Image() };
    toneError.image.onload = redraw;
    toneError.image.src = address(`/api/stage/${file}`, { quality: "full", revision });
  }
  if (!toneError.image.complete || toneError.image.naturalWidth === 0) return;
  context.save();
  context.translate(camera.x, camera.y);
  context.scale(camera.scale, camera.scale);
  context.imageSmoothingEnabled = true;
  drawInBox(context, toneError.image);
  context.restore();
}

export function isStageShown(): boolean {
  const { film } = now();
  return film.isOpen && film.chosen !== null && picture?.file === film.chosen;
}

/** Draws the chosen stage where it belongs. */
export function drawStage(context: CanvasRenderingContext2D): void {
  const { film } = now();
  const stage = film.stages.findIndex((one) => one.file === film.chosen);
  if (!picture || stage < 0) return;
  const { image } = picture;
  const { name, file } = film.stages[stage]!;
  // The first stages are what was seen in the photograph; a style may have stages of the same names later.
  const isSeen = WHOLE.includes(name) && film.stages.slice(0, stage).every((one) => WHOLE.includes(one.name));
  context.save();
  context.translate(camera.x, camera.y);
  context.scale(camera.scale, camera.scale);
  // Grids are shown as they are, pixel by pixel, where they are enlarged.
  context.imageSmoothingEnabled = file.endsWith(".svg");
  if (file.endsWith(".svg")) context.drawImage(image, 0, 0, ...camera.page);
  else if (isSeen) {
    const { pixels, affine } = photographToSheet(camera.page);
    context.transform(...affine);
    context.drawImage(image, 0, 0, ...pixels);
  } else drawInBox(context, image);
  context.restore();
}

/** In the picture's box, turned as the picture is turned. A stage of a part keeps its own proportions. */
export function drawInBox(context: CanvasRenderingContext2D, image: HTMLImageElement): void {
  const [x, y, width, height] = pictureBox();
  const { affine } = photographToSheet(camera.page);
  const quarters = Math.round((2 * Math.atan2(-affine[2], affine[3])) / Math.PI);
  const [across, down] = quarters % 2 === 0 ? [width, height] : [height, width];
  const [imageWidth, imageHeight] = [image.naturalWidth, image.naturalHeight];
  const isWhole = Math.abs((imageWidth * down) / (imageHeight * across) - 1) < 0.03;
  const scale = Math.min(across / imageWidth, down / imageHeight);
  const size = isWhole ? [across, down] : [imageWidth * scale, imageHeight * scale];
  context.translate(x + width / 2, y + height / 2);
  context.rotate((quarters * Math.PI) / 2);
  context.drawImage(image, -size[0]! / 2, -size[1]! / 2, size[0]!, size[1]!);
}
