/** Where everything is on the page. */
import { Canvas } from "../canvas/canvas";
import type { View as CanvasView } from "../canvas/view";
import type { Editor, ToolName } from "../model/editor";
import { grooves } from "../model/scene";
import { cameraPanel } from "../panels/camera";
import { groovePanel } from "../panels/groove";
import { groovesPanel } from "../panels/grooves";
import { lightsPanel } from "../panels/lights";
import { markProblems } from "../panels/marks";
import { materialsPanel } from "../panels/materials";
import { objectPanel } from "../panels/object";
import { problemsList } from "../panels/problems";
import { Preview } from "../preview/preview";
import { Checker } from "../preview/problems";
import { PreviewRenderer } from "../preview/renderer";
import { CircleTool } from "../tools/circle";
import { DrawingTool } from "../tools/drawing";
import { rememberStyle } from "../tools/newgroove";
import { SelectTool } from "../tools/select";
import type { Tool } from "../tools/tool";
import { h } from "../ui/dom";
import { panel, type PanelPlan } from "../ui/panel";
import type { Files } from "./files";
import { tools, topBar } from "./toolbar";

export class Shell {
  readonly canvas: Canvas;
  readonly #tools: Record<ToolName, Tool>;
  readonly #hint = h("span", { class: "hint" });
  readonly #position = h("span", { class: "position code" });
  readonly #message = h("p", { class: "message", role: "status", hidden: true });
  readonly #checker: Checker;
  readonly #renderer: PreviewRenderer;
  readonly #preview: Preview;

  constructor(readonly editor: Editor) {
    const element = h("canvas", {
      tabindex: 0, role: "application", class: "plane",
      "aria-label": "The pattern's plane. The list of grooves and their points does by keyboard what is done here by pointer.",
    });
    this.canvas = new Canvas(element, editor, () => this.tool, (view, pointer) => this.#show(view, pointer));
    this.#tools = {
      select: new SelectTool(this.canvas),
      polyline: new DrawingTool(this.canvas, "polyline"),
      curve: new DrawingTool(this.canvas, "curve"),
      circle: new CircleTool(this.canvas),
    };
    this.#preview = new Preview(editor);
    this.#checker = new Checker(editor);
    this.#renderer = new PreviewRenderer(editor, this.#preview, (problems) => this.#checker.refused(problems));
  }

  get tool(): Tool {
    return this.#tools[this.editor.state.tool];
  }

  mount(root: HTMLElement, files: Files): void {
    const { editor } = this;
    const make = (plan: PanelPlan): HTMLElement => panel(editor, plan, () => markProblems(editor));
    root.replaceChildren(
      topBar(editor, files),
      tools(editor, () => this.canvas.fit()),
      h("main", { class: "middle" }, [
        h("div", { class: "plane-frame" }, [this.canvas.element, this.#message]),
        h("div", { class: "plane-foot" }, [this.#hint, this.#position]),
        problemsList(editor),
      ]),
      h("div", { class: "side" }, [
        h("aside", { class: "inspector", "aria-label": "Pattern and groove" }, [make(groovesPanel(editor)), make(groovePanel(editor))]),
        h("aside", { class: "scene", "aria-label": "Scene" }, [
          this.#preview.element,
          h("div", { class: "scene-panels" }, [
            make(lightsPanel(editor)), make(materialsPanel(editor)), make(cameraPanel(editor)), make(objectPanel(editor)),
          ]),
        ]),
      ]),
    );
    editor.store.watch((now, before) => {
      if (now.tool !== before.tool) this.#toolChanged(before.tool);
      if (now.problems !== before.problems || now.warnings !== before.warnings) markProblems(editor);
      if (now.groove !== null) rememberStyle(grooves(now.history.present, now.target.pattern)[now.groove]);
      document.body.dataset["revision"] = String(now.revision);
    });
    document.body.dataset["revision"] = String(editor.state.revision);
    this.#toolChanged("select");
  }

  /** Begins to check and to render. */
  start(): void {
    this.#checker.later(0);
    this.#renderer.start();
  }

  say(text: string): void {
    this.#message.textContent = text;
    this.#message.hidden = text === "";
    if (text.startsWith("Saved")) window.setTimeout(() => this.#message.textContent === text && this.say(""), 4000);
  }

  /** Gives up what is under way; with nothing under way, the tool, and then the selection. */
  cancel(): boolean {
    this.say("");
    if (!this.tool.cancel() && this.editor.state.tool !== "select") this.editor.chooseTool("select");
    return true;
  }

  #toolChanged(before: ToolName): void {
    if (before !== "select") this.#tools[before].cancel();
    this.#hint.textContent = this.#hint.title = this.tool.hint;
    this.canvas.element.style.cursor = this.tool.cursor;
    this.canvas.hovered = null;
    this.canvas.repaint();
  }

  #show(view: CanvasView, pointer: readonly [number, number] | null): void {
    const digits = Math.max(0, Math.ceil(Math.log10(view.zoom)));
    const at = pointer ? `p ${pointer[0].toFixed(digits)}  q ${pointer[1].toFixed(digits)}  ` : "";
    this.#position.textContent = `${at}${Number(view.zoom.toPrecision(3))} px a unit`;
  }
}
