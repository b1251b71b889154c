/** Drawing a circle: from its centre to its radius. */
import type { Canvas } from "../canvas/canvas";
import { precision } from "../canvas/view";
import { circle } from "../geometry/flatten";
import { rounded, type PatternPoint } from "../geometry/units";
import { newGroove } from "./newgroove";
import type { Draft, Tool, ToolEvent } from "./tool";

export class CircleTool implements Tool {
  readonly hint = "Drag from the centre outwards · Esc cancels";
  readonly cursor = "crosshair";
  #center: PatternPoint | null = null;
  #radius = 0;

  constructor(readonly canvas: Canvas) {}

  down({ point }: ToolEvent): void {
    this.#center = point;
    this.#radius = 0;
  }

  move({ point }: ToolEvent, pressed: boolean): void {
    if (!this.#center || !pressed) return;
    this.#radius = Math.hypot(point[0] - this.#center[0], point[1] - this.#center[1]);
    this.canvas.repaint();
  }

  up(event: ToolEvent): void {
    this.move(event, true);
    const step = precision(this.canvas.view);
    const radius = rounded(this.#radius, step);
    const center = this.#center;
    this.cancel();
    if (!center || radius < 4 * step) return; // a click, no drag
    const at: [number, number] = [rounded(center[0], step), rounded(center[1], step)];
    this.canvas.editor.add(newGroove(this.canvas, { type: "circle", center: at, radius }));
  }

  doubleClick(): void {}

  key(): boolean {
    return false;
  }

  cancel(): boolean {
    const was = this.#center !== null;
    this.#center = null;
    this.canvas.repaint();
    return was;
  }

  draft(): Draft | null {
    if (!this.#center) return null;
    const { points } = circle(this.#center, this.#radius);
    return { line: [...points, ...points.slice(0, 1)], points: [this.#center] };
  }
}
