// The three tasks of docs/studio.md, done by mouse as someone new would, timed and photographed:
// `node trial/tour.mjs FOLDER` writes its pictures there and says how long each task took.
import { mkdir, readFile, rename, stat } from "node:fs/promises";
import { join } from "node:path";
import { folderWith, openPage, scene, shownInFull, startStudio } from "./studio.mjs";

const folder = process.argv[2] ?? "tour";
await mkdir(folder, { recursive: true });
/// What a person takes to find and press something, in milliseconds.
const HAND = 1000;

/// A studio with a page of a fresh portrait, and the time since it was asked for.
async function begin(file = "portrait.jpg") {
  const place = await folderWith("astronaut.jpg");
  await rename(join(place, "astronaut.jpg"), join(place, "portrait.jpg"));
  const begun = performance.now();
  const studio = await startStudio(place, file);
  const { browser, page } = await openPage(studio.address);
  const end = async () => {
    await browser.close();
    await studio.end();
  };
  return { page, place, end, seconds: () => Math.round((performance.now() - begun) / 1000) };
}

const shoot = (page, name) => page.screenshot({ path: join(folder, `${name}.jpg`), type: "jpeg", quality: 80 });

async function press(page, locator) {
  await page.waitForTimeout(HAND);
  await locator.click();
}

async function write(page, label, text) {
  await page.waitForTimeout(HAND);
  await page.getByLabel(label, { exact: true }).and(page.locator("[type=text]")).first().fill(text);
  await page.keyboard.press("Enter");
}

async function choose(page, label, value) {
  await page.waitForTimeout(HAND);
  await page.getByLabel(label, { exact: true }).first().selectOption(value);
}

/// Waits until the change has been taken and is drawn in full.
async function drawn(page) {
  await page.waitForTimeout(400);
  await shownInFull(page);
}

async function focusDrawing(page) {
  await page.locator("canvas").first().focus();
}

/// The shots of the page itself: what is dropped, a slider, playback by keys.
async function firstSteps() {
  const { page, place, end } = await begin(null);
  const bytes = [...(await readFile(join(place, "portrait.jpg")))];
  await page.evaluate((bytes) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(bytes)], "dropped.jpg", { type: "image/jpeg" }));
    document.querySelector(".stage").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, bytes);
  await page.waitForFunction(() => document.querySelector("[data-shown]")?.dataset.shown === "Coarse", null, { timeout: 60_000 });
  await page.waitForTimeout(200);
  await shoot(page, "dropped");
  await drawn(page);
  await shoot(page, "page");
  await page.locator(".right .slider").first().focus();
  for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("[data-shown]")?.dataset.shown === "Coarse", null, { timeout: 60_000 });
  await shoot(page, "slider");
  await drawn(page);
  await focusDrawing(page);
  await page.keyboard.press("Control+z");
  await drawn(page);
  await shoot(page, "undone");
  await end();
}

async function hedcut() {
  const { page, place, end, seconds } = await begin();
  await drawn(page);
  await press(page, page.locator("#tab-sheet"));
  await write(page, "size of the picture", "38x50mm");
  await choose(page, "fit", "cover");
  await press(page, page.locator(".right summary", { hasText: "Picture" }).first());
  await write(page, "crop", "head");
  await write(page, "pitch", "0.35");
  await drawn(page);
  await shoot(page, "head");
  await focusDrawing(page);
  await page.keyboard.press("1");
  await page.waitForTimeout(HAND);
  await page.keyboard.press("0");
  await press(page, page.getByRole("button", { name: "Export", exact: true }));
  await press(page, page.locator(".formats label", { hasText: "pdf" }).first());
  await press(page, page.getByText("Write beside the scene"));
  await page.waitForSelector(".written");
  await shoot(page, "export");
  console.log(`a hedcut of 38 x 50 mm: ${seconds()} s; portrait.pdf has ${(await stat(join(place, "portrait.pdf"))).size} bytes`);
  await end();
}

async function plan(page) {
  await press(page, page.getByRole("button", { name: "Plan the plot" }));
  await page.getByText("Planning…").waitFor({ timeout: 5000 }).catch(() => {});
  await page.getByRole("button", { name: "Plan the plot" }).waitFor({ timeout: 120_000 });
}

