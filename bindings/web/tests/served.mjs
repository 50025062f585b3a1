// The web edition served by a floor, in headless Chromium: feet and events by UDP, the delay from a packet to the picture,
// a server that is killed and comes back, a design put on the floor, the plain page, a name over plain HTTP.
//
//     node bindings/web/tests/served.mjs CHROMIUM UNDERFOOT [SCREENSHOTS]
//
// UNDERFOOT is the program with the feature web-edition.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { resolve } from "node:path";
import { WebSocket } from "ws";
import { Boards, nowMs } from "./edition/boards.mjs";
import { Edition, atEnd, script, visitor } from "./edition/page.mjs";
import { freeAddress, until } from "./harness.mjs";

const [chromium, underfoot] = process.argv.slice(2);

/// The greatest time in milliseconds for which a page may show a hold after its server was killed, and the number of
/// rounds on a machine that may be busy: one of them has to keep it.
const SOON_MS = 150;
const ROUNDS = 6;

/// Number of steps whose delay is measured.
const STEPS = 40;

/// A name of this machine for which browsers withhold what they give to pages over https.
const NAME = "floor.test";

const [web, boardsAt] = [await freeAddress(), await freeAddress()];
const named = `${NAME}:${web.split(":")[1]}`;

/// `underfoot run` with the map, once it listens.
async function serve() {
  const options = ["run", "map", "--listen", boardsAt, "--web", web, "--web-layouts", "--no-osc", "--sound", "off"];
  const floor = spawn(resolve(underfoot), [...options, "--web-origin", `http://${named}`], { stdio: "ignore" });
  await until("the floor", () => fetch(`http://${web}/health`).then(() => true, () => false));
  return floor;
}

async function kill(floor) {
  const at = nowMs();
  floor.kill("SIGKILL");
  await once(floor, "exit");
  return at;
}

/// In the page: notes the mean colour of a square of its canvas in each frame in which that differs, and the times at
/// which a control is shown as pressed and as released.
function watch(x, y, name) {
  const canvas = document.getElementById("window");
  const gl = canvas.getContext("webgl2");
  const size = 16;
  const pixels = new Uint8Array(4 * size * size);
  const [seen, shown] = [[], []];
  globalThis.watched = { seen, shown };
  const channel = new MessageChannel();
  let report = "";
  channel.port1.onmessage = () => {
    gl.readPixels(x - size / 2, canvas.height - y - size / 2, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const at = performance.timeOrigin + performance.now();
    const colour = [0, 0, 0];
    pixels.forEach((value, place) => { if (place % 4 < 3) colour[place % 4] += value / size / size; });
    if (seen.length === 0 || colour.some((value, part) => Math.abs(value - seen.at(-1).colour[part]) > 0.5)) {
      seen.push({ at, colour });
    }
    if (report === globalThis.underfootScreen) return;
    report = globalThis.underfootScreen;
    const control = JSON.parse(report).widgets.find((widget) => widget.name === name && widget.role === "Button");
    const isPressed = control?.is_on === true;
    if (shown.at(-1)?.isPressed !== isPressed) shown.push({ at, isPressed });
  };
  // After the drawing of the frame.
  const each = () => { channel.port2.postMessage(0); requestAnimationFrame(each); };
  each();
}

const watched = (edition) => edition.page.evaluate(() => globalThis.watched);

/// The time at which the page shows the control as pressed or released, after `since`.
function shownAt(edition, isPressed, since) {
  return until(`pressed: ${isPressed}`, async () => {
    const { shown } = await watched(edition);
    return shown.find((state) => state.at > since && state.isPressed === isPressed)?.at;
  });
}

/// Percentiles of some delays.
function spread(delays) {
  const sorted = delays.toSorted((one, other) => one - other);
  const at = (share) => Math.round(sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))]);
  return { median_ms: at(0.5), of_95_percent_ms: at(0.95), steps: sorted.length };
}

