// Scripted voltages: each line is `ms input millivolts`, in order of time; input -1 is a mark.

import { readFileSync } from "node:fs";

/** The inputs of all converters. */
export const INPUTS = 32;

const MARK = -1;

export class Script {
  /** Millivolts of each input now. */
  millivolts = new Float64Array(INPUTS);

  constructor(path, onMark = () => {}) {
    const numbers = Float64Array.from(readFileSync(path, "utf8").split(/\s+/).filter(Boolean), Number);
    if (numbers.length % 3 !== 0 || numbers.some(Number.isNaN)) throw new Error(`a line is not \`ms input value\`: ${path}`);
    for (let at = 0; at < numbers.length; at += 3) {
      const input = numbers[at + 1];
      if (!(Number.isInteger(input) && input >= MARK && input < INPUTS)) throw new Error(`inputs are 0 to 31, or -1: ${path}`);
      if (at > 0 && numbers[at] < numbers[at - 3]) throw new Error(`a line is earlier than the one before: ${path}`);
    }
    this.numbers = numbers;
    this.next = 0;
    this.onMark = onMark;
  }

  /** Makes the changes up to this time. */
  advance(ms) {
    const { numbers } = this;
    for (; this.next < numbers.length && numbers[this.next] <= ms; this.next += 3) {
      const input = numbers[this.next + 1];
      if (input === MARK) this.onMark(numbers[this.next]);
      else this.millivolts[input] = numbers[this.next + 2];
    }
  }
}
