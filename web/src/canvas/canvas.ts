/** The canvas element: shows the target's pattern and hands pointers and keys to the tool of the moment. */
import { screen, type ScreenPoint } from "../geometry/units";
import type { Editor, State } from "../model/editor";
import { array, type Json } from "../model/json";
import { parse } from "../model/pointer";
import { grooves } from "../model/scene";
import type { Tool, ToolEvent } from "../tools/tool";
import { paint } from "./paint";
import { lookBounds, surfaceBounds, tileBounds } from "./surface";
import { fitted, panned, toPattern, zoomed, type View } from "./view";

export class Canvas {
  view: View = { center: [0, 0], zoom: 100, width: 1, height: 1 };
  hovered: number | null = null;
  #painted = 0;
  #pan: ScreenPoint | null = null;
  #fitWhenSized = true;

  constructor(
    readonly element: HTMLCanvasElement,
    readonly editor: Editor,
    readonly tool: () => Tool,
    readonly moved: (view: View, pointer: readonly [number, number] | null) => void,
  ) {
    new ResizeObserver(() => this.#resize()).observe(element);
    editor.store.watch((now, before) => this.#changed(now, before));
    element.addEventListener("pointerdown", (event) => this.#down(event));
    element.addEventListener("pointermove", (event) => this.#move(event));
    element.addEventListener("pointerup", (event) => this.#up(event));
    element.addEventListener("pointercancel", () => this.tool().cancel());
    element.addEventListener("pointerleave", () => this.moved(this.view, null));
    element.addEventListener("dblclick", (event) => this.tool().doubleClick(this.#toolEvent(event)));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
  }

  get grooves(): Json[] {
    return grooves(this.editor.doc, this.editor.state.target.pattern);
  }

  fit(): void {
    this.view = fitted(this.view, lookBounds(this.editor.doc, this.editor.state.target));
    this.repaint();
    this.moved(this.view, null);
  }

  zoomBy(factor: number): void {
    this.view = zoomed(this.view, factor, screen(this.view.width / 2, this.view.height / 2));
    this.repaint();
    this.moved(this.view, null);
  }

  pan(dx: number, dy: number): void {
    this.view = panned(this.view, dx, dy);
    this.repaint();
  }

  repaint(): void {
    if (this.#painted === 0) this.#painted = requestAnimationFrame(() => this.#paint());
  }

  #paint(): void {
    this.#painted = 0;
    const context = this.element.getContext("2d");
    if (!context) return;
    const { target, groove, point, problems } = this.editor.state;
    const ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const wrong = problems
      .map((problem) => parse(problem.pointer))
      .filter(([patterns, name, list]) => patterns === "patterns" && name === target.pattern && list === "grooves")
      .map((place) => Number(place[3]));
    paint(context, {
      view: this.view,
      grooves: this.grooves,
      surface: surfaceBounds(this.editor.doc, target),
      tile: tileBounds(this.editor.doc, target),
      selected: groove,
      point,
      hovered: this.hovered,
      wrong: new Set(wrong),
      draft: this.tool().draft(),
    });
  }

  #changed(now: State, before: State): void {
    if (now.opened !== before.opened || now.target.object !== before.target.object) this.fit();
    else if (now.target.pattern !== before.target.pattern && array(this.grooves).length > 1) this.fit();
    this.repaint();
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    const ratio = window.devicePixelRatio || 1;
    [this.element.width, this.element.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.view = { ...this.view, width, height };
    if (this.#fitWhenSized && width > 1) {
      this.#fitWhenSized = false;
      this.fit();
    }
    this.#paint(); // at once: sizing has cleared the canvas
  }

  #toolEvent(event: MouseEvent): ToolEvent {
    const box = this.element.getBoundingClientRect();
    const at = screen(event.clientX - box.left, event.clientY - box.top);
    return { at, point: toPattern(this.view, at), shift: event.shiftKey, alt: event.altKey };
  }

  #down(event: PointerEvent): void {
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    if (event.button === 1 || event.button === 2) this.#pan = screen(event.clientX, event.clientY);
    else if (event.button === 0) this.tool().down(this.#toolEvent(event));
  }

  #move(event: PointerEvent): void {
    const found = this.#toolEvent(event);
    if (this.#pan) {
      this.pan(event.clientX - this.#pan[0], event.clientY - this.#pan[1]);
      this.#pan = screen(event.clientX, event.clientY);
    } else this.tool().move(found, (event.buttons & 1) === 1);
    this.moved(this.view, found.point);
  }

  #up(event: PointerEvent): void {
    this.#pan = null;
    if (event.button === 0) this.tool().up(this.#toolEvent(event));
  }

  #wheel(event: WheelEvent): void {
    event.preventDefault();
    const { at, point } = this.#toolEvent(event);
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    this.view = zoomed(this.view, Math.exp(-event.deltaY * lines * 0.0015), at);
    this.repaint();
    this.moved(this.view, point);
  }
}
