"""Builds `layouts/map.ron` from an empty file in Design mode, tries it with a foot, saves it, and compares.

    python3 tools/design/build_map.py target/release/underfoot [--keys] [--busy N] [--shots FOLDER]

By mouse, which puts down, takes hold and chooses fields, and keys, which type; with `--keys` by keys alone. Everything is
real input on a display of its own, and waits for what the window shows; `--busy` lets so many other processes take all
they can of this machine meanwhile. The saved file must resolve to the same layout as the shipped one: the two outputs
of `underfoot check --resolved` are compared, whatever order the controls came in.
"""
import argparse
import contextlib
import difflib
import os
import subprocess
import sys
import tempfile

from window import Floor, Window

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHIPPED = os.path.join(ROOT, "layouts", "map.ron")

# Kind (its name in the list at the left), id, label, at, size, in tiles.
CONTROLS = [
    ("button", "pan_north", "North", (1.9, 2.9), (0.6, 0.5)),
    ("button", "pan_south", "South", (1.9, 2.2), (0.6, 0.5)),
    ("button", "pan_west", "West", (1.1, 2.55), (0.55, 0.5)),
    ("button", "pan_east", "East", (2.75, 2.55), (0.55, 0.5)),
    ("round button", "home", "Home", (0.2, 2.2), (0.6, 0.6)),
    ("switch", "satellite", "Satellite", (3.6, 2.2), (0.7, 0.6)),
    ("slider", "zoom", "Zoom", (4.5, 2.2), (1.35, 0.6)),
]


class Fields:
    """The fields at the right, found by their names: by mouse, or with `is_keys` by Tab from where the keyboard is."""

    ROLES = ("TextInput", "SpinButton")

    def __init__(self, window, is_keys):
        self.window, self.is_keys = window, is_keys

    def seen(self, name):
        found = [field for role in self.ROLES for field in self.window.all(name, role)]
        return found[0] if found else None

    def fill(self, name, text):
        """Puts `text` in place of what the field called `name` says."""
        self.reach(name) if self.is_keys else self.click(name)
        self.window.until(lambda: (self.seen(name) or {}).get("has_focus"), f"the keyboard in {name}")
        self.window.type(text)
        self.window.key("Tab")

    def click(self, name):
        window = self.window
        # The panel of fields is a column below its heading at the right edge.
        x, y = window.report()["size"][0] - 60, window.report()["size"][1] / 2
        while self.seen(name) is None:
            window.wheel(x, y, 3, "wheel over the fields")
        window.click(*centre(self.seen(name)), what=name)

    def reach(self, name):
        """Tab after Tab, or back where the field is above."""
        window = self.window
        for _ in range(80):
            focused = next((widget for widget in window.report()["widgets"] if widget["has_focus"]), None)
            wanted = next((widget for widget in window.report()["widgets"]
                           if widget["name"] == name and widget["role"] in self.ROLES), None)
            if wanted and wanted["has_focus"]:
                return
            is_above = wanted and focused and order(wanted) < order(focused)
            window.key("shift+Tab" if is_above else "Tab")
        sys.exit(f"no Tab leads to {name}")


def order(widget):
    left, top, *_ = widget["place"]
    return round(top / 8), left


def centre(widget):
    left, top, right, bottom = widget["seen"]
    return (left + right) / 2, (top + bottom) / 2


@contextlib.contextmanager
def busy(count):
    """So many processes that take all they can of the machine."""
    spins = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in spins:
            process.kill()
            process.wait()


def is_on(window, name):
    return any(widget["is_on"] for widget in window.all(name))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--keys", action="store_true", help="by keys alone")
    parser.add_argument("--busy", type=int, default=0, help="number of other busy processes")
    parser.add_argument("--shots", help="folder for six pictures")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    folder = tempfile.mkdtemp(prefix="underfoot-map-")
    path = os.path.join(folder, "mine.ron")
    open(path, "w").close()
    with busy(args.busy):
        window = Window(program, [path, "--wav", os.path.join(folder, "sound.wav")], folder, args.shots)
        try:
            (by_keys if args.keys else by_mouse)(window, path)
            window.key("F2")
            window.shot("6-saved")
            events = window.events()
        finally:
            window.close()
    for told in ('"pressed"', '"changed"', '"released"'):
        if told not in events or '"zoom"' not in events:
            sys.exit(f"the foot that tried it brought no {told}")
    same(program, path)
    print(f"{path}: {window.count} actions, the same layout as {os.path.relpath(SHIPPED)}")


