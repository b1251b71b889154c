/** Selecting and moving grooves and their points; a drag beside them moves the plane. */
import type { Canvas } from "../canvas/canvas";
import { hitGroove } from "../canvas/hit";
import { gridStep, precision, toScreen } from "../canvas/view";
import { handles, HANDLES, moved, withHandle, withoutHandle, withPoint } from "../geometry/handles";
import { pattern, rounded, type PatternPoint } from "../geometry/units";
import { DRAG } from "../model/history";
import { entry, type Json, type Place } from "../model/json";
import { groovePlace, kind } from "../model/scene";
import type { Tool, ToolEvent } from "./tool";

const GRAB = 8; // pixels around a handle
const SLACK = 3; // pixels that a click may wander before it is a drag

type Drag = { readonly from: ToolEvent; readonly path: Json | null; readonly key: string; moving: boolean; last: ToolEvent };

const ARROWS: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};

export class SelectTool implements Tool {
  readonly hint = "Drag moves a groove, a point or the plane · double-click adds a point";
  readonly cursor = "default";
  #drag: Drag | null = null;
  #drags = 0;

  constructor(readonly canvas: Canvas) {}

  down(event: ToolEvent): void {
    const { editor } = this.canvas;
    const handle = this.#handleAt(event);
    if (handle !== null) editor.select(editor.state.groove, handle);
    else {
      const hit = hitGroove(this.canvas.grooves, event.point, this.canvas.view.zoom);
      editor.select(hit ? hit.groove : null);
    }
    this.#drags += 1;
    this.#drag = { from: event, path: this.#path() ?? null, key: `${DRAG}${this.#drags}`, moving: false, last: event };
  }

  move(event: ToolEvent, pressed: boolean): void {
    if (!this.#drag || !pressed) {
      this.#hover(event);
      return;
    }
    const drag = this.#drag;
    const [dx, dy] = [event.at[0] - drag.from.at[0], event.at[1] - drag.from.at[1]];
    if (!drag.moving && Math.hypot(dx, dy) < SLACK) return;
    drag.moving = true;
    const { editor, view } = this.canvas;
    if (drag.path === null) this.canvas.pan(event.at[0] - drag.last.at[0], event.at[1] - drag.last.at[1]);
    else if (editor.state.point !== null) {
      this.#put(withHandle(drag.path, editor.state.point, this.#snapped(event), this.#step(event)), drag.key);
    } else {
      const by = pattern(event.point[0] - drag.from.point[0], event.point[1] - drag.from.point[1]);
      this.#put(moved(drag.path, by, event.shift ? gridStep(view) : precision(view)), drag.key);
    }
    drag.last = event;
  }

  up(): void {
    this.#drag = null;
  }

  doubleClick(event: ToolEvent): void {
    const { view, editor } = this.canvas;
    const hit = hitGroove(this.canvas.grooves, event.point, view.zoom);
    const path = this.#path();
    if (!hit || hit.groove !== editor.state.groove || path === undefined || kind(path) !== "polyline") return;
    if (this.#handleAt(event) !== null) return;
    this.#put(withPoint(path, hit.after, hit.point, precision(view)), null);
    editor.select(hit.groove, hit.after + 1);
  }

  key(name: string, shift: boolean): boolean {
    const { editor, view } = this.canvas;
    if (name === "Delete" || name === "Backspace") return this.#delete();
    const arrow = ARROWS[name];
    if (!arrow) return false;
    const path = this.#path();
    const step = gridStep(view) * (shift ? 1 : 0.1);
    if (path === undefined) this.canvas.pan(-arrow[0] * 40, arrow[1] * 40);
    else if (editor.state.point === null) {
      this.#put(moved(path, pattern(arrow[0] * step, arrow[1] * step), step / 10), `nudge ${editor.state.groove}`);
    } else {
      const at = handles(path)[editor.state.point]?.point;
      const digits = Math.min(step / 10, precision(view) / 10);
      if (at) {
        const to = pattern(at[0] + arrow[0] * step, at[1] + arrow[1] * step);
        this.#put(withHandle(path, editor.state.point, to, digits), `nudge ${editor.state.groove} ${editor.state.point}`);
      }
    }
    return true;
  }

  cancel(): boolean {
    const { editor } = this.canvas;
    const drag = this.#drag;
    this.#drag = null;
    if (drag?.moving && drag.path !== null) {
      this.#put(drag.path, drag.key);
      return true;
    }
    const was = editor.state.groove !== null;
    editor.select(null);
    return was;
  }

  draft(): null {
    return null;
  }

  #delete(): boolean {
    const { editor } = this.canvas;
    const { groove, point } = editor.state;
    if (groove === null) return false;
    const path = point === null ? null : withoutHandle(this.#path(), point);
    if (path === null) editor.removeGroove();
    else {
      this.#put(path, null);
      editor.select(groove, null);
    }
    return true;
  }

  #place(): Place | null {
    const { target, groove } = this.canvas.editor.state;
    return target.pattern === null || groove === null ? null : [...groovePlace(target.pattern, groove), "path"];
  }

  #path(): Json | undefined {
    const { groove } = this.canvas.editor.state;
    return groove === null ? undefined : entry(this.canvas.grooves[groove], "path");
  }

  #put(path: Json, key: string | null): void {
    const place = this.#place();
    if (place) this.canvas.editor.set(place, path, key);
  }

  #step({ shift }: ToolEvent): number {
    return shift ? precision(this.canvas.view) / 10 : precision(this.canvas.view);
  }

  #snapped({ point, shift }: ToolEvent): PatternPoint {
    if (!shift) return point;
    const step = gridStep(this.canvas.view);
    return pattern(rounded(point[0], step), rounded(point[1], step));
  }

  #handleAt({ at }: ToolEvent): number | null {
    const all = handles(this.#path());
    if (all.length > HANDLES) return null;
    let best: number | null = null, least = GRAB;
    for (const [index, { point }] of all.entries()) {
      const [x, y] = toScreen(this.canvas.view, point);
      const distance = Math.hypot(x - at[0], y - at[1]);
      if (distance <= least) [best, least] = [index, distance];
    }
    return best;
  }

  #hover(event: ToolEvent): void {
    const hit = hitGroove(this.canvas.grooves, event.point, this.canvas.view.zoom);
    const hovered = hit?.groove ?? null;
    if (hovered === this.canvas.hovered) return;
    this.canvas.hovered = hovered;
    this.canvas.element.style.cursor = hovered === null ? "default" : "move";
    this.canvas.repaint();
  }
}
