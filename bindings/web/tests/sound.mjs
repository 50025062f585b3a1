// The sound of the web edition against the program's own renderer: the samples that leave the AudioWorklet for the
// loudspeakers, for one click and one friction of the same visit, in dB below that sound.
//
//     node bindings/web/tests/sound.mjs CHROMIUM FOLDER UNDERFOOT
//
// FOLDER is target/web, which `./dev web` makes. The program writes a channel per actuator (`underfoot session LINK`);
// this script mixes them to two as docs/actuators-and-sound.md says: by columns, at constant power.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Edition, answerFrom, script, serve, visitor } from "./edition/page.mjs";
import { root, until } from "./harness.mjs";

const [chromium, folder, underfoot] = process.argv.slice(2);
const RATE = 48000;

/// Columns of the floor; channels follow the tiles row by row.
const COLUMNS = 6;

/// The greatest error that nobody hears beside the sound itself.
const LOUDEST_ERROR_DB = -60;

/// Frames that are compared at a time, and that find their delay.
const PIECE = 256;

/// The samples of a WAV file with 24 bits: one array per channel. Its steps are 138 dB below full scale.
function readWav(file) {
  const bytes = fs.readFileSync(file);
  let [at, channels] = [12, 0];
  while (at < bytes.length) {
    const [name, size] = [bytes.toString("latin1", at, at + 4), bytes.readUInt32LE(at + 4)];
    if (name === "fmt ") {
      channels = bytes.readUInt16LE(at + 10);
      assert.equal(bytes.readUInt32LE(at + 12), RATE);
      assert.equal(bytes.readUInt16LE(at + 22), 24, "24 bits");
    }
    if (name === "data") {
      const frames = Math.floor(size / 3 / channels);
      return Array.from({ length: channels }, (_, channel) => Float32Array.from({ length: frames }, (_, frame) =>
        bytes.readIntLE(at + 8 + 3 * (channels * frame + channel), 3) / 2 ** 23));
    }
    at += 8 + size + (size & 1);
  }
  throw new Error(`${file} has no samples`);
}

/// Two sides of a channel per tile.
function mixed(channels) {
  const sides = [new Float32Array(channels[0].length), new Float32Array(channels[0].length)];
  channels.forEach((samples, channel) => {
    const angle = ((channel % COLUMNS) + 0.5) / COLUMNS * Math.PI / 2;
    const gains = [Math.cos(angle), Math.sin(angle)];
    samples.forEach((sample, frame) => { for (const side of [0, 1]) sides[side][frame] += gains[side] * sample; });
  });
  return sides;
}

/// A module of the page: keeps all samples that come in, and passes them on 32 blocks at a time.
const TAPE = `registerProcessor("tape", class extends AudioWorkletProcessor {
  process([[left, right]]) {
    this.kept = (this.kept ?? []).concat(left ? [left.slice(), (right ?? left).slice()] : []);
    if (this.kept.length >= 64) { this.port.postMessage(this.kept); this.kept = []; }
    return true;
  }
});`;

/// In the page: tapes what the worklet sends to the loudspeakers.
function tapeSound() {
  globalThis.tape = [];
  const { connect } = AudioNode.prototype;
  AudioNode.prototype.connect = function (to, ...rest) {
    if (this instanceof AudioWorkletNode && to === this.context.destination) {
      this.context.audioWorklet.addModule("tape.js").then(() => {
        const options = { numberOfOutputs: 0, channelCount: 2, channelCountMode: "explicit" };
        const recorder = new AudioWorkletNode(this.context, "tape", options);
        recorder.port.onmessage = ({ data }) => tape.push(...data);
        connect.call(this, recorder);
      });
    }
    return connect.call(this, to, ...rest);
  };
}

/// The taped samples of both sides.
async function taped(edition) {
  const pieces = await edition.page.evaluate(() => {
    const bytes = new Uint8Array(tape.length * 512);
    tape.forEach((samples, index) => bytes.set(new Uint8Array(samples.buffer), 512 * index));
    let text = "";
    for (let at = 0; at < bytes.length; at += 32768) text += String.fromCharCode(...bytes.subarray(at, at + 32768));
    return btoa(text);
  });
  const bytes = Buffer.from(pieces, "base64");
  const all = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const frames = all.length / 2;
  return [0, 1].map((side) => Float32Array.from({ length: frames }, (_, frame) =>
    all[256 * Math.floor(frame / 128) + 128 * side + frame % 128]));
}

const energy = (samples, from, to) => {
  let sum = 0;
  for (const side of samples) for (let at = from; at < to; at += 1) sum += side[at] ** 2;
  return sum;
};

