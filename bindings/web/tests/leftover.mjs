// A floor that serves its page at an address where a browser has stored a page from static files: the browser leaves that
// page, and never shows it again.
//
//     node bindings/web/tests/leftover.mjs CHROMIUM FOLDER UNDERFOOT
//
// FOLDER is target/web, which `./dev web` makes; UNDERFOOT is the program, with the web edition or without.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { resolve } from "node:path";
import { answerFrom, atEnd, script, serve, stop, visitor } from "./edition/page.mjs";
import { freeAddress, until } from "./harness.mjs";

const [chromium, folder, underfoot] = process.argv.slice(2);
const [web, boards] = [await freeAddress(), await freeAddress()];
const home = `http://${web}/`;
await script(async (results) => {
  const { browser } = await visitor(chromium);
  // A visit of the static page, which the browser keeps.
  const server = await serve(folder, answerFrom(folder), Number(web.split(":")[1]));
  const page = await browser.newPage();
  await page.goto(home);
  await page.waitForFunction(() => document.getElementById("cover").hidden && navigator.serviceWorker.controller);
  await page.evaluate(() => {
    localStorage.setItem("underfoot:kept.ron", "a draft");
    return caches.open("another program's").then((cache) => cache.put("/x", new Response("y")));
  });
  await stop(server);
  await page.goto("about:blank");

  // The floor at the same address.
  const options = ["run", "map", "--listen", boards, "--web", web, "--no-osc", "--sound", "off"];
  const floor = spawn(resolve(underfoot), options, { stdio: "ignore" });
  atEnd(() => floor.kill("SIGKILL"));
  await until("the floor", () => fetch(`${home}health`).then(() => true, () => false));
  const begun = performance.now();
  await page.goto(home);
  const isOfFloor = () => page.evaluate(async () => {
    if (navigator.serviceWorker.controller) return false;
    const served = await fetch("served.js").then((answer) => answer.ok ? answer.text() : "plain", () => "");
    return served === "plain" || served.includes("/mirror");
  }).catch(() => false);
  await until("the floor's own page", isOfFloor, 60);
  const passed_s = Number(((performance.now() - begun) / 1000).toFixed(1));

  assert.deepEqual(await page.evaluate(() => caches.keys()), ["another program's"], "the stores of the static page are gone");
  assert.deepEqual(await page.evaluate(() => navigator.serviceWorker.getRegistrations().then((all) => all.length)), 0);
  assert.equal(await page.evaluate(() => localStorage.getItem("underfoot:kept.ron")), "a draft");
  // From now on at once.
  await page.goto(home);
  assert.ok(await isOfFloor(), "the next visit shows the floor's page");
  results.passed_s = passed_s;
});
