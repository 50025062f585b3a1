// In the page: makes files and folders that are damaged in any way, and drops them as events of its own are.

/// A generator of numbers from 0 to 1 for one case, by G. Marsaglia's xorshift with 32 bits.
function randomOf(seed, index) {
  let state = (seed * 0x9e3779b1 ^ index * 0x85ebca6b) | 1;
  const random = () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
  for (let turn = 0; turn < 8; turn += 1) random();
  return random;
}

const PIECES = ["(", ")", "[", "\"", ",", ":", "NaN", "-1e99", "9".repeat(40), "\u0000", "\u202e", "😀", "//", "/*", "Layout(", "id:", "\r", "((((((((((((((((", "'", "\\u{110000}"];
const NAMES = ["", "", "a ", "ä", "..", "\u202e", "x".repeat(200), "%2e", "<b>"];
const ENDINGS = [".ron", ".ron", ".ron", ".ron", ".RON", ".txt", "", ".mcap"];

/// A file or a folder of one drop, as browsers give them.
function fileEntry(fullPath, content) {
  const name = fullPath.split("/").pop();
  return { isFile: true, isDirectory: false, name, fullPath, file: (take) => take(new File([content], name)) };
}

function folderEntry(fullPath, inner) {
  const createReader = () => {
    // Browsers give some entries at a time, and none at the end.
    const rest = inner.slice();
    return { readEntries: (take) => take(rest.splice(0, 3)) };
  };
  return { isFile: false, isDirectory: true, name: fullPath.split("/").pop(), fullPath, createReader, inner };
}

/// Makes the entries of the case `index`; the name of each file has `case-` and its number.
class CaseMaker {
  constructor(seed, index, { texts, recording }) {
    [this.random, this.index, this.texts, this.recording] = [randomOf(seed, index), index, texts, recording];
  }

  below(most) {
    return Math.floor(this.random() * most);
  }

  one(list) {
    return list[this.below(list.length)];
  }

  changedText(text) {
    let out = text;
    for (let change = 0; change <= this.below(4); change += 1) {
      const at = this.below(out.length + 1);
      out = out.slice(0, at) + (this.random() < 0.7 ? this.one(PIECES) : "") + out.slice(at + this.below(30));
    }
    return this.random() < 0.1 ? out.slice(0, this.below(out.length)) : out;
  }

  changedBytes(bytes) {
    const out = bytes.slice();
    for (let change = 0; change <= this.below(6); change += 1) {
      const [at, length] = [this.below(out.length), 1 + this.below(12)];
      for (let place = at; place < Math.min(out.length, at + length); place += 1) out[place] = this.below(256);
    }
    return this.random() < 0.4 ? out.slice(0, this.below(out.length + 1)) : out;
  }

  noise(length) {
    return Uint8Array.from({ length }, () => this.below(256));
  }

  content() {
    const draw = this.random();
    if (draw < 0.7) return this.changedText(this.one(this.texts));
    if (draw < 0.8) return this.noise(this.below(3000));
    if (draw < 0.9) return this.one(this.texts);
    return draw < 0.98 ? "" : "(".repeat(2e6);
  }

  name() {
    return `${this.one(NAMES)}case-${this.index}`;
  }

  file(within) {
    return fileEntry(`${within}/${this.name()}${this.one(ENDINGS)}`, this.content());
  }

  folder(within, depth) {
    const path = `${within}/${this.one(["layouts", "widgets", "effects", this.name()])}`;
    const entry = () => (depth > 0 && this.random() < 0.4 ? this.folder(path, depth - 1) : this.file(path));
    return folderEntry(path, Array.from({ length: this.below(5) }, entry));
  }

  /// A recording, a file, or several files and folders.
  entries(kind) {
    if (kind === "recordings") {
      const bytes = this.random() < 0.1 ? this.noise(this.below(5000)) : this.changedBytes(this.recording);
      return [fileEntry(`/case-${this.index}.mcap`, bytes)];
    }
    if (this.random() < 0.6) return [this.file("")];
    return Array.from({ length: 1 + this.below(3) }, () => (this.random() < 0.7 ? this.folder("", 3) : this.file("")));
  }
}

