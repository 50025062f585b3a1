// Files and folders that are damaged in any way, dropped on the web edition: it opens them, or says why not, keeps nothing
// that cannot be read, and goes on.
//
//     node bindings/web/tests/drops.mjs CHROMIUM FOLDER UNDERFOOT [CASES] [SEED]
//
// FOLDER is target/web, which `./dev web` makes. Of CASES, 300 if not given, two in five are recordings, the others
// layouts and folders. They are dropped by the scripts of the page. SHOWS_MESSAGES in the environment prints messages.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Edition, script, serve, visitor } from "./edition/page.mjs";
import { root } from "./harness.mjs";

const [chromium, folder, underfoot, cases = "300", seed = "1"] = process.argv.slice(2);

/// Time in milliseconds within which the page has answered a drop, on a machine that pauses it for something else too.
const SOON_MS = 60000;

/// Cases of one turn of the script in the page.
const TURN = 50;

const SCRIPT = fs.readFileSync(path.join(root, "bindings/web/tests/edition/drop_cases.js"), "utf8");

/// A recording of a foot that presses one control, in base64.
function shortRecording() {
  const made = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-drops-"));
  const [scenario, recording] = ["short.ron", "walk.mcap"].map((name) => path.join(made, name));
  fs.writeFileSync(scenario, `Scenario(title: "short", person: (mass_kg: 74), steps: [Enter(from: South, at: (1.4, 0.5)), Press(widget: "home"), Wait(ms: 200)])`);
  execFileSync(underfoot, ["session", "map", "--scenario", scenario, "--json", "--record", recording], { maxBuffer: 1 << 28 });
  const letters = fs.readFileSync(recording).toString("base64");
  fs.rmSync(made, { recursive: true });
  return letters;
}

/// The layouts, kinds and effects that come with underfoot.
function shippedTexts() {
  const inFolder = (kind) => {
    const names = fs.readdirSync(path.join(root, kind)).filter((name) => name.endsWith(".ron"));
    return names.map((name) => fs.readFileSync(path.join(root, kind, name), "utf8"));
  };
  return ["layouts", "widgets", "effects"].flatMap(inFolder);
}

/// Drops a file of this computer, with a name of its own.
async function dropText(edition, name, text) {
  const made = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-drops-"));
  fs.writeFileSync(path.join(made, name), text);
  await edition.drop(path.join(made, name));
  await edition.wait(500);
  fs.rmSync(made, { recursive: true });
}

const layout = (label) => `Layout(version: 1, title: "last", regions: [(id: "all", at: (0, 0), size: (6, 6))],
  widgets: [(id: "one", kind: "button", label: "${label}", at: (2, 2), size: (1, 1))])`;

/// A broken kind, effect or layout that is dropped alone says where, is not kept, and leaves later layouts alone.
async function tryBrokenAlone(edition) {
  const broken = [["alone.ron", "widgets/alone.ron", `Kind(name: "alone", from: "button",\n  look: (`],
    ["beat.ron", "effects/beat.ron", `Effect(name: "beat",\n  plays: Click(level_n: `],
    ["page.ron", "page.ron", `Layout(version: 1,\n  widgets: [(`]];
  for (const [name, place, text] of broken) {
    await dropText(edition, name, text);
    await edition.says(`${place} is not opened`);
    await edition.says(`${place}:2:`);
    assert.equal(await edition.stored(place), null, `${place} is not kept`);
    await dropText(edition, "good.ron", layout(`After ${name}`));
    await edition.widget(`After ${name}`);
  }
  // The last good kind of that name stays.
  const good = `Kind(name: "alone", from: "button")`;
  await dropText(edition, "alone.ron", good);
  await edition.says("1 kind or effect is beside the layouts now");
  await dropText(edition, "alone.ron", broken[0][2]);
  assert.equal(await edition.stored("widgets/alone.ron"), good);
}

/// Drops the cases of one kind in a page of their own; returns the results for the report.
async function tryCases(browser, home, kind, wanted, { texts, recording }) {
  // A small window is drawn faster than a large one, on a computer without a graphics card too.
  const edition = await Edition.open(browser, home, () => {}, { width: 640, height: 480 });
  await edition.choose("map");
  await edition.page.evaluate((letters) => {
    globalThis.walk = Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
  }, recording);
  await edition.page.evaluate(SCRIPT);
  const messages = new Set();
  let longest_ms = 0;
  for (let first = 0; first < wanted; first += TURN) {
    const asked = { kind, first, count: Math.min(TURN, wanted - first), seed: Number(seed), texts, soon: SOON_MS };
    const done = await edition.page.evaluate((all) => dropCases({ ...all, recording: walk }), asked);
    assert.deepEqual(done.silent, [], `no answer, of seed ${seed}`);
    assert.deepEqual(edition.errors, [], `seed ${seed}, cases ${first} to ${first + TURN}`);
    done.messages.forEach((text) => messages.add(text));
    longest_ms = Math.max(longest_ms, Math.round(done.longest));
    if (first % 1000 === 0 && wanted > 1000) console.error(`${kind}: ${first} of ${wanted}`);
  }
  if (process.env.SHOWS_MESSAGES) console.error([...messages].slice(0, 60).join("\n"));
  // It still works: a sound layout opens, or, after a recording, the page says how it would.
  if (kind === "recordings") {
    await dropText(edition, "last.ron", layout("The last"));
    await edition.says("load the page without a link");
  } else {
    await tryBrokenAlone(edition);
  }
  assert.deepEqual(edition.errors, []);
  await edition.page.close();
  return { cases: wanted, longest_ms, messages: messages.size };
}

await script(async (results) => {
  const server = await serve(folder);
  const home = `http://127.0.0.1:${server.address().port}/?screen_report`;
  const { browser } = await visitor(chromium);
  const made = { texts: shippedTexts(), recording: shortRecording() };
  for (const [kind, share] of [["files", 0.6], ["recordings", 0.4]]) {
    const begun = performance.now();
    results[kind] = await tryCases(browser, home, kind, Math.round(Number(cases) * share), made);
    results[kind].seconds = Math.round((performance.now() - begun) / 1000);
  }
});
