// The web edition in headless Chromium, with real mouse, touch and keys: a press, two feet on two sliders, controls built
// in Design, sound, files, saving in place, a link opened by another visitor, bad links, a visit without a network.
//
//     node bindings/web/tests/edition.mjs CHROMIUM FOLDER [SCREENSHOTS]
//
// FOLDER is target/web, which `./dev web` makes. Widgets are found by their names in the reports of the window.
import assert from "node:assert/strict";
import { files } from "./edition/files.mjs";
import { Edition, linkTo, script, serve, stop, visitor } from "./edition/page.mjs";
import { saving } from "./edition/saving.mjs";

const [chromium, folder] = process.argv.slice(2);
await script(async (results) => {
  const server = await serve(folder);
  const home = `http://127.0.0.1:${server.address().port}/?screen_report`;
  const { browser } = await visitor(chromium);
  const edition = await Edition.open(browser, home);
  results.first_frame_s = Number(edition.first_s.toFixed(2));
  await edition.wait(500);
  await edition.picture("1-first");

  // A press with the mouse.
  await edition.choose("map");
  const at = await edition.middle("Home");
  await edition.page.mouse.move(at.x, at.y);
  await edition.wait(200);
  await edition.page.mouse.down();
  await edition.says("home");
  await edition.wait(400);
  await edition.picture("2-pressed");
  await edition.page.mouse.up();
  const { loudest, buzzes } = await edition.noted();
  assert.ok(loudest > 0.005, `the loudspeakers got ${loudest}`);
  assert.ok(buzzes > 0, "a phone would have buzzed");
  Object.assign(results, { pressed: "home", loudest: Number(loudest.toFixed(3)), buzzes });

  // Frames while a foot moves.
  const frames = async () => (await edition.noted()).frames;
  const [before, begun] = [await frames(), performance.now()];
  for (let step = 0; step < 120; step += 1) {
    await edition.page.mouse.move(at.x + 60 * Math.sin(step / 8), at.y + 40 * Math.cos(step / 8));
    await edition.wait(16);
  }
  results.frames_per_s = Number(((await frames()) - before) / ((performance.now() - begun) / 1000)).toFixed(1);

  // Two fingers are two feet, which drag two sliders at once.
  const two = await Edition.open(browser, home + linkTo("two.ron", `Layout(version: 1, title: "two",
    regions: [(id: "all", at: (0, 0), size: (6, 6), cursor: Each)],
    widgets: [(id: "one", kind: "slider", label: "One", at: (0.2, 1), size: (2.2, 1)),
      (id: "other", kind: "slider", label: "Other", at: (3.4, 1), size: (2.2, 1))])`));
  const wire = await two.page.createCDPSession();
  const used = async () => [await two.widget("One"), await two.widget("Other")];
  const rest = await used();
  // Feet on the floor at its start have to be lifted first.
  await two.wait(1500);
  const middles = rest.map(({ seen: [x0, y0, x1, y1] }) => ({ x: (x0 + x1) / 2, y: y0 + 0.6 * (y1 - y0) }));
  const touch = (type, points) => wire.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  const fingers = middles.map((at, id) => ({ ...at, id, force: 0.5 }));
  await touch("touchStart", fingers.slice(0, 1));
  await two.wait(400);
  await touch("touchStart", fingers);
  await two.wait(800);
  for (let step = 0; step <= 30; step += 1) {
    await touch("touchMove", middles.map((at, id) => ({ x: at.x + 2 * step, y: at.y, id, force: 0.5 })));
    await two.wait(30);
  }
  await two.wait(500);
  await two.picture("2c-two-fingers");
  for (const [index, { name, value, text }] of (await used()).entries()) {
    assert.notDeepEqual([value, text], [rest[index].value, rest[index].text], `${name} has moved`);
  }
  results.two_fingers = rest.map((widget) => widget.name);
  await touch("touchEnd", []);
  assert.deepEqual(two.errors, []);
  await two.page.close();

  // Three controls built in Design, on an empty floor.
  await edition.click("Design");
  await edition.click("File");
  await edition.click("New");
  await edition.click("Empty floor");
  await edition.wait(300);
  for (const [thing, dx, dy] of [["button", -120, 90], ["slider", 30, 0], ["switch", 130, -110]]) {
    // The list is longer than the window: it is found by its name.
    await edition.click("Search things");
    await edition.page.keyboard.down("Control");
    await edition.page.keyboard.press("a");
    await edition.page.keyboard.up("Control");
    await edition.page.keyboard.type(thing);
    await edition.wait(200);
    const [from, board] = [await edition.middle(`Put down: ${thing}`), await edition.middle("Drawing board")];
    await edition.page.mouse.move(from.x, from.y);
    await edition.page.mouse.down();
    await edition.page.mouse.move(board.x + dx, board.y + dy, { steps: 12 });
    await edition.wait(200);
    await edition.page.mouse.up();
    await edition.wait(300);
  }
  await edition.picture("3-design");

  // Share, and open the link in another browser.
  await edition.click("Share");
  const field = await edition.widget("Link");
  const link = field.text;
  await edition.wait(300);
  await edition.picture("4-share");
  assert.match(link, /#1\./, "the field holds the link");
  await edition.click("Close");
  results.link_letters = link.length;

  const other = await visitor(chromium);
  const opened = await Edition.open(other.browser, link);
  await opened.wait(500);
  await opened.picture("5-opened");
  await opened.click("Share");
  assert.equal((await opened.widget("Link")).text, link, "the same layout, to the byte");
  results.same_link = true;
  await opened.click("Close");

  // Files of the computer, those of the browser, and drafts.
  Object.assign(results, await files(other.browser, home), await saving(other.browser, home));

  // Bad links.
  for (const bad of ["#1.nonsense", link.slice(link.indexOf("#")).slice(0, -12), "#9.abc", "#top"]) {
    const page = await Edition.open(other.browser, `${home.split("?")[0]}?screen_report${bad}`);
    await page.says("cannot be shown");
    if (bad === "#1.nonsense") await page.picture("6-bad-link");
    assert.deepEqual(page.errors, []);
    await page.page.close();
  }
  results.bad_links = "a message each";

  // Without a network.
  await edition.page.waitForFunction(() => navigator.serviceWorker.controller !== null);
  await stop(server);
  await edition.page.reload();
  await edition.widget("Floor");
  results.offline = true;
  await edition.picture("7-offline");

  const foreign = [...edition.requests, ...opened.requests].filter((url) => !url.startsWith("http://127.0.0.1") && !url.startsWith("data:") && !url.startsWith("blob:"));
  assert.deepEqual(foreign, [], "requests to other hosts");
  assert.deepEqual(edition.errors, []);
});
