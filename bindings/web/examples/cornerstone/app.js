// Images that feet leaf through: `underfoot run surgical --web 127.0.0.1:9002`.
import { connect } from "underfoot";
import { RenderingEngine, init } from "@cornerstonejs/core";
import { init as initLoader, wadouri } from "@cornerstonejs/dicom-image-loader";

await init();
initLoader({ maxWebWorkers: 1, decodeConfig: { wasmBasePath: "./" } });
const engine = new RenderingEngine("engine");
engine.enableElement({ viewportId: "image", type: "stack", element: document.getElementById("image") });
const viewport = engine.getViewport("image");
const say = (id, text) => { document.getElementById(id).textContent = text; };
const floor = connect(new URLSearchParams(location.search).get("floor") ?? undefined);
onunhandledrejection = (event) => {
  event.preventDefault();
  say("note", `Not shown: ${event.reason.error?.message ?? event.reason.message}`);
};

async function show(index) {
  const last = viewport.getImageIds().length - 1;
  if (last < 0) return say("note", "Open a series first");
  const shown = Math.min(Math.max(index, 0), last), slices = floor.controls.get("slices");
  await viewport.setImageIdIndex(shown);
  say("place", `Image ${shown + 1} of ${last + 1}`);
  if (slices?.range[1] !== last + 1) floor.setRange("slices", 1, last + 1);
  if (slices?.value !== shown + 1) floor.set("slices", shown + 1);
}
document.getElementById("files").onchange = async ({ target }) => {
  const series = [...target.files].sort((one, other) => one.name.localeCompare(other.name));
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
