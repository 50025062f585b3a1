// The memory of the web edition while a foot moves for ten minutes: of the program, of the page's scripts, and of the
// process that shows the page.
//
//     node bindings/web/tests/memory.mjs CHROMIUM FOLDER [MINUTES]
//
// FOLDER is target/web, which `./dev web` makes.
import assert from "node:assert/strict";
import fs from "node:fs";
import { Edition, linkTo, script, serve, visitor } from "./edition/page.mjs";

const [chromium, folder, asked] = process.argv.slice(2);
const MINUTES = Number(asked ?? 10);

/// The greatest growth after the first two minutes, in megabytes: traces, plots and event lists are full by then.
const MOST_GROWTH_MB = 8;

const megabytes = (bytes) => Number((bytes / 1e6).toFixed(1));

/// In the page: keeps the program, for the size of its memory.
function keepProgram() {
  const { instantiateStreaming } = WebAssembly;
  WebAssembly.instantiateStreaming = async (...from) => {
    const made = await instantiateStreaming(...from);
    globalThis.program = made.instance;
    return made;
  };
}

/// The memory of a process that nothing else shares, in bytes.
function privateBytes(process) {
  const lines = fs.readFileSync(`/proc/${process}/smaps_rollup`, "utf8").split("\n");
  const of = (name) => Number(lines.find((line) => line.startsWith(`${name}:`))?.match(/\d+/)[0] ?? 0) * 1024;
  return of("Private_Clean") + of("Private_Dirty");
}

await script(async (results) => {
  const server = await serve(folder);
  const { browser } = await visitor(chromium);
  // A layout with a slider under all of the floor: the foot changes a value all the time, and rubs.
  const link = linkTo("wide.ron", `Layout(version: 1, title: "wide", regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "wide", kind: "slider", label: "Wide", at: (0.5, 2), size: (5, 2))])`);
  const edition = await Edition.open(browser, `http://127.0.0.1:${server.address().port}/?screen_report${link}`, keepProgram);
  const wire = await edition.page.createCDPSession();
  const ofBrowser = await browser.target().createCDPSession();
  await wire.send("Performance.enable");
  const { processInfo } = await ofBrowser.send("SystemInfo.getProcessInfo");
  const renderers = processInfo.filter(({ type }) => type === "renderer").map(({ id }) => id);
  const measured = async () => {
    await wire.send("HeapProfiler.collectGarbage");
    const { metrics } = await wire.send("Performance.getMetrics");
    const program = await edition.page.evaluate(() => program.exports.memory.buffer.byteLength);
    return {
      program_mb: megabytes(program),
      scripts_mb: megabytes(metrics.find(({ name }) => name === "JSHeapUsedSize").value),
      process_mb: megabytes(Math.max(...renderers.map(privateBytes))),
    };
  };
  const [x0, y0, x1, y1] = (await edition.widget("Wide")).seen;
  const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2];
  await edition.wait(1500);
  await edition.page.mouse.move(x, y);
  await edition.page.mouse.down();
  const begun = performance.now();
  const minutes = () => (performance.now() - begun) / 60000;
  const rows = [{ minute: 0, ...await measured() }];
  const frames = async () => (await edition.noted()).frames;
  const before = await frames();
  while (minutes() < MINUTES) {
    const t = minutes() * 60;
    await edition.page.mouse.move(x + 0.4 * (x1 - x0) * Math.sin(1.3 * t), y + 0.3 * (y1 - y0) * Math.sin(0.7 * t));
    await edition.wait(30);
    // A new step now and then.
    if (Math.floor(t / 7) > Math.floor((t - 0.04) / 7)) {
      await edition.page.mouse.up();
      await edition.wait(200);
      await edition.page.mouse.down();
    }
    if (minutes() >= rows.length) {
      rows.push({ minute: rows.length, ...await measured() });
      console.error(JSON.stringify(rows.at(-1)));
    }
  }
  const frames_per_s = Number((((await frames()) - before) / (minutes() * 60)).toFixed(1));
  await edition.page.mouse.up();
  assert.deepEqual(edition.errors, []);
  Object.assign(results, { frames_per_s, rows });
  const [settled, last] = [rows[Math.min(2, rows.length - 1)], rows.at(-1)];
  for (const part of ["program_mb", "scripts_mb", "process_mb"]) {
    assert.ok(last[part] - settled[part] <= MOST_GROWTH_MB, `${part} grows from ${settled[part]} to ${last[part]}`);
  }
});
