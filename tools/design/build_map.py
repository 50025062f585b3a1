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

# From the id of a slider to its initial value.
TABS_TO_INITIAL = 26


class Places:
    """Where things are in a window of 1400 x 900 points with one notice, which `--wav` brings about anywhere."""

    kinds = (95, 167)  # the first of what can be put down
    next_kind, last_kind = 45, 215  # the distance, and the last kind when the list is scrolled to its end
    title, field = (1255, 188), (1255, 209)  # the layout's field, and the first one of a record
    design, trying = ((294, 824), 112.2), ((188, 829), 120)  # the floor's south-west corner, and a tile

    @classmethod
    def kind(cls, index):
        """How far down it is: in the first part from the top, in the rest from the end of the list."""
        return cls.kinds[1] + cls.next_kind * index if index < 8 else cls.last_kind - cls.next_kind * (18 - index)

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
    parser.add_argument("--pace", type=float, default=0.15, help="seconds from key to key; more on a busy machine")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    folder = tempfile.mkdtemp(prefix="underfoot-map-")
    path = os.path.join(folder, "mine.ron")
    open(path, "w").close()
    window = Window(program, [path, "--wav", os.path.join(folder, "sound.wav")], folder, args.shots,
                    args.pace)
    try:
        (by_keys if args.keys else by_mouse)(window)
        window.key("F2", settle=0.5)
        window.shot("6-saved")
        events = window.events()
    finally:
        window.close()
    for told in ('"pressed"', '"changed"', '"released"'):
        if told not in events or '"zoom"' not in events:
            sys.exit(f"the foot that tried it brought no {told}")
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
        window.key(*["Down"] * KINDS.index(control[0]))
        window.key("Return", "shift+F6", settle=0.2)
        fields(window, control)
        if number in (0, 4):
            window.shot(f"{3 if number == 0 else 4}-{control[1]}")
    window.key("F6", "F6", "F6")
    window.key(*["Tab"] * TABS_TO_INITIAL)
    window.type("0.3")
    window.key("Tab")
    window.key("ctrl+s", settle=0.6)
    # A foot on what has the keyboard: shift+Tab leads to the last control, the slider.
    window.key("F2", "shift+Tab", settle=0.5)
    window.x("keydown", "Return")
    window.key("Right", "Right", settle=0.3)
    window.shot("5-tried")
    window.x("keyup", "Return")


def by_mouse(window):
    at = Places.on
    window.key("F2")
    window.shot("1-empty")
    window.click(*Places.title)
    window.type("Map navigation")
    window.key("Tab")
    # The region: free floor, then the first of its fields.
    window.click(*at(Places.design, 3, 4.5))
    window.click(*Places.field)
    region(window)
    window.shot("2-region")
    for number, control in enumerate(CONTROLS):
        index = KINDS.index(control[0])
        window.move(*Places.kinds)
        window.x("click", "--repeat", 30, "--delay", 10, 4 if index < 8 else 5)
        window.steps += 1
        window.click(Places.kinds[0], Places.kind(index), settle=0.6)
        window.click(*at(Places.design, control[3][0] + control[4][0] / 2, control[3][1] + control[4][1] / 2))
        window.click(*Places.field)
        fields(window, control)
        if number in (0, 4):
            window.shot(f"{3 if number == 0 else 4}-{control[1]}")
    window.click(*Places.field)
    window.key(*["Tab"] * TABS_TO_INITIAL)
    window.type("0.3")
    window.key("Tab")
    window.key("ctrl+s", settle=0.6)
    window.key("F2", settle=0.6)
    window.click(*at(Places.trying, 0.5, 2.5), settle=0.6)
    window.drag(at(Places.trying, 5.0, 2.4), at(Places.trying, 5.6, 2.4), hold=0.3)
    window.shot("5-tried")


def region(window):
    """Its id, its depth, and how far north it begins: five tiles from there on would leave the floor."""
    window.type("map")
    window.key("Tab", "Tab", "Tab", "Tab")
    window.type("4")
    window.key("shift+Tab", "shift+Tab")
    window.type("2")
    window.key("Tab")


def same(program, path):
    """Ends with what differs between the file and the shipped one, if anything does."""
    resolved = [subprocess.run([program, "check", "--resolved", file], check=True, capture_output=True, text=True)
                .stdout for file in (path, SHIPPED)]
    if resolved[0] != resolved[1]:
        sys.exit(f"{path} is another layout than {SHIPPED}:\n" + "\n".join(resolved))


if __name__ == "__main__":
    main()
