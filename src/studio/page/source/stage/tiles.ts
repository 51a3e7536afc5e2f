// Bitmaps of the drawing, painted by the worker. While the view zooms, the tiles of the old zoom are stretched; when it rests,
// tiles of the new zoom replace them. A new drawing replaces the old one only when all of it that is in sight is painted.

import type { FromWorker, ToWorker } from "../marks/messages.ts";
import { camera } from "./camera.ts";

const SIDE = 512;
/** How long the view must rest before tiles of its zoom are painted, in milliseconds. */
const REST = 130;
/** Tiles of one zoom that are kept; 1 MB each. */
const KEPT = 90;

type Tile = Extract<FromWorker, { kind: "tile" }>;

interface Level {
  scale: number;
  tiles: Map<string, { column: number; row: number; bitmap: ImageBitmap }>;
}

interface Sheets {
  id: string;
  page: [number, number];
  /** The whole sheet, coarse: what is seen until better is there. */
  overview: Level;
  previous: Level | null;
  current: Level;
}

function level(scale: number): Level {
  return { scale, tiles: new Map() };
}

function discard(old: Level | null): void {
  old?.tiles.forEach(({ bitmap }) => bitmap.close());
  old?.tiles.clear();
}

export class Tiles {
  private front: Sheets | null = null;
  private back: Sheets | null = null;
  private asked = "";

  constructor(
    private readonly post: (message: ToWorker) => void,
    private readonly redraw: () => void,
    private readonly swapped: (id: string) => void,
  ) {}

  show(id: string, page: [number, number]): void {
    if (this.back) this.drop(this.back);
    // Never quite the scale of the view, so that each tile belongs to one of the two.
    const scale = 0.6137 * Math.min(camera.fitScale(), 1600 / Math.max(...page));
    this.back = { id, page, overview: level(scale), previous: null, current: level(camera.scale) };
    this.update();
  }

  clear(): void {
    for (const sheets of [this.front, this.back]) if (sheets) this.drop(sheets);
    this.front = this.back = null;
  }

  private drop(sheets: Sheets): void {
    [sheets.overview, sheets.previous, sheets.current].forEach(discard);
    this.post({ kind: "forget", id: sheets.id });
  }

  receive(tile: Tile): void {
    const sheets = [this.front, this.back].find((one) => one?.id === tile.id);
    const place = sheets && [sheets.current, sheets.overview].find((one) => one.scale === tile.scale);
    if (!place) {
      tile.bitmap.close();
      return;
    }
    const key = `${tile.column},${tile.row}`;
    place.tiles.get(key)?.bitmap.close();
    place.tiles.set(key, tile);
    if (place.tiles.size > KEPT) this.thin(place);
    this.finish();
    this.redraw();
  }

  /** Forgets tiles out of sight, the oldest first. */
  private thin(place: Level): void {
    const seen = new Set(this.inSight(place.scale, camera.page, 1).map(String));
    for (const [key, tile] of place.tiles) {
      if (place.tiles.size <= KEPT) return;
      if (seen.has(key)) continue;
      tile.bitmap.close();
      place.tiles.delete(key);
    }
  }

  private finish(): void {
    const sheets = this.back ?? this.front;
    if (!sheets) return;
    const isComplete = this.inSight(sheets.current.scale, sheets.page, 0).every((at) => sheets.current.tiles.has(String(at)));
    if (!isComplete) return;
    discard(sheets.previous);
    sheets.previous = null;
    if (sheets === this.back) {
      if (this.front) this.drop(this.front);
      this.front = this.back;
      this.back = null;
      this.asked = "";
      this.swapped(sheets.id);
      this.update();
    }
  }

