// Starts the window and its sound, and keeps the page for visits without a network. A page that a floor serves joins it.
import { takeFiles } from "./files.js";
import { mirror } from "./served.js";
import init, { join, open_recording, start, takes_layouts } from "./underfoot.js";

const cover = document.getElementById("cover");
const state = document.getElementById("state");

// A link that is opened in this page has another layout behind `#`. Unsaved changes stay as a draft.
addEventListener("hashchange", () => location.reload());

// On the floor of a server there is neither a recording nor a visit.
takeFiles(mirror === null ? { play: open_recording, takesLayouts: takes_layouts } : {});

// Over plain HTTP from another computer, browsers have no service worker: the page then needs its server.
// So does a page of a floor, which is of no use without it.
if (mirror === null && "serviceWorker" in navigator) {
  navigator.serviceWorker.register("offline.js").catch((error) => console.warn("no visits offline:", error));
}

// The actuators' signals as sound, from the first gesture on, as browsers ask.
const RATE = 48000;
let speaker = null;

async function beginSound() {
  const context = new AudioContext({ sampleRate: RATE, latencyHint: "interactive" });
  await context.audioWorklet.addModule("sound.js");
  const node = new AudioWorkletNode(context, "actuators", { numberOfInputs: 0, outputChannelCount: [2] });
  node.connect(context.destination);
  await context.resume();
  speaker = node.port;
}

const hasSound = "AudioContext" in window && "audioWorklet" in AudioContext.prototype;
const gestures = ["pointerdown", "pointerup", "keydown", "touchend"];
function atGesture() {
  gestures.forEach((name) => removeEventListener(name, atGesture, true));
  beginSound().catch((error) => console.warn("no sound:", error));
}
if (hasSound && mirror === null) gestures.forEach((name) => addEventListener(name, atGesture, true));

// A fault of the program ends its frames; the draft of the layout is in the storage.
addEventListener("error", ({ error }) => {
  if (!(error instanceof WebAssembly.RuntimeError)) return;
  state.textContent = "The window has failed, which it should not. Your layout is kept as a draft: load the page again.";
  cover.hidden = false;
});

// Functions of the page for the window.
const hooks = {
  sound: hasSound
    ? "Sound: all tiles in stereo, from the first click on."
    : "No sound: this browser gives it to pages over https and on this computer alone.",
  play: (samples) => speaker?.postMessage(samples, [samples.buffer]),
  click: () => navigator.vibrate?.(12),
};

// Told in the window of a floor's page over plain HTTP from another computer.
const WITHHELD = "Over http, browsers give a page of another computer no clipboard, no sound and no visits offline: "
  + "mark links and copy them by keys.";

try {
  await init({ module_or_path: "underfoot.wasm" });
  const canvas = document.getElementById("window");
  if (mirror === null) {
    await start(canvas, hooks.sound, hooks.play, hooks.click);
  } else {
    state.textContent = "The page joins the floor …";
    await join(canvas, mirror, isSecureContext ? "" : WITHHELD, (text) => { state.textContent = text; });
  }
  performance.mark("underfoot started");
  cover.hidden = true;
} catch (error) {
  console.error(error);
  state.textContent = typeof WebAssembly === "undefined" || error instanceof WebAssembly.CompileError
    ? "This browser has no WebAssembly with vectors, which the floor needs and all browsers since March 2023 have."
    : `The window cannot open: ${error?.message ?? error}`;
}
