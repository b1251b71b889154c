/**
 * A panel shows a part of the document. It is built anew when what it shows becomes another thing, as its key tells;
 * otherwise its fields only take on their new values, so that the one being typed in keeps the focus.
 */
import type { Editor, State } from "../model/editor";
import { h } from "./dom";

export type Refresh = () => void;
/** Fields leave here what brings them up to date. */
export type Binder = (refresh: Refresh) => void;

export interface PanelPlan {
  readonly title: string;
  readonly key: (state: State) => string;
  readonly build: (bind: Binder) => readonly (Node | string)[];
}

export function panel(editor: Editor, plan: PanelPlan, rebuilt: () => void): HTMLElement {
  const body = h("div", { class: "panel-body" });
  const element = h("section", { class: "panel", "aria-label": plan.title }, [h("h2", {}, [plan.title]), body]);
  let key: string | null = null;
  let refreshers: Refresh[] = [];
  const show = (): void => {
    const now = plan.key(editor.state);
    if (now !== key) {
      key = now;
      refreshers = [];
      const focus = focusedField(body);
      body.replaceChildren(...plan.build((refresh) => refreshers.push(refresh)));
      if (focus) refocus(body, focus);
      rebuilt();
    }
    for (const refresh of refreshers) refresh();
  };
  editor.store.watch((now, before) => {
    const isSame = now.history === before.history && now.target === before.target && now.groove === before.groove
      && now.point === before.point;
    if (!isSame) show();
  });
  show();
  return element;
}

function focusedField(body: HTMLElement): string | null {
  const active = document.activeElement;
  if (!(active instanceof HTMLElement) || !body.contains(active)) return null;
  return active.closest<HTMLElement>("[data-pointer]")?.dataset["pointer"] ?? null;
}

function refocus(body: HTMLElement, pointer: string): void {
  const control = body.querySelector<HTMLElement>(`[data-pointer="${CSS.escape(pointer)}"] :is(input:not([type=range]), select)`);
  control?.focus();
  if (control instanceof HTMLInputElement && control.type === "text") control.selectionStart = control.value.length;
}
