/** The bar on top and the tools at the side. */
import type { Editor, ToolName } from "../model/editor";
import { h, s } from "../ui/dom";
import type { Files } from "./files";

const ICONS: Record<ToolName | "delete" | "fit" | "undo" | "redo", string> = {
  select: "M5 3l11 8-5 .8 3 5.4-2 1-3-5.5L5 16z",
  polyline: "M3 16L8 6l5 8 4-10",
  curve: "M3 16C5 4 9 4 10 10s5 6 7-6",
  circle: "M17 10a7 7 0 1 1-14 0 7 7 0 0 1 14 0z",
  delete: "M4 6h12M8 6V4h4v2M6 6l1 11h6l1-11",
  fit: "M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4",
  undo: "M7 4L3 8l4 4M3 8h9a4.5 4.5 0 0 1 0 9H8",
  redo: "M13 4l4 4-4 4M17 8H8a4.5 4.5 0 0 0 0 9h4",
};

const TOOLS: readonly (readonly [ToolName, string, string])[] = [
  ["select", "Select and move", "V"],
  ["polyline", "Draw a polyline", "P"],
  ["curve", "Draw a curve", "C"],
  ["circle", "Draw a circle", "O"],
];

export function icon(name: keyof typeof ICONS): SVGElement {
  return s("svg", { viewBox: "0 0 20 20", class: "icon", "aria-hidden": "true" }, [s("path", { d: ICONS[name] })]);
}

function iconButton(name: keyof typeof ICONS, label: string, keys: string, action: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "icon-button", "aria-label": label, title: `${label} (${keys})`, onclick: action }, [icon(name)]);
}

export function tools(editor: Editor, fit: () => void): HTMLElement {
  const buttons = TOOLS.map(([name, label, key]) => {
    const button = iconButton(name, label, key, () => editor.chooseTool(name));
    button.dataset["tool"] = name;
    return button;
  });
  const remove = iconButton("delete", "Delete the groove", "Del", () => editor.removeGroove());
  const show = (): void => {
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset["tool"] === editor.state.tool));
    remove.disabled = editor.state.groove === null;
  };
  editor.store.watch(show);
  show();
  const shown = iconButton("fit", "Show all", "F", fit);
  return h("div", { class: "tools", role: "toolbar", "aria-label": "Tools", "aria-orientation": "vertical" }, [
    ...buttons, h("hr"), remove, h("hr"), shown,
  ]);
}

export function topBar(editor: Editor, files: Files): HTMLElement {
  const button = (label: string, keys: string, action: () => void): HTMLButtonElement =>
    h("button", { type: "button", title: keys ? `${label} (${keys})` : label, onclick: action }, [label]);
  const undo = iconButton("undo", "Undo", "Ctrl+Z", () => editor.undo());
  const redo = iconButton("redo", "Redo", "Ctrl+Shift+Z", () => editor.redo());
  const name = h("span", { class: "file-name" });
  const show = (): void => {
    const { history, fileName } = editor.state;
    undo.disabled = history.past.length === 0;
    redo.disabled = history.future.length === 0;
    name.textContent = fileName;
    name.classList.toggle("dirty", editor.isDirty);
    name.title = editor.isDirty ? `${fileName}: has unsaved changes` : fileName;
    document.title = `${editor.isDirty ? "• " : ""}${fileName} – intaglio`;
  };
  editor.store.watch(show);
  show();
  return h("header", { class: "top-bar" }, [
    h("h1", {}, ["intaglio"]),
    h("div", { class: "group" }, [
      button("New", "", () => files.create()), button("Open", "Ctrl+O", () => files.choose()), files.examples,
      button("Save", "Ctrl+S", () => files.save()),
    ]),
    h("div", { class: "group" }, [undo, redo]),
    name,
  ]);
}
