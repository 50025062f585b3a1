// The page of controls in headless Chromium: it says why controls are off and that they are on, and continues after
// its floor was gone for a moment.
//
//     node example.mjs CHROMIUM UNDERFOOT
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";
import { files, QUIET, Site } from "./harness.mjs";

const [executablePath, underfoot] = process.argv.slice(2);
const site = await Site.make(underfoot, "map");
const served = await files(fileURLToPath(new URL("..", import.meta.url)));
let floor = site.serve();
const browser = await puppeteer.launch({ executablePath, args: QUIET, headless: true });
let status = 1;
try {
  const page = await browser.newPage();
  page.on("pageerror", (error) => { throw error; });
  await page.goto(`http://${served.address}/examples/controls/?floor=${site.web}`);
  const says = (id, text) =>
    page.waitForFunction((id, text) => document.getElementById(id)?.textContent.includes(text), {}, id, text);
  // Without packets each control says why it is off.
  await says("controls", "has not been sensed yet");
  for (const end of ["SIGKILL", "SIGTERM"]) {
    floor.kill(end);
    await says("link", "no connection");
    floor = site.serve();
    await says("link", "waiting");
    await says("controls", "has not been sensed yet");
  }
  // With packets, that they are on.
  site.play("crates/underfoot-cli/tests/program/visit.ron");
  await says("control-zoom", "of 0 to 1");
  await page.waitForFunction(() => document.querySelectorAll(".off").length === 0);
  console.log("example page: came back after each loss");
  status = 0;
} finally {
  await browser.close();
  served.server.close();
  await site.end();
}
process.exit(status);
