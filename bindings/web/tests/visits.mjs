// Visits in links: browsers and the program give the same events at the same milliseconds; feet are recorded, shared,
// scrubbed and taken over; a recording plays.
//
//     node bindings/web/tests/visits.mjs CHROMIUM FOLDER UNDERFOOT [SCREENSHOTS] [LAYOUT...]
//
// FOLDER is target/web, which `./dev web` makes. Without a LAYOUT, all shipped ones are visited.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import zlib from "node:zlib";
import { Edition, script, serve, visitor } from "./edition/page.mjs";

const [chromium, folder, underfoot, pictures, ...asked] = process.argv.slice(2);
Edition.pictures = pictures;
const run = (...options) => execFileSync(underfoot, options, { encoding: "utf8", maxBuffer: 1 << 28 });

const LAYOUTS = [
  "map", "first_steps", "museum_room", "radiology_reading", "fluoroscopy", "stage_cues", "rehab_steps", "ice_piano",
  "surgical", "dicom_viewer", "globe", "winter_walk", "pond", "all_controls",
];

/** Times within a millisecond, numbers within a ten-thousandth of one, all else equal. */
function alike(one, other, within = 1e-4) {
  if (typeof one === "number" && typeof other === "number") return Math.abs(one - other) <= within * Math.max(1, Math.abs(one));
  if (one === null || typeof one !== "object") return one === other;
  if (other === null || typeof other !== "object") return false;
  const names = new Set([...Object.keys(one), ...Object.keys(other)]);
  return [...names].every((name) => alike(one[name], other[name], name === "t_s" ? 0.001 + 1e-9 : within));
}

// The lines that the page has too.
const OTHERS = new Set(["page", "health", "link", "link_cause", "device", "mute", "state", "area", "crack", "gap", "contacts"]);
const isShared = (line) => line.event !== undefined && !OTHERS.has(line.event);

function assertAlike(name, expected, seen) {
  const differ = expected.findIndex((line, index) => !alike(line, seen[index]));
  if (differ >= 0) {
    assert.fail(`${name}: event ${differ} is ${JSON.stringify(expected[differ])}, and here ${JSON.stringify(seen[differ])}`);
  }
  assert.equal(seen.length, expected.length, `${name}: ${JSON.stringify(seen[expected.length])} is too much`);
}

