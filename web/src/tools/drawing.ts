/** Drawing through clicked points: polylines, and smooth curves as SVG paths. */
import type { Canvas } from "../canvas/canvas";
import { gridStep, precision, toScreen } from "../canvas/view";
import { chains } from "../geometry/flatten";
import { smoothPath } from "../geometry/smooth";
import { pattern, rounded, type PatternPoint } from "../geometry/units";
import type { Path } from "../api/types";
import { asJson } from "../model/edits";
import { newGroove } from "./newgroove";
import type { Draft, Tool, ToolEvent } from "./tool";

const CLOSE = 8; // pixels

export class DrawingTool implements Tool {
  readonly hint: string;
  readonly cursor = "crosshair";
  #points: PatternPoint[] = [];
  #next: PatternPoint | null = null;

  constructor(readonly canvas: Canvas, readonly kind: "polyline" | "curve") {
    const closing = kind === "polyline" ? " · the first point closes" : "";
    this.hint = `Click adds points · Enter or double-click finishes${closing} · Shift snaps · Esc cancels`;
  }

  down(event: ToolEvent): void {
    const first = this.#points[0], last = this.#points.at(-1);
    if (first && this.#points.length > 2 && this.kind === "polyline" && this.#near(first, event)) {
      this.#finish(true);
      return;
    }
    if (last && this.#near(last, event, 3)) return; // the second press of a double click
    this.#points.push(this.#snapped(event));
    this.#next = null;
    this.canvas.repaint();
  }

  move(event: ToolEvent): void {
    this.#next = this.#points.length > 0 ? this.#snapped(event) : null;
    this.canvas.repaint();
  }

  up(): void {}

  doubleClick(): void {
    this.#finish(false);
  }

  key(name: string): boolean {
    if (name === "Enter") this.#finish(false);
    else if (name === "Backspace" && this.#points.length > 0) {
      this.#points.pop();
      this.canvas.repaint();
    } else return false;
    return true;
  }

  cancel(): boolean {
    const was = this.#points.length > 0;
    [this.#points, this.#next] = [[], null];
    this.canvas.repaint();
    return was;
  }

  draft(): Draft | null {
    if (this.#points.length === 0) return null;
    const points = this.#next ? [...this.#points, this.#next] : this.#points;
    const line = points.length > 1 ? (chains(asJson(this.#path(points, false)))[0]?.points ?? []) : [];
    return { line, points: this.#points };
  }

  #path(points: readonly PatternPoint[], closed: boolean): Path {
    const step = precision(this.canvas.view);
    if (this.kind === "curve") return { type: "svg", d: smoothPath(points, step) };
    const path: Path = { type: "polyline", points: points.map(([p, q]) => [p, q]) };
    return closed ? { ...path, closed } : path;
  }

  #finish(closed: boolean): void {
    const points = this.#points;
    [this.#points, this.#next] = [[], null];
    if (points.length > 1) this.canvas.editor.add(newGroove(this.canvas, this.#path(points, closed)));
    this.canvas.repaint();
  }

  #snapped({ point, shift }: ToolEvent): PatternPoint {
    const step = shift ? gridStep(this.canvas.view) : precision(this.canvas.view);
    return pattern(rounded(Math.round(point[0] / step) * step, precision(this.canvas.view) / 10),
      rounded(Math.round(point[1] / step) * step, precision(this.canvas.view) / 10));
  }

  #near(point: PatternPoint, { at }: ToolEvent, within = CLOSE): boolean {
    const [x, y] = toScreen(this.canvas.view, point);
    return Math.hypot(at[0] - x, at[1] - y) <= within;
  }
}
