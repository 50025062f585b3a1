// The dashboard in headless Chromium: a floor without packets, with feet that a control ignores, and gone.
//
//     node dashboard.mjs CHROMIUM UNDERFOOT [FOLDER]
//
// With FOLDER, screenshots of a desk and of a phone, light and dark, go there.
import assert from "node:assert/strict";
import { join } from "node:path";
import puppeteer from "puppeteer-core";
import { QUIET, Site, until } from "./harness.mjs";

const [executablePath, underfoot, pictures] = process.argv.slice(2);

const site = await Site.make(underfoot, "map");
const floor = site.serve();
const browser = await puppeteer.launch({ executablePath, args: QUIET, headless: true });
let status = 1;
try {
  const page = await browser.newPage();
  page.on("pageerror", (error) => { throw error; });
  page.on("request", (request) => assert.equal(new URL(request.url()).host, site.web, "no other host is asked"));
  // A refusal by the page's policy is an error in the console; so is a floor that is gone.
  const refused = [];
  page.on("console", (message) => { if (message.text().includes("Content Security Policy")) refused.push(message.text()); });
  const says = (id, text) =>
    page.waitForFunction((id, text) => document.getElementById(id)?.textContent.includes(text), {}, id, text);
  await until("the dashboard", () => page.goto(`http://${site.web}/dashboard`).catch(() => null));
  await says("status", "failed");
  await says("reasons", "waits for boards");
  await says("off", "has not been sensed yet");
  // An app switches a control off, over the page's own connection to the floor.
  await page.evaluate((web) => new Promise((done) => {
    const socket = new WebSocket(`ws://${web}/`);
    socket.onopen = () => { socket.send(JSON.stringify({ request: "widget/home/disable", args: [] })); setTimeout(done, 200); };
  }), site.web);
  const feet = site.play("crates/underfoot-cli/tests/program/visit.ron");
  await says("boards", "live");
  await says("ignored", "an app has switched it off");
  await says("counts", "disabled 1");
  if (pictures) {
    for (const [name, width, height] of [["desk", 1280, 900], ["phone", 390, 844]]) {
      for (const scheme of ["light", "dark"]) {
        await page.setViewport({ width, height });
        await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
        await page.screenshot({ path: join(pictures, `${name}_${scheme}.png`), fullPage: true });
        const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
        assert.equal(wide, false, `${name} scrolls sideways`);
      }
    }
  }
  feet.kill();
  await says("status", "failed");
  floor.kill();
  await says("status", "no connection");
  assert.deepEqual(refused, []);
  status = 0;
} finally {
  await browser.close();
  await site.end();
}
process.exit(status);
