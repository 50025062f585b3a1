// The six boards of the paper's floor at 1 kHz in newtons, on a thread of their own, with one foot that steps at command.
import dgram from "node:dgram";
import { once } from "node:events";
import { fileURLToPath } from "node:url";
import { isMainThread, parentPort, Worker, workerData } from "node:worker_threads";

/// Boards, and sensors of one: those of a row of six tiles.
const BOARDS = 6;
const SENSORS = 24;

/// The time of this machine in milliseconds, as pages have it too.
export const nowMs = () => performance.timeOrigin + performance.now();

/// Boards that send to `address` until they are ended.
export class Boards {
  static async start(address) {
    const boards = new Boards();
    boards.worker = new Worker(fileURLToPath(import.meta.url), { workerData: address });
    await once(boards.worker, "online");
    return boards;
  }

  /// Puts a foot of `force` newtons onto the middle of a tile; returns the time of its first packet.
  async step(column, row, force) {
    this.worker.postMessage({ tile: 6 * row + column, force });
    const [at] = await once(this.worker, "message");
    return at;
  }

  end() {
    return this.worker.terminate();
  }
}

function padded(text) {
  const bytes = Buffer.alloc(4 * Math.floor(text.length / 4 + 1));
  bytes.write(text, "latin1");
  return bytes;
}

function sendForEver([host, port]) {
  const socket = dgram.createSocket("udp4");
  // A floor that is killed leaves its port closed, and the boards go on.
  socket.on("error", (error) => { if (error.code !== "ECONNREFUSED") throw error; });
  const heads = Array.from({ length: BOARDS }, (_, board) =>
    Buffer.concat([padded(`/underfoot/board/${board}`), padded(`,i${"f".repeat(SENSORS)}`)]));
  let [sequence, foot, isNew] = [0, { tile: 0, force: 0 }, false];
  parentPort.on("message", (next) => { [foot, isNew] = [next, true]; });
  const begun = performance.now();
  const send = () => {
    while (sequence < performance.now() - begun) {
      if (isNew) parentPort.postMessage(nowMs());
      isNew = false;
      for (let board = 0; board < BOARDS; board += 1) {
        const values = Buffer.alloc(4 + 4 * SENSORS);
        values.writeInt32BE(sequence, 0);
        for (let sensor = 0; sensor < SENSORS; sensor += 1) {
          const isUnder = Math.floor((SENSORS * board + sensor) / 4) === foot.tile;
          const noise = 0.3 * (Math.random() - 0.5);
          values.writeFloatBE((isUnder ? foot.force / 4 : 0) + noise, 4 + 4 * sensor);
        }
        socket.send(Buffer.concat([heads[board], values]));
      }
      sequence += 1;
    }
    setTimeout(send, 1);
  };
  socket.connect(port, host, send);
}

if (!isMainThread) {
  const [host, port] = workerData.split(":");
  sendForEver([host, Number(port)]);
}
