// The countries of Natural Earth (public domain) as GeoJSON for flat maps.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { feature } from "topojson-client";

/** The countries at a scale of 1 to 110 million, each with its number and its name. */
export async function countries() {
  const file = createRequire(import.meta.url).resolve("world-atlas/countries-110m.json");
  const world = JSON.parse(await readFile(file, "utf8"));
  const { type, features } = feature(world, world.objects.countries);
  return { type, features: features.map((country) => ({ ...country, geometry: flat(country.geometry) })) };
}

function flat({ type, coordinates }) {
  return { type, coordinates: type === "Polygon" ? coordinates.map(unbroken) : coordinates.map((part) => part.map(unbroken)) };
}

// An outline over the 180th meridian goes on beyond it; one round a pole stays as it is.
function unbroken(ring) {
  let turns = 0;
  const outline = ring.map(([east, north], index) => {
    const step = index > 0 ? east - ring[index - 1][0] : 0;
    if (Math.abs(step) > 180) turns -= Math.sign(step);
    return [east + 360 * turns, north];
  });
  return turns === 0 ? outline : ring;
}
