// The page tried in a real browser, as a person would use it: `node --test trial/`.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile, rm, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { startMachine } from "./machine.mjs";
import { command, folderWith, openPage, scene, sceneThat, shownInFull, startStudio } from "./studio.mjs";

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

const until = (isTrue) => sceneThat(page, isTrue);

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

test("without a scene nothing fails", async () => {
  await page.waitForLoadState("networkidle");
  assert.equal(await page.locator(".failure").count(), 0);
});

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

test("the stages between photograph and drawing are shown and explained", async () => {
  await page.locator("canvas").first().focus();
  await page.keyboard.press("i");
  await page.waitForSelector(".frame", { timeout: 120_000 });
  await page.locator(".frame", { hasText: "seeds" }).first().click();
  await page.waitForSelector("[data-shown='Stage: seeds']");
  assert.match(await page.locator(".film-text").innerText(), /row by row/);
  assert.deepEqual(await barriers(), []);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Enter");
  await page.waitForSelector("[data-shown='Stage: offset lines']");
  await page.keyboard.press("i");
  await page.waitForSelector("[data-shown='Full']");
  await page.keyboard.press("o");
  await page.waitForFunction(() => /too dark|no picture/.test(document.querySelector(".tone-legend")?.textContent ?? ""), null, { timeout: 120_000 });
  assert.deepEqual(await barriers(), []);
  await page.keyboard.press("o");
  assert.equal(await page.locator(".frame").count(), 0);
});

test("presets are shown as pictures of this portrait, and one is taken", async () => {
  await page.locator("canvas").first().focus();
  await page.keyboard.press("y");
  const first = page.locator(".preset-picture").first();
  await first.locator("img").waitFor({ timeout: 120_000 });
  assert.deepEqual(await barriers(), []);
  const before = await scene(page);
  await first.press("Enter");
  await until(({ values }) => values.style === "engrave");
  await page.keyboard.press("y");
  await page.keyboard.press("Control+z");
  await until(({ toml }) => toml === before.toml);
  await shownInFull(page);
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

test("an edge is drawn and undone", async () => {
  await page.locator("canvas").first().focus();
  await page.keyboard.press("n");
  const { x, y, width, height } = await page.locator("canvas").first().boundingBox();
  await page.mouse.move(x + width / 2 - 60, y + height / 2);
  await page.mouse.down();
  for (let i = 1; i <= 12; i++) await page.mouse.move(x + width / 2 - 60 + 10 * i, y + height / 2 + 2 * i);
  await page.mouse.up();
  await page.keyboard.press("Escape");
  await until(({ values }) => values.mask?.edges === "portrait-edges.png");
  await shownInFull(page);
  assert.deepEqual(await barriers(), []);
  await page.locator("canvas").first().focus();
  await page.keyboard.press("Control+z");
  await until(({ values }) => values.mask === undefined);
  await page.keyboard.press("v");
  await shownInFull(page);
});

test("letters typed in a list choose there and do nothing else", async () => {
  await page.locator("#tab-regions").click();
  const before = await scene(page);
  await page.getByLabel("Add a region for").focus();
  for (const key of ["b", "i", "y", "m", "x", "g", "r", "n"]) await page.keyboard.press(key);
  assert.equal(await page.locator("dialog, .film, .preset-pictures").count(), 0);
  assert.equal(await page.locator(".tool-hand").count(), 1);
  assert.equal((await scene(page)).toml, before.toml);
  assert.match(await page.locator(".top").innerText(), /Keep as B/);
  await page.keyboard.press("Tab");
});

test("a mask that is not there yet is not painted over", async () => {
  const other = await startStudio(await folderWith("astronaut.jpg"), "astronaut.jpg");
  const early = await openPage(other.address);
  try {
    const painted = early.page;
    // The page is kept from hearing what masks there are, as long as it is painted on.
    let isHeld = true;
    await painted.route("**/api/masks", async (route) => {
      while (isHeld) await new Promise((resolve) => setTimeout(resolve, 20));
      await route.continue();
    });
    await painted.reload();
    const canvas = painted.locator("canvas").first();
    await canvas.focus();
    await painted.keyboard.press("b");
    const { x, y, width, height } = await canvas.boundingBox();
    await painted.mouse.move(x + width / 2, y + height / 2);
    await painted.mouse.down();
    await painted.mouse.move(x + width / 2 + 40, y + height / 2 + 20);
    await painted.mouse.up();
    await painted.keyboard.press("Enter");
    await painted.getByText("The mask is not there yet").waitFor();
    isHeld = false;
    await painted.waitForSelector(".masks .mask-name");
    await shownInFull(painted);
    const { toml, undo } = await scene(painted);
    assert.deepEqual([toml, undo], ['photograph = "astronaut.jpg"\n', 0]);
    assert.deepEqual(early.faults, []);
  } finally {
    await early.browser.close();
    await other.end();
  }
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
    assert.equal((await scene(page)).command, `drypoint draw portrait.toml -o ${file}`);
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

test("a part of the sheet is chosen and sent to a machine, paused, stopped and finished", async () => {
  const machine = await startMachine();
  try {
    await page.locator("canvas").first().focus();
    await page.keyboard.press("0");
    await page.keyboard.press("r");
    const { x, y, width, height } = await page.locator("canvas").first().boundingBox();
    await page.mouse.move(x + width / 2 - 60, y + height / 2 - 60);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 60, y + height / 2 + 60);
    await page.mouse.up();
    await page.keyboard.press("m");
    await page.getByLabel("Port").fill(machine.port);
    await page.waitForFunction(() => document.querySelector(".send .command")?.textContent.includes("--region="));
    assert.deepEqual(await barriers(), []);
    assert.equal(machine.lines.length, 0);
    await page.getByRole("button", { name: "Draw this part" }).click();
    await page.getByRole("button", { name: "Pause", exact: true }).click();
    await page.locator(".send strong", { hasText: "Paused with the pen up" }).waitFor();
    assert.deepEqual(await barriers(), []);
    // Another page that is opened meanwhile is told, too.
    await page.reload();
    await page.locator(".sending").click();
    await page.getByRole("button", { name: "Go on", exact: true }).click();
    await page.getByRole("button", { name: "Stop now" }).click();
    await page.getByText("was stopped with the pen up").waitFor();
    machine.hurry();
    await page.getByRole("button", { name: "Go on where it stopped" }).click();
    await page.getByText("is drawn.").waitFor({ timeout: 120_000 });
    assert.ok(machine.lines.length > 10);
    await page.keyboard.press("Escape");
  } finally {
    machine.end();
  }
});

test("nothing was asked of another computer, and no script failed", () => {
  assert.deepEqual(shown.strangers, []);
  assert.deepEqual(shown.faults, []);
});