await script(async (results) => {
  let floor = await serve();
  atEnd(() => { if (floor.exitCode === null && floor.signalCode === null) return kill(floor); });
  const boards = await Boards.start(boardsAt);
  atEnd(() => boards.end());
  const { browser } = await visitor(chromium, `--host-resolver-rules=MAP ${NAME} 127.0.0.1`);
  const edition = await Edition.open(browser, `http://${web}/?screen_report`);
  results.first_frame_s = Number(edition.first_s.toFixed(2));
  // The tare of an empty floor.
  await edition.wait(2500);
  await edition.picture("1-joined");
  const home = await edition.middle("Home", "Button");
  await edition.page.evaluate(watch, Math.round(home.x), Math.round(home.y), "Home");

  // A foot by UDP.
  let stepped = await boards.step(0, 2, 150);
  await shownAt(edition, true, stepped);
  await edition.says("pressed");
  await edition.wait(300);
  await edition.picture("2-pressed");
  stepped = await boards.step(0, 2, 0);
  await shownAt(edition, false, stepped);
  await edition.says("clicked");

  // The delay from the first packet of a foot to the picture of it.
  const delays = [];
  for (let step = 0; step < STEPS; step += 1) {
    await edition.wait(900 + 100 * Math.random());
    const rest = (await watched(edition)).seen.at(-1);
    stepped = await boards.step(0, 2, 150);
    const differs = ({ at, colour }) =>
      at > stepped && colour.some((value, part) => Math.abs(value - rest.colour[part]) > 3);
    delays.push(await until("a picture", async () => {
      const picture = (await watched(edition)).seen.find(differs);
      return picture && picture.at - stepped;
    }));
    await edition.wait(300);
    await boards.step(0, 2, 0);
  }
  results.delay = spread(delays);

  // Killed with a foot on a control; and back.
  const released = [];
  while (released.length < ROUNDS && !(Math.min(...released) <= SOON_MS)) {
    await edition.wait(1000);
    stepped = await boards.step(0, 2, 150);
    await shownAt(edition, true, stepped);
    await edition.wait(400);
    const killed = await kill(floor);
    released.push(Math.round(await shownAt(edition, false, killed) - killed));
    await edition.says("trying again");
    if (released.length === 1) await edition.picture("3-killed");
    await boards.step(0, 2, 0);
    floor = await serve();
    await until("the page joins again", async () => {
      const said = (await edition.report()).widgets.map((widget) => `${widget.name} ${widget.text ?? ""}`);
      return !said.some((text) => text.includes("trying again"));
    });
    await edition.wait(1500);
  }
  results.released_ms = released;
  assert.ok(Math.min(...released) <= SOON_MS, `released after ${released} ms`);

  // A design of the page on the floor.
  const lines = new WebSocket(`ws://${web}/`);
  const layouts = [];
  lines.on("message", (text) => {
    const line = JSON.parse(text);
    if (line.event === "floor") layouts.push(line.controls.map((control) => control.id));
  });
  await until("the layout", () => layouts.length === 1);
  assert.ok(layouts[0].includes("home"));
  await edition.click("Design");
  await edition.click("File");
  await edition.click("New");
  await edition.click("Empty floor");
  await edition.wait(500);
  assert.equal(layouts.length, 1, "the floor keeps its layout until the user puts another there");
  await edition.picture("4-design");
  await edition.click("Put on the floor");
  await until("another layout", () => layouts.length === 2);
  assert.deepEqual(layouts[1], []);
  lines.close();
  results.put = "an empty layout";

  // Over plain HTTP from another computer: everything but what browsers withhold, which the page names.
  const away = await Edition.open(browser, `http://${named}/?screen_report`);
  assert.equal(await away.page.evaluate(() => isSecureContext), false);
  await away.says("Over http");
  await away.picture("5-over-http");
  const problems = away.errors.filter((text) => !text.includes("Cross-Origin-Opener-Policy"));
  assert.deepEqual(problems, []);
  await away.page.close();

  // The plain page, without an inline script.
  const plain = await browser.newPage();
  const wrong = [];
  plain.on("pageerror", (error) => wrong.push(String(error)));
  plain.on("console", (line) => { if (line.type() === "error") wrong.push(line.text()); });
  await plain.goto(`http://${web}/plain`);
  await plain.waitForFunction(() => document.getElementById("state").textContent.includes("live"));
  assert.deepEqual(wrong, []);
  await plain.close();

  const foreign = edition.requests.filter((url) => !url.startsWith(`http://${web}/`) && !/^(data|blob):/.test(url));
  assert.deepEqual(foreign, [], "requests to other hosts");
  // While the server was killed, the browser names each failed connection.
  const errors = edition.errors.filter((text) => !text.includes("WebSocket connection"));
  assert.deepEqual(errors, []);
});