  /** The tiles of a zoom that the pane shows, from the middle outwards, with a border of `more` tiles. */
  private inSight(scale: number, page: [number, number], more: number): [number, number][] {
    const ratio = scale / camera.scale;
    const range = (offset: number, room: number, length: number): [number, number] => [
      Math.max(0, Math.floor((-offset * ratio) / SIDE) - more),
      Math.min(Math.ceil((length * scale) / SIDE) - 1, Math.floor(((room - offset) * ratio) / SIDE) + more),
    ];
    const [left, right] = range(camera.x, camera.width, page[0]);
    const [top, bottom] = range(camera.y, camera.height, page[1]);
    const found: [number, number][] = [];
    for (let row = top; row <= bottom; row++) for (let column = left; column <= right; column++) found.push([column, row]);
    const [x, y] = [(left + right) / 2, (top + bottom) / 2];
    return found.sort((a, b) => Math.hypot(a[0] - x, a[1] - y) - Math.hypot(b[0] - x, b[1] - y));
  }

  /** Asks for what is missing; called whenever the view has moved. Returns whether it wants to be called again soon. */
  update(): boolean {
    const sheets = this.back ?? this.front;
    if (!sheets) return false;
    const isResting = performance.now() - camera.movedAt > REST;
    if (sheets.current.scale !== camera.scale && (isResting || sheets === this.back)) {
      if (sheets.previous && sheets.current.tiles.size === 0) discard(sheets.current);
      else (discard(sheets.previous), (sheets.previous = sheets.current));
      sheets.current = level(camera.scale);
    }
    if (sheets.current.scale === camera.scale) this.ask(sheets);
    return sheets.current.scale !== camera.scale;
  }

  private ask(sheets: Sheets): void {
    const missing = this.inSight(camera.scale, sheets.page, 1).filter((at) => !sheets.current.tiles.has(String(at)));
    const seen = new Set(this.inSight(camera.scale, sheets.page, 0).map(String));
    const tiles = [...missing.filter((at) => seen.has(String(at))), ...missing.filter((at) => !seen.has(String(at)))];
    const isFirst = tiles.some((at) => seen.has(String(at)));
    const scale = isFirst || tiles.length > 0 ? camera.scale : sheets.overview.scale;
    const wanted = tiles.length > 0 ? tiles : this.missingOverview(sheets);
    const asked = `${sheets.id} ${scale} ${wanted.join(" ")}`;
    if (asked === this.asked || wanted.length === 0) return;
    this.asked = asked;
    this.post({ kind: "tiles", id: sheets.id, scale, tiles: wanted });
  }

  private missingOverview({ overview, page }: Sheets): [number, number][] {
    const missing: [number, number][] = [];
    for (let row = 0; row * SIDE < page[1] * overview.scale; row++) {
      for (let column = 0; column * SIDE < page[0] * overview.scale; column++) {
        if (!overview.tiles.has(`${column},${row}`)) missing.push([column, row]);
      }
    }
    return missing;
  }

  /** Whether there is a drawing to see. */
  hasDrawing(): boolean {
    return this.front !== null;
  }

  draw(context: CanvasRenderingContext2D): void {
    const sheets = this.front;
    if (!sheets) return;
    const isSharp = sheets.current.scale === camera.scale && this.inSight(camera.scale, sheets.page, 0).every((at) => sheets.current.tiles.has(String(at)));
    context.imageSmoothingQuality = "low";
    if (!isSharp) {
      drawLevel(context, sheets.overview);
      if (sheets.previous) drawLevel(context, sheets.previous);
    }
    drawLevel(context, sheets.current);
  }
}

function drawLevel(context: CanvasRenderingContext2D, { scale, tiles }: Level): void {
  const size = (SIDE * camera.scale) / scale;
  context.imageSmoothingEnabled = scale !== camera.scale;
  for (const { column, row, bitmap } of tiles.values()) {
    // Edges on whole pixels, so that no seam shines through.
    const [left, top] = [Math.round(camera.x + column * size), Math.round(camera.y + row * size)];
    const [right, bottom] = [Math.round(camera.x + (column + 1) * size), Math.round(camera.y + (row + 1) * size)];
    if (right <= 0 || bottom <= 0 || left >= camera.width || top >= camera.height) continue;
    context.drawImage(bitmap, left, top, right - left, bottom - top);
  }
}
