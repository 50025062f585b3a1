// Files in the web edition: dropped layouts and folders, saved, downloaded and opened again, and drafts after a crash.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Edition } from "./page.mjs";

const LAYOUT = `// Comments stay.
Layout(version: 1, title: "own", regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "big", kind: "huge", label: "Enormous", at: (2, 2), size: (2, 2))])
`;
const KIND = `Kind(name: "huge", from: "button", feel: (press: "thud"))\n`;
const EFFECT = `Effect(name: "thud", about: "A low one", plays: Click(level_n: 9, modes: [(hz: 90, decay_ms: 30)]))\n`;
const PLAIN = LAYOUT.replace("huge", "button").replace("Enormous", "Ordinary");

/// A folder of a designer's: a layout with a kind and an effect of its own, and files of other sorts.
function makeFolder() {
  const home = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-files-"));
  const write = (name, text) => {
    fs.mkdirSync(path.dirname(path.join(home, name)), { recursive: true });
    fs.writeFileSync(path.join(home, name), text);
  };
  write("my floor/layouts/own.ron", LAYOUT);
  write("my floor/widgets/huge.ron", KIND);
  write("my floor/effects/thud.ron", EFFECT);
  write("my floor/notes.txt", "not a layout");
  write("plain.ron", PLAIN);
  write("broken.ron", "Layout(version: 1, widgets: [(id: 5)])");
  write("picture.png", "not a layout");
  write("walk.mcap", "not a layout");
  return home;
}

/// In the page: the browser gives no places of dropped files. Otherwise it would ask the user at the first save, and no
/// script can answer; `saving.mjs` has saving in place.
function hidePlaces() {
  delete DataTransferItem.prototype.getAsFileSystemHandle;
}

/// Opens, changes, saves and recovers layouts; returns the results for the report.
export async function files(browser, home) {
  const folder = makeFolder(), at = (name) => path.join(folder, name);
  const page = await Edition.open(browser, home, hidePlaces);
  await page.choose("map");
  const downloads = at("downloads");
  const wire = await browser.target().createCDPSession();
  await wire.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });

  await page.drop(at("plain.ron"));
  await page.widget("Ordinary");
  assert.equal(await page.stored("plain.ron"), PLAIN);

  await page.drop(at("my floor"));
  await page.widget("Enormous");
  assert.equal(await page.stored("my floor/layouts/own.ron"), LAYOUT);
  assert.equal(await page.stored("my floor/widgets/huge.ron"), KIND);
  assert.equal(await page.stored("my floor/notes.txt"), null);
  await page.picture("8-dropped");

  // A kind and an effect of its own travel in the link.
  await page.click("Share");
  const { text: link } = await page.widget("Link");
  await page.click("Close");
  const shown = await Edition.open(browser, link);
  await shown.widget("Enormous");
  assert.deepEqual(shown.errors, []);
  await shown.page.close();

  // Changed, saved and downloaded: comments stay.
  await page.click("Design");
  await page.click("Drawing board");
  await page.says("m east,");
  await page.page.keyboard.press("ArrowRight");
  await page.says("• own.ron");
  await page.control("s");
  await page.says("Saved in my floor/layouts/own.ron");
  const saved = await page.stored("my floor/layouts/own.ron");
  assert.notEqual(saved, LAYOUT);
  assert.match(saved, /^\/\/ Comments stay\./);
  assert.equal(await page.stored("my floor/layouts/own.ron.bak"), LAYOUT);
  await page.click("File");
  await page.click("Download");
  const given = path.join(downloads, "own.ron");
  for (let turn = 0; turn < 100 && !fs.existsSync(given); turn += 1) await page.wait(50);
  assert.equal(fs.readFileSync(given, "utf8"), saved);

  // A page that ends without saving leaves a draft, which the next one offers.
  await page.page.keyboard.press("ArrowRight");
  await page.says("• own.ron");
  await page.wait(2600);
  const draft = await page.stored("my floor/layouts/.own.ron.draft");
  assert.ok(draft && draft !== saved, "there is a draft");
  assert.deepEqual(page.errors, []);
  await page.page.close();
  const next = await Edition.open(browser, home);
  await next.choose("map");
  await next.click("Design");
  await next.click("File");
  await next.click("Open recent");
  await next.click("own.ron");
  await next.picture("10-draft");
  await next.click("Recover the draft");
  await next.control("s");
  await next.says("Saved in my floor/layouts/own.ron");
  assert.equal(await next.stored("my floor/layouts/own.ron"), draft);

  // What is dropped and cannot be opened says why, and the layout stays.
  await next.click("Try");
  for (const [name, says] of [["broken.ron", "broken.ron"], ["picture.png", "its name ends in .ron"], ["walk.mcap", "no recording of a floor begins there"]]) {
    await next.drop(at(name));
    await next.says(says);
    await next.widget("Enormous");
  }
  await next.picture("9-refused");
  assert.deepEqual(next.errors, []);
  await next.page.close();
  fs.rmSync(folder, { recursive: true });
  return { dropped: "a layout and a folder", saved: true, downloaded: true, recovered: true };
}
