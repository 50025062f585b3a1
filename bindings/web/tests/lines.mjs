// The floor through the package, without a browser: prints its events, and the beginning and end of each hold of a
// control.
//
//     node --import ./socket.mjs lines.mjs 127.0.0.1:9002 beam
//
// SIGTERM ends it, SIGUSR1 makes it fail at the next line, so that it watches no more, and SIGUSR2 closes the floor.
import { connect } from "underfoot";

const [address, watched] = process.argv.slice(2);
const print = (line) => console.log(JSON.stringify(line));
let hasToFail = false;

const floor = connect(address);
floor.on("floor", () => print({ listening: address }));
// What runs while the foot holds stops at the end of the hold.
const off = floor.whileHeld(watched, () => {
  const say = (held) => print({ now_s: Number(process.hrtime.bigint()) / 1e9, id: watched, held });
  say(true);
  return () => say(false);
});
floor.on("line", (line) => {
  if (hasToFail) {
    off();
    throw new Error("as it was asked to");
  }
  if (line.id && !["state", "ignored"].includes(line.event)) print(line);
});
process.on("SIGTERM", () => process.exit());
process.on("SIGUSR1", () => { hasToFail = true; });
process.on("SIGUSR2", () => floor.close());