/// Energy of the difference between `wanted` from `from` to `to` and `heard`, `delay` frames later.
function difference(wanted, heard, from, to, delay) {
  let sum = 0;
  for (const side of [0, 1]) {
    for (let at = from; at < to; at += 1) sum += (wanted[side][at] - (heard[side][at + delay] ?? 0)) ** 2;
  }
  return sum;
}

/// The delay in frames, of those from `least` to `most`, at which `heard` is most like `wanted`.
function delayOf(wanted, heard, from, to, least, most) {
  let best = { delay: least, error: Infinity };
  for (let delay = least; delay <= most; delay += 1) {
    let error = 0;
    for (let at = from; at < to && error < best.error; at += 1) {
      error += (wanted[0][at] - (heard[0][at + delay] ?? 0)) ** 2 + (wanted[1][at] - (heard[1][at + delay] ?? 0)) ** 2;
    }
    if (error < best.error) best = { delay, error };
  }
  return best.delay;
}

/// The error of a part of the sound, and the number of pauses in it: a page that is late is silent for a moment, and then
/// goes on where it was.
function compared(wanted, heard, { from, to }) {
  let delay = delayOf(wanted, heard, from, Math.min(to, from + 4 * PIECE), -from, heard[0].length - from);
  let [at, error, pauses] = [from, 0, 0];
  while (at < to) {
    const end = Math.min(to, at + PIECE);
    const differs = difference(wanted, heard, at, end, delay);
    if (differs > 1e-4 * energy(wanted, at, end) + 1e-12) {
      const least = 1e-6 * energy(wanted, at, end) / PIECE;
      let begins = at;
      while (begins < end - 1 && difference(wanted, heard, begins, begins + 1, delay) <= least) begins += 1;
      const other = delayOf(wanted, heard, begins, Math.min(to, begins + PIECE), delay, delay + RATE / 4);
      if (other !== delay) {
        error += difference(wanted, heard, at, begins, delay);
        [at, delay, pauses] = [begins, other, pauses + 1];
        continue;
      }
    }
    error += differs;
    at = end;
  }
  const error_db = 10 * Math.log10(error / energy(wanted, from, to));
  return { ms: Math.round((to - from) / RATE * 1000), error_db: Number(error_db.toFixed(1)), pauses };
}

/// From the first sample that is not silent after `at_s` to the first silence of 20 ms.
function soundAfter(wanted, at_s) {
  const isLoud = (at) => Math.abs(wanted[0][at]) + Math.abs(wanted[1][at]) > 1e-6;
  let from = Math.round(at_s * RATE);
  while (from < wanted[0].length && !isLoud(from)) from += 1;
  let to = from;
  for (let at = from; at < wanted[0].length && at < to + RATE / 50; at += 1) if (isLoud(at)) to = at + 1;
  return { from, to };
}

const made = fs.mkdtempSync(path.join(os.tmpdir(), "underfoot-sound-"));
const run = (...options) => execFileSync(underfoot, options, { encoding: "utf8", maxBuffer: 1 << 28 });
const link = run("share", "map", "--visit", path.join(root, "bindings/web/tests/sound.ron")).trim();
run("session", link, "--out", made);
const wanted = mixed(readWav(path.join(made, "actuators.wav")));
const events = fs.readFileSync(path.join(made, "events.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
fs.rmSync(made, { recursive: true });
const at_s = (word, id) => events.find((line) => line.event === word && line.id === id).t_s;
// The click of the press ends before the foot is lifted; the friction begins with the drag, after the press of the slider.
const click = soundAfter(wanted, at_s("pressed", "home") - 0.002);
const friction = soundAfter(wanted, at_s("changed", "zoom") - 0.002);

const files = answerFrom(folder);
await script(async (results) => {
  const server = await serve(folder, (request, response) => {
    if (request.url !== "/tape.js") return files(request, response);
    response.writeHead(200, { "content-type": "text/javascript" }).end(TAPE);
  });
  const { browser } = await visitor(chromium);
  const address = `http://127.0.0.1:${server.address().port}/?screen_report${link}`;
  // A small window is drawn faster than the time passes, on a computer without a graphics card too.
  const edition = await Edition.open(browser, address, tapeSound, { width: 640, height: 480 });
  // The first click lets the page sound; the second begins the visit anew, on tape.
  await edition.goTo(0.9);
  await until("the tape runs", () => edition.page.evaluate(() => tape.length > 0));
  await edition.goTo(0);
  await edition.page.evaluate(() => { tape.length = 0; });
  await edition.widget("Play", "Button", 1200);
  await edition.wait(500);
  const heard = await taped(edition);
  assert.deepEqual(edition.errors, []);
  Object.assign(results, { click: compared(wanted, heard, click), friction: compared(wanted, heard, friction) });
  for (const [name, { error_db }] of Object.entries(results)) {
    assert.ok(error_db < LOUDEST_ERROR_DB, `${name}: ${error_db} dB`);
  }
});
