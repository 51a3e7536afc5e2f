// Where the sheet lies on the screen. Lengths here are pixels of the device, so that marks are sharp on every screen.

import { set } from "../model/store.ts";

const [LEAST, MOST] = [0.05, 400];
const BORDER = 36;

function calibration(): number {
  const kept = Number(localStorage.getItem("drypoint-pixels-per-mm"));
  return kept > 0.5 && kept < 40 ? kept : 96 / 25.4;
}

class Camera {
  scale = 4;
  x = 0;
  y = 0;
  /** The pane that shows the sheet; side by side there are two of this size. */
  width = 800;
  height = 600;
  density = 1;
  isFitted = true;
  movedAt = 0;
  page: [number, number] = [90, 120];
  private moved: () => void = () => {};

  whenMoved(act: () => void): void {
    this.moved = act;
  }

  private tell(): void {
    this.movedAt = performance.now();
    set({ zoom: this.scale / this.density / calibration() });
    this.moved();
  }

  resize(width: number, height: number, density: number): void {
    const [dx, dy] = [(width - this.width) / 2, (height - this.height) / 2];
    Object.assign(this, { width, height, density });
    if (this.isFitted) this.fit();
    else this.pan(dx, dy);
  }

  showPage(page: [number, number]): void {
    const isNew = page[0] !== this.page[0] || page[1] !== this.page[1];
    this.page = page;
    if (isNew && this.isFitted) this.fit();
  }

  fitScale(): number {
    const border = BORDER * this.density * 2;
    const room = [Math.max(50, this.width - border), Math.max(50, this.height - border)] as const;
    return Math.min(room[0] / this.page[0], room[1] / this.page[1]);
  }

  fit(): void {
    this.scale = this.fitScale();
    this.x = Math.round((this.width - this.page[0] * this.scale) / 2);
    this.y = Math.round((this.height - this.page[1] * this.scale) / 2);
    this.isFitted = true;
    this.tell();
  }

  printSize(): void {
    this.zoomTo(calibration() * this.density);
  }

  pan(dx: number, dy: number): void {
    this.x = Math.round(this.x + dx);
    this.y = Math.round(this.y + dy);
    this.keepInSight();
    this.isFitted = false;
    this.tell();
  }

  /** Zooms about a point of the pane; by default its middle. */
  zoom(factor: number, x = this.width / 2, y = this.height / 2): void {
    const scale = Math.min(MOST * this.density, Math.max(LEAST * this.density, this.scale * factor));
    const change = scale / this.scale;
    this.scale = scale;
    this.x = Math.round(x - (x - this.x) * change);
    this.y = Math.round(y - (y - this.y) * change);
    this.isFitted = false;
    this.tell();
  }

  zoomTo(scale: number): void {
    this.zoom(scale / this.scale);
  }

  private keepInSight(): void {
    const rest = 48 * this.density;
    this.x = Math.min(this.width - rest, Math.max(rest - this.page[0] * this.scale, this.x));
    this.y = Math.min(this.height - rest, Math.max(rest - this.page[1] * this.scale, this.y));
  }

  toSheet(x: number, y: number): [number, number] {
    return [(x - this.x) / this.scale, (y - this.y) / this.scale];
  }

  calibrate(pixelsPerMm: number): void {
    localStorage.setItem("drypoint-pixels-per-mm", String(pixelsPerMm));
    this.tell();
  }

  pixelsPerMm(): number {
    return calibration();
  }
}

export const camera = new Camera();
