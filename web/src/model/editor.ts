/** The state of the page, and what can be done to it. */
import type { Finding } from "../api/types";
import { addGroove, removeGroove } from "./edits";
import { begin, changed, redone, undone, type History } from "./history";
import { withAt, without, type Json, type Place } from "./json";
import { format } from "./pointer";
import { firstTarget, grooves, kept, type Target } from "./scene";
import { Store } from "./store";

export type ToolName = "select" | "polyline" | "curve" | "circle";

export interface State {
  readonly history: History;
  /** Counts the documents that there have been: a picture tells by it which one it shows. */
  readonly revision: number;
  readonly fileName: string;
  /** The document as it was last opened or saved. */
  readonly saved: Json;
  readonly target: Target;
  readonly groove: number | null;
  readonly point: number | null;
  readonly tool: ToolName;
  readonly problems: readonly Finding[];
  readonly warnings: readonly Finding[];
  /** Counts the documents that were opened, not edited: the canvas then shows all of the new one. */
  readonly opened: number;
}

export class Editor {
  readonly store: Store<State>;

  constructor(doc: Json, fileName: string) {
    this.store = new Store<State>({
      history: begin(doc),
      revision: 0,
      fileName,
      saved: doc,
      target: firstTarget(doc),
      groove: null,
      point: null,
      tool: "select",
      problems: [],
      warnings: [],
      opened: 0,
    });
  }

  get state(): State {
    return this.store.state;
  }

  get doc(): Json {
    return this.state.history.present;
  }

  get isDirty(): boolean {
    return this.doc !== this.state.saved;
  }

  /** A new document in place of the present one, one step of history; `key` joins it to steps with the same key. */
  edit(doc: Json, key: string | null = null, change: Partial<State> = {}): void {
    if (doc === this.doc) return;
    this.#show(changed(this.state.history, doc, key, performance.now()), change);
  }

  set(place: Place, value: Json, key: string | null = format(place)): void {
    this.edit(withAt(this.doc, place, value), key);
  }

  remove(place: Place): void {
    this.edit(without(this.doc, place));
  }

  undo(): void {
    this.#show(undone(this.state.history), {});
  }

  redo(): void {
    this.#show(redone(this.state.history), {});
  }

  open(doc: Json, fileName: string, saved: Json = doc): void {
    const { revision, opened } = this.state;
    const fresh = { groove: null, point: null, problems: [], warnings: [], tool: "select" as const };
    const target = firstTarget(doc);
    this.store.update({ history: begin(doc), revision: revision + 1, opened: opened + 1, fileName, saved, target, ...fresh });
  }

  markSaved(): void {
    this.store.update({ saved: this.doc });
  }

  selectTarget(target: Target): void {
    this.store.update({ target, groove: null, point: null });
  }

  select(groove: number | null, point: number | null = null): void {
    if (groove !== this.state.groove || point !== this.state.point) this.store.update({ groove, point });
  }

  chooseTool(tool: ToolName): void {
    this.store.update({ tool });
  }

  add(groove: Json): void {
    const added = addGroove(this.doc, this.state.target, groove);
    this.edit(added.doc, null, { target: added.target, groove: added.groove, point: null });
  }

  removeGroove(): void {
    const { target, groove } = this.state;
    if (target.pattern === null || groove === null) return;
    this.edit(removeGroove(this.doc, target.pattern, groove), null, { groove: null, point: null });
  }

  #show(history: History, change: Partial<State>): void {
    if (history === this.state.history) return;
    const state = { ...this.state, ...change, history };
    const target = kept(history.present, state.target);
    const count = grooves(history.present, target.pattern).length;
    const groove = state.groove !== null && state.groove < count ? state.groove : null;
    const point = groove === null ? null : state.point;
    this.store.update({ ...change, history, target, groove, point, revision: this.state.revision + 1 });
  }
}
