// A Pico with the firmware of a UF2 file, its converters, and a computer at its USB socket.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

import { Mcp3208 } from "./mcp3208.mjs";

/** The outputs that select the converters of each SPI bus, as in firmware/pico/src/main.rs. */
const SELECTS = [
  [5, 6],
  [13, 14],
];
const LIGHT = 25;

const CHANNELS = 8;

/** Clocks of eight bits, and of the pause that the chip makes behind them. */
const CLOCKS_PER_BYTE = 10;

const FLASH = 0x1000_0000;

/** Where the program begins, behind the second stage of the boot loader. */
const PROGRAM = 0x1000_0100;

/** Its place among the emulator's parts. */
const WATCHDOG = 0x40058;

/** A request of USB for the text of the serial number. */
const GET_DESCRIPTOR = 6;
const TEXT = 3;
const SERIAL_NUMBER = 3;

/** The control of the endpoint with the bytes of the serial port, in the memory of the USB device. */
const DATA_TO_COMPUTER = 0x90;

const NANOS_PER_CYCLE = 8;
const MS = 1_000_000;

/** Writes the pages of a UF2 file into `flash`, as the boot loader of the chip does. */
function write(flash, uf2) {
  const blocks = new DataView(uf2.buffer, uf2.byteOffset, uf2.length);
  for (let at = 0; at < uf2.length; at += 512) {
    const [begin, , , address, length, number, count] = [0, 4, 8, 12, 16, 20, 24].map((field) => blocks.getUint32(at + field, true));
    if (begin !== 0x0a324655 || count * 512 !== uf2.length || number * 512 !== at) throw new Error("this is no UF2 file");
    flash.set(uf2.subarray(at + 32, at + 32 + length), address - FLASH);
  }
}

export class Board {
  /** `modules` is the folder of npm's; `faults` has `without`, a converter that is not there, and `stallMs`. */
  constructor(modules, uf2, script, faults = {}) {
    const { Simulator, USBCDC } = createRequire(`${resolve(modules)}/`)("rp2040js");
    ({ clock: this.clock, rp2040: this.chip } = new Simulator());
    this.chip.logger = { debug() {}, info() {}, warn() {}, error() {} };
    write(this.chip.flash, readFileSync(uf2));
    this.script = script;
    this.faults = faults;
    this.noise = 0;
    this.seed = 1;
    this.onBytes = () => {};
    this.onWatchdog = () => {};
    this.port = new USBCDC(this.chip.usbCtrl);
    this.port.onSerialData = (bytes) => this.onBytes(bytes);
    const watchdog = this.chip.peripherals[WATCHDOG];
    watchdog.onWatchdogTrigger = () => {
      // Its counter would stay at zero, and trigger for ever.
      watchdog.alarm.enable = false;
      this.onWatchdog();
    };
    SELECTS.forEach((selects, bus) => this.connect(bus, selects));
    this.start();
  }

  get ms() {
    return this.clock.nanos / MS;
  }

  get isLit() {
    return this.chip.gpio[LIGHT].outputValue;
  }

  /** Connects the converters of one bus. */
  connect(bus, selects) {
    const converters = selects.map((pin, at) => {
      const first = (selects.length * bus + at) * CHANNELS;
      const converter = new Mcp3208((channel) => this.millivolts(first + channel));
      this.chip.gpio[pin].addListener((state) => converter.select(state === 0, this.clock.nanos));
      return converter;
    });
    const spi = this.chip.spi[bus];
    let answer = 0xff;
    const done = this.clock.createAlarm(() => spi.completeTransmit(answer));
    spi.onTransmit = (byte) => {
      if (this.ms >= (this.faults.stallMs ?? Infinity)) return;
      const selected = converters.filter((converter, at) => converter.isSelected && selects.length * bus + at !== this.faults.without);
      if (selected.length > 1) throw new Error("two converters answer at once");
      answer = selected[0]?.exchange(byte) ?? 0xff;
      done.schedule((CLOCKS_PER_BYTE * 1e9) / spi.clockFrequency);
    };
  }

  /** The voltage of an input now, with the noise of a converter. */
  millivolts(input) {
    this.script.advance(this.ms - this.begunMs);
    this.seed = (Math.imul(this.seed, 1664525) + 1013904223) >>> 0;
    return this.script.millivolts[input] + this.noise * (this.seed / 2 ** 31 - 1);
  }

  /** Starts the program as the second stage of the boot loader does; its script begins now. */
  start() {
    const { core } = this.chip;
    core.VTOR = PROGRAM;
    core.SP = this.chip.readUint32(PROGRAM);
    core.PC = this.chip.readUint32(PROGRAM + 4) & ~1;
    this.begunMs = this.ms;
  }

  /** Makes the computer take nothing that is sent to it between these two times. */
  deafen(fromMs, toMs) {
    const { usbCtrl } = this.chip;
    const update = usbCtrl.DPRAMUpdated.bind(usbCtrl);
    const held = [];
    usbCtrl.DPRAMUpdated = (offset, value) => {
      const isHeld = offset === DATA_TO_COMPUTER && this.ms >= fromMs && this.ms < toMs;
      if (isHeld) held.push(value);
      else update(offset, value);
    };
    const again = this.clock.createAlarm(() => held.splice(0).forEach((value) => update(DATA_TO_COMPUTER, value)));
    again.schedule((toMs - this.ms) * MS);
  }

  /** Asks the USB device for its serial number: a text of two bytes a letter, behind its length and its sort. */
  askSerialNumber(onAnswer) {
    const { usbCtrl } = this.chip;
    const others = usbCtrl.onEndpointWrite;
    usbCtrl.onEndpointWrite = (endpoint, bytes) => {
      if (endpoint !== 0 || bytes[1] !== TEXT) return others(endpoint, bytes);
      usbCtrl.onEndpointWrite = others;
      onAnswer(Buffer.from(bytes.subarray(2)).toString("utf16le"));
    };
    usbCtrl.sendSetupPacket(Uint8Array.of(0x80, GET_DESCRIPTOR, SERIAL_NUMBER, TEXT, 0x09, 0x04, 64, 0));
  }

  /** Runs the program up to this time. */
  runUntil(ms) {
    const { clock } = this;
    const { core } = this.chip;
    const end = ms * MS;
    while (clock.nanosCounter < end) {
      if (core.waiting) {
        const next = clock.nextAlarm?.nanos ?? end;
        clock.tick(Math.max(Math.min(next, end) - clock.nanosCounter, 0));
      } else {
        clock.tick(core.executeInstruction() * NANOS_PER_CYCLE);
      }
    }
  }
}
