/** A value that others watch. */
export type Listener<T> = (now: T, before: T) => void;

export class Store<T extends object> {
  readonly #listeners = new Set<Listener<T>>();
  #state: T;

  constructor(state: T) {
    this.#state = state;
  }

  get state(): T {
    return this.#state;
  }

  update(change: Partial<T>): void {
    const before = this.#state;
    this.#state = { ...before, ...change };
    for (const listener of this.#listeners) listener(this.#state, before);
  }

  watch(listener: Listener<T>): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}
