import { Holds } from "./holds.js";
import { Link } from "./link.js";
import { Listeners } from "./listeners.js";
import { Presses } from "./presses.js";

/** Properties of a control that an event changes. */
const AFTER = {
  pressed: () => ({ pressed: true }),
  released: () => ({ pressed: false }),
  cancelled: () => ({ pressed: false }),
  armed: () => ({ armed: true }),
  disarmed: () => ({ armed: false }),
  changed: ({ value }) => ({ value }),
};

/**
 * A floor over WebSocket: its controls, holds and feet as they are now, events, and requests. `index.d.ts` describes
 * its members.
 */
export class Floor {
  #link;
  #listeners = new Listeners();
  #presses = new Presses();
  #holds = new Holds((hold) => this.#listeners.tell("held", hold, hold.id));
  #controls = new Map();
  #misnamed = new Set();
  #state = { link: "no_connection", why: "connecting" };
  #info = { title: "", page: null, width_m: 0, depth_m: 0, tile_m: 0 };

  constructor(address) {
    this.contacts = [];
    this.unreadable = 0;
    this.url = address.includes("://") ? address : `ws://${address}/`;
    this.#link = new Link(this.url, (text) => this.#take(text), (why) => this.#lose("no_connection", why));
  }

  get link() { return this.#state.link; }
  get why() { return this.#state.why; }
  get title() { return this.#info.title; }
  get page() { return this.#info.page; }
  get width_m() { return this.#info.width_m; }
  get depth_m() { return this.#info.depth_m; }
  get tile_m() { return this.#info.tile_m; }
  get controls() { return this.#controls; }
  get held() { return this.#holds.now(); }

  isHeld(id) { return this.held.includes(id); }

  on(event, ...rest) {
    const [id, call] = rest.length > 1 ? rest : [null, rest[0]];
    const off = this.#listeners.add(event, id, call);
    this.#checkNames();
    return off;
  }

  whileHeld(id, begin) {
    const off = this.#holds.watch(id, begin);
    this.#checkNames();
    return off;
  }

  request(path, ...args) { return this.#link.send(JSON.stringify({ request: path, args })); }
  set(id, value) { return this.request(`widget/${id}/set`, ...[value].flat()); }
  setRange(id, least, greatest) { return this.request(`widget/${id}/range/set`, least, greatest); }
  setLabel(id, text) { return this.request(`widget/${id}/label`, text); }
  setIndicator(id, state) { return this.request(`widget/${id}/indicator`, state); }
  setEnabled(id, enabled) { return this.request(`widget/${id}/${enabled ? "enable" : "disable"}`); }
  setLocked(id, locked) { return this.request(`widget/${id}/${locked ? "lock" : "unlock"}`); }
  setPage(page) { return this.request("page/set", page); }
  cancel() { return this.request("cancel"); }

  close() {
    this.#link.close();
    this.#lose("closed", "this page has closed the connection");
  }

  #take(text) {
    const line = parsed(text);
    if (line === null) {
      this.unreadable += 1;
      return;
    }
    this.#listeners.tell("line", line);
    if (Array.isArray(line.held)) this.#holds.report(line.held);
    switch (line.event) {
      case "floor": return this.#greet(line);
      case "contacts":
        this.contacts = line.contacts;
        return this.#listeners.tell("contacts", line.contacts);
      case "link": return this.#say(line.state, line.state === "live" ? "" : this.why);
      case "link_cause": return this.#say(this.link, line.why);
      case "page":
        this.#info = { ...this.#info, page: line.page };
        return this.#listeners.tell("page", line.page);
      case "state": return this.#listeners.tell("state", this.#change(line.id, controlFields(line)), line.id);
      case "ignored": return this.#listeners.tell("ignored", line, line.id);
      case "error": return this.#refused(line);
      default:
        if (typeof line.id === "string" && "contact" in line) this.#act(line);
    }
  }

  #greet(line) {
    const { title, page, width_m, depth_m, tile_m, link, why, controls } = line;
    this.#info = { title, page, width_m, depth_m, tile_m };
    this.#controls = new Map(controls.map((control) => [control.id, control]));
    this.#checkNames();
    this.#listeners.tell("floor", this);
    this.#say(link, why ?? "");
  }

  #act(event) {
    this.#presses.take(event);
    this.#change(event.id, AFTER[event.event]?.(event));
    this.#listeners.tell(event.event, event, event.id);
  }

  #change(id, fields) {
    const control = { ...this.#controls.get(id), ...fields };
    if (this.#controls.has(id)) this.#controls.set(id, control);
    return control;
  }

  #say(link, why) {
    if (link === this.link && why === this.why) return;
    this.#state = { link, why };
    this.#listeners.tell("link", this.#state);
  }

  #lose(link, why) {
    this.contacts = [];
    this.#holds.end(link);
    for (const event of this.#presses.cancel()) this.#act(event);
    this.#listeners.tell("contacts", this.contacts);
    this.#say(link, why);
  }

  #refused({ request, why }) {
    if (this.#listeners.tell("error", { request, why }) === 0) console.warn(`underfoot: ${request}: ${why}`);
  }

  // A misspelt name would wait for a foot for ever.
  #checkNames() {
    if (this.#controls.size === 0) return;
    for (const id of [...this.#listeners.ids(), ...this.#holds.ids()]) {
      if (this.#controls.has(id) || this.#misnamed.has(id)) continue;
      this.#misnamed.add(id);
      console.warn(`underfoot: "${this.title}" has no control "${id}", only: ${[...this.#controls.keys()].join(", ")}`);
    }
  }
}

/** The lists that lines of these events have. */
const LISTS = { floor: "controls", contacts: "contacts" };

/** Returns the line in `text`; null for one that no floor sends. */
function parsed(text) {
  try {
    const line = JSON.parse(text);
    const isLine = typeof line === "object" && line !== null;
    return isLine && (!(line.event in LISTS) || Array.isArray(line[LISTS[line.event]])) ? line : null;
  } catch {
    return null;
  }
}

function controlFields({ event: _, t_s: __, ...fields }) {
  return fields;
}
