// How fluently 100,000 marks are panned in a browser without a graphics processor: `node trial/panning.mjs`.
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { folderWith, openPage, shownInFull, startStudio } from "./studio.mjs";

const folder = await folderWith("astronaut.jpg");
await writeFile(join(folder, "many.toml"), 'photograph = "astronaut.jpg"\nstyle = "grid"\nbackground = "keep"\nsight = "none"\nsize = "150x150mm"\n[set]\npitch = "0.42mm"\n');
const studio = await startStudio(folder, "many.toml");
const { browser, page } = await openPage(studio.address);
await shownInFull(page);
const told = await page.locator(".bottom").innerText();
const { x, y, width, height } = await page.locator("canvas").first().boundingBox();

/// The times between frames while the view is dragged in a circle, in milliseconds.
async function panned(zoom) {
  await page.locator("canvas").first().focus();
  for (let i = 0; i < zoom; i++) await page.keyboard.press("+");
  await page.waitForTimeout(1500);
  await page.evaluate(() => {
    window.frames_ = [];
    let before = performance.now();
    const tick = (now) => (window.frames_.push(now - before), (before = now), requestAnimationFrame(tick));
    requestAnimationFrame(tick);
  });
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  for (let i = 0; i < 240; i++) {
    await page.mouse.move(x + width / 2 + 120 * Math.sin(i / 12), y + height / 2 + 120 * (1 - Math.cos(i / 12)));
  }
  await page.mouse.up();
  const frames = (await page.evaluate(() => window.frames_.slice(3))).sort((a, b) => a - b);
  const at = (share) => frames[Math.floor(share * (frames.length - 1))].toFixed(1);
  console.log(`zoomed in ${zoom} times: ${frames.length} frames, ${at(0.5)} ms in the middle, ${at(0.95)} ms at the 95th percentile, ${at(1)} at most`);
}

console.log(told.replaceAll("\n", " "));
for (const zoom of [0, 2, 3]) await panned(zoom);
await browser.close();
await studio.end();
