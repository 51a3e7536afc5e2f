// The page tried in a real browser, as a person would use it: `node --test trial/`.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { command, folderWith, openPage, scene, shownInFull, startStudio } from "./studio.mjs";

const run = promisify(execFile);
const axe = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let studio, shown, page;

before(async () => {
  studio = await startStudio(await folderWith("astronaut.jpg"));
  shown = await openPage(studio.address);
  page = shown.page;
});

after(async () => {
  await shown?.browser.close();
  await studio?.end();
});

/// What axe-core finds that keeps people out.
async function barriers() {
  const found = await page.evaluate(async (source) => {
    if (!window.axe) (0, eval)(source);
    return (await window.axe.run()).violations.map(({ id, impact, nodes }) => ({ id, impact, at: nodes[0].html.slice(0, 120) }));
  }, axe);
  return found.filter(({ impact }) => ["serious", "critical"].includes(impact));
}

/// Drops a file on the page.
async function drop(name, kind, bytes) {
  await page.evaluate(
    ([name, kind, bytes]) => {
      const data = new DataTransfer();
      data.items.add(new File([Uint8Array.from(bytes)], name, { type: kind }));
      const event = new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true });
      document.querySelector(".stage").dispatchEvent(event);
    },
    [name, kind, [...bytes]],
  );
}

/// Waits until the scene fulfils a condition.
async function until(isTrue) {
  for (let tries = 0; tries < 200; tries++) {
    const state = await scene(page);
    if (isTrue(state)) return state;
    await page.waitForTimeout(50);
  }
  assert.fail(`the scene stays ${(await scene(page)).toml}`);
}

/// The file that the page exports beside the scene, and the one that its command makes.
async function exported(file) {
  const [stem, format] = file.split(".");
  await page.locator("canvas").first().focus();
  await page.keyboard.press("Control+e");
  await page.locator(".formats label", { hasText: format }).first().click();
  await page.getByLabel("Name").fill(stem);
  await page.getByText("Write beside the scene").click();
  await page.waitForSelector(".written");
  const words = (await page.locator(".written .command").innerText()).trim().split(" ");
  assert.equal(words[0], "drypoint");
  const path = join(studio.folder, words[words.indexOf("-o") + 1]);
  const bytes = await readFile(path);
  await rm(path);
  await run(command, [...words.slice(1), "-q"], { cwd: studio.folder });
  const made = await readFile(path);
  await page.keyboard.press("Escape");
  return { bytes, made };
}

test("a text file that is dropped is refused in words", async () => {
  await drop("note.txt", "text/plain", Buffer.from("this is no photograph"));
  await page.waitForSelector(".failure");
  assert.match(await page.locator(".failure").first().innerText(), /note\.txt/);
});

test("a photograph that is dropped is drawn", async () => {
  await drop("portrait.jpg", "image/jpeg", await readFile(join(studio.folder, "astronaut.jpg")));
  const state = await until(({ photograph }) => photograph?.name === "portrait.jpg");
  assert.equal(state.file, "portrait.toml");
  await page.evaluate(async () => {
    const token = new URLSearchParams(location.search).get("token");
    const changes = [{ path: ["size"], value: "40x40mm" }];
    await fetch(`/api/scene?token=${token}`, { method: "POST", body: JSON.stringify({ label: "size", changes }) });
  });
  await shownInFull(page);
  assert.deepEqual(await barriers(), []);
});

test("a slider changes the scene and the drawing, and is undone", async () => {
  const before = await scene(page);
  await page.locator(".right .slider").first().focus();
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowRight");
  await until(({ values }) => values.set?.pitch !== undefined);
  await shownInFull(page);
  const after = await scene(page);
  await page.locator("canvas").first().focus();
  await page.keyboard.press("Control+z");
  await until(({ toml }) => toml === before.toml);
  await page.keyboard.press("Control+Shift+z");
  await until(({ toml }) => toml === after.toml);
  await shownInFull(page);
});

test("a mask is painted and undone", async () => {
  await page.locator(".masks .mask-name", { hasText: "clothing" }).click();
  await page.locator("canvas").first().focus();
  await page.keyboard.press("b");
  const box = await page.locator("canvas").first().boundingBox();
  const [x, y] = [box.x + box.width / 2 - 150, box.y + box.height / 2 - 120];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 0; i < 12; i++) await page.mouse.move(x + 6 * i, y + 4 * i);
  await page.mouse.up();
  await until(({ values }) => values.sight === "portrait-sight");
  await shownInFull(page);
  assert.deepEqual(await barriers(), []);
  await page.locator("canvas").first().focus();
  await page.keyboard.press("Control+z");
  await until(({ values }) => values.sight === undefined);
  await page.keyboard.press("Control+Shift+z");
  await until(({ values }) => values.sight === "portrait-sight");
});

test("a region has a style of its own", async () => {
  await page.locator("#tab-regions").click();
  await page.getByLabel("Add a region for").selectOption("hair");
  await until(({ values }) => values.region?.length === 1);
  await page.locator(".region-body select").first().selectOption("charcoal");
  await until(({ values }) => values.region[0].style === "charcoal");
  await shownInFull(page);
  assert.deepEqual(await barriers(), []);
});

test("what is exported is what the copied command makes", async () => {
  for (const file of ["first.svg", "first.pdf", "first.json"]) {
    const { bytes, made } = await exported(file);
    assert.ok(bytes.length > 1000 && bytes.equals(made), `${file} differs`);
  }
});

test("recipes that are typed are exported as their command makes them", async () => {
  const styles = ["hedcut", "grid", "engrave", "charcoal", "glass"];
  const recipes = Number(process.env.DRYPOINT_RECIPES ?? 5);
  for (let i = 0; i < recipes; i++) {
    const toml = `photograph = "portrait.jpg"\nstyle = "${styles[i % 5]}"\nsize = "${20 + (7 * i) % 13}x30mm"\nseed = ${i}\ngamma = ${0.8 + 0.1 * (i % 5)}\nmirror = ${i % 2 === 0}\n\n[set]\npitch = ${0.6 + 0.05 * (i % 7)}\n`;
    await page.locator("#tab-scene").click();
    await page.locator("textarea").fill(toml);
    await page.locator("textarea").press("Control+Enter");
    await until((state) => state.toml === toml);
    await shownInFull(page);
    const { bytes, made } = await exported(`recipe.${["svg", "pdf"][i % 2]}`);
    assert.ok(bytes.equals(made), `recipe ${i} differs:\n${toml}`);
  }
});

test("the file that an editor changes is followed", async () => {
  const toml = 'photograph = "portrait.jpg"\nsize = "30x30mm"\nprofile = "grbl-servo"\n';
  await writeFile(join(studio.folder, "portrait.toml"), toml);
  await until((state) => state.toml === toml);
  await shownInFull(page);
});

test("the plot is played back", async () => {
  await page.getByText("Play back the plot").click();
  await page.waitForSelector(".time");
  const time = page.getByLabel("Time in the plot");
  await time.focus();
  await page.keyboard.press("End");
  const [done, all] = (await time.getAttribute("aria-valuetext")).match(/path (\d+) of (\d+)/).slice(1).map(Number);
  assert.ok(all > 10 && done === all, `${done} of ${all}`);
  assert.deepEqual(await barriers(), []);
});

test("nothing was asked of another computer, and no script failed", () => {
  assert.deepEqual(shown.strangers, []);
  assert.deepEqual(shown.faults, []);
});
