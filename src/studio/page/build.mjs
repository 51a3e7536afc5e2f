// Writes built/: what the binary embeds. The same source and lock file give the same bytes, so that the gate can compare them.
import { build } from "esbuild";
import { mkdir, readFile, rm, writeFile } from "node:fs/promises";

await rm("built", { recursive: true, force: true });
await mkdir("built");

const common = {
  bundle: true,
  minify: true,
  charset: "utf8",
  legalComments: "none",
  target: ["es2022", "chrome110", "firefox115", "safari16.4"],
  format: "esm",
  jsx: "automatic",
  jsxImportSource: "preact",
  logLevel: "warning",
};

await build({ ...common, entryPoints: ["source/main.tsx"], outfile: "built/studio.js" });
await build({ ...common, entryPoints: ["source/worker.ts"], outfile: "built/worker.js" });
await build({ ...common, entryPoints: ["source/studio.css"], outfile: "built/studio.css" });
// Line breaks between tags show nothing: the page puts all that is shown into one element.
const page = await readFile("source/index.html", "utf8");
await writeFile("built/index.html", page.replace(/>\s*\n\s*</g, "><"));
