// The web edition on a phone and a tablet, emulated: all buttons are on the screen and large enough for fingers, the floor
// keeps half of it, panels fold, and controls are pressed by touch, upright and across.
//
//     node bindings/web/tests/phone.mjs CHROMIUM FOLDER [SCREENSHOTS]
//
// FOLDER is target/web, which `./dev web` makes.
import assert from "node:assert/strict";
import { Edition, script, serve, visitor } from "./edition/page.mjs";

const [chromium, folder] = process.argv.slice(2);

/// Screens in points, as browsers count them, and their pixels per point. The browser gets the latter by a flag: if
/// puppeteer sets them, Chromium still reports the canvas in other pixels.
const SCREENS = {
  phone: { width: 390, height: 844, scale: 3 },
  phone_across: { width: 844, height: 390, scale: 3 },
  tablet: { width: 820, height: 1180, scale: 2 },
};

/// The least height and width of a button for fingers in points, with the rounding to pixels. Icons differ by a point in
/// width.
const [LEAST_HEIGHT, LEAST_WIDTH] = [44 - 0.35, 43];

/// A visitor's page on a screen, with a finger.
class Hand {
  static async open(browser, address, { scale, ...screen }) {
    const viewport = { ...screen, deviceScaleFactor: 0, isMobile: true, hasTouch: true };
    const hand = new Hand();
    hand.edition = await Edition.open(browser, address, () => {}, viewport);
    hand.wire = await hand.edition.page.createCDPSession();
    return Object.assign(hand, { scale, screen });
  }

  /// The seen part of a widget, in points.
  seen({ seen }) {
    return seen.map((at) => at / this.scale);
  }

  touch(type, points) {
    return this.wire.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  }

  async middleOf(widget, role) {
    const [x0, y0, x1, y1] = this.seen(await this.edition.widget(widget, role));
    return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, id: 1 };
  }

  async tap(widget, role) {
    await this.tapAt(await this.middleOf(widget, role));
  }

  async tapAt(point) {
    await this.touch("touchStart", [point]);
    await this.edition.wait(120);
    const { frame } = await this.edition.report();
    await this.touch("touchEnd", []);
    await this.edition.wait(500);
    // Some frames later, the window shows what follows; on a busy machine that takes a while.
    for (let turn = 0; turn < 100 && (await this.edition.report()).frame < frame + 5; turn += 1) await this.edition.wait(50);
  }

  async isShown(name, role) {
    const { widgets } = await this.edition.report();
    return widgets.some((widget) => widget.name === name && widget.seen && (!role || widget.role === role));
  }

  /// The share of the screen that a widget has.
  async shareOf(name) {
    const [x0, y0, x1, y1] = this.seen(await this.edition.widget(name));
    return Number(((x1 - x0) * (y1 - y0) / this.screen.width / this.screen.height).toFixed(2));
  }

  /// The buttons above the floor: each is on the screen and large enough; returns the smallest size.
  async checkBar(floor, at) {
    const { widgets } = await this.edition.report();
    const [, top] = this.seen(await this.edition.widget(floor));
    const isButton = ({ role, seen }) => ["Button", "RadioButton", "ComboBox"].includes(role) && seen;
    const bar = widgets.filter((widget) => isButton(widget) && this.seen(widget)[3] <= top + 1);
    assert.ok(bar.length >= 8, `${at}: the bar has ${bar.map(({ name }) => name)}`);
    let smallest = Infinity;
    for (const { name, place, seen } of bar) {
      const [x0, y0, x1, y1] = place.map((side) => side / this.scale);
      assert.deepEqual(place, seen, `${at}: all of ${name} is seen`);
      assert.ok(y1 - y0 >= LEAST_HEIGHT && x1 - x0 >= LEAST_WIDTH, `${at}: ${name} is ${x1 - x0} x ${y1 - y0}`);
      assert.ok(x0 >= 0 && y0 >= 0 && x1 <= this.screen.width && y1 <= this.screen.height, `${at}: ${name} is at ${[x0, y0, x1, y1]}`);
      smallest = Math.min(smallest, x1 - x0, y1 - y0);
    }
    return Number(smallest.toFixed(1));
  }
}

