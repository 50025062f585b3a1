// Files and folders that are damaged in any way, dropped on the web edition: it opens them, or says why not, and goes on.
//
//     node bindings/web/tests/drops.mjs CHROMIUM FOLDER UNDERFOOT [CASES] [SEED]
//
// FOLDER is target/web, which `./dev web` makes. Of CASES, 300 if not given, two in five are recordings, the others
// layouts and folders. They are dropped by the scripts of the page, as events of its own are.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Edition, serve, visitor } from "./edition/page.mjs";
import { root } from "./harness.mjs";

const [chromium, folder, underfoot, cases = "300", seed = "1"] = process.argv.slice(2);

/// Time in milliseconds within which the page has answered a drop, on a busy machine too.
const SOON_MS = 10000;

/// Cases of one turn of the script.
const TURN = 50;

/// In the page: drops `count` cases, which the numbers from `first` on determine, and returns the messages of the window
/// that came, and the cases without an answer.
async function dropCases({ kind, first, count, seed, texts, recording, soon }) {
  // A generator of numbers from 0 to 1, by G. Marsaglia's xorshift with 32 bits.
  let state;
  const random = () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
  const below = (most) => Math.floor(random() * most);
  const one = (list) => list[below(list.length)];
  const PIECES = ["(", ")", "[", "\"", ",", ":", "NaN", "-1e99", "9".repeat(40), "\u0000", "\u202e", "😀", "//", "/*", "Layout(", "id:", "\r", "((((((((((((((((", "'", "\\u{110000}"];
  const changedText = (text) => {
    let out = text;
    for (let change = 0; change <= below(4); change += 1) {
      const at = below(out.length + 1);
      out = out.slice(0, at) + (random() < 0.7 ? one(PIECES) : "") + out.slice(at + below(30));
    }
    return random() < 0.1 ? out.slice(0, below(out.length)) : out;
  };
  const changedBytes = (bytes) => {
    const out = bytes.slice();
    for (let change = 0; change <= below(6); change += 1) {
      const [at, length] = [below(out.length), 1 + below(12)];
      for (let place = at; place < Math.min(out.length, at + length); place += 1) out[place] = below(256);
    }
    return random() < 0.4 ? out.slice(0, below(out.length + 1)) : out;
  };
  const noise = (length) => Uint8Array.from({ length }, () => below(256));
  const file = (fullPath, content) => ({
    isFile: true, isDirectory: false, name: fullPath.split("/").pop(), fullPath,
    file: (take) => take(new File([content], fullPath.split("/").pop())),
  });
  const directory = (fullPath, entries) => ({
    isFile: false, isDirectory: true, name: fullPath.split("/").pop(), fullPath,
    createReader: () => {
      // Browsers give some entries at a time, and none at the end.
      const rest = entries.slice();
      return { readEntries: (take) => take(rest.splice(0, 3)) };
    },
  });
  const name = (index) => one(["", "", "a ", "ä", "..", "\u202e", "x".repeat(200), "%2e", "<b>"]) + `case-${index}`;
  const content = () => {
    const draw = random();
    if (draw < 0.7) return changedText(one(texts));
    if (draw < 0.8) return noise(below(3000));
    if (draw < 0.9) return one(texts);
    return draw < 0.98 ? "" : "(".repeat(2e6);
  };
  const anyFile = (index, below_) => file(`${below_}/${name(index)}${one([".ron", ".ron", ".ron", ".ron", ".RON", ".txt", "", ".mcap"])}`, content());
  const anyFolder = (index, at, depth) => {
    const path = `${at}/${one(["layouts", "widgets", "effects", name(index)])}`;
    const inner = Array.from({ length: below(5) }, () => (depth > 0 && random() < 0.4 ? anyFolder(index, path, depth - 1) : anyFile(index, path)));
    return directory(path, inner);
  };
  const drop = (entries) => {
    const event = new Event("drop", { bubbles: true, cancelable: true });
    event.dataTransfer = { items: entries.map((entry) => ({ webkitGetAsEntry: () => entry })) };
    document.getElementById("window").dispatchEvent(event);
  };
  const frame = () => new Promise((take) => requestAnimationFrame(take));
  const report = () => JSON.parse(globalThis.underfootScreen ?? "null");
  const said = () => (report()?.widgets ?? []).map((widget) => `${widget.name} ${widget.text ?? ""}`).filter((text) => text.includes("case-")).map((text) => text.trim());
  const messages = new Set();
  const silent = [];
  let longest = 0;
  for (let index = first; index < first + count; index += 1) {
    state = (seed * 0x9e3779b1 ^ index * 0x85ebca6b) | 1;
    for (let turn = 0; turn < 8; turn += 1) random();
    let entries;
    if (kind === "recordings") {
      entries = [file(`/case-${index}.mcap`, random() < 0.1 ? noise(below(5000)) : changedBytes(recording))];
    } else if (random() < 0.6) {
      entries = [anyFile(index, "")];
    } else {
      entries = Array.from({ length: 1 + below(3) }, () => (random() < 0.7 ? anyFolder(index, "", 3) : anyFile(index, "")));
    }
    // Something in it that has a name; an empty folder has its own message.
    const files = [];
    const walk = (entry) => (entry.isFile ? files.push(entry) : undefined);
    entries.forEach(walk);
    const before = report().frame;
    const begun = performance.now();
    drop(entries);
    const isRefused = files.length === 1 && entries.length === 1 && kind !== "recordings" && !files[0].name.endsWith(".ron") && !files[0].name.endsWith(".mcap") && !files[0].name.startsWith(".");
    for (;;) {
      await frame();
      const now = said();
      now.forEach((text) => messages.add(text.replace(/.*(?=case-)/s, "").replace(/case-\d+/, "case").slice(0, 160)));
      const passed = performance.now() - begun;
      const isAnswered = !isRefused || now.some((text) => text.includes(`case-${index}`));
      if (report().frame > before + 2 && isAnswered) break;
      if (passed > soon) { silent.push({ index, names: files.map((one) => one.name) }); break; }
    }
    longest = Math.max(longest, performance.now() - begun);
  }
  // The storage of a browser has 5 MB, and kinds and effects stay beside all later layouts, with their errors.
  Object.keys(localStorage).filter((key) => key.includes("case-")).forEach((key) => localStorage.removeItem(key));
  return { messages: [...messages], silent, longest };
}

