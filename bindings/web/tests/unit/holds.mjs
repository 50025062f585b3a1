import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import { floor, GREETING, holds, pass, press, sockets, stall } from "../fake_socket.mjs";

let open;
const made = () => (open = floor());
afterEach(() => open.floor.close());

test("a foot goes down and lifts", () => {
  const { floor, socket, told } = made();
  for (let report = 0; report < 20; report++) {
    socket.say(holds("beam"));
    pass(20);
  }
  assert.deepEqual([floor.held, floor.isHeld("beam"), told], [["beam"], true, ["down"]]);
  socket.say(holds());
  assert.deepEqual([floor.held, told], [[], ["down", "released"]]);
});

test("no report for 100 ms ends a hold, and the next one begins another", () => {
  const { floor, socket, told } = made();
  socket.say(holds("beam"));
  pass(99);
  assert.deepEqual(told, ["down"]);
  // Other lines are no reports.
  socket.say({ event: "contacts", contacts: [] });
  pass(1);
  assert.deepEqual([told, floor.isHeld("beam")], [["down", "silence"], false]);
  socket.say(holds("beam"));
  assert.deepEqual(told, ["down", "silence", "down"]);
});

test("a page that was busy first reads the reports that have come meanwhile", () => {
  const { floor, socket, told } = made();
  socket.say(holds("beam"));
  for (let drawing = 0; drawing < 5; drawing++) {
    stall(400);
    assert.equal(floor.isHeld("beam"), false, "it has not read them yet");
    pass(1);
    socket.say(holds("beam"));
    assert.deepEqual([floor.isHeld("beam"), told], [true, ["down"]]);
  }
  stall(400);
  pass(19);
  assert.deepEqual(told, ["down"]);
  pass(2);
  assert.deepEqual(told, ["down", "silence"]);
});

test("a hidden page, whose timers are late, ends a hold that was not reported meanwhile", () => {
  const { socket, told } = made();
  globalThis.document = { hidden: true };
  socket.say(holds("beam"));
  stall(150);
  socket.say(holds("beam"));
  stall(900);
  pass(1);
  delete globalThis.document;
  assert.deepEqual(told, ["down", "silence", "down", "silence"]);
});

test("a lost connection ends holds and presses at once, once", () => {
  const { floor, socket, told } = made();
  const ends = [];
  for (const end of ["released", "cancelled"]) floor.on(end, "beam", ({ event, contact }) => ends.push([event, contact]));
  socket.say(press("pressed"), holds("beam"));
  assert.equal(floor.controls.get("beam").pressed, true);
  socket.drop();
  assert.deepEqual([told, ends], [["down", "no_connection"], [["cancelled", null]]]);
  assert.equal(floor.controls.get("beam").pressed, false);
  pass(5000);
  sockets.at(-1).drop();
  assert.deepEqual([told.length, ends.length], [2, 1]);
});

test("a closed floor ends holds and comes back no more", () => {
  const { floor, socket, told } = made();
  const before = sockets.length;
  socket.say(press("pressed"), holds("beam"));
  floor.close();
  assert.deepEqual([told, floor.link, socket.isLeft], [["down", "closed"], "closed", true]);
  pass(20000);
  socket.drop();
  pass(20000);
  assert.equal(sockets.length, before);
});

test("an app that closes a lost floor is left alone", () => {
  const { floor, socket } = made();
  floor.on("link", () => floor.close());
  const before = sockets.length;
  socket.drop();
  pass(20000);
  assert.deepEqual([sockets.length, floor.link], [before, "closed"]);
});

test("an exception of the app neither stops the end of a hold nor other functions", () => {
  const { floor, socket, told } = made();
  const reported = [];
  globalThis.reportError = (error) => reported.push(error.message);
  floor.whileHeld("beam", () => { throw new Error("begin"); });
  floor.on("held", () => { throw new Error("held"); });
  floor.on("line", () => { throw new Error("line"); });
  socket.say(holds("beam"), holds());
  delete globalThis.reportError;
  assert.deepEqual(told, ["down", "released"]);
  assert.deepEqual(reported, ["line", "begin", "held", "line", "held"]);
});

test("a watch begins during a hold, and its end is the hold's", () => {
  const { floor, socket } = made();
  const told = [];
  socket.say(holds("beam"));
  const off = floor.whileHeld("beam", () => (why) => told.push(why));
  off();
  off();
  socket.say(holds());
  // One that ends itself.
  const once = floor.whileHeld("beam", () => {
    once();
    return (why) => told.push(`self ${why}`);
  });
  socket.say(holds("beam"), holds());
  assert.deepEqual(told, ["unwatched", "self unwatched"]);
});

test("each of several held controls ends by itself", () => {
  const { floor, socket } = made();
  const told = [];
  floor.on("held", ({ id, held }) => told.push([id, held, floor.held.join()]));
  socket.say({ ...GREETING, controls: [{ id: "beam" }, { id: "pump" }] }, holds("beam", "pump"), holds("pump"), holds());
  assert.deepEqual(told, [["beam", true, "beam"], ["pump", true, "beam,pump"], ["beam", false, "pump"], ["pump", false, ""]]);
});
