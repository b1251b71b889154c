/** Keeps the list of problems current: the service checks the document after each change. */
import { ServiceError, validate } from "../api/client";
import type { Finding } from "../api/types";
import type { Editor } from "../model/editor";

const PAUSE = 120; // milliseconds after the last change

export class Checker {
  #timer: number | undefined;
  #running = new AbortController();
  #found: readonly Finding[] = [];
  #refused: readonly Finding[] = [];

  constructor(readonly editor: Editor) {
    editor.store.watch((now, before) => now.revision !== before.revision && this.later(PAUSE));
  }

  later(pause: number): void {
    window.clearTimeout(this.#timer);
    this.#running.abort();
    this.#timer = window.setTimeout(() => void this.#check(), pause);
  }

  /** What a render was refused for: a service refuses more than a scene's own faults. */
  refused(problems: readonly Finding[]): void {
    this.#refused = problems;
    this.#publish();
  }

  async #check(): Promise<void> {
    const running = (this.#running = new AbortController());
    try {
      const { problems, warnings } = await validate(this.editor.doc, running.signal);
      if (running.signal.aborted) return;
      this.#found = problems;
      this.editor.store.update({ warnings });
      this.#publish();
    } catch (error) {
      if (running.signal.aborted) return;
      const detail = error instanceof ServiceError && error.status > 0 ? error : null;
      if (detail) this.refused(detail.problems.length ? detail.problems : [{ pointer: "", expected: "a scene", found: detail.message }]);
      else this.later(2000);
    }
  }

  #publish(): void {
    const known = new Set(this.#found.map((problem) => `${problem.pointer} ${problem.expected}`));
    const more = this.#refused.filter((problem) => !known.has(`${problem.pointer} ${problem.expected}`));
    this.editor.store.update({ problems: [...this.#found, ...more] });
  }
}
