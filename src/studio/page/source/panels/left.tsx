// The left rail: tools in a column, beside them one of four panels.

import type { ComponentType } from "preact";
import { set, useStudio, type Panel, type Tool } from "../model/store.ts";
import { IconButton } from "../parts/button.tsx";
import { chooseLines, endLine } from "../stage/line.ts";
import { redraw } from "../stage/engine.ts";
import { MasksPanel } from "./masks.tsx";
import { RegionsPanel } from "./regions.tsx";
import { ScenePanel } from "./scene.tsx";
import { SheetPanel } from "./sheet.tsx";

export const TOOLS: { tool: Tool; name: string; keys: string }[] = [
  { tool: "hand", name: "Move the view", keys: "V" },
  { tool: "place", name: "Place the picture on the sheet", keys: "G" },
  { tool: "part", name: "Part to plot: drag a box", keys: "R" },
  { tool: "brush", name: "Brush: add to the mask", keys: "B" },
  { tool: "eraser", name: "Eraser: take from the mask", keys: "E" },
  { tool: "lasso", name: "Lasso: add what is inside; Alt takes away", keys: "L" },
  { tool: "line", name: "Pen: draw lines that rows and marks follow", keys: "N" },
  { tool: "fill", name: "Fill what the mask encloses; Alt empties", keys: "F" },
];

const PANELS: { panel: Panel; name: string; View: ComponentType }[] = [
  { panel: "masks", name: "Masks", View: MasksPanel },
  { panel: "regions", name: "Regions", View: RegionsPanel },
  { panel: "sheet", name: "Sheet", View: SheetPanel },
  { panel: "scene", name: "Scene", View: ScenePanel },
];

export function chooseTool(tool: Tool): void {
  endLine();
  if (tool === "line" && !chooseLines()) return;
  if (tool === "hand") set({ tool });
  else set({ tool, panel: tool === "place" || tool === "part" ? "sheet" : "masks", isLeftOpen: true });
}

export function Left() {
  const tool = useStudio((state) => state.tool);
  const panel = useStudio((state) => state.panel);
  const isOpen = useStudio((state) => state.isLeftOpen);
  const isReady = useStudio((state) => state.start !== null);
  const View = PANELS.find((one) => one.panel === panel)!.View;
  return (
    <nav class="left" id="left" aria-label="Tools and panels" tabIndex={-1}>
      <div class="rail" role="toolbar" aria-label="Tools" aria-orientation="vertical">
        {TOOLS.map((one) => (
          <IconButton key={one.tool} icon={one.tool} name={one.name} keys={one.keys} isPressed={one.tool === tool} act={() => chooseTool(one.tool)} />
        ))}
        <span class="spring" />
        <IconButton icon={isOpen ? "left" : "right"} name={isOpen ? "Close the panel" : "Open the panel"} keys="Q" act={() => set({ isLeftOpen: !isOpen })} />
      </div>
      {isOpen && (
        <div class="panel">
          <div class="tabs" role="tablist" aria-label="Panels">
            {PANELS.map((one) => (
              <button role="tab" id={`tab-${one.panel}`} aria-selected={one.panel === panel} aria-controls="left-panel" onClick={() => (set({ panel: one.panel }), redraw())}>
                {one.name}
              </button>
            ))}
          </div>
          <div class="tab-panel" id="left-panel" role="tabpanel" aria-labelledby={`tab-${panel}`} tabIndex={0}>
            {isReady && <View />}
          </div>
        </div>
      )}
    </nav>
  );
}
