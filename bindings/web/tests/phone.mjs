// The web edition on a phone and a tablet, emulated: what fits on the screen, buttons for fingers, and controls pressed by
// touch, upright and across.
//
//     node bindings/web/tests/phone.mjs CHROMIUM FOLDER [SCREENSHOTS]
//
// FOLDER is target/web, which `./dev web` makes.
import assert from "node:assert/strict";
import { Edition, serve, visitor } from "./edition/page.mjs";

const [chromium, folder] = process.argv.slice(2);

/// Screens in points, as browsers count them, and their pixels per point. The browser gets the latter by a flag: if
/// puppeteer sets them, Chromium still reports the canvas in other pixels.
const SCREENS = {
  phone: { width: 390, height: 844, scale: 3 },
  phone_across: { width: 844, height: 390, scale: 3 },
  tablet: { width: 820, height: 1180, scale: 2 },
};

const server = await serve(folder);
const results = {};
let status = 1;
let end = () => {};
try {
  for (const [name, { scale, ...screen }] of Object.entries(SCREENS)) {
    const visit = await visitor(chromium, `--force-device-scale-factor=${scale}`);
    end = visit.end;
    const { browser } = visit;
    const viewport = { ...screen, deviceScaleFactor: 0, isMobile: true, hasTouch: true };
    const edition = await Edition.open(browser, `http://127.0.0.1:${server.address().port}/?screen_report`, () => {}, viewport);
    const wire = await edition.page.createCDPSession();
    const touch = (type, points) => wire.send("Input.dispatchTouchEvent", { type, touchPoints: points });
    const inPoints = ({ seen }) => seen.map((at) => at / scale);
    const middleOf = async (widget, role) => {
      const [x0, y0, x1, y1] = inPoints(await edition.widget(widget, role));
      return { x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
    };
    const tap = async (widget, role) => {
      await touch("touchStart", [{ ...await middleOf(widget, role), id: 1 }]);
      await edition.wait(120);
      await touch("touchEnd", []);
      await edition.wait(400);
    };
    await edition.wait(1500);
    await edition.picture(`${name}-1-first`);
    const isOpen = (await edition.report()).widgets.some((widget) => widget.name === "map" && widget.role === "Button");
    if (!isOpen) await tap("Layout", "ComboBox");
    await tap("map", "Button");
    await edition.wait(1500);
    await edition.picture(`${name}-2-map`);
    const [x0, y0, x1, y1] = inPoints(await edition.widget("Floor"));
    const { widgets } = await edition.report();
    const buttons = widgets.filter(({ role, seen }) => role === "Button" && seen).map((widget) => {
      const [left, top, right, bottom] = inPoints(widget);
      return { name: widget.name, width: Math.round(right - left), height: Math.round(bottom - top) };
    });
    results[name] = {
      floor_share: Number(((x1 - x0) * (y1 - y0) / screen.width / screen.height).toFixed(2)),
      smallest: buttons.toSorted((one, other) => Math.min(one.width, one.height) - Math.min(other.width, other.height)).slice(0, 4),
    };
    // A finger on a control.
    await touch("touchStart", [{ ...await middleOf("Home"), id: 1, force: 0.5 }]);
    await edition.wait(600);
    await edition.picture(`${name}-3-pressed`);
    await touch("touchEnd", []);
    await edition.wait(600);
    const { buzzes } = await edition.noted();
    assert.ok(buzzes > 0, `${name}: the phone buzzes under the finger`);
    await tap("Design");
    await edition.wait(800);
    await edition.picture(`${name}-4-design`);
    assert.deepEqual(edition.errors, []);
    await end();
    end = () => {};
  }
  console.log(JSON.stringify(results));
  status = 0;
} finally {
  if (status) console.error(JSON.stringify(results));
  await end();
  server.close();
}
process.exit(status);
