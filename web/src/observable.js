// What changes, and calls those who listen.

export class Observable {
  #listeners = new Set();

  /** Call `fn` with each change from now on; the answer stops it. */
  on(fn) {
    this.#listeners.add(fn);
    return () => this.#listeners.delete(fn);
  }

  notify(change) {
    for (const fn of this.#listeners) fn(change);
  }
}
