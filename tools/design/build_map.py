"""Builds `layouts/map.ron` from an empty file in Design mode, tries it with a foot, saves it, and compares.

    python3 tools/design/build_map.py target/release/underfoot [--keys] [--shots FOLDER]

By mouse, which puts down and takes hold, and keys, which type; with `--keys` by keys alone. Everything is real input
on a display of its own. The saved file must resolve to the same layout as the shipped one: the two outputs of
`underfoot check --resolved` are compared, whatever order the controls came in.
"""
import argparse
import difflib
import os
import subprocess
import sys
import tempfile
import time

from window import SIZE, Window

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHIPPED = os.path.join(ROOT, "layouts", "map.ron")

# Kind (its name in the list of what can be put down), id, label, at, size, in tiles.
CONTROLS = [
    ("button", "pan_north", "North", (1.9, 2.9), (0.6, 0.5)),
    ("button", "pan_south", "South", (1.9, 2.2), (0.6, 0.5)),
    ("button", "pan_west", "West", (1.1, 2.55), (0.55, 0.5)),
    ("button", "pan_east", "East", (2.75, 2.55), (0.55, 0.5)),
    ("round button", "home", "Home", (0.2, 2.2), (0.6, 0.6)),
    ("switch", "satellite", "Satellite", (3.6, 2.2), (0.7, 0.6)),
    ("slider", "zoom", "Zoom", (4.5, 2.2), (1.35, 0.6)),
]
# From the id of a slider to its initial value.
TABS_TO_INITIAL = 26

# Colours of the light theme: between plates, and behind what is typed.
SEAM, FIELD = 0xDCD6CB, 0xFAF8F4

# The floor's side, and the width of the frame around it, in metres.
FLOOR_M, FRAME_M, TILE_M = 1.824, 0.014, 0.304


class Floor:
    """Where the floor is on the screen: it is the square whose sides have the seams' colour."""

    def __init__(self, screen):
        rows = [y for y in range(screen.height) if screen.count_across(y, SEAM) > 400]
        columns = [x for x in range(screen.width) if screen.count_down(x, SEAM) > 400]
        if not rows or not columns:
            sys.exit("there is no floor on the screen")
        metre = (rows[-1] + 1 - rows[0]) / (FLOOR_M + FRAME_M)
        self.tile = TILE_M * metre
        self.west = columns[0] + 0.5 * FRAME_M * metre
        self.south = rows[-1] + 1 - 0.5 * FRAME_M * metre

    def at(self, east, north):
        """A place in tiles, on the screen."""
        return round(self.west + self.tile * east), round(self.south - self.tile * north)


class Things:
    """The list of what can be put down: the words of a search leave the wanted one in the first row."""

    # The search field, and the first row below it.
    SEARCH, FIRST = (90, 72), (120, 110)

    def __init__(self, window):
        self.window = window

    def click(self, kind):
        """Takes one of this kind in hand."""
        self.window.click(*self.SEARCH, settle=0.2)
        self.window.type(kind)
        self.window.click(*self.FIRST, settle=0.3)


def first_field(window):
    """The first field at the right that is typed into, once what is there stands still."""
    x, before = SIZE[0] - 78, None
    while True:
        screen = window.look()
        shown = screen.part(SIZE[0] - 300, 100, SIZE[0], SIZE[1] - 50)
        if shown == before:
            break
        before = shown
        time.sleep(0.2)
    found = screen.down(x, FIELD, range(14, 32), start=100)
    if not found:
        sys.exit("there is no field at the right")
    return x, sum(found[0]) // 2


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
        window.type(control[0])
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
    window.key("F2", settle=0.5)
    window.shot("1-empty")
    window.click(*first_field(window))
    window.type("Map navigation")
    window.key("Tab")
    # The region: free floor, then the first of its fields.
    floor, things = Floor(window.look()), Things(window)
    window.click(*floor.at(3, 4.5), settle=0.3)
    window.click(*first_field(window))
    region(window)
    window.shot("2-region")
    for number, control in enumerate(CONTROLS):
        _, _, _, (east, north), (width, depth) = control
        things.click(control[0])
        middle = (east + width / 2, north + depth / 2)
        if number == 0:
            # Taken hold of once more: put down a tile further north, and dragged south.
            window.click(*floor.at(middle[0], middle[1] + 1), settle=0.3)
            window.drag(floor.at(middle[0], middle[1] + 1), floor.at(*middle))
        else:
            window.click(*floor.at(*middle), settle=0.3)
        window.click(*first_field(window))
        fields(window, control)
        if number in (0, 4):
            window.shot(f"{3 if number == 0 else 4}-{control[1]}")
    window.click(*first_field(window))
    window.key(*["Tab"] * TABS_TO_INITIAL)
    window.type("0.3")
    window.key("Tab")
    window.key("ctrl+s", settle=0.6)
    window.key("F2", settle=0.6)
    floor = Floor(window.look())
    window.click(*floor.at(0.5, 2.5), settle=0.6)
    window.drag(floor.at(5.0, 2.4), floor.at(5.6, 2.4), hold=0.5, shot="5-tried")


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
        lines = [text.splitlines() for text in resolved]
        sys.exit("\n".join(difflib.unified_diff(*lines, path, SHIPPED, lineterm="", n=1)))


if __name__ == "__main__":
    main()
