// A board in real time behind the master of a pseudo terminal.

import { readSync, writeSync } from "node:fs";
import { setTimeout as sleep } from "node:timers/promises";

/** Milliseconds that the firmware has to set itself up, before anybody opens its port. */
const SET_UP_MS = 500;

/** Emulated milliseconds between two looks at the clock. */
const TURN_MS = 0.25;

/** Milliseconds between two looks at the terminal. */
const LOOK_MS = 20;

export class Terminal {
  sent = 0;
  lost = 0;
  lateMs = 0;
  isStopped = false;
  isOpen = false;

  constructor(file, board, say) {
    this.file = file;
    this.board = board;
    this.say = say;
    board.onBytes = (bytes) => this.send(bytes);
  }

  stop() {
    this.isStopped = true;
  }

  /** Whether a program has the other side open. */
  look() {
    try {
      readSync(this.file, Buffer.alloc(256));
      return true;
    } catch (error) {
      if (error.code === "EAGAIN") return true;
      if (error.code === "EIO") return false;
      throw error;
    }
  }

  send(bytes) {
    if (!this.isOpen) return;
    this.sent += bytes.length;
    let written = 0;
    try {
      written = writeSync(this.file, bytes);
    } catch (error) {
      if (error.code !== "EAGAIN" && error.code !== "EIO") throw error;
    }
    this.lost += bytes.length - written;
  }

  /** Waits until the terminal is open, and keeps real time until it is closed or the process has to end. */
  async serve() {
    this.board.runUntil(SET_UP_MS);
    while (!this.look() && !this.isStopped) await sleep(1);
    this.isOpen = true;
    const [begun, first] = [performance.now(), this.board.ms];
    this.board.begunMs = first;
    let lookAt = LOOK_MS;
    for (let ms = TURN_MS; !this.isStopped && this.isOpen; ms += TURN_MS) {
      const early = begun + ms - performance.now();
      if (early > 0) await sleep(early);
      else this.lateMs = Math.max(this.lateMs, -early);
      this.board.runUntil(first + ms);
      if (ms < lookAt) continue;
      lookAt = ms + LOOK_MS;
      this.isOpen = this.look();
      // Signals come between two turns.
      await sleep(0);
    }
    this.say(`sent ${this.sent} bytes, of which nobody took ${this.lost}; late by ${this.lateMs.toFixed(1)} ms at most`);
  }
}
