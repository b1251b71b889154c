/** Undo and redo. Changes with one key that follow each other closely, as those of a drag, are one step. */
import type { Json } from "./json";

const STEPS = 200;
const PAUSE = 1200; // milliseconds after which the same key begins a new step
export const DRAG = "drag "; // keys that begin so are one drag each, however long it takes

export interface History {
  readonly past: readonly Json[];
  readonly present: Json;
  readonly future: readonly Json[];
  readonly key: string | null;
  readonly time: number;
}

export function begin(present: Json): History {
  return { past: [], present, future: [], key: null, time: 0 };
}

export function changed(history: History, next: Json, key: string | null, time: number): History {
  if (next === history.present) return history;
  const same = key !== null && key === history.key && (key.startsWith(DRAG) || time - history.time < PAUSE);
  const past = same ? history.past : [...history.past, history.present].slice(-STEPS);
  return { past, present: next, future: [], key, time };
}

export function undone(history: History): History {
  const present = history.past.at(-1);
  if (present === undefined) return history;
  return { past: history.past.slice(0, -1), present, future: [history.present, ...history.future], key: null, time: 0 };
}

export function redone(history: History): History {
  const [present, ...future] = history.future;
  if (present === undefined) return history;
  return { past: [...history.past, history.present], present, future, key: null, time: 0 };
}
