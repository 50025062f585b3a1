// A visitor's browser with the web edition, for its tests.
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import zlib from "node:zlib";
import puppeteer from "puppeteer-core";

const TYPES = { html: "text/html", js: "text/javascript", css: "text/css", wasm: "application/wasm" };

/// The answers of a host of static files to requests for those of `folder`.
export function answerFrom(folder) {
  return (request, response) => {
    const name = new URL(request.url, "http://x").pathname.replace(/\/$/, "/index.html");
    const file = path.join(folder, path.normalize(name));
    if (!fs.existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[file.split(".").pop()] ?? "text/plain" });
    fs.createReadStream(file).pipe(response);
  };
}

/// Static files, as any host serves them, until the script ends; at any free port unless one is given.
export function serve(folder, answer = answerFrom(folder), port = 0) {
  const server = http.createServer(answer);
  atEnd(() => stop(server));
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve(server)));
}

/// Ends a server and its connections; one that has ended stays so.
export function stop(server) {
  server.closeAllConnections();
  return new Promise((resolve) => server.close(resolve));
}

/// What ends all that the script has opened, the last first.
const ends = [];

/// Calls `end` when the script ends, if its tests fail, too.
export function atEnd(end) {
  ends.push(end);
}

/// Runs the tests of a script, which note their results in the object that they get; prints those, and ends the script.
export async function script(tests) {
  const results = {};
  const failure = await tests(results).then(() => null, (error) => ({ error }));
  for (const end of ends.reverse()) await end();
  if (failure) console.error(JSON.stringify(results), failure.error);
  else console.log(JSON.stringify(results));
  process.exit(failure ? 1 : 0);
}

const ARGS = [
  "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/// The part of a link that opens a layout with this name and text.
export function linkTo(name, text) {
  return `#1.${zlib.deflateSync(JSON.stringify({ name, text })).toString("base64url")}`;
}

/// A browser of a visitor's own, with nothing stored, and with further flags. It ends with the script, or before by `end`.
export async function visitor(executablePath, ...flags) {
  const userDataDir = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-visitor-"));
  const browser = await puppeteer.launch({ executablePath, args: [...ARGS, ...flags], headless: true, userDataDir });
  const end = async () => { await browser.close(); fs.rmSync(userDataDir, { recursive: true, force: true }); };
  atEnd(end);
  return { browser, end };
}

/// In the page: notes what the loudspeakers get, how often the phone buzzes, and the frames that are drawn.
function listen() {
  globalThis.noted = { loudest: 0, buzzes: 0, frames: 0 };
  const { connect } = AudioNode.prototype;
  AudioNode.prototype.connect = function (to, ...rest) {
    if (this instanceof AudioWorkletNode && to === this.context.destination) {
      const ear = new AnalyserNode(this.context, { fftSize: 2048 });
      const samples = new Float32Array(ear.fftSize);
      connect.call(this, ear);
      setInterval(() => {
        ear.getFloatTimeDomainData(samples);
        for (const sample of samples) noted.loudest = Math.max(noted.loudest, Math.abs(sample));
      }, 10);
    }
    return connect.call(this, to, ...rest);
  };
  navigator.vibrate = () => { noted.buzzes += 1; return true; };
  // The window sets this colour once a frame.
  const { clearColor } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.clearColor = function (...parts) {
    noted.frames += 1;
    return clearColor.apply(this, parts);
  };
}

/// A page of the web edition.
export class Edition {
  /** The folder for screenshots, if they are wanted. */
  static pictures = process.argv[4];

  /** Opens the page; `before` runs in it before its own scripts. `screen` has the viewport of puppeteer. */
  static async open(browser, address, before = () => {}, screen = { width: 1280, height: 800, hasTouch: true }) {
    const page = await browser.newPage();
    await page.evaluateOnNewDocument(listen);
    await page.evaluateOnNewDocument(before);
    const edition = new Edition(page);
    await page.setViewport(screen);
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
  async widget(name, role, turns = 300) {
    const fits = (widget) => widget.name === name && (!role || widget.role === role) && widget.seen;
    for (let turn = 0; turn < turns; turn += 1) {
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

  /// Clicks on the time line at this share of its length.
  async goTo(share) {
    const [x0, y0, x1, y1] = (await this.widget("Time line")).seen;
    const x = x0 + 8 + share * (x1 - x0 - 16);
    await this.page.mouse.move(x, (y0 + y1) / 2);
    await this.wait(60);
    await this.page.mouse.click(x, (y0 + y1) / 2, { delay: 60 });
  }

  /// Presses `key` with Control.
  async control(key) {
    await this.page.keyboard.down("Control");
    await this.page.keyboard.press(key);
    await this.page.keyboard.up("Control");
    await this.wait(200);
  }

  /// Drops files or folders of the computer onto the floor, as a file manager does.
  async drop(...files) {
    const wire = await this.page.createCDPSession();
    const { x, y } = await this.middle("Floor");
    const data = { items: [], files, dragOperationsMask: 1 };
    for (const type of ["dragEnter", "dragOver", "drop"]) {
      await wire.send("Input.dispatchDragEvent", { type, x, y, data });
      await this.wait(50);
    }
  }

  /// The text that the storage of the browser has under `name`.
  stored(name) {
    return this.page.evaluate((key) => localStorage.getItem(key), `underfoot:${name}`);
  }

  noted() {
    return this.page.evaluate(() => ({ ...noted }));
  }

  async choose(layout) {
    const isOpen = (await this.report()).widgets.some((widget) => widget.name === layout && widget.role === "Button");
    if (!isOpen) await this.click("Layout", "ComboBox");
    await this.click(layout, "Button");
    await this.wait(300);
  }

  async picture(name) {
    const folder = Edition.pictures;
    if (!folder) return;
    fs.mkdirSync(folder, { recursive: true });
    await this.page.screenshot({ path: path.join(folder, `${name}.png`) });
  }
}
