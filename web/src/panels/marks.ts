/** Marks the fields that problems point to, each with what was expected. */
import type { Finding } from "../api/types";
import type { Editor } from "../model/editor";
import { covers } from "../model/pointer";
import { freshId, h } from "../ui/dom";

export function markProblems(editor: Editor): void {
  for (const old of document.querySelectorAll(".mark")) old.remove();
  for (const field of document.querySelectorAll<HTMLElement>(".is-wrong, .is-warned")) clear(field);
  const fields = [...document.querySelectorAll<HTMLElement>("[data-pointer]")];
  for (const finding of editor.state.problems) markOne(fields, finding, "is-wrong");
  for (const finding of editor.state.warnings) markOne(fields, finding, "is-warned");
}

function clear(field: HTMLElement): void {
  field.classList.remove("is-wrong", "is-warned");
  for (const control of field.querySelectorAll("[aria-invalid]")) {
    control.removeAttribute("aria-invalid");
    control.removeAttribute("aria-describedby");
  }
}

function markOne(fields: readonly HTMLElement[], finding: Finding, kind: string): void {
  const holders = fields.filter((field) => field.dataset["pointer"] && covers(field.dataset["pointer"], finding.pointer));
  const depth = (field: HTMLElement): number => field.dataset["pointer"]?.length ?? 0;
  const deepest = Math.max(0, ...holders.map(depth));
  for (const field of holders) {
    const isQuiet = field.dataset["marks"] === "quiet";
    if (!isQuiet && depth(field) !== deepest) continue;
    if (!(kind === "is-warned" && field.classList.contains("is-wrong"))) field.classList.add(kind);
    if (isQuiet || kind === "is-warned") continue;
    const message = h("p", { class: "mark", id: freshId("mark") }, [`Expected ${finding.expected}.`]);
    (field.classList.contains("part") ? field.closest(".field") : field)?.append(message);
    const control = field.querySelector("input, select");
    control?.setAttribute("aria-invalid", "true");
    control?.setAttribute("aria-describedby", message.id);
  }
}
