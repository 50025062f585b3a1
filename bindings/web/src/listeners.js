/**
 * Functions that are called for an event: of all controls, or of one.
 */
export class Listeners {
  #calls = new Map();

  /** Calls `call` for each `event`, of the control `id` only unless that is null. Returns a function that ends this. */
  add(event, id, call) {
    const entry = { id, call };
    const entries = this.#calls.get(event) ?? new Set();
    this.#calls.set(event, entries.add(entry));
    return () => entries.delete(entry);
  }

  /** Calls the functions for `event` of the control `id`. Returns how many there are. */
  tell(event, value, id = null) {
    const chosen = [...(this.#calls.get(event) ?? [])].filter((entry) => entry.id === null || entry.id === id);
    for (const { call } of chosen) guarded(call, value);
    return chosen.length;
  }

  /** The controls that functions are for. */
  ids() {
    const entries = [...this.#calls.values()].flatMap((entries) => [...entries]);
    return new Set(entries.map((entry) => entry.id).filter((id) => id !== null));
  }
}

/** Calls a function of the app and returns its result; an exception is reported and goes no further. */
export function guarded(call, value) {
  try {
    return call(value);
  } catch (error) {
    (globalThis.reportError ?? console.error)(error);
    return undefined;
  }
}
