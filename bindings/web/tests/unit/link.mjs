import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { connect } from "../../src/index.js";
import { CONTROL, floor, GREETING, pass, press, sockets } from "../fake_socket.mjs";

let open, warned;
beforeEach(() => {
  warned = [];
  mock.method(console, "warn", (text) => warned.push(text));
});
afterEach(() => open?.floor.close());
const made = () => (open = floor());

test("attempts to connect come later and later, and early again after a line", () => {
  const { floor, socket } = made();
  const waits = [];
  let before = sockets.length, last = socket;
  for (let attempt = 0; attempt < 9; attempt++) {
    last.drop();
    let wait = 0;
    for (; sockets.length === before; wait++) pass(1);
    waits.push(wait);
    before = sockets.length;
    last = sockets.at(-1);
  }
  for (const [attempt, wait] of waits.entries()) {
    const longest = Math.min(250 * 2 ** attempt, 8000);
    assert.ok(wait >= longest / 2 && wait <= longest + 1, `attempt ${attempt} after ${wait} ms`);
  }
  assert.equal(floor.link, "no_connection");
  assert.match(floor.why, /no connection to ws:\/\/floor:1\//);
  last.say(GREETING);
  assert.deepEqual([floor.link, floor.why], ["live", ""]);
  last.drop();
  pass(251);
  assert.equal(sockets.length, before + 1);
});

test("a floor that says nothing for three seconds is lost, and its late lines count no more", () => {
  const { floor, socket } = made();
  const links = [];
  floor.on("link", ({ link, why }) => links.push([link, why]));
  floor.on("contacts", () => {});
  socket.say(press("pressed"), { event: "contacts", contacts: [{ id: 4 }] });
  for (let second = 0; second < 5; second++) {
    pass(1000);
    socket.say({ event: "contacts", contacts: [{ id: 4 }] });
  }
  assert.deepEqual([links, floor.contacts.length], [[], 1]);
  pass(3800);
  assert.equal(links[0][0], "no_connection");
  assert.match(links[0][1], /nothing has come .* for 3 s/);
  assert.deepEqual([floor.contacts, socket.isLeft], [[], true]);
  socket.say(press("pressed"));
  socket.drop();
  assert.deepEqual([floor.controls.get("beam").pressed, links.length], [false, 1]);
});

test("requests go out while there is a connection, and are never kept for later", () => {
  const { floor, socket } = made();
  assert.equal(floor.set("zoom", 0.5), true);
  assert.equal(floor.set("pan", [1, 2]), true);
  assert.equal(floor.setLocked("zoom", true), true);
  assert.deepEqual(socket.sent, [
    { request: "widget/zoom/set", args: [0.5] },
    { request: "widget/pan/set", args: [1, 2] },
    { request: "widget/zoom/lock", args: [] },
  ]);
  socket.drop();
  assert.equal(floor.set("zoom", 0.7), false);
  pass(300);
  sockets.at(-1).say(GREETING);
  assert.deepEqual(sockets.at(-1).sent, []);
});

test("a refusal goes to the app, or to the console", () => {
  const { floor, socket } = made();
  const refusal = { event: "error", request: "widget/zoom/set", why: "the control is locked" };
  socket.say(refusal);
  assert.deepEqual(warned, ["underfoot: widget/zoom/set: the control is locked"]);
  floor.on("error", ({ why }) => warned.push(why));
  socket.say(refusal);
  assert.deepEqual(warned.slice(1), ["the control is locked"]);
});

test("a control that the layout lacks is named once", () => {
  const { floor, socket } = made();
  floor.on("clicked", "baem", () => {});
  socket.say(GREETING);
  assert.deepEqual(warned, ['underfoot: "Test" has no control "baem", only: beam']);
});

test("controls follow lines, and what is not understood is counted or handed on", () => {
  const { floor, socket } = made();
  const lines = [];
  floor.on("line", ({ event }) => lines.push(event));
  const off = { event: "state", ...CONTROL, off: "disabled", off_text: "an app has switched it off" };
  socket.say(off, "{", "7", "null", { event: "floor" }, { event: "contacts", contacts: 4 }, { event: "tomorrow" }, { event: "changed", ...press("changed"), id: "nobody" });
  assert.deepEqual([floor.controls.get("beam").off, floor.controls.get("beam").kind], ["disabled", "dead_man"]);
  assert.deepEqual([floor.unreadable, lines], [5, ["state", "tomorrow", "changed"]]);
  assert.equal(floor.controls.size, 1);
});

test("an address that is none is refused at once", () => {
  assert.throws(() => connect("http://floor/"), SyntaxError);
});
