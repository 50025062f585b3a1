"""Quick drags over the sliders of the shipped layouts by a real mouse.

    python3 tools/design/drags.py target/release/underfoot [--busy]

The mouse rests for 0.4 s and drags at 0.2 to 1 m/s, 20 times on each slider. Each time the value must come to where the
mouse ended, with one foot all the way and no link lost. With `--busy` two other processes keep all they can of two cores.
"""
import argparse
import json
import os
import sys
import tempfile
import time

from build_map import ROOT, busy
from window import Floor, Window

ROUNDS = 20
# Layout, id, west and north end and size in tiles, the range of values.
SLIDERS = [
    ("map", "zoom", (4.5, 2.2), (1.35, 0.6), (0, 1)),
    ("first_steps", "volume", (2.2, 2.2), (1.6, 0.6), (0, 100)),
    ("surgical", "slices", (1.9, 2.15), (2.2, 0.55), (1, 60)),
    ("all_controls", "volume", (5, 2.9), (0.9, 0.55), (0, 100)),
]
TILE_M = 0.304
# Between these shares of a slider's length it is dragged to and fro; its value may be so far off, in parts of the range: the
# ends of a slider lie within its edge, and steps round.
ENDS, OFF = (0.25, 0.75), 0.15
# How often a mouse tells its place.
EVERY_S = 0.01


def drag(window, start, end, seconds):
    """Rests, drags, lifts."""
    start, end = (tuple(map(round, place)) for place in (start, end))
    window.x("mousemove", *start)
    time.sleep(0.1)
    window.x("mousedown", 1)
    time.sleep(0.4)
    begun = time.monotonic()
    while (share := min(1, (time.monotonic() - begun) / seconds)) < 1:
        window.x("mousemove", *(round(a + (b - a) * share) for a, b in zip(start, end)))
        time.sleep(EVERY_S)
    window.x("mousemove", *end)
    time.sleep(0.5)
    window.x("mouseup", 1)
    time.sleep(0.4)


def lines(window, begin):
    """The lines told since byte `begin`, and where they end."""
    text = window.events()[begin:]
    whole = text[:text.rfind("\n") + 1]
    return [json.loads(line) for line in whole.splitlines()], begin + len(whole)


def try_slider(program, layout, name, at, size, values):
    folder = tempfile.mkdtemp(prefix="underfoot-drags-")
    path = os.path.join(ROOT, "layouts", layout + ".ron")
    window = Window(program, [path, "--json-contacts"], folder)
    try:
        floor = Floor(window)
        places = [floor.at(at[0] + size[0] * share, at[1] + size[1] / 2) for share in ENDS]
        length_m = (ENDS[1] - ENDS[0]) * size[0] * TILE_M
        followed, alone, linked, told = 0, 0, 0, len(window.events())
        for number in range(ROUNDS):
            speed = 0.2 + 0.8 * number / (ROUNDS - 1)
            way = (0, 1) if number % 2 == 0 else (1, 0)
            drag(window, places[way[0]], places[way[1]], length_m / speed)
            heard, told = lines(window, told)
            last = [line["value"] for line in heard if line.get("event") == "changed" and line.get("id") == name]
            goal = values[0] + ENDS[way[1]] * (values[1] - values[0])
            followed += bool(last) and abs(last[-1] - goal) < OFF * (values[1] - values[0])
            alone += all(len(line["contacts"]) < 2 for line in heard if line.get("event") == "contacts")
            linked += not any(line.get("event") == "link" for line in heard)
    finally:
        window.close()
    print(f"{layout} {name}: {followed} of {ROUNDS} followed, {alone} with one foot, {linked} with their link", flush=True)
    return followed == alone == linked == ROUNDS


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--busy", action="store_true", help="keep two cores busy meanwhile")
    args = parser.parse_args()
    with busy(2 * args.busy):
        good = [try_slider(os.path.abspath(args.program), *slider) for slider in SLIDERS]
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
