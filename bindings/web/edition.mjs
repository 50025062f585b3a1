// The web edition in headless Chromium, with real mouse, touch and keys: a press, two feet on two sliders, controls built
// in Design, a link opened by another visitor, bad links, a visit without a network.
//
//     node edition.mjs CHROMIUM FOLDER [SCREENSHOTS]
//
// FOLDER is target/web, which `./dev web` makes. Widgets are found by their names in the reports of the window.
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import puppeteer from "puppeteer-core";

const [executablePath, folder, pictures] = process.argv.slice(2);
const TYPES = { html: "text/html", js: "text/javascript", css: "text/css", wasm: "application/wasm" };

/// Static files, as any host serves them.
function serve() {
  const server = http.createServer((request, response) => {
    const name = new URL(request.url, "http://x").pathname.replace(/\/$/, "/index.html");
    const file = path.join(folder, path.normalize(name));
    if (!fs.existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[file.split(".").pop()] ?? "text/plain" });
    fs.createReadStream(file).pipe(response);
  });
  return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(server)));
}

const ARGS = [
  "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/// A browser of a visitor's own, with nothing stored.
async function visitor() {
  const userDataDir = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-visitor-"));
  const browser = await puppeteer.launch({ executablePath, args: ARGS, headless: true, userDataDir });
  return { browser, end: async () => { await browser.close(); fs.rmSync(userDataDir, { recursive: true, force: true }); } };
}

/// A page of the web edition.
class Edition {
  static async open(browser, address) {
    const page = await browser.newPage();
    const edition = new Edition(page);
    await page.setViewport({ width: 1280, height: 800, hasTouch: true });
    page.on("pageerror", (error) => edition.errors.push(String(error)));
    page.on("console", (line) => { if (line.type() === "error") edition.errors.push(line.text()); });
    page.on("request", (request) => edition.requests.push(request.url()));
    const begun = performance.now();
    await page.goto(address);
    await edition.widget("Floor");
    edition.first_s = (performance.now() - begun) / 1000;
    return edition;
  }

  constructor(page) {
    this.page = page;
    this.errors = [];
    this.requests = [];
  }

  async report() {
    const text = await this.page.evaluate(() => globalThis.underfootScreen ?? "null");
    return JSON.parse(text);
  }

  /// The widget called `name` once it is on the screen; its places are in points of the page.
  async widget(name, role) {
    const fits = (widget) => widget.name === name && (!role || widget.role === role) && widget.seen;
    for (let turn = 0; turn < 300; turn += 1) {
      const found = (await this.report())?.widgets.find(fits);
      if (found) return found;
      await this.wait(50);
    }
    const names = (await this.report())?.widgets.map((widget) => widget.name);
    throw new Error(`there is no ${name}, but ${names?.join(", ")}; ${this.errors}`);
  }

  async says(part) {
    for (let turn = 0; turn < 200; turn += 1) {
      const report = await this.report();
      const text = report?.widgets.find((widget) => `${widget.name} ${widget.text ?? ""}`.includes(part));
      if (text) return text;
      await this.wait(50);
    }
    throw new Error(`nothing says ${part}: ${(await this.report())?.widgets.map((widget) => widget.name).join(" | ")}`);
  }

  wait(ms) {
    return new Promise((resolve) => setTimeout(resolve, ms));
  }

  async middle(name, role) {
    const [x0, y0, x1, y1] = (await this.widget(name, role)).seen;
    return { x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
  }

  async click(name, role) {
    const { x, y } = await this.middle(name, role);
    await this.page.mouse.move(x, y);
    await this.wait(120);
    await this.page.mouse.click(x, y, { delay: 120 });
    await this.wait(200);
  }

  async choose(layout) {
    await this.click("Layout", "ComboBox");
    await this.click(layout, "Button");
    await this.wait(300);
  }

  async picture(name) {
    if (pictures) await this.page.screenshot({ path: path.join(pictures, `${name}.png`) });
  }
}

const server = await serve();
const home = `http://127.0.0.1:${server.address().port}/?screen_report`;
const results = {};
const { browser, end } = await visitor();
const edition = await Edition.open(browser, home);
results.first_frame_s = Number(edition.first_s.toFixed(2));
await edition.wait(500);
await edition.picture("1-first");

// A press with the mouse.
await edition.choose("map");
const at = await edition.middle("Home");
await edition.page.mouse.move(at.x, at.y);
await edition.wait(200);
await edition.page.mouse.down();
await edition.says("home");
await edition.wait(400);
await edition.picture("2-pressed");
await edition.page.mouse.up();
results.pressed = "home";

// Frames while a foot moves.
const frames = async () => (await edition.report()).frame;
const [before, begun] = [await frames(), performance.now()];
for (let step = 0; step < 120; step += 1) {
  await edition.page.mouse.move(at.x + 60 * Math.sin(step / 8), at.y + 40 * Math.cos(step / 8));
  await edition.wait(16);
}
results.frames_per_s = Number(((await frames()) - before) / ((performance.now() - begun) / 1000)).toFixed(1);

// Two fingers are two feet on two controls.
await edition.choose("all_controls");
await edition.wait(300);
await edition.picture("2b-all-controls");
const wire = await edition.page.createCDPSession();
const names = (await edition.report()).widgets.filter((widget) => widget.role === "Slider" && widget.seen);
results.sliders = names.map((widget) => widget.name);
const middles = names.slice(0, 2).map(({ seen: [x0, y0, x1, y1] }) => ({ x: (x0 + x1) / 2, y: (y0 + y1) / 2 }));
const touch = (type, points) => wire.send("Input.dispatchTouchEvent", { type, touchPoints: points });
await touch("touchStart", middles.map((at, id) => ({ ...at, id })));
for (let step = 0; step <= 20; step += 1) {
  await touch("touchMove", middles.map((at, id) => ({ x: at.x + step, y: at.y + step, id })));
  await edition.wait(30);
}
await edition.picture("2c-two-fingers");
await touch("touchEnd", []);

// Three controls built in Design, on an empty floor.
await edition.click("Design");
await edition.click("File");
await edition.click("New");
await edition.click("Empty floor");
await edition.wait(300);
for (const [thing, dx, dy] of [["button", -120, 90], ["slider", 30, 0], ["switch", 130, -110]]) {
  // The list is longer than the window: it is found by its name.
  await edition.click("Search things");
  await edition.page.keyboard.down("Control");
  await edition.page.keyboard.press("a");
  await edition.page.keyboard.up("Control");
  await edition.page.keyboard.type(thing);
  await edition.wait(200);
  const [from, board] = [await edition.middle(`Put down: ${thing}`), await edition.middle("Drawing board")];
  await edition.page.mouse.move(from.x, from.y);
  await edition.page.mouse.down();
  await edition.page.mouse.move(board.x + dx, board.y + dy, { steps: 12 });
  await edition.wait(200);
  await edition.page.mouse.up();
  await edition.wait(300);
}
await edition.picture("3-design");

// Share, and open the link in another browser.
await edition.click("Share");
const field = await edition.widget("Link");
const link = field.text;
await edition.wait(300);
await edition.picture("4-share");
assert.match(link, /#1\./, "the field holds the link");
await edition.click("Close");
results.link_letters = link.length;

const other = await visitor();
const opened = await Edition.open(other.browser, link);
await opened.wait(500);
await opened.picture("5-opened");
await opened.click("Share");
assert.equal((await opened.widget("Link")).text, link, "the same layout, to the byte");
results.same_link = true;
await opened.click("Close");

// Bad links.
for (const bad of ["#1.nonsense", link.slice(link.indexOf("#")).slice(0, -12), "#9.abc", "#top"]) {
  const page = await Edition.open(other.browser, `${home.split("?")[0]}?screen_report${bad}`);
  await page.says("cannot be shown");
  if (bad === "#1.nonsense") await page.picture("6-bad-link");
  assert.deepEqual(page.errors, []);
  await page.page.close();
}
results.bad_links = "a message each";

// Without a network.
await edition.page.waitForFunction(() => navigator.serviceWorker.controller !== null);
await new Promise((resolve) => { server.closeAllConnections(); server.close(resolve); });
await edition.page.reload();
await edition.widget("Floor");
results.offline = true;
await edition.picture("7-offline");

const foreign = [...edition.requests, ...opened.requests].filter((url) => !url.startsWith("http://127.0.0.1") && !url.startsWith("data:") && !url.startsWith("blob:"));
assert.deepEqual(foreign, [], "requests to other hosts");
assert.deepEqual(edition.errors, []);
await other.end();
await end();
console.log(JSON.stringify(results));
