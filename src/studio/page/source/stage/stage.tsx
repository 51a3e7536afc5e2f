// The drawing area: canvas, divider, and the label that always says what is shown.

import { useEffect, useRef, useState } from "preact/hooks";
import { openPhotograph, say } from "../model/scene.ts";
import { now, set, useStudio } from "../model/store.ts";
import { camera } from "./camera.ts";
import { attach, redraw } from "./engine.ts";
import { brushOnScreen, moved, pressed, released, wheeled } from "./gestures.ts";
import { ShownLabel } from "./shown.tsx";

function followSize(holder: HTMLElement, canvas: HTMLCanvasElement): () => void {
  const measure = () => {
    const box = holder.getBoundingClientRect();
    const density = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(box.width * density), Math.round(box.height * density)];
    canvas.width = width;
    canvas.height = height;
    const gap = Math.round(12 * density);
    camera.resize(now().mode === "side" ? Math.floor((width - gap) / 2) : width, height, density);
    redraw();
  };
  const observer = new ResizeObserver(measure);
  observer.observe(holder);
  measure();
  return () => observer.disconnect();
}

export function Stage() {
  const holder = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [isOver, setOver] = useState(false);
  const mode = useStudio((state) => state.mode);
  const tool = useStudio((state) => state.tool);
  const label = useStudio((state) => state.shown?.summary ?? "No drawing yet");
  useEffect(() => followSize(holder.current!, canvas.current!), [mode]);
  useEffect(() => {
    const element = canvas.current!;
    attach(element);
    element.addEventListener("wheel", wheeled, { passive: false });
    return () => (attach(null), element.removeEventListener("wheel", wheeled));
  }, []);
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    const file = event.dataTransfer?.files[0];
    if (file) void openPhotograph(file);
    else say("That was no file");
  };
  return (
    <main class="stage" ref={holder} id="stage" onDragOver={(event) => (event.preventDefault(), setOver(true))} onDragLeave={() => setOver(false)} onDrop={drop}>
      <canvas
        ref={canvas}
        class={`sheet tool-${tool}`}
        tabIndex={0}
        role="application"
        aria-roledescription="drawing area"
        aria-label={`Drawing: ${label}. Arrows move, plus and minus zoom, question mark lists all keys.`}
        onPointerDown={pressed}
        onPointerMove={(event) => (moved(event), followBrush(event))}
        onPointerUp={released}
        onPointerCancel={released}
        onPointerLeave={() => showBrush((pointer = null))}
        onDblClick={() => now().tool === "hand" && camera.fit()}
        onContextMenu={(event) => event.preventDefault()}
      />
      <div class="brush-ring" id="brush-ring" aria-hidden="true" />
      {mode === "divider" && <Divider holder={holder} />}
      {mode === "side" && <PaneNames />}
      <ShownLabel />
      {isOver && <div class="drop-here">Drop a photograph to draw it</div>}
    </main>
  );
}

function PaneNames() {
  return (
    <div class="pane-names" aria-hidden="true">
      <span>Photograph</span>
      <span>Drawing</span>
    </div>
  );
}

/** Where the pointer is over the canvas. */
let pointer: { x: number; y: number } | null = null;

function showBrush(place: { x: number; y: number } | null, isByKey = false): void {
  const ring = document.getElementById("brush-ring")!;
  const { tool } = now();
  const isBrush = tool === "brush" || tool === "eraser" || (isByKey && (tool === "lasso" || tool === "fill" || tool === "line"));
  ring.hidden = !place || !isBrush;
  if (!place || !isBrush) return;
  const size = brushOnScreen();
  ring.style.width = ring.style.height = `${size}px`;
  ring.style.transform = `translate(${place.x - size / 2}px, ${place.y - size / 2}px)`;
}

function followBrush(event: PointerEvent): void {
  const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
  pointer = { x: event.clientX - box.left, y: event.clientY - box.top };
  showBrush(pointer);
}

/** After a key: the brush in its new size at the pointer or, for whoever paints by keyboard, in the middle where Enter paints. */
export function showBrushAfterKey(isMoved: boolean): void {
  const middle = { x: camera.width / 2 / camera.density, y: camera.height / 2 / camera.density };
  showBrush(isMoved ? middle : (pointer ?? middle), true);
}

export function setDivider(divider: number): void {
  set({ divider: Math.min(0.98, Math.max(0.02, divider)) });
  redraw();
}

function Divider({ holder }: { holder: { current: HTMLDivElement | null } }) {
  const divider = useStudio((state) => state.divider);
  const drag = (event: PointerEvent) => {
    if (event.type === "pointerdown") (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    if (event.buttons === 0) return;
    const box = holder.current!.getBoundingClientRect();
    setDivider((event.clientX - box.left) / box.width);
  };
  const key = (event: KeyboardEvent) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, PageUp: 0.1, PageDown: -0.1, Home: -1, End: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    setDivider(divider + step);
  };
  return (
    <div
      class="divider"
      style={{ left: `${100 * divider}%` }}
      role="slider"
      tabIndex={0}
      aria-label="Divider between photograph and drawing"
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={Math.round(100 * divider)}
      aria-valuetext={`${Math.round(100 * divider)} percent photograph`}
      onPointerDown={drag}
      onPointerMove={drag}
      onKeyDown={key}
    >
      <span class="grip" aria-hidden="true" />
      <span class="side-name left" aria-hidden="true">Photograph</span>
      <span class="side-name right" aria-hidden="true">Drawing</span>
    </div>
  );
}
