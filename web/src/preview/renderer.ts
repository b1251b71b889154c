/** Keeps the picture current: a draft after each change, a sharp one after a pause; only the latest document counts. */
import { health, render, ServiceError } from "../api/client";
import type { Finding } from "../api/types";
import type { Editor } from "../model/editor";
import { draft, sharp, sizeOf, work, type Quality, type Size } from "./settings";

const SOON = 40; // milliseconds from a change to its draft
const STILL = 450; // milliseconds without a change until the sharp picture
const PATIENCE = 700; // milliseconds that a draft of an older document may go on
const AGAIN = 2000; // milliseconds until a service that does not answer is asked again

export interface Rendered {
  readonly picture: Blob;
  readonly quality: Quality;
  readonly size: Size;
  readonly seconds: number;
  readonly revision: number;
}

export interface View {
  busy(text: string | null): void;
  show(rendered: Rendered): void;
  /** The picture is none of this document's. */
  clear(): void;
  /** The document cannot be rendered, for its problems or for what the text says. */
  failed(text: string): void;
}

export class PreviewRenderer {
  #timer: number | undefined;
  #pace = Infinity; // seconds a sample of a pixel
  #running: { abort: AbortController; revision: number; since: number; quality: Quality } | null = null;

  constructor(
    readonly editor: Editor,
    readonly view: View,
    readonly refused: (problems: readonly Finding[]) => void,
  ) {
    editor.store.watch((now, before) => {
      if (now.opened !== before.opened) this.#opened();
      else if (now.revision !== before.revision) this.#changed();
    });
  }

  start(): void {
    this.#later(draft, 0);
  }

  /** Another document: nothing is known of it, and nothing of the old one is waited for. */
  #opened(): void {
    this.#pace = Infinity;
    this.view.clear();
    this.#later(draft, 0);
  }

  #changed(): void {
    const running = this.#running;
    // A draft under way is let finish, so that a long drag shows pictures; the next one starts right after it.
    if (running?.quality === draft && performance.now() - running.since < PATIENCE) return;
    this.#later(draft, SOON);
  }

  #later(quality: Quality, pause: number): void {
    window.clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => void this.#render(quality), pause);
  }

  async #render(quality: Quality): Promise<void> {
    this.#running?.abort.abort();
    const { revision } = this.editor.state;
    const running = { abort: new AbortController(), revision, since: performance.now(), quality };
    this.#running = running;
    this.view.busy(quality === draft ? "Rendering…" : "Refining…");
    const waiting = window.setTimeout(() => void this.#explain(running.abort.signal), 1500);
    const size = sizeOf(this.editor.doc, quality, this.#pace);
    const { samples } = size;
    const resolution = `${size.width}x${size.height}`;
    let next: [Quality, number] | null = quality === draft ? [sharp, STILL] : null;
    try {
      const picture = await render(this.editor.doc, { resolution, samples }, running.abort.signal);
      const seconds = (performance.now() - running.since) / 1000;
      this.#pace = seconds / work(size);
      this.view.show({ picture, quality, size, seconds, revision });
      this.refused([]);
    } catch (error) {
      if (running.abort.signal.aborted) return;
      next = this.#failed(error, quality);
    } finally {
      window.clearTimeout(waiting);
    }
    if (this.#running !== running) return;
    this.#running = null;
    if (this.editor.state.revision !== revision) next = [draft, 0];
    if (next) this.#later(...next);
    if (next?.[0] !== draft) this.view.busy(null);
  }

  #failed(error: unknown, quality: Quality): [Quality, number] | null {
    if (!(error instanceof ServiceError)) throw error;
    this.view.failed(error.problems.length ? "The scene has problems: no new picture until they are solved." : error.message);
    if (error.status === 422) this.refused(error.problems);
    if (error.status === 0) return [draft, AGAIN];
    return error.retryAfter !== null ? [quality, error.retryAfter] : null;
  }

  /** Says what a long wait is for. */
  async #explain(signal: AbortSignal): Promise<void> {
    try {
      const { kernels } = await health();
      if (!signal.aborted && this.#running?.abort.signal === signal && kernels === "compiling") {
        this.view.busy("Compiling kernels for the first picture: up to a minute…");
      }
    } catch {
      // The render itself will tell.
    }
  }
}
