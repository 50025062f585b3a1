import { guarded } from "./listeners.js";

/** Time in milliseconds after the last report of it at which a hold ends. */
export const BELIEVED_FOR = 100;

/** Delay in milliseconds of a timer above which the page was busy, and reports may wait to be read. */
const BUSY = 10;

/** Time in milliseconds that a page which was busy takes to read them. */
const READING = 20;

/**
 * The controls that feet hold. The floor reports them 50 times a second; a control that no report has named for
 * `BELIEVED_FOR` is not held, for any reason that reports may stop.
 */
export class Holds {
  #held = new Set();
  #reportedAt = -Infinity;
  #timer = null;
  #watchers = new Set();
  #news;

  /** Calls `news` with `{ id, held, why }` at the beginning and at the end of each hold. */
  constructor(news) {
    this.#news = news;
  }

  /** Processes a report: these controls are held, and no other. */
  report(ids) {
    if (this.#isOld() && isHidden()) this.end("silence");
    this.#reportedAt = performance.now();
    const named = new Set(ids);
    this.#finish([...this.#held].filter((id) => !named.has(id)), "released");
    for (const id of named) this.#begin(id);
    clearTimeout(this.#timer);
    if (this.#held.size > 0) this.#timer = setTimeout(() => this.#expire(), BELIEVED_FOR);
  }

  /** Ends all holds. */
  end(why) {
    clearTimeout(this.#timer);
    this.#finish([...this.#held], why);
  }

  /** The held controls; none while the last report is too old. */
  now() {
    return this.#isOld() ? [] : [...this.#held];
  }

  /** Calls `begin` with each hold of the control, and the function that it returns at the end of that hold. */
  watch(id, begin) {
    const watcher = { id, begin, end: null };
    this.#watchers.add(watcher);
    if (this.now().includes(id)) this.#start(watcher);
    return () => {
      this.#watchers.delete(watcher);
      stop(watcher, "unwatched");
    };
  }

  /** The controls that are watched. */
  ids() {
    return new Set([...this.#watchers].map((watcher) => watcher.id));
  }

  // A page that was busy first reads the reports that have come meanwhile. In a hidden page timers are late anyway.
  #expire() {
    const isBusy = performance.now() - this.#reportedAt > BELIEVED_FOR + BUSY;
    if (isBusy && !isHidden()) this.#timer = setTimeout(() => this.end("silence"), READING);
    else this.end("silence");
  }

  #isOld() {
    return performance.now() - this.#reportedAt >= BELIEVED_FOR;
  }

  #begin(id) {
    if (this.#held.has(id)) return;
    this.#held.add(id);
    for (const watcher of this.#of(id)) this.#start(watcher);
    this.#news({ id, held: true, why: null });
  }

  #finish(ids, why) {
    // First all, so that no function of the app sees a control as held that is not.
    for (const id of ids) this.#held.delete(id);
    for (const id of ids) {
      for (const watcher of this.#of(id)) stop(watcher, why);
      this.#news({ id, held: false, why });
    }
  }

  #of(id) {
    return [...this.#watchers].filter((watcher) => watcher.id === id);
  }

  #start(watcher) {
    const end = guarded(watcher.begin, watcher.id);
    watcher.end = typeof end === "function" ? end : null;
    // It may have ended its own watch.
    if (!this.#watchers.has(watcher)) stop(watcher, "unwatched");
  }
}

function stop(watcher, why) {
  const { end } = watcher;
  watcher.end = null;
  if (end) guarded(end, why);
}

function isHidden() {
  return globalThis.document?.hidden ?? false;
}
