// Saving in place, by the File System Access API: into a file that was chosen, beside the changes of another program.
import assert from "node:assert/strict";
import { Edition } from "./page.mjs";

const LAYOUT = `// Comments stay.
Layout(version: 1, title: "chosen", regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "one", kind: "button", label: "Chosen", at: (2, 2), size: (2, 2))])
`;

/// In the page: the user chooses a file of the browser's own file system, as no script can work the dialogue of the
/// system.
function chooses() {
  globalThis.ownFile = async () => (await navigator.storage.getDirectory()).getFileHandle("chosen.ron", { create: true });
  globalThis.showOpenFilePicker = async () => [await ownFile()];
}

const write = (edition, text) => edition.page.evaluate(async (whole) => {
  const writer = await (await ownFile()).createWritable();
  await writer.write(whole);
  await writer.close();
}, text);

const read = (edition) => edition.page.evaluate(async () => (await (await ownFile()).getFile()).text());

/// Opens, changes and saves a file in its place; returns the results for the report.
export async function saving(browser, home) {
  const edition = await Edition.open(browser, home, chooses);
  await edition.choose("map");
  await write(edition, LAYOUT);
  await edition.click("Design");
  await edition.click("File");
  await edition.click("Open file Ctrl+O");
  await edition.says("chosen.ron");
  const change = async (key) => {
    await edition.click("Drawing board");
    await edition.says("m east,");
    await edition.page.keyboard.press(key);
    await edition.says("• chosen.ron");
    await edition.control("s");
  };
  await change("ArrowRight");
  await edition.says("Saved in the file chosen.ron of this computer, too");
  await edition.picture("11-saved-in-place");
  const saved = await read(edition);
  assert.notEqual(saved, LAYOUT);
  assert.match(saved, /^\/\/ Comments stay\./);
  assert.equal(await edition.stored("chosen.ron"), saved);

  // The second save into the same file, and one after another program has changed it.
  await change("ArrowRight");
  for (let turn = 0; turn < 100 && await read(edition) === saved; turn += 1) await edition.wait(50);
  assert.equal(await read(edition), await edition.stored("chosen.ron"));
  const theirs = LAYOUT.replace("Chosen", "Theirs");
  await write(edition, theirs);
  await change("ArrowLeft");
  await edition.says("another program has changed the file");
  assert.equal(await read(edition), theirs, "the change of the other program stays");
  assert.deepEqual(edition.errors, []);
  await edition.page.close();
  return { saved_in_place: true };
}
