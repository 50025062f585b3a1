// A page of an example in headless Chromium, and feet that play a scenario on a floor that the program serves.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import puppeteer from "puppeteer-core";
import { files, QUIET, Site } from "../harness.mjs";

/** Most lines of an example's own script. */
const LINES = 40;

/**
 * Checks the script of the example `name`, opens its page of the folder `built` in `executablePath`, and calls `prepare`;
 * then plays the scenario and calls `steps`. Each step ends with a screenshot in the folder `shots`, if there is one.
 */
export async function visit({ name, layout, executablePath, underfoot, built, shots }, prepare, steps) {
  const script = await readFile(new URL(`../../examples/${name}/app.js`, import.meta.url), "utf8");
  const lines = script.trimEnd().split("\n");
  const isShort = lines.length <= LINES && lines.every((line) => line.length <= 120);
  assert.ok(isShort, `${name}/app.js has ${lines.length} lines, or long ones`);
  console.log(`${name}: ${lines.length} lines of script`);

  const site = await Site.make(underfoot, layout);
  const served = await files(built);
  const floor = site.serve();
  const browser = await puppeteer.launch({ executablePath, args: QUIET, headless: true });
  try {
    const page = await browser.newPage();
    await page.setViewport({ width: 1000, height: 700 });
    const errors = [], hosts = new Set();
    page.on("pageerror", (error) => errors.push(error.message));
    const wire = await page.createCDPSession();
    await wire.send("Network.enable");
    wire.on("Network.requestWillBeSent", ({ request }) => hosts.add(new URL(request.url).host));
    wire.on("Network.webSocketCreated", ({ url }) => hosts.add(new URL(url).host));
    await page.goto(`http://${served.address}/${name}/?floor=${site.web}`);
    const includes = (id, text) => document.getElementById(id).textContent.includes(text);
    const says = (id, text) => page.waitForFunction(includes, { timeout: 60000 }, id, text);
    let step = 0;
    const shown = async (what) => {
      console.log(`${name}: ${++step}. ${what}`);
      if (shots) await page.screenshot({ path: join(shots, `${name}_${step}.png`) });
    };
    await says("link", "waiting");
    await prepare({ page, says, shown });
    const feet = site.play(`bindings/web/tests/pages/${name}.ron`);
    await steps({ page, says, shown });
    // The feet are gone, and so is the floor.
    feet.kill();
    floor.kill("SIGKILL");
    await says("link", "no connection");
    await shown("the floor is gone");
    assert.deepEqual(errors, []);
    // Blobs and data are of no host.
    hosts.delete("");
    assert.deepEqual([...hosts].sort(), [served.address, site.web].sort(), "no other host is asked");
  } finally {
    await browser.close();
    served.server.close();
    await site.end();
  }
}
