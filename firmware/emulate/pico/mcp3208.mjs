// Converters of eight inputs and 12 bits behind SPI, bit by bit as their data sheet has it.

const SUPPLY_MV = 3300;
const GREATEST = 4095;

/** Least time for which it must not be selected between two conversions. */
const UNSELECTED_NS = 500;

/** A line that nobody drives, with a resistor to the supply. */
const UNDRIVEN = 1;

/** Clocks from the start bit on: four bits of the request, one to sample, a zero, and the result. */
const REQUEST = 4;
const ZERO = REQUEST + 2;
const END = ZERO + 12;

export class Mcp3208 {
  isSelected = false;
  /** Clocks since the start bit; `null` before it. */
  clocks = null;
  request = 0;
  result = 0;

  /** Nanoseconds at which it was last deselected. */
  deselected = -Infinity;

  /** `millivolts(channel)` is the voltage at an input now. */
  constructor(millivolts) {
    this.millivolts = millivolts;
  }

  /** Selects it, or not, at this time in nanoseconds. */
  select(isSelected, now) {
    if (isSelected === this.isSelected) return;
    this.isSelected = isSelected;
    if (!isSelected) {
      this.deselected = now;
      return;
    }
    if (now - this.deselected < UNSELECTED_NS) throw new Error(`a converter is selected again after ${now - this.deselected} ns`);
    this.clocks = null;
  }

  /** Exchanges eight bits, the highest first. */
  exchange(byte) {
    let answer = 0;
    for (let bit = 7; bit >= 0; bit--) answer = (answer << 1) | this.clock((byte >> bit) & 1);
    return answer;
  }

  clock(bit) {
    if (this.clocks === null) {
      if (bit === 1) {
        this.clocks = 0;
        this.request = 0;
      }
      return UNDRIVEN;
    }
    this.clocks++;
    if (this.clocks <= REQUEST) {
      this.request = (this.request << 1) | bit;
      return UNDRIVEN;
    }
    if (this.clocks < ZERO) {
      const isSingleEnded = this.request & 8;
      if (!isSingleEnded) throw new Error("the firmware asks for a difference of two inputs");
      const count = Math.floor((this.millivolts(this.request & 7) * (GREATEST + 1)) / SUPPLY_MV);
      this.result = Math.min(Math.max(count, 0), GREATEST);
      return UNDRIVEN;
    }
    return this.clocks > ZERO && this.clocks <= END ? (this.result >> (END - this.clocks)) & 1 : 0;
  }
}