await script(async (results) => {
  const server = await serve(folder);
  const home = `http://127.0.0.1:${server.address().port}/?screen_report`;
  const visitors = [await visitor(chromium), await visitor(chromium)];

  /** Opens a page that collects the events of its floor. */
  const open = (browser, link) => Edition.open(browser, home + link, () => {
    globalThis.lines = [];
    addEventListener("underfoot-event", ({ detail }) => lines.push(JSON.parse(detail)));
  });

  const eventsOf = (edition) => edition.page.evaluate(() => lines);

  /** Goes to the end of the visit as fast as the page simulates, and returns all events up to there. */
  async function played(edition) {
    await edition.goTo(1);
    // At the end it stands still.
    await edition.widget("Play", "Button", 2400);
    await edition.wait(200);
    return eventsOf(edition);
  }

  /** The events of the program's own simulation of the visit in `link`. */
  const simulated = (link) => run("session", link, "--json").trim().split("\n").map((line) => JSON.parse(line)).filter(isShared);

  /** Plays the visit to the end in one browser; what happens there is what happens in the program. Returns its events. */
  async function playVisit({ browser }, { layout, link, expected }) {
    const begun = performance.now();
    const edition = await open(browser, link);
    const lines = await played(edition);
    await edition.picture(`visit-${layout}`);
    assert.deepEqual(edition.errors, []);
    await edition.page.close();
    assertAlike(layout, expected, lines);
    const seconds = Math.round((performance.now() - begun) / 1000);
    results[layout] = { letters: link.length, events: expected.length, seconds };
    return lines;
  }

  const visits = (asked.length > 0 ? asked : LAYOUTS).map((layout) => {
    const link = run("share", layout, "--visit", "session").trim();
    return { layout, link, expected: simulated(link) };
  });
  // The first one in both browsers, and each of the others in the browser that is free.
  const both = visits.shift();
  const [one, other] = await Promise.all(visitors.map((visitor) => playVisit(visitor, both)));
  assert.deepEqual(one, other, `${both.layout}: two browsers`);
  await Promise.all(visitors.map(async (visitor) => {
    for (let next = visits.shift(); next !== undefined; next = visits.shift()) await playVisit(visitor, next);
  }));

  // Feet of a mouse, recorded in one browser and seen in another one.
  const [{ browser: first }, { browser: second }] = visitors;
  const maker = await open(first, run("share", "map").trim());
  await maker.wait(1500);
  await maker.click("REC");
  const press = async (edition, name, ms) => {
    const { x, y } = await edition.middle(name);
    await edition.page.mouse.move(x, y);
    await edition.wait(150);
    await edition.page.mouse.down();
    await edition.wait(ms);
    await edition.page.mouse.up();
    await edition.wait(400);
  };
  await press(maker, "Home", 500);
  const [x0, y0, x1, y1] = (await maker.widget("Zoom")).seen;
  await maker.page.mouse.move(x0 + 0.4 * (x1 - x0), y0 + 0.6 * (y1 - y0));
  await maker.page.mouse.down();
  await maker.wait(400);
  await maker.page.mouse.move(x0 + 0.7 * (x1 - x0), y0 + 0.6 * (y1 - y0), { steps: 30 });
  await maker.wait(400);
  await maker.page.mouse.up();
  await maker.wait(500);
  await maker.picture("visit-recording");
  await maker.page.keyboard.press("F9");
  await maker.click("Share this visit");
  const { text: link } = await maker.widget("Link");
  await maker.picture("visit-shared");
  await maker.click("Close");
  const done = await eventsOf(maker);
  const words = (lines) => lines.filter(({ event }) => !["changed", "ticked", "ignored"].includes(event)).map(({ event, id }) => `${event} ${id}`);
  assert.ok(words(done).includes("pressed home") && done.some(({ event, id }) => event === "changed" && id === "zoom"), words(done));

  const watcher = await open(second, link.slice(link.indexOf("#")));
  await watcher.widget("Take over");
  await watcher.wait(2500);
  await watcher.picture("visit-playing");
  const again = await played(watcher);
  assertAlike("a recorded visit", simulated(link), again);
  assert.deepEqual(words(again), words(done), "what was done is done again");

  // Scrubbed back, the same once more; then taken over.
  await watcher.page.evaluate(() => { lines.length = 0; });
  await watcher.goTo(0.8);
  await watcher.wait(1500);
  const some = await eventsOf(watcher);
  assert.deepEqual(some, again.slice(0, some.length), "the same events again");
  assert.ok(some.length > 0, "it went there");
  await watcher.picture("visit-scrubbed");
  await watcher.click("Take over");
  await watcher.widget("REC");
  assert.ok(!(await watcher.report()).widgets.some(({ name }) => name === "Time line"), "the time line is gone");
  await watcher.wait(500);
  await watcher.page.evaluate(() => { lines.length = 0; });
  await press(watcher, "Home", 500);
  assert.ok(words(await eventsOf(watcher)).includes("pressed home"), "the mouse is a foot");
  await watcher.picture("visit-taken-over");
  await watcher.choose("surgical");
  await watcher.says("surgical");
  for (const edition of [maker, watcher]) assert.deepEqual(edition.errors, []);
  results.recorded = { letters: link.length, events: again.length };

  // Visits that cannot be played.
  const good = link.slice(link.indexOf("#"));
  const shared = JSON.parse(zlib.inflateSync(Buffer.from(good.slice(3), "base64url")));
  const packed = (visit) => `#1.${zlib.deflateSync(JSON.stringify({ ...shared, visit })).toString("base64url")}`;
  const { visit } = shared;
  for (const [bad, says] of [
    [good.slice(0, -40), "damaged"],
    [packed({ ...visit, feet: visit.feet.slice(0, 90) }), "feet are damaged"],
    [packed({ ...visit, feet: "AAAA" }), "feet are damaged"],
    [packed({ ...visit, quality: "golden" }), "golden"],
    [packed({ ...visit, seed: -1 }), "damaged"],
  ]) {
    const page = await Edition.open(first, home + bad);
    await page.says("cannot be shown");
    await page.says(says);
    assert.deepEqual(page.errors, []);
    await page.page.close();
  }
  results.bad_visits = "a message each";

  // A recording that is dropped on the page plays on the time line; a damaged one as far as it can be read.
  const files = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-visits-"));
  const at = (name) => path.join(files, name);
  const recorded = run("session", "map", "--json", "--record", at("walk.mcap")).trim().split("\n").map((line) => JSON.parse(line)).filter(isShared);
  const bytes = fs.readFileSync(at("walk.mcap"));
  fs.writeFileSync(at("cut.mcap"), bytes.subarray(0, bytes.length * 0.6));
  fs.writeFileSync(at("text.mcap"), "not a recording");
  fs.writeFileSync(at("plain.ron"), "Layout(version: 1, title: \"plain\")");
  const cinema = await open(first, run("share", "first_steps").trim());
  await cinema.drop(at("text.mcap"));
  await cinema.says("text.mcap is not opened");
  await cinema.drop(at("walk.mcap"));
  await cinema.widget("Time line");
  await cinema.page.evaluate(() => { lines.length = 0; });
  const replayed = await played(cinema);
  await cinema.picture("recording");
  assertAlike("a recording", recorded.slice(recorded.length - replayed.length), replayed);
  assert.ok(replayed.length > 0.8 * recorded.length, `${replayed.length} of ${recorded.length}`);
  await cinema.drop(at("plain.ron"));
  await cinema.says("load the page without a link");
  await cinema.drop(at("cut.mcap"));
  await cinema.says("The recording breaks off");
  await cinema.picture("recording-cut");
  await played(cinema);
  assert.deepEqual(cinema.errors, []);
  fs.rmSync(files, { recursive: true });
  results.recording = { events: replayed.length, megabytes: Number((bytes.length / 1e6).toFixed(1)) };

});
