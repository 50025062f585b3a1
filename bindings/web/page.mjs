// The floor's page in headless Chromium: prints the lines that it hears, and when it shows a control as held.
//
//     node page.mjs UNDERFOOT ADDRESS LAYOUT ID
//
// UNDERFOOT is the program, which serves the page. SIGTERM ends it.
import { spawn } from "node:child_process";
import { createServer } from "node:net";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import chromium from "@sparticuz/chromium";
import puppeteer from "puppeteer-core";

const [program, address, layout, watched] = process.argv.slice(2);
const print = (line) => console.log(JSON.stringify(line));

async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => server.once("listening", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

const folder = mkdtempSync(join(tmpdir(), "floor-"));
const web = `127.0.0.1:${await freePort()}`;
const sound = join(folder, "out.wav");
const floor = spawn(program, ["run", layout, "--listen", address, "--web", web, "--no-osc", "--wav", sound], {
  stdio: ["ignore", "ignore", "pipe"],
});
const served = new Promise((resolve) => {
  floor.stderr.on("data", (text) => { if (String(text).includes("as a web page")) resolve(); });
});
const browser = await puppeteer.launch({
  args: [...chromium.args, "--no-sandbox"],
  executablePath: await chromium.executablePath(),
  headless: "shell",
});

async function end(status) {
  await browser.close();
  floor.kill();
  await new Promise((resolve) => floor.once("exit", resolve));
  rmSync(folder, { recursive: true });
  process.exit(status);
}
process.on("SIGTERM", () => end(0));

const page = await browser.newPage();
page.on("pageerror", (error) => { console.error(error); end(1); });
const wire = await page.createCDPSession();
await wire.send("Network.enable");
wire.on("Network.webSocketFrameReceived", ({ response }) => {
  const line = JSON.parse(response.payloadData);
  if (line.id && line.event !== "state") print(line);
});
// What a person sees, by the clock that all programs of this machine share.
await page.exposeFunction("sayHeld", (held) => {
  const now_s = Number(process.hrtime.bigint()) / 1e9;
  print({ now_s, id: watched, held });
});
await served;
await page.goto(`http://${web}/`);
await page.waitForSelector("#row-zoom input");
// Somebody sets a control on the page.
await page.evaluate(() => {
  const input = document.querySelector("#row-zoom input");
  input.value = 0.5;
  input.dispatchEvent(new Event("change"));
});
await page.waitForFunction(() => document.querySelector("#row-zoom").cells[1].textContent === "0.5");
await page.evaluate((id) => {
  let was = false;
  const look = () => {
    const held = document.querySelector("#row-" + id).cells[2].textContent === "held";
    if (held !== was) sayHeld(held);
    was = held;
    requestAnimationFrame(look);
  };
  look();
}, watched);
print({ listening: address });
