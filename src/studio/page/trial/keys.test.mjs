// The three tasks of docs/studio.md by keyboard alone: no mouse is moved here. `node --test trial/`.
import assert from "node:assert/strict";
import { readFile, rename, stat } from "node:fs/promises";
import { join } from "node:path";
import { afterEach, beforeEach, test } from "node:test";
import { folderWith, openPage, scene, sceneThat, shownInFull, startStudio } from "./studio.mjs";

let studio, shown, page;

beforeEach(async () => {
  const folder = await folderWith("astronaut.jpg");
  await rename(join(folder, "astronaut.jpg"), join(folder, "portrait.jpg"));
  studio = await startStudio(folder, "portrait.jpg");
  shown = await openPage(studio.address);
  page = shown.page;
  await page.waitForFunction(() => document.querySelector("[data-shown]"), null, { timeout: 60_000 });
});

afterEach(async () => {
  assert.deepEqual([shown?.strangers, shown?.faults], [[], []]);
  await shown?.browser.close();
  await studio?.end();
});

/// Presses Tab until what has the focus is called so; a text field if it is to be typed in.
async function tabTo(name, kind = "") {
  for (let i = 0; i < 250; i++) {
    await page.keyboard.press("Tab");
    const [found, type] = await page.evaluate(() => {
      const it = document.activeElement;
      const words = it?.getAttribute("aria-label") ?? it?.labels?.[0]?.innerText ?? it?.innerText ?? "";
      return [words.trim(), it?.getAttribute("type") ?? it?.tagName.toLowerCase() ?? ""];
    });
    if ((found === name || (name.endsWith("…") && found.startsWith(name.slice(0, -1)))) && (!kind || type === kind)) return;
  }
  assert.fail(`no Tab leads to ${name}`);
}

async function typed(name, text) {
  await tabTo(name, "text");
  await page.keyboard.press("Control+a");
  await page.keyboard.type(text);
  await page.keyboard.press("Enter");
}

async function opened(name) {
  await tabTo(name);
  await page.keyboard.press("Enter");
}

/// Chooses in the list that has the focus, by its letters.
async function picked(name, letters) {
  await tabTo(name, "select");
  await page.keyboard.type(letters);
}

const until = (isTrue) => sceneThat(page, isTrue);

/// Exports with the dialog's own keys; returns the bytes written.
async function exported(format) {
  await page.keyboard.press("Escape");
  await page.keyboard.press("Control+e");
  await page.waitForSelector("dialog");
  await tabTo("svg…");
  for (let i = 0; i < ["svg", "pdf", "json", "hpgl", "gcode"].indexOf(format); i++) await page.keyboard.press("ArrowRight");
  await tabTo("Write beside the scene");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".written", { timeout: 120_000 });
  return (await stat(join(studio.folder, `portrait.${format}`))).size;
}

test("a hedcut of 38 x 50 mm", async () => {
  await opened("Sheet");
  await typed("size of the picture", "38x50mm");
  await picked("fit", "cover");
  await until(({ values }) => values.size === "38x50mm" && values.fit === "cover");
  await typed("pitch", "0.5");
  await opened("Picture");
  await typed("crop", "head");
  await until(({ values }) => values.crop === "head" && Number.parseFloat(values.set?.pitch) === 0.5);
  await shownInFull(page);
  assert.ok((await exported("pdf")) > 50_000);
});

test("a plot with two pens", async () => {
  await opened("Sheet");
  await picked("page", "a5");
  await typed("size of the picture", "40x40mm");
  await picked("machine", "grbl-servo");
  await until(({ values }) => values.profile === "grbl-servo" && values.page === "a5");
  await opened("Regions");
  await tabTo("Add a region for", "select");
  await page.keyboard.type("clothing");
  await page.keyboard.press("Enter");
  await until(({ values }) => values.region?.[0]?.mask === "clothing");
  await picked("style", "engrave");
  await typed("pen", "2");
  await until(({ values }) => values.region[0].style === "engrave" && values.region[0].pen === 2);
  await shownInFull(page);
  await opened("Sheet");
  await tabTo("Plan the plot");
  await page.keyboard.press("Enter");
  await page.waitForSelector("table", { timeout: 120_000 });
  assert.match(await page.locator("table").first().innerText(), /\n2\s/);
  assert.ok((await exported("gcode")) > 20_000);
});

/// Presses Enter until the mask, which is fetched first, is painted.
async function painting() {
  for (let tries = 0; tries < 20; tries++) {
    await page.keyboard.press("Enter");
    await page.waitForTimeout(1000);
    if ((await scene(page)).values.sight === "portrait-sight") return;
  }
  assert.fail("nothing is painted");
}

test("a wrong mask of hair", async () => {
  await shownInFull(page);
  await tabTo("hair");
  await page.keyboard.press("Enter");
  for (let i = 0; i < 12 && !(await page.evaluate(() => document.activeElement?.tagName === "CANVAS")); i++) {
    await page.keyboard.press("F6");
  }
  await page.keyboard.press("b");
  for (const key of ["ArrowUp", "ArrowUp"]) await page.keyboard.press(key);
  await painting();
  const painted = await readFile(join(studio.folder, "portrait-sight", "hair.png"));
  for (let tries = 0; tries < 20 && (await scene(page)).values.sight; tries++) {
    await page.keyboard.press("Control+z");
    await page.waitForTimeout(500);
  }
  assert.equal((await scene(page)).values.sight, undefined);
  await page.keyboard.press("e");
  await painting();
  const erased = await readFile(join(studio.folder, "portrait-sight", "hair.png"));
  assert.ok(!painted.equals(erased));
  await shownInFull(page);
  assert.ok((await exported("svg")) > 100_000);
});
