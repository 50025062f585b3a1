// The map with MapLibre GL, moved by feet: node maplibre.mjs CHROMIUM UNDERFOOT BUILT [SHOTS]
import assert from "node:assert/strict";
import { until } from "../harness.mjs";
import { visit } from "./visit.mjs";

const [executablePath, underfoot, built, shots] = process.argv.slice(2);

/** The colour of a corner of the map. */
async function corner(page) {
  const png = await page.screenshot({ encoding: "base64", clip: { x: 2, y: 62, width: 1, height: 1 } });
  return page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const pen = new OffscreenCanvas(1, 1).getContext("2d");
    pen.drawImage(image, 0, 0);
    return pen.getImageData(0, 0, 1, 1).data.slice(0, 3).join();
  }, png);
}

/** The country in the middle of the map, latitude and longitude in degrees, and the zoom. */
async function place(page) {
  const text = await page.$eval("#place", (element) => element.textContent);
  const [, country, latitude, longitude, zoom] = /^(.*) \((-?\d+), (-?\d+)\), zoom (.*)$/.exec(text);
  return { country, latitude: Number(latitude), longitude: Number(longitude), zoom: Number(zoom), text };
}

await visit({ name: "maplibre", layout: "map", executablePath, underfoot, built, shots },
  async ({ says, shown }) => {
    await says("place", "Germany (48, 10), zoom 3.0");
    await shown("the map rests over Germany");
  },
  async ({ page, says, shown }) => {
    const is = (what, check) => until(what, async () => check(await place(page)) && place(page));
    await says("link", "live");
    let now = await is("the map moves east", ({ longitude }) => longitude > 14);
    assert.equal(now.latitude, 48);
    await shown(`east: ${now.text}`);
    now = await is("the map moves south", ({ latitude }) => latitude < 44);
    await shown(`south: ${now.text}`);
    await until("the map rests", async () => {
      const before = now;
      await new Promise((done) => setTimeout(done, 500));
      now = await place(page);
      return before.text === now.text;
    });
    await says("note", "North did nothing: too light");
    assert.equal((await place(page)).text, now.text, "a light foot moves nothing");
    await shown("a foot too light");
    now = await is("the map is home", ({ text }) => text === "Germany (48, 10), zoom 3.0");
    await shown(`home: ${now.text}`);
    now = await is("the map is far away", ({ zoom }) => zoom < 1.5);
    await shown(`far: ${now.text}`);
    assert.equal(await corner(page), "169,203,220", "the flat map fills its corner");
    await until("the map is a globe", async () => (await corner(page)) === "255,255,255");
    await shown("a globe");
  });
