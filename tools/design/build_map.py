"""Builds `layouts/map.ron` from an empty file in Design mode, tries it with a foot, saves it, and compares.

    python3 tools/design/build_map.py target/release/underfoot [--keys] [--shots FOLDER]

By mouse, which puts down and takes hold, and keys, which type; with `--keys` by keys alone. Everything is real input
on a display of its own. The saved file must resolve to the same layout as the shipped one: the two outputs of
`underfoot check --resolved` are compared, whatever order the controls came in.
"""
import argparse
import os
import subprocess
import sys
import tempfile

from window import Window

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHIPPED = os.path.join(ROOT, "layouts", "map.ron")

# Kind (its place in the list of what can be put down), id, label, at, size, in tiles.
CONTROLS = [
    ("button", "pan_north", "North", (1.9, 2.9), (0.6, 0.5)),
    ("button", "pan_south", "South", (1.9, 2.2), (0.6, 0.5)),
    ("button", "pan_west", "West", (1.1, 2.55), (0.55, 0.5)),
    ("button", "pan_east", "East", (2.75, 2.55), (0.55, 0.5)),
    ("round button", "home", "Home", (0.2, 2.2), (0.6, 0.6)),
    ("switch", "satellite", "Satellite", (3.6, 2.2), (0.7, 0.6)),
    ("slider", "zoom", "Zoom", (4.5, 2.2), (1.35, 0.6)),
]
KINDS = ["arc slider", "button", "confirm button", "dead man", "dial", "fader", "gesture button", "heavy button",
         "hold", "instant button", "lean", "pad", "pedal", "rate slider", "round button", "selector", "slider",
         "stepper", "switch"]


class Places:
    """Where things are in a window of 1400 x 900 points with one notice, which `--wav` brings about anywhere."""

    kinds = (95, 167)  # the first of what can be put down
    next_kind = 45
    title = field = None
    design, trying = ((294, 824), 112.2), ((188, 829), 120)  # the floor's south-west corner, and a tile

    @staticmethod
    def on(floor, east, north):
        (x, y), tile = floor
        return round(x + tile * east), round(y - tile * north)


def fields(window, control):
    """Fills in the fields of what is selected, from the id on, with the first one focused."""
    _, identity, label, at, size = control
    window.type(identity)
    window.key("Tab", "Tab")  # over the kind
    window.type(label)
    window.key("Tab", "Tab")  # over the x behind it
    # The size first: on the way, nothing overlaps or leaves the floor.
    window.key("Tab", "Tab")
    for length in size:
        window.type(str(length))
        window.key("Tab")
    window.key(*["shift+Tab"] * 4)
    for length in at:
        window.type(str(length))
        window.key("Tab")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--keys", action="store_true", help="by keys alone")
    parser.add_argument("--shots", help="folder for six pictures")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    folder = tempfile.mkdtemp(prefix="underfoot-map-")
    path = os.path.join(folder, "mine.ron")
    open(path, "w").close()
    window = Window(program, [path, "--wav", os.path.join(folder, "sound.wav")], folder, args.shots)
    try:
        (by_keys if args.keys else by_mouse)(window)
        window.key("ctrl+s", settle=0.6)
        window.shot("6-saved")
    finally:
        window.close()
    same(program, path)
    print(f"{path}: {window.steps} steps, the same layout as {os.path.relpath(SHIPPED)}")


def by_keys(window):
    window.key("F2", "F6", "F6", "F6")
    window.shot("1-empty")
    window.type("Map navigation")
    window.key("Tab")
    # The first row of the list is the region.
    window.key("shift+F6", "Return", "F6")
    region(window)
    window.shot("2-region")
    for number, control in enumerate(CONTROLS):
        window.key("F6")
        window.key(*["Down"] * KINDS.index(control[0]), settle=0.05)
        window.key("Return", "shift+F6")
        fields(window, control)
        window.shot({0: "3-first", 4: "4-five"}.get(number, "last"))
    initial(window)
    # The foot of the keyboard: the first control that Tab leads to is pressed.
    window.key("Escape", "F2")
    try_it(window, False)
    window.key("F2")


def by_mouse(window):
    window.key("F2")
    window.shot("1-empty")


def region(window):
    window.type("map")
    window.key("Tab", "Tab")
    window.type("2")
    window.key("Tab", "Tab")
    window.type("4")
    window.key("Tab")


def initial(window):
    pass


def try_it(window, by_mouse):
    pass


def same(program, path):
    """Ends with what differs between the file and the shipped one, if anything does."""
    resolved = [subprocess.run([program, "check", "--resolved", file], check=True, capture_output=True, text=True)
                .stdout for file in (path, SHIPPED)]
    if resolved[0] != resolved[1]:
        sys.exit(f"{path} is another layout than {SHIPPED}:\n" + "\n".join(resolved))


if __name__ == "__main__":
    main()
