// A drawing on its way to a machine: asked for here, kept by the server.

import { get, send } from "../server/requests.ts";
import { attemptQuietly, flush } from "./scene.ts";
import { now, set, type Box, type Sending } from "./store.ts";

export interface Port {
  port: string;
  what: string;
  usb: boolean;
}

const ENDED = ["done", "stopped", "failed"];

/** True while the machine may move. */
export function isSending(sending: Sending | null): sending is Sending {
  return sending !== null && !ENDED.includes(sending.state);
}

/** True while the machine waits for somebody. */
export function isWaiting(sending: Sending): boolean {
  return ["paused", "waiting", "pen wanted", "ink wanted"].includes(sending.state);
}

export function hearSending(told: Sending): void {
  const before = now().sending;
  // Progress is told while the machine waits, too: what it waits for stays in sight.
  const keeps = told.state === "waiting" && before !== null && isWaiting(before);
  set({ sending: keeps ? { ...before, ...told, state: before.state, name: before.name } : { ...before, ...told } });
}

export async function fetchPorts(): Promise<{ ports: Port[]; fault: string | null }> {
  const { value, fault } = await attemptQuietly(() => get<{ ports: Port[] }>("/api/ports"));
  return { ports: value?.ports ?? [], fault };
}

export async function startSending(port: string, profile: string, part: Box | null): Promise<string | null> {
  await flush();
  return tell("/api/send", { port, profile, part });
}

/** Pauses or goes on; stops; or goes on after a stop. */
export async function tell(path: string, body?: unknown): Promise<string | null> {
  const { value, fault } = await attemptQuietly(() => send<Sending | null>("POST", path, body));
  // What was told meanwhile is newer than the answer.
  if (value && !now().sending) set({ sending: value });
  return fault;
}
