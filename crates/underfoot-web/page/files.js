// Files of the computer: dropped on the page or chosen, and saved in place where the browser has the File System Access API.

// Files of one drop; the window gets all of them with their paths.
const MOST_FILES = 1000;

async function filesIn(entry, found) {
  if (found.length >= MOST_FILES || entry.name.startsWith(".")) return;
  if (entry.isFile) {
    found.push([entry.fullPath.replace(/^\//, ""), await new Promise((take, fail) => entry.file(take, fail))]);
    return;
  }
  const reader = entry.createReader();
  const next = () => new Promise((take, fail) => reader.readEntries(take, fail));
  for (let entries = await next(); entries.length > 0; entries = await next()) {
    for (const inner of entries) await filesIn(inner, found);
  }
}

// A recording larger than this does not fit into the memory of a page; its answer names the limit.
const MOST_BYTES = 2 ** 26;

// The files and folders that came last, by their names, and the times of the changes that the page knows, by paths.
const roots = new Map();
const known = new Map();

/// Remembers where a dropped item lies; only while the drop is being handled.
function remember(item) {
  item.getAsFileSystemHandle?.().then((handle) => handle && roots.set(handle.name, handle), () => {});
}

function give(found) {
  for (const [path, file] of found) known.set(path, file.lastModified);
  dispatchEvent(new CustomEvent("underfoot-files", { detail: found }));
}

function tell(text) {
  dispatchEvent(new CustomEvent("underfoot-told", { detail: text }));
}

/// Opens what is dropped: layouts and folders with the window, and with `play`, if given, a recording. `takesLayouts`
/// returns whether the window opens layouts now.
export function takeFiles({ play, takesLayouts = () => true }) {
  addEventListener("drop", async (event) => {
    event.preventDefault();
    const items = [...event.dataTransfer.items];
    items.forEach(remember);
    const entries = items.map((item) => item.webkitGetAsEntry()).filter((entry) => entry);
    const found = [];
    for (const entry of entries) {
      // A file that has gone meanwhile, for example.
      await filesIn(entry, found).catch((error) => tell(`${entry.name} cannot be read: ${error.message}`));
    }
    const recording = play && found.length === 1 && found.find(([path]) => path.endsWith(".mcap"));
    if (recording) {
      const [path, file] = recording;
      // One byte more is enough for the answer.
      const bytes = await file.slice(0, MOST_BYTES + 1).arrayBuffer().catch((error) => error);
      return bytes instanceof Error ? tell(`${path} cannot be read: ${bytes.message}`) : play(path, new Uint8Array(bytes));
    }
    if (!takesLayouts()) return;
    // Of a folder, only the files that the window can open; a single file of another form gets its own message.
    give(entries.every((entry) => entry.isFile) ? found : found.filter(([path]) => path.endsWith(".ron")));
  }, true);
}

// The window asks for files: without this API, and in a page within another one, it shows a dialogue of its own.
addEventListener("underfoot-choose", (event) => {
  if (!("showOpenFilePicker" in window) || window.top !== window) return;
  event.preventDefault();
  choose().catch((error) => { if (error.name !== "AbortError") tell(`the browser shows no files: ${error.message}`); });
});

async function choose() {
  const types = [{ description: "Layouts, kinds and effects", accept: { "text/plain": [".ron"] } }];
  const handles = await showOpenFilePicker({ multiple: true, types });
  const found = [];
  for (const handle of handles) {
    roots.set(handle.name, handle);
    found.push([handle.name, await handle.getFile()]);
  }
  give(found);
}

/// The handle of the file at `path`, if it came from this computer since the page was loaded.
async function handleOf(path) {
  const [first, ...rest] = path.split("/");
  let handle = roots.get(first);
  for (const [index, name] of rest.entries()) {
    if (handle?.kind !== "directory") return null;
    handle = await (index + 1 < rest.length ? handle.getDirectoryHandle(name) : handle.getFileHandle(name));
  }
  return handle?.kind === "file" ? handle : null;
}

// The user has saved a layout in the storage of the browser: it goes into its own file, too. One save follows the other.
let saving = Promise.resolve();
addEventListener("underfoot-saved", ({ detail: [path, text] }) => {
  saving = saving.then(() => saveInPlace(path, text)).catch((error) => {
    tell(`${path} is saved in this browser, and not in its file: ${error.message}`);
  });
});

async function saveInPlace(path, text) {
  const handle = await handleOf(path);
  if (!handle) return;
  const isAllowed = async (ask) => !ask || await ask.call(handle, { mode: "readwrite" }) === "granted";
  if (!await isAllowed(handle.queryPermission) && !await isAllowed(handle.requestPermission)) {
    throw new Error("you or the browser did not allow it");
  }
  if ((await handle.getFile()).lastModified !== known.get(path)) {
    throw new Error("another program has changed the file; drop it on the page again, or download yours");
  }
  const writer = await handle.createWritable();
  await writer.write(text);
  await writer.close();
  known.set(path, (await handle.getFile()).lastModified);
  tell(`Saved in the file ${path} of this computer, too`);
}
