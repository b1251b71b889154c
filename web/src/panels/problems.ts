/** The list of problems and warnings; a click goes to where one is. */
import type { Finding } from "../api/types";
import type { Editor } from "../model/editor";
import { covers, parse } from "../model/pointer";
import { targets } from "../model/scene";
import { h } from "../ui/dom";

const LISTED = 100;

export function problemsList(editor: Editor): HTMLElement {
  const summary = h("h2", { "aria-live": "polite", id: "problems-title" });
  const list = h("ul", {});
  const element = h("section", { class: "problems", "aria-labelledby": "problems-title" }, [summary, list]);
  const show = (): void => {
    const { problems, warnings } = editor.state;
    const counted = (count: number, noun: string): string => `${count} ${noun}${count === 1 ? "" : "s"}`;
    const parts = [
      problems.length > 0 ? counted(problems.length, "problem") : "No problems",
      ...(warnings.length > 0 ? [counted(warnings.length, "warning")] : []),
    ];
    if (summary.textContent !== parts.join(", ")) summary.textContent = parts.join(", ");
    element.classList.toggle("has-problems", problems.length > 0);
    const all = [...problems.map((one) => item(editor, one, "problem")), ...warnings.map((one) => item(editor, one, "warning"))];
    list.replaceChildren(...all.slice(0, LISTED));
  };
  editor.store.watch((now, before) => (now.problems !== before.problems || now.warnings !== before.warnings) && show());
  show();
  return element;
}

function item(editor: Editor, finding: Finding, severity: "problem" | "warning"): HTMLElement {
  const content = [
    h("span", { class: "where" }, [spoken(finding.pointer)]),
    h("span", {}, [`expected ${finding.expected}, found ${finding.found}`]),
  ];
  return h("li", {}, [
    h("button", { type: "button", class: `finding ${severity}`, title: finding.pointer, onclick: () => goTo(editor, finding.pointer) }, content),
  ]);
}

/** A pointer as people count. */
function spoken(pointer: string): string {
  const parts = parse(pointer).map((part) => (/^\d+$/.test(part) ? String(Number(part) + 1) : part));
  return parts.length === 0 ? "the scene" : parts.join(" › ");
}

/** Shows what a pointer points to: the groove or object is selected, its field gets the focus. */
function goTo(editor: Editor, pointer: string): void {
  const [part, name, list, index, ...rest] = parse(pointer);
  const all = targets(editor.doc);
  const found = part === "patterns" ? all.find((one) => one.pattern === name)
    : part === "objects" ? all.find((one) => one.object === Number(name)) : undefined;
  const { target } = editor.state;
  const isShown = found && (part === "patterns" ? target.pattern === found.pattern : target.object === found.object);
  if (found && !isShown) editor.selectTarget(found);
  if (part === "patterns" && list === "grooves" && index !== undefined) {
    const point = rest[0] === "path" && rest[1] === "points" && rest[2] !== undefined ? Number(rest[2]) : null;
    editor.select(Number(index), point);
  }
  window.setTimeout(() => focusField(pointer), 0);
}

/** The deepest field that holds the place. */
function focusField(pointer: string): void {
  const holders = [...document.querySelectorAll<HTMLElement>("[data-pointer]")]
    .filter((element) => element.dataset["pointer"] && covers(element.dataset["pointer"], pointer))
    .sort((a, b) => (b.dataset["pointer"]?.length ?? 0) - (a.dataset["pointer"]?.length ?? 0));
  for (const holder of holders) {
    for (let details = holder.closest("details"); details; details = details.parentElement?.closest("details") ?? null) details.open = true;
    const control = holder.querySelector<HTMLElement>("input:not([type=range]), select, button, canvas");
    if (!control) continue;
    control.focus();
    holder.scrollIntoView({ block: "nearest" });
    return;
  }
}