/// Try: the bar, the floor, a press, a menu and the panel.
async function tryFloor(hand, name) {
  const { edition } = hand;
  await edition.wait(1500);
  await edition.picture(`${name}-1-first`);
  if (!await hand.isShown("map", "Button")) await hand.tap("Layout", "ComboBox");
  if (await hand.isShown("map", "Button")) await hand.tap("map", "Button");
  await edition.wait(1500);
  await edition.picture(`${name}-2-map`);
  const floor_share = await hand.shareOf("Floor");
  assert.ok(floor_share >= 0.5, `${name}: the floor has ${floor_share} of the screen`);
  const smallest_button = await hand.checkBar("Floor", name);
  // A finger on a control.
  await hand.touch("touchStart", [{ ...await hand.middleOf("Home"), force: 0.5 }]);
  await edition.wait(600);
  await edition.picture(`${name}-3-pressed`);
  await hand.touch("touchEnd", []);
  await edition.wait(600);
  const { buzzes } = await edition.noted();
  assert.ok(buzzes > 0, `${name}: the phone buzzes under the finger`);
  for (const menu of ["Appearance", "Help"]) {
    await hand.tap(menu);
    await edition.picture(`${name}-4-${menu.toLowerCase()}`);
    await edition.page.keyboard.press("Escape");
    await edition.wait(300);
  }
  await hand.tap("Panel");
  await edition.picture(`${name}-5-panel`);
  assert.ok(await hand.shareOf("Floor") > 0.25, `${name}: the floor stays beside the panel`);
  await hand.tap("Panel");
  return { floor_share, smallest_button };
}

/// Design: the panels are folded, a thing is put down by taps, and its fields are shown on request.
async function design(hand, name) {
  const { edition } = hand;
  await hand.tap("Design");
  await edition.wait(800);
  await edition.picture(`${name}-6-design`);
  const board_share = await hand.shareOf("Drawing board");
  assert.ok(board_share >= 0.5, `${name}: the drawing board has ${board_share} of the screen`);
  await hand.checkBar("Drawing board", `${name}, Design`);
  await hand.tap("Add");
  await edition.picture(`${name}-7-things`);
  assert.ok(await hand.shareOf("Drawing board") > 0.25, `${name}: the floor stays beside the things`);
  await hand.tap("Put down: button");
  assert.ok(!await hand.isShown("Put down: button"), `${name}: the list folds for the thing in hand`);
  const [x0, y0, x1, y1] = hand.seen(await edition.widget("Drawing board"));
  // The free part of the map's region, north of its controls: the floor fills the board from north to south if that is low.
  const down = hand.screen.width > hand.screen.height ? 0.25 : 0.33;
  await hand.tapAt({ x: x0 + 0.5 * (x1 - x0), y: y0 + down * (y1 - y0), id: 1 });
  await edition.picture(`${name}-8-put`);
  // What was put down is selected: its fields are those of the panel.
  await hand.tap("Panel");
  await edition.picture(`${name}-9-fields`);
  assert.ok(await hand.shareOf("Drawing board") > 0.25, `${name}: the floor stays beside the fields`);
  assert.ok(await hand.isShown("button"), `${name}: a tap puts the button down and selects it`);
  return { board_share };
}

await script(async (results) => {
  const server = await serve(folder);
  const address = `http://127.0.0.1:${server.address().port}/?screen_report`;
  for (const [name, screen] of Object.entries(SCREENS)) {
    const { browser, end } = await visitor(chromium, `--force-device-scale-factor=${screen.scale}`);
    const hand = await Hand.open(browser, address, screen);
    results[name] = await tryFloor(hand, name);
    Object.assign(results[name], await design(hand, name));
    assert.deepEqual(hand.edition.errors, []);
    await end();
  }
});
