// What the server tells by itself.

import { address } from "./requests.ts";
import type { Sending } from "../model/store.ts";
import type { Quality } from "./shapes.ts";

export interface Told {
  scene: { revision: number };
  started: { id: string | number; quality: Quality; revision: number };
  stage: { id: string | number; stage: string };
  finished: { id: string | number; quality: Quality; revision: number };
  failed: { quality: Quality; revision: number; message: string };
  sending: Sending;
  sight: { state: string; message: string };
}

type Hearers = { [Name in keyof Told]: (told: Told[Name]) => void };

export function listen(hearers: Hearers, connection: (isOpen: boolean) => void): void {
  const events = new EventSource(address("/api/events"));
  for (const name of Object.keys(hearers) as (keyof Told)[]) {
    events.addEventListener(name, (event) => {
      const hear = hearers[name] as (told: unknown) => void;
      hear(JSON.parse((event as MessageEvent<string>).data));
    });
  }
  events.onopen = () => connection(true);
  events.onerror = () => connection(false);
}
