/** The document in the browser's storage, so that a reload or a crash loses nothing. */
import type { Editor } from "./editor";
import type { Json } from "./json";
import { NotAScene, parseScene } from "./text";

const KEY = "intaglio.document";
const PAUSE = 250; // milliseconds

export interface Stored {
  readonly doc: Json;
  readonly fileName: string;
  readonly dirty: boolean;
}

export function restore(): Stored | null {
  try {
    const found = JSON.parse(localStorage.getItem(KEY) ?? "null") as { text: string; fileName: string; dirty: boolean } | null;
    return found && { doc: parseScene(found.text), fileName: String(found.fileName), dirty: Boolean(found.dirty) };
  } catch (error) {
    if (!(error instanceof NotAScene)) console.warn("The stored document cannot be read:", error);
    return null;
  }
}

/** Keeps the stored document current; `failed` is called when the browser has no room for it. */
export function keepStored(editor: Editor, failed: () => void): void {
  let timer: number | undefined;
  let told = false;
  const store = (): void => {
    window.clearTimeout(timer);
    timer = undefined;
    const record = { text: JSON.stringify(editor.doc), fileName: editor.state.fileName, dirty: editor.isDirty };
    try {
      localStorage.setItem(KEY, JSON.stringify(record));
    } catch {
      if (!told) failed();
      told = true;
    }
  };
  editor.store.watch((now, before) => {
    if (now.history === before.history && now.saved === before.saved) return;
    window.clearTimeout(timer);
    timer = window.setTimeout(store, PAUSE);
  });
  window.addEventListener("pagehide", () => timer !== undefined && store());
}
