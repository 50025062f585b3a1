import { Floor } from "./floor.js";

export { BELIEVED_FOR } from "./holds.js";

/** Connects to a floor that `underfoot run --web` serves, and again whenever the connection ends. */
export function connect(address = "127.0.0.1:9002") {
  return new Floor(address);
}