async function plot() {
  const { page, end, seconds } = await begin();
  await drawn(page);
  await press(page, page.locator("#tab-sheet"));
  await choose(page, "page", "a4");
  await write(page, "size of the picture", "80x80mm");
  await choose(page, "machine", "grbl-servo");
  await press(page, page.locator("#tab-regions"));
  await choose(page, "Add a region for", "clothing");
  await page.waitForTimeout(HAND);
  await page.locator(".region-body select").first().selectOption("engrave");
  await page.waitForTimeout(HAND);
  for (const [label, text] of [["pen", "2"], ["ink", "#b03a20"]]) {
    await page.locator(".region-body").getByLabel(label, { exact: true }).first().fill(text);
    await page.keyboard.press("Enter");
    await page.waitForTimeout(HAND);
  }
  await drawn(page);
  await shoot(page, "region");
  await press(page, page.locator("#tab-sheet"));
  await plan(page);
  const first = await page.locator(".pens, table").first().innerText();
  await write(page, "pitch", "0.45");
  await drawn(page);
  await plan(page);
  await page.locator("table").first().scrollIntoViewIfNeeded();
  await shoot(page, "plan");
  const second = await page.locator("table").first().innerText();
  const time = page.getByLabel("Time in the plot");
  if ((await time.count()) === 0) await press(page, page.getByText("Play back the plot"));
  await time.focus();
  await time.fill(String(0.42 * Number(await time.getAttribute("max"))));
  await page.waitForTimeout(500);
  await shoot(page, "playback");
  await press(page, page.getByRole("button", { name: "Export", exact: true }));
  await press(page, page.locator(".formats label", { hasText: "gcode" }).first());
  await press(page, page.getByText("Write beside the scene"));
  await page.waitForSelector(".written", { timeout: 120_000 });
  await shoot(page, "gcode");
  console.log(`a plot with two pens: ${seconds()} s\n${first}\n--- pitch 0.45\n${second}`);
  await end();
}

async function drag(page, [x, y], steps, [dx, dy]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= steps; i++) await page.mouse.move(x + dx * i, y + dy * i, { steps: 2 });
  await page.mouse.up();
}

async function mask() {
  const { page, place, end, seconds } = await begin();
  await drawn(page);
  await press(page, page.locator(".masks .mask-name", { hasText: "hair" }).first());
  await focusDrawing(page);
  await page.keyboard.press("d");
  await page.waitForTimeout(HAND);
  await page.keyboard.press("b");
  for (let i = 0; i < 3; i++) await page.keyboard.press("[");
  const { x, y, width, height } = await page.locator("canvas").first().boundingBox();
  const at = (dx, dy) => [x + width / 2 + dx, y + height / 2 + dy];
  await drag(page, at(-40, -195), 10, [7, -1]);
  await shoot(page, "brush");
  await page.waitForTimeout(500);
  await drawn(page);
  await page.keyboard.press("w");
  await page.waitForTimeout(HAND);
  await shoot(page, "corrected");
  await page.keyboard.press("Control+z");
  await drawn(page);
  await page.keyboard.press("e");
  await drag(page, at(-40, -225), 6, [7, 0]);
  await page.waitForTimeout(500);
  await drawn(page);
  await press(page, page.getByRole("button", { name: "Export", exact: true }));
  await press(page, page.getByText("Write beside the scene"));
  await page.waitForSelector(".written", { timeout: 120_000 });
  const { values } = await scene(page);
  console.log(`a wrong mask of hair: ${seconds()} s; the scene names ${values.sight}, ${(await stat(join(place, "portrait-sight", "hair.png"))).size} bytes`);
  await page.keyboard.press("Escape");
  await press(page, page.locator(".masks .mask-name", { hasText: "directions" }).first());
  await focusDrawing(page);
  await page.keyboard.press("n");
  await drag(page, at(-150, 60), 12, [6, 10]);
  await drag(page, at(60, 40), 12, [8, 9]);
  await page.keyboard.press("Escape");
  await page.waitForTimeout(700);
  await drawn(page);
  await shoot(page, "directions");
  await end();
}

for (const task of [firstSteps, hedcut, plot, mask]) await task();
