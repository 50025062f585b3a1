// The floor's plain page in headless Chromium: prints the lines that it receives, and the times at which it shows a
// control as held.
//
//     node page.mjs CHROMIUM 127.0.0.1:9002 beam [SCREENSHOT]
//
// SIGTERM ends it, after a screenshot of the page if SCREENSHOT is given; SIGUSR1 makes the page fail at each
// message, and SIGUSR2 closes its connection.
import puppeteer from "puppeteer-core";

const [executablePath, address, watched, picture] = process.argv.slice(2);
const print = (line) => console.log(JSON.stringify(line));

const browser = await puppeteer.launch({ executablePath, args: ["--no-sandbox"], headless: true });
const page = await browser.newPage();

async function end(status) {
  if (picture) await page.screenshot({ path: picture, fullPage: true });
  await browser.close();
  process.exit(status);
}
process.on("SIGTERM", () => end(0));
let hasToFail = false;
process.on("SIGUSR1", () => {
  hasToFail = true;
  page.evaluate(() => { take = () => { throw new Error("as it was asked to"); }; });
});
process.on("SIGUSR2", () => page.evaluate(() => socket.close()));

page.on("pageerror", (error) => {
  console.error(error);
  if (!hasToFail) end(1);
});
const wire = await page.createCDPSession();
await wire.send("Network.enable");
wire.on("Network.webSocketFrameReceived", ({ response }) => {
  const line = JSON.parse(response.payloadData);
  if (line.id && !["state", "ignored"].includes(line.event)) print(line);
});
// The visible state, by the clock that all programs of this machine share.
await page.exposeFunction("sayHeld", (held) => {
  const now_s = Number(process.hrtime.bigint()) / 1e9;
  print({ now_s, id: watched, held });
});
await page.goto(`http://${address}/plain`);
await page.waitForSelector("#row-" + watched);
if (await page.$("#row-zoom input")) {
  // A user sets a control on the page.
  await page.evaluate(() => {
    const input = document.querySelector("#row-zoom input");
    input.value = 0.5;
    input.dispatchEvent(new Event("change"));
  });
  await page.waitForFunction(() => document.querySelector("#row-zoom").cells[1].textContent === "0.5");
}
await page.evaluate((id) => {
  let was = false;
  const look = () => {
    const held = document.querySelector("#row-" + id).cells[2].textContent === "held";
    if (held !== was) sayHeld(held);
    was = held;
  };
  // Each layout creates new rows.
  new MutationObserver(look).observe(document.querySelector("#controls"), { childList: true, subtree: true });
  look();
}, watched);
print({ listening: address });