def by_keys(window, path):
    fields = Fields(window, True)
    window.key("F2", "F6", "F6", "F6")
    window.shot("1-empty")
    fields.fill("Title", "Map navigation")
    # The first row of the list is the region.
    window.key("shift+F6")
    window.until(lambda: window.has_focus("Region main"), "the keyboard in the list")
    window.key("Return", "F6")
    region(window, fields)
    window.shot("2-region")
    for number, control in enumerate(CONTROLS):
        window.key("F6")
        window.until(lambda: window.has_focus("Search things"), "the keyboard in the search")
        window.type(control[0])
        window.key("Return", "shift+F6")
        fill(fields, control)
        if number in (0, 4):
            window.shot(f"{3 if number == 0 else 4}-{control[1]}")
    fields.fill("Starts at", "0.3")
    save(window, path)
    # A foot on the control that has the keyboard: shift+Tab leads to the last control, the slider.
    window.key("F2")
    window.until(lambda: is_on(window, "Try"), "Try")
    while not window.has_focus("Zoom", "Slider"):
        window.key("shift+Tab")
    window.hold("Return")
    window.until(lambda: '"pressed"' in window.events(), "a press by keys")
    window.key("Right", "Right")
    window.until(lambda: '"changed"' in window.events(), "a slide by keys")
    window.shot("5-tried")
    window.release("Return")
    window.note("hold Return")
    window.until(lambda: '"released"' in window.events(), "the end of the press")


def by_mouse(window, path):
    fields = Fields(window, False)
    window.key("F2")
    window.until(lambda: is_on(window, "Design"), "Design")
    window.shot("1-empty")
    fields.fill("Title", "Map navigation")
    floor = Floor(window)
    window.click(*floor.at(3, 4.5), what="the region")
    window.until(lambda: is_on(window, "Region main"), "the region selected")
    region(window, fields)
    window.shot("2-region")
    for number, control in enumerate(CONTROLS):
        kind, _, _, (east, north), (width, depth) = control
        window.click_on("Search things")
        window.type(kind)
        window.click_on(f"Put down: {kind}")
        floor = Floor(window)
        goal = floor.at(east + width / 2, north + depth / 2)
        if number == 0:
            # Taken hold of once more: put down a tile further north, and dragged south.
            above = floor.at(east + width / 2, north + depth / 2 + 1)
            window.click(*above, what="the floor")
            window.drag(above, goal, what="it")
        else:
            window.click(*goal, what="the floor")
        fill(fields, control)
        if number in (0, 4):
            window.shot(f"{3 if number == 0 else 4}-{control[1]}")
    fields.fill("Starts at", "0.3")
    save(window, path)
    window.key("F2")
    window.until(lambda: is_on(window, "Try"), "Try")
    window.press(*window.at("Home", "Button"), lambda: '"pressed"' in window.events(), "Home")
    left, top, right, bottom = window.find("Zoom", "Slider")["seen"]
    along = lambda share: (left + (right - left) * share, (top + bottom) / 2)
    window.drag(along(0.37), along(0.81), until=lambda: '"changed"' in window.events(), shot="5-tried", what="Zoom")
    window.until(lambda: window.events().count('"released"') > 1, "the end of the slide")


def region(window, fields):
    """Its id, its depth, and how far north it begins: five tiles from there on would leave the floor."""
    fields.fill("Name for apps", "map")
    fields.fill("Size: depth", "4")
    fields.fill("Place: north", "2")


def fill(fields, control):
    """The fields of the control that was put down, at the end of a row by keys.

    Its size first, then north: on the way, nothing overlaps or leaves the floor.
    """
    _, identity, label, at, size = control
    values = [("Name for apps", identity), ("Text on it", label), ("Size: width", size[0]), ("Size: depth", size[1]),
              ("Place: north", at[1]), ("Place: east", at[0])]
    for name, value in values:
        fields.fill(name, str(value))


def save(window, path):
    window.key("ctrl+s")
    def is_saved():
        with open(path) as file:
            return "initial: 0.3" in file.read()
    window.until(is_saved, "the saved file")


def same(program, path):
    """Ends with what differs between the file and the shipped one, if anything does."""
    resolved = [subprocess.run([program, "check", "--resolved", file], check=True, capture_output=True, text=True)
                .stdout for file in (path, SHIPPED)]
    if resolved[0] != resolved[1]:
        lines = [text.splitlines() for text in resolved]
        sys.exit("\n".join(difflib.unified_diff(*lines, path, SHIPPED, lineterm="", n=1)))


if __name__ == "__main__":
    main()
