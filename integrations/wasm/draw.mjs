// node draw.mjs MODULE.js PHOTO STYLE WIDTH OUT.svg
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [module, photo, style, width, out] = process.argv.slice(2);
const { draw } = (await import(pathToFileURL(module))).default;
const begun = performance.now();
writeFileSync(out, draw(readFileSync(photo), style, "", Number(width), 0));
console.error(`${style}: ${((performance.now() - begun) / 1000).toFixed(2)} s`);

// A photograph that is none must be an error in words, not a trap.
try {
  draw(new TextEncoder().encode("words"), style, "", Number(width), 0);
  process.exit(1);
} catch (error) {
  if (!/not in a known image format/.test(error.message)) throw error;
}
