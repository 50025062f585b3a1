// The OSC addresses of a floor as the npm package `oscquery` reads them.
//
//     node query.mjs UNDERFOOT
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import oscquery from "oscquery";

const probe = createServer().listen(0, "127.0.0.1");
await once(probe, "listening");
const { port } = probe.address();
probe.close();

const folder = await mkdtemp(join(tmpdir(), "floor-"));
const options = ["run", "map", "--listen", "127.0.0.1:0", `--discover=127.0.0.1:${port}`, "--no-osc", "--wav", "out.wav"];
const floor = spawn(resolve(process.argv[2]), options, { cwd: folder, stdio: "ignore" });
try {
  const service = new oscquery.DiscoveredService("127.0.0.1", port);
  for (let tries = 0; ; tries++) {
    try {
      await service.update();
      break;
    } catch (error) {
      // The floor may still be starting.
      if (tries === 100) throw error;
      await new Promise((done) => setTimeout(done, 100));
    }
  }
  assert.match(service.hostInfo.name, /^underfoot/);
  assert.equal(service.hostInfo.oscTransport, "UDP");
  assert.equal(service.hostInfo.extensions.LISTEN, true);
  const methods = new Map(service.flat().map((method) => [method.full_path, method]));
  const set = methods.get("/underfoot/widget/zoom/set"), value = methods.get("/underfoot/widget/zoom/value");
  assert.deepEqual(set.arguments[0].range, { min: 0, max: 1, vals: undefined });
  assert.equal(value.arguments[0].value, 0.3);
  assert.equal(service.resolvePath("/underfoot/widget/nobody"), null);
  console.log(`oscquery reads ${methods.size} addresses`);
} finally {
  floor.kill();
  await once(floor, "exit");
  await rm(folder, { recursive: true, force: true });
}