function drop(entries) {
  const event = new Event("drop", { bubbles: true, cancelable: true });
  event.dataTransfer = { items: entries.map((entry) => ({ webkitGetAsEntry: () => entry })) };
  document.getElementById("window").dispatchEvent(event);
}

/// The names of the files that the page looks at: hidden files and folders stay out.
function seenNames(entries) {
  const seen = entries.filter((entry) => !entry.name.startsWith("."));
  return seen.flatMap((entry) => (entry.isFile ? [entry.name] : seenNames(entry.inner)));
}

/// Whether the page has a file to open or to refuse by its name. Of folders, it takes layouts, kinds and effects alone, or
/// one recording.
function hasFileToName(entries) {
  const names = seenNames(entries);
  if (entries.every((entry) => entry.isFile)) return names.length > 0;
  return names.some((name) => name.endsWith(".ron")) || (names.length === 1 && names[0].endsWith(".mcap"));
}

const report = () => JSON.parse(globalThis.underfootScreen ?? "null");

/// What the window shows, with its title.
function shownTexts() {
  const { widgets = [], title = "" } = report() ?? {};
  return [title ?? "", ...widgets.map((widget) => `${widget.name} ${widget.text ?? ""}`)];
}

/// Whether a message or the title names a file of the case.
function isNamed(index) {
  return shownTexts().some((text) => new RegExp(`case-${index}(?!\\d)`).test(text));
}

/// Whether the storage of the browser has a file of the case.
function isKept(index) {
  return Object.keys(localStorage).some((key) => new RegExp(`case-${index}(?!\\d)`).test(key));
}

function isAnswered(index, entries) {
  if (hasFileToName(entries)) return isNamed(index) || isKept(index);
  return shownTexts().some((text) => text.includes("there is no file in it"));
}

const nextFrame = () => new Promise((take) => requestAnimationFrame(take));

/// Waits until `check` holds in a later frame of the window than `frame`; returns whether it did within `soon` ms. A window
/// without news draws no further ones.
async function comesWithin(soon, frame, check) {
  const begun = performance.now();
  while (performance.now() - begun < soon) {
    await nextFrame();
    if (report().frame > frame && check()) return true;
  }
  return false;
}

/// A layout with a kind of its own, whatever lies beside it.
const SOUND = `Layout(version: 1, title: "sound", regions: [(id: "all", at: (0, 0), size: (6, 6))],
  kinds: [Kind(name: "own", behaviour: Button, press_n: 60, release_n: 40)], widgets: [(id: "one", kind: "own", label: "Sound", at: (2, 2), size: (1, 1))])`;

/// Whether a sound layout opens beside all that the cases have left behind.
async function opensSoundLayout(soon, name) {
  const { frame } = report();
  drop([fileEntry(`/${name}`, SOUND)]);
  return comesWithin(soon, frame, () => (report().title ?? "").includes(name));
}

/// Drops `count` cases from `first` on; returns the cases without an answer, the messages, and the longest time in ms.
async function dropCases({ kind, first, count, seed, soon, ...made }) {
  const [messages, silent] = [new Set(), []];
  let longest = 0;
  for (let index = first; index < first + count; index += 1) {
    const entries = new CaseMaker(seed, index, made).entries(kind);
    const [{ frame }, begun] = [report(), performance.now()];
    drop(entries);
    const answered = await comesWithin(soon, frame, () => isAnswered(index, entries));
    if (!answered) silent.push({ index, names: seenNames(entries), shown: shownTexts().filter((text) => text.includes(": ")).slice(0, 6) });
    longest = Math.max(longest, performance.now() - begun);
    const told = shownTexts().filter((text) => text.includes(`case-${index}`));
    told.forEach((text) => messages.add(text.replace(/^.*?case-\d+/s, "case").trim().slice(0, 160)));
  }
  if (kind === "files" && !await opensSoundLayout(soon, `sound-${first}.ron`)) silent.push({ after: first + count, names: ["sound"], shown: shownTexts() });
  // The storage of a browser has 5 MB.
  Object.keys(localStorage).filter((key) => /case-|sound-/.test(key)).forEach((key) => localStorage.removeItem(key));
  return { messages: [...messages], silent, longest };
}
