// Runs the firmware of a Pico with scripted voltages at its 32 inputs:
//
//     node main.mjs MODULES FIRMWARE.uf2 SCRIPT [--out FILE --until MS] [--noise MV] [--without CONVERTER] [--stall MS]
//         [--deaf FROM-TO]
//
// MODULES is the folder of npm's modules. Each line of the script is `ms input millivolts`, in order of time; input -1
// is a mark, which prints `mark MS SECONDS`, by the clock of the system.
//
// Without --out, the program runs in real time, and file descriptor 3 is the master of a pseudo terminal: terminal.py
// opens it. The script begins when a program opens the terminal. With --out, the bytes of the port go to a file as fast as
// the machine runs the program, up to --until. --noise adds up to so many millivolts to each input; --without takes a
// converter away; --stall stops both SPI buses at a time; with --deaf, the computer takes nothing between two times.
//
// At the end, the last line says how many bytes nobody took, and by how much the emulator was late at most.

import { openSync, writeSync } from "node:fs";
import { parseArgs } from "node:util";

import { Board } from "./board.mjs";
import { Script } from "./script.mjs";
import { Terminal } from "./terminal.mjs";

const text = { type: "string" };
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { out: text, until: text, noise: text, without: text, stall: text, deaf: text },
});
const [modules, uf2, path] = positionals;
const number = (given) => (given === undefined ? undefined : Number(given));

const say = (line) => writeSync(1, `${line}\n`);
const script = new Script(path, (ms) => say(`mark ${ms.toFixed(3)} ${(Date.now() / 1000).toFixed(6)}`));
const board = new Board(modules, uf2, script, { without: number(values.without), stallMs: number(values.stall) });
board.noise = number(values.noise) ?? 0;
if (values.deaf) board.deafen(...values.deaf.split("-").map(Number));
let isStopped = false;
board.onWatchdog = () => {
  say(`watchdog at ${board.ms.toFixed(1)} ms`);
  isStopped = true;
};

/** Milliseconds that the firmware has to set itself up, before the computer asks for more. */
const SET_UP_MS = 100;

/** As fast as this machine can; says how the light shone in the last second. */
function runToFile() {
  const file = openSync(values.out, "w");
  let sent = 0;
  board.onBytes = (bytes) => {
    sent += writeSync(file, bytes);
  };
  const until = Number(values.until);
  let [changes, lit, was] = [0, 0, board.isLit];
  for (let ms = 1; ms <= until && !isStopped; ms++) {
    board.runUntil(ms);
    if (ms === SET_UP_MS) board.askSerialNumber((number) => say(`serial number ${number}`));
    if (ms > until - 1000) {
      changes += board.isLit !== was;
      lit += board.isLit;
    }
    was = board.isLit;
  }
  say(`light on for ${lit} ms of the last second, with ${changes} changes`);
  say(`sent ${sent} bytes, of which nobody took 0; late by 0.0 ms at most`);
}

if (values.out === undefined) {
  const terminal = new Terminal(3, board, say);
  process.on("SIGTERM", () => terminal.stop());
  process.on("SIGINT", () => terminal.stop());
  await terminal.serve();
} else {
  runToFile();
}
