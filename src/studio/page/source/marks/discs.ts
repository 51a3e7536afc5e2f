// Small dots are set pixel by pixel: a canvas path of 100,000 arcs takes a second without a GPU, this takes milliseconds.

import type { Run } from "./pack.ts";

export function rgb(color: string): [number, number, number] {
  const hex = color.replace("#", "");
  const full = hex.length === 3 ? [...hex].map((digit) => digit + digit).join("") : hex;
  const number = Number.parseInt(full.slice(0, 6), 16);
  return Number.isNaN(number) ? [0, 0, 0] : [(number >> 16) & 255, (number >> 8) & 255, number & 255];
}

/** Adds the coverage of dots to `coverage` (side x side); the tile begins at (left, top) in pixels of this scale. */
export function cover(coverage: Float32Array, side: number, run: Run, members: Uint32Array, scale: number, left: number, top: number): void {
  const { numbers } = run;
  for (const member of members) {
    const x = numbers[3 * member]! * scale - left;
    const y = numbers[3 * member + 1]! * scale - top;
    const radius = numbers[3 * member + 2]! * scale;
    const reach = radius + 0.75;
    const [x0, x1] = [Math.max(0, Math.floor(x - reach)), Math.min(side - 1, Math.ceil(x + reach))];
    const [y0, y1] = [Math.max(0, Math.floor(y - reach)), Math.min(side - 1, Math.ceil(y + reach))];
    // A dot smaller than a pixel keeps its ink: its disc is widened to a pixel and made as much lighter.
    const drawn = Math.max(radius, 0.55);
    const strength = (radius / drawn) ** 2;
    for (let row = y0; row <= y1; row++) {
      const dy = row + 0.5 - y;
      for (let column = x0; column <= x1; column++) {
        const dx = column + 0.5 - x;
        const share = drawn + 0.5 - Math.sqrt(dx * dx + dy * dy);
        if (share <= 0) continue;
        const at = row * side + column;
        coverage[at] = 1 - (1 - coverage[at]!) * (1 - strength * Math.min(1, share));
      }
    }
  }
}

export function colorPixels(pixels: Uint8ClampedArray, coverage: Float32Array, color: string): void {
  const [red, green, blue] = rgb(color);
  for (let at = 0; at < coverage.length; at++) {
    pixels[4 * at] = red;
    pixels[4 * at + 1] = green;
    pixels[4 * at + 2] = blue;
    pixels[4 * at + 3] = 255 * coverage[at]!;
  }
}
