// A studio that runs, and a browser that shows its page.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { cp, mkdtemp, rm } from "node:fs/promises";
import { existsSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

/// The command that is tried: $DRYPOINT, or the one that cargo builds.
export const command = process.env.DRYPOINT ?? new URL("../../../../target/release/drypoint", import.meta.url).pathname;
const samples = new URL("../../../../samples/", import.meta.url).pathname;
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

/// A folder with photographs of the samples.
export async function folderWith(...names) {
  const folder = await mkdtemp(join(tmpdir(), "drypoint-trial-"));
  for (const name of names) await cp(join(samples, name), join(folder, name));
  return folder;
}

/// Starts `drypoint studio` in the folder; `end` stops it.
export async function startStudio(folder, file) {
  const words = ["studio", "--no-browser", ...(file ? [file] : [])];
  // Not among the recent scenes of whoever runs the trial.
  const env = { ...process.env, XDG_STATE_HOME: join(folder, ".state") };
  const child = spawn(command, words, { cwd: folder, env, stdio: ["ignore", "pipe", "ignore"] });
  const [line] = await once(child.stdout, "data");
  const address = String(line).trim();
  const end = async () => {
    child.kill("SIGKILL");
    await rm(folder, { recursive: true, force: true });
  };
  return { address, folder, end };
}

/// Opens the page in a browser without a graphics processor. `strangers` are requests that left this computer.
export async function openPage(address, size = { width: 1280, height: 720 }) {
  const browser = await chromium.launch({ executablePath, args: ["--disable-gpu", "--no-sandbox"] });
  const context = await browser.newContext({ viewport: size, acceptDownloads: true });
  const strangers = [];
  const faults = [];
  context.on("request", (request) => {
    const { protocol, hostname } = new URL(request.url());
    if (!["blob:", "data:"].includes(protocol) && hostname !== "127.0.0.1") strangers.push(request.url());
  });
  const page = await context.newPage();
  page.on("pageerror", (error) => faults.push(String(error)));
  page.setDefaultTimeout(30_000);
  await page.goto(address);
  return { browser, page, strangers, faults };
}

/// Waits until the drawing shown is the full one of the scene as it is now.
export async function shownInFull(page) {
  const revision = (await scene(page)).revision;
  await page.waitForFunction(
    (revision) => {
      const shown = document.querySelector("[data-shown]");
      return shown?.dataset.shown === "Full" && Number(shown.dataset.revision ?? revision) >= revision;
    },
    revision,
    { timeout: 120_000 },
  );
}

/// The scene's state as the server tells it.
export function scene(page) {
  return page.evaluate(async () => {
    const token = new URLSearchParams(location.search).get("token");
    return (await fetch(`/api/scene?token=${token}`)).json();
  });
}

/// Waits until the scene fulfils a condition.
export async function sceneThat(page, isTrue) {
  for (let tries = 0; tries < 200; tries++) {
    const state = await scene(page);
    if (isTrue(state)) return state;
    await page.waitForTimeout(50);
  }
  throw new Error(`the scene stays ${(await scene(page)).toml}`);
}
