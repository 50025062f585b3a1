/**
 * The presses that have begun and not ended, so that each gets its end when the floor can no longer report it.
 */
export class Presses {
  #open = new Map();

  /** Processes an event of a control. */
  take(event) {
    if (event.event === "pressed") this.#open.set(event.id, event);
    if (event.event === "released" || event.event === "cancelled") this.#open.delete(event.id);
  }

  /** Returns the `cancelled` of each open press; none is open after that. */
  cancel() {
    const ends = [...this.#open.values()].map((press) => ({ ...press, event: "cancelled", force_n: 0, contact: null }));
    this.#open.clear();
    return ends;
  }
}
