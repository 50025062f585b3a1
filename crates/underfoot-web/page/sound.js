// Plays the signals of the actuators: left and right in turn, some milliseconds at a time.

// Samples of both sides that wait before the sound begins, and at most: 40 ms against uneven frames, 250 ms after a stall.
const BEGIN = 2 * 0.040;
const MOST = 2 * 0.250;

class Actuators extends AudioWorkletProcessor {
  constructor() {
    super();
    this.waiting = [];
    this.count = 0;
    this.at = 0;
    this.plays = false;
    this.port.onmessage = ({ data }) => {
      this.waiting.push(data);
      this.count += data.length;
      while (this.count > MOST * sampleRate && this.waiting.length > 1) {
        this.count -= this.waiting.shift().length - this.at;
        this.at = 0;
      }
    };
  }

  next() {
    while (this.waiting.length > 0 && this.at >= this.waiting[0].length) {
      this.waiting.shift();
      this.at = 0;
    }
    if (this.waiting.length === 0) return 0;
    this.count -= 1;
    return this.waiting[0][this.at++];
  }

  process(_, [[left, right]]) {
    this.plays = this.plays ? this.count > 0 : this.count >= BEGIN * sampleRate;
    for (let frame = 0; this.plays && frame < left.length; frame += 1) {
      left[frame] = this.next();
      const other = this.next();
      if (right) right[frame] = other;
    }
    return true;
  }
}

registerProcessor("actuators", Actuators);
