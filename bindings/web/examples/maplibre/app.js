// A map that feet move: `underfoot run map --web 127.0.0.1:9002`.
import { connect } from "underfoot";
import { Map } from "maplibre-gl";
import "maplibre-gl/dist/maplibre-gl.css";
import style from "./style.json";

const HOME = { center: [10, 48], zoom: 3 };
// Speed of the map, in pixels per millisecond.
const SPEED = 0.25;

const map = new Map({ container: "map", attributionControl: false, style, ...HOME });
const say = (id, text) => { document.getElementById(id).textContent = text; };
map.on("idle", () => {
  const center = map.getCenter();
  const [country] = map.queryRenderedFeatures(map.project(center), { layers: ["land"] });
  const at = `(${center.lat.toFixed()}, ${center.lng.toFixed()}), zoom ${map.getZoom().toFixed(1)}`;
  say("place", `${country?.properties.name ?? "Open sea"} ${at}`);
});

await map.once("load");
const floor = connect(new URLSearchParams(location.search).get("floor") ?? undefined);
// The map moves for as long as a foot holds an arrow.
for (const [id, x, y] of [["pan_north", 0, -1], ["pan_south", 0, 1], ["pan_west", -1, 0], ["pan_east", 1, 0]]) {
  floor.whileHeld(id, () => {
    let last = performance.now();
    const timer = setInterval(() => {
      const step = SPEED * (performance.now() - last);
      last = performance.now();
      map.panBy([x * step, y * step], { duration: 0 });
    }, 16);
    return () => clearInterval(timer);
  });
}
floor.on("clicked", "home", () => map.flyTo({ ...HOME, duration: 800 }));
floor.on("changed", "zoom", ({ value }) => map.easeTo({ zoom: 1 + 6 * value, duration: 150 }));
floor.on("changed", "satellite", ({ value }) => map.setProjection({ type: value ? "globe" : "mercator" }));
floor.on("link", ({ link, why }) => say("link", why || link));
floor.on("ignored", ({ id, why }) => say("note", `${floor.controls.get(id).label} did nothing: ${why}`));
