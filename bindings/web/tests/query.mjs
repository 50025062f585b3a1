// The OSC addresses of a floor as the npm package `oscquery` reads them.
//
//     node query.mjs UNDERFOOT
import assert from "node:assert/strict";
import oscquery from "oscquery";
import { freeAddress, Site, until } from "./harness.mjs";

const site = await Site.make(process.argv[2], "map");
const address = await freeAddress();
site.serve(`--discover=${address}`);
try {
  const service = new oscquery.DiscoveredService("127.0.0.1", Number(address.split(":")[1]));
  // The floor may still be starting.
  await until("a list of addresses", () => service.update().then(() => true, () => false));
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
  await site.end();
}
