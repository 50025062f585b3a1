// Images that feet leaf through: `underfoot run surgical --web 127.0.0.1:9002`.
import { connect } from "underfoot";
import { Enums, RenderingEngine, init } from "@cornerstonejs/core";
import { init as initLoader, wadouri } from "@cornerstonejs/dicom-image-loader";

await init();
initLoader({ maxWebWorkers: 1, decodeConfig: { wasmBasePath: "./" } });
const engine = new RenderingEngine("engine");
const element = document.getElementById("image");
engine.enableElement({ viewportId: "image", type: Enums.ViewportType.STACK, element });
const viewport = engine.getViewport("image");
const say = (id, text) => { document.getElementById(id).textContent = text; };
const floor = connect(new URLSearchParams(location.search).get("floor") ?? undefined);
const files = document.getElementById("files");

async function show(index) {
  const last = viewport.getImageIds().length - 1;
  if (last < 0) return say("note", "Open a series first");
  const shown = Math.min(Math.max(index, 0), last);
  await viewport.setImageIdIndex(shown);
  say("place", `Image ${shown + 1} of ${last + 1}`);
  floor.setRange("slices", 1, last + 1);
  floor.set("slices", shown + 1);
}
files.onchange = async () => {
  const series = [...files.files].sort((one, other) => one.name.localeCompare(other.name));
  await viewport.setStack(series.map((file) => wadouri.fileManager.add(file)));
  await show(0);
};
floor.on("clicked", "previous", () => show(viewport.getCurrentImageIdIndex() - 1));
floor.on("clicked", "next", () => show(viewport.getCurrentImageIdIndex() + 1));
floor.on("changed", "slices", ({ value }) => show(value - 1));
floor.on("changed", "light", ({ value }) => { viewport.setProperties({ invert: value }); viewport.render(); });
floor.on("clicked", "capture", () => {
  Object.assign(document.createElement("a"), { href: viewport.getCanvas().toDataURL(), download: "image.png" }).click();
});
floor.on("link", ({ link, why }) => say("link", why || link));
floor.on("ignored", ({ id, why }) => say("note", `${floor.controls.get(id).label} did nothing: ${why}`));
