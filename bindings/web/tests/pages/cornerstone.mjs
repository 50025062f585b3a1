// The images with Cornerstone3D, leafed through by feet: node cornerstone.mjs CHROMIUM UNDERFOOT BUILT SERIES [SHOTS]
//
// SERIES has the images of tools/apps/series.py, each with a white bar as long as its number, and compressed ones in
// `compressed`.
import assert from "node:assert/strict";
import { mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { until } from "../harness.mjs";
import { visit } from "./visit.mjs";

const [executablePath, underfoot, built, series, shots] = process.argv.slice(2);

/** The images in a folder, in the order of their names. */
async function images(folder) {
  const names = await readdir(folder);
  return names.filter((name) => name.endsWith(".dcm")).sort().map((name) => join(folder, name));
}

/** Length of the white bar in the picture on the screen, in pixels, and the brightness of its corner. */
function look(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector("#image canvas");
    const { width, height } = canvas, pen = new OffscreenCanvas(width, height).getContext("2d");
    pen.drawImage(canvas, 0, 0);
    // The image fills the height: 128 rows, of which 8 to 16 have the bar.
    const row = pen.getImageData(0, Math.round((12 / 128) * height), width, 1).data;
    let bar = 0, longest = 0;
    for (let at = 0; at < row.length; at += 4) {
      bar = row[at] > 250 ? bar + 1 : 0;
      longest = Math.max(longest, bar);
    }
    // One pixel of the image is so large.
    return { bar: longest / (height / 128), middle: pen.getImageData(width / 2, height / 2, 1, 1).data[0] };
  });
}

async function open(page, files, says) {
  await (await page.$("#files")).uploadFile(...files);
  await says("place", `Image 1 of ${files.length}`);
}

const taken = await mkdtemp(join(tmpdir(), "taken-"));
await visit({ name: "cornerstone", layout: "surgical", executablePath, underfoot, built, shots },
  async ({ page, says, shown }) => {
    const unreadable = fileURLToPath(import.meta.url);
    await (await page.$("#files")).uploadFile(unreadable);
    await says("note", "Not shown");
    await shown("a file that is no image");
    await open(page, await images(join(series, "compressed")), says);
    await until("a compressed image is shown", async () => (await look(page)).middle > 20);
    await shown("a compressed image");
    await open(page, await images(series), says);
    await shown("a series is open");
    const wire = await page.browser().target().createCDPSession();
    await wire.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: taken });
  },
  async ({ page, says, shown }) => {
    const is = (number) => until(`image ${number} is shown`, async () => {
      const { bar } = await look(page);
      return Math.abs(bar - 9 * number) < 3 && says("place", `Image ${number} of 12`);
    });
    await is(1);
    await is(2);
    await shown("next: image 2");
    await is(3);
    await shown("next: image 3");
    await says("note", "Next did nothing: too light");
    await is(3);
    await shown("a foot too light");
    await is(2);
    await shown("previous: image 2");
    await is(11);
    await shown("the slider: image 11");
    const { middle } = await look(page);
    await until("the image is inverted", async () => Math.abs((await look(page)).middle - (255 - middle)) < 3);
    await shown("light");
    const picture = await until("a picture is taken", () => readFile(join(taken, "image.png")).catch(() => null));
    assert.equal(picture.subarray(1, 4).toString(), "PNG");
    await shown("a picture is taken");
  });
await rm(taken, { recursive: true });