const run = (...options) => execFileSync(underfoot, options, { encoding: "utf8", maxBuffer: 1 << 28 });
const made = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-drops-"));
const short = path.join(made, "short.ron");
fs.writeFileSync(short, `Scenario(title: "short", person: (mass_kg: 74), steps: [Enter(from: South, at: (1.4, 0.5)), Press(widget: "home"), Wait(ms: 200)])`);
run("session", "map", "--scenario", short, "--json", "--record", path.join(made, "walk.mcap"));
const recording = fs.readFileSync(path.join(made, "walk.mcap")).toString("base64");
fs.rmSync(made, { recursive: true });
const texts = ["layouts", "widgets", "effects"].flatMap((kind) =>
  fs.readdirSync(path.join(root, kind)).filter((name) => name.endsWith(".ron")).map((name) => fs.readFileSync(path.join(root, kind, name), "utf8")));

const server = await serve(folder);
const home = `http://127.0.0.1:${server.address().port}/?screen_report`;
const { browser, end } = await visitor(chromium);
const results = {};
let status = 1;
try {
  for (const [kind, share] of [["files", 0.6], ["recordings", 0.4]]) {
    const wanted = Math.round(Number(cases) * share);
    const edition = await Edition.open(browser, home);
    await edition.choose("map");
    await edition.page.evaluate((letters) => {
      globalThis.recording = Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
    }, recording);
    await edition.page.evaluate(`globalThis.dropCases = ${dropCases}`);
    const messages = new Set();
    let longest_ms = 0;
    for (let first = 0; first < wanted; first += TURN) {
      const asked = { kind, first, count: Math.min(TURN, wanted - first), seed: Number(seed), texts, soon: SOON_MS };
      const done = await edition.page.evaluate((all) => dropCases({ ...all, recording }), asked);
      assert.deepEqual(done.silent, [], `no answer, of seed ${seed}`);
      assert.deepEqual(edition.errors, [], `seed ${seed}, cases ${first} to ${first + TURN}`);
      done.messages.forEach((text) => messages.add(text));
      longest_ms = Math.max(longest_ms, Math.round(done.longest));
    }
    // It still works: a sound layout opens, or, after a recording, the page says how it would.
    const last = path.join(os.tmpdir(), `underfoot-last-${process.pid}.ron`);
    fs.writeFileSync(last, `Layout(version: 1, title: "last", regions: [(id: "all", at: (0, 0), size: (6, 6))], widgets: [(id: "one", kind: "button", label: "The last", at: (2, 2), size: (1, 1))])`);
    await edition.drop(last);
    if (kind === "files") await edition.widget("The last");
    else await edition.says("load the page without a link");
    fs.rmSync(last);
    assert.deepEqual(edition.errors, []);
    results[kind] = { cases: wanted, longest_ms, messages: messages.size };
    if (process.env.SHOWS_MESSAGES) console.error([...messages].slice(0, 60).join("\n"));
    await edition.page.close();
  }
  console.log(JSON.stringify(results));
  status = 0;
} finally {
  if (status) console.error(JSON.stringify(results));
  await end();
  server.close();
}
process.exit(status);
