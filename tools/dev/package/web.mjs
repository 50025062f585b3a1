// An app on the package of npm beside a floor that the program serves: node web.mjs UNDERFOOT FOLDER. The folder has the
// installed package and press.mjs.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { fileURLToPath } from "node:url";
import { Site, until } from "../../../bindings/web/tests/harness.mjs";

const [underfoot, folder] = process.argv.slice(2);
const socket = fileURLToPath(new URL("../../../bindings/web/tests/socket.mjs", import.meta.url));
const site = await Site.make(underfoot, "map");
try {
  site.serve();
  await until("the web server", () => fetch(`http://${site.web}/`).catch(() => null));
  const app = ["--import", socket, "press.mjs", site.web];
  const pressing = spawn("node", app, { cwd: folder, stdio: ["ignore", "inherit", "inherit"] });
  site.play("tools/dev/package/press.ron");
  const [status] = await once(pressing, "exit");
  process.exitCode = status;
} finally {
  await site.end();
}
