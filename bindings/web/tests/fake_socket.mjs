// A WebSocket without a network, and time that a test moves.
import { connect } from "../src/index.js";

let now = 0, number = 0;
const timers = new Map();
const later = (every) => (call, ms) => {
  timers.set(++number, { call, at: now + ms, every: every ? ms : null });
  return number;
};
performance.now = () => now;
globalThis.setTimeout = later(false);
globalThis.setInterval = later(true);
globalThis.clearTimeout = globalThis.clearInterval = (id) => timers.delete(id);

function runDue() {
  for (const [id, timer] of [...timers].filter(([, { at }]) => at <= now)) {
    if (timer.every === null) timers.delete(id);
    else timer.at = now + timer.every;
    timer.call();
  }
}

/** Moves time on by milliseconds. */
export function pass(ms) {
  for (let step = 0; step < ms; step++) {
    now += 1;
    runDue();
  }
}

/** Moves time on while the page is busy: no timer runs. */
export function stall(ms) {
  now += ms;
}

/** All sockets that were opened, the newest last. */
export const sockets = [];

globalThis.WebSocket = class {
  readyState = 0;
  sent = [];
  isLeft = false;

  constructor(url) {
    // As the real one.
    if (!URL.canParse(url) || !/^wss?:/.test(url)) throw new SyntaxError(`no URL of a WebSocket: ${url}`);
    this.url = url;
    sockets.push(this);
  }
  send(text) { this.sent.push(JSON.parse(text)); }
  close() { this.isLeft = true; }
  say(...lines) {
    this.readyState = 1;
    for (const line of lines) this.onmessage?.({ data: typeof line === "string" ? line : JSON.stringify(line) });
  }
  drop() {
    this.readyState = 3;
    this.onclose?.({});
  }
};

export const CONTROL = { id: "beam", kind: "dead_man", label: "Beam", value: null, off: null, pressed: false };
export const GREETING = { event: "floor", title: "Test", page: null, link: "live", controls: [CONTROL] };
export const press = (event, id = "beam") => ({ event, id, value: null, force_n: 150, x_m: 1, y_m: 1, contact: 4 });
export const holds = (...held) => ({ t_s: 1, held, sequence: 1 });

/** A floor that has greeted, its socket, and what happens to it. */
export function floor() {
  const floor = connect("floor:1");
  const socket = sockets.at(-1), told = [];
  socket.say(GREETING);
  floor.whileHeld("beam", () => {
    told.push("down");
    return (why) => told.push(why);
  });
  return { floor, socket, told };
}
