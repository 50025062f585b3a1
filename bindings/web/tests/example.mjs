// The example page in headless Chromium continues after its floor was gone for a moment.
//
//     node example.mjs CHROMIUM UNDERFOOT
import { spawn } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createServer } from "node:http";
import { once } from "node:events";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import puppeteer from "puppeteer-core";

const [executablePath, underfoot] = process.argv.slice(2);
const html = await readFile(new URL("../../examples/web/page.html", import.meta.url));

async function listening(server) {
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  return server.address().port;
}

// A port that was free just before, and that each floor uses again.
const probe = createServer();
const address = `127.0.0.1:${await listening(probe)}`;
probe.close();
const folder = await mkdtemp(join(tmpdir(), "floor-"));

function serve() {
  const options = ["run", "map", "--listen", "127.0.0.1:0", "--web", address, "--no-osc", "--wav", "out.wav"];
  return spawn(resolve(underfoot), options, { cwd: folder, stdio: "ignore" });
}

const files = createServer((_, answer) => answer.end(html));
const port = await listening(files);
let floor = serve();
const browser = await puppeteer.launch({ executablePath, args: ["--no-sandbox"], headless: true });
let status = 1;
try {
  const page = await browser.newPage();
  page.on("pageerror", (error) => { throw error; });
  await page.goto(`http://127.0.0.1:${port}/page.html?floor=${address}`);
  const says = (id, text) =>
    page.waitForFunction((id, text) => document.getElementById(id)?.textContent.includes(text), {}, id, text);
  // Without packets each control says why it is off.
  await says("controls", "has not been sensed yet");
  for (const end of ["SIGKILL", "SIGTERM"]) {
    floor.kill(end);
    await says("link", "no connection");
    floor = serve();
    await says("link", "waiting");
    await says("controls", "has not been sensed yet");
  }
  console.log("example page: came back after each loss");
  status = 0;
} finally {
  await browser.close();
  floor.kill("SIGKILL");
  files.close();
  await rm(folder, { recursive: true, force: true });
}
process.exit(status);
