"""The tasks of `docs/design.md`, done by real mouse and keys: how many actions each takes, and that its result is right.

    python3 tools/design/tasks.py target/release/underfoot [NAME...] [--shots FOLDER]

A click, a drag, a turn of the wheel, a key chord and a typed word are one action each. `before` counts the quickest way in
the window of revision 13d9503, as its own pages and its source give it. Actions that both ways have in common, such as
the presses of people, count in the column `all` alone. With `--shots`, each action has a picture in a folder of its task.
Names of tasks choose some of them; the exit status is 1 if one took more than two thirds of before.
"""
import argparse
import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile

from build_map import is_on
from window import SIZE, Floor, Window, near

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

SLIDERS = """Layout(
    version: 1,
    title: "Three sliders",
    regions: [(id: "all", at: (0, 2), size: (6, 4))],
    stances: [(at: (2, 0), size: (2, 1), label: "Stand here")],
    widgets: [
        (id: "bass", kind: "slider", at: (0.9, 2.1), size: (1.35, 0.6), label: "Bass", press_n: 80, release_n: 50,
            look: (face: "#dde6f2")),
        (id: "middle", kind: "slider", at: (2.6, 2.2), size: (1, 0.5), label: "Middle"),
        (id: "treble", kind: "slider", at: (4.3, 2.1), size: (0.9, 0.7), label: "Treble", press_n: 60),
    ],
)
"""

# Two controls too close to their neighbours; three too small, one of them also for where it is; two out of reach; one at
# the feet of standing people, which also press it; and two that stick out of the region.
TWELVE = """Layout(
    version: 1,
    title: "Twelve findings",
    regions: [(id: "all", at: (0.2, 1), size: (5.6, 5), cursor: Working)],
    stances: [(at: (2, 0), size: (2, 1), label: "Stand here")],
    widgets: [
        (id: "a", kind: "button", at: (0.3, 2.1), size: (0.6, 0.55), label: "A"),
        (id: "b", kind: "button", at: (0.95, 2.1), size: (0.6, 0.55), label: "B"),
        (id: "c", kind: "button", at: (1.6, 2.1), size: (0.6, 0.55), label: "C"),
        (id: "d", kind: "button", at: (2.25, 2.1), size: (0.6, 0.55), label: "D"),
        (id: "e", kind: "button", at: (2.9, 2.1), size: (0.6, 0.55), label: "E"),
        (id: "f", kind: "button", at: (3.7, 2.1), size: (0.25, 0.25), label: "F"),
        (id: "g", kind: "button", at: (4.3, 2.1), size: (0.25, 0.25), label: "G"),
        (id: "h", kind: "button", at: (4.9, 2.2), size: (0.15, 0.15), label: "H"),
        (id: "i", kind: "button", at: (0.3, 5.2), size: (0.6, 0.6), label: "I"),
        (id: "j", kind: "button", at: (5.1, 5.2), size: (0.6, 0.6), label: "J"),
        (id: "k", kind: "button", at: (2.2, 1.2), size: (0.6, 0.55), label: "K"),
        (id: "l", kind: "button", at: (5.4, 1.3), size: (0.6, 0.5), label: "L"),
        (id: "m", kind: "button", at: (0, 1.3), size: (0.6, 0.5), label: "M"),
    ],
)
"""

SIX_LABELS = "3 button: Welcome, Map, Help; 2 slider: Volume, Light; switch: Guide"


class Bench:
    """One task on a window of its own, with a file of its own."""

    # Width of the projector's screen, in pixels.
    PROJECTOR = 1000

    def __init__(self, program, shots, text=None):
        self.program = program
        self.folder = tempfile.mkdtemp(prefix="underfoot-task-")
        self.path = os.path.join(self.folder, "mine.ron")
        # Number of actions that both ways have in common.
        self.common = 0
        if text is not None:
            with open(self.path, "w") as file:
                file.write(text)
        self.window = Window(program, [self.path], self.folder, shots, beside=self.PROJECTOR)

    def read(self):
        with open(self.path) as file:
            return file.read()

    def saved(self, *parts):
        """Waits until the file has these parts; patterns count as well."""
        def has_all():
            text = self.read() if os.path.exists(self.path) else ""
            return all(part.search(text) if isinstance(part, re.Pattern) else part in text for part in parts)
        self.window.until(has_all, f"a file with {parts}")

    def problems(self):
        """The errors and warnings of `underfoot check`, as many as there are."""
        checked = subprocess.run([self.program, "check", self.path], capture_output=True, text=True)
        return len(re.findall(r"^(?:error|warning)\b.*\n +-->", checked.stdout + checked.stderr, re.M))

    def begin(self):
        """From here on actions count, and have pictures."""
        self.window.actions, self.window.count = [], 0
        self.window.pictures = bool(self.window.shots)
        self.window.shot("00-before")

    def design(self):
        self.window.key("F2")
        self.window.until(lambda: is_on(self.window, "Design"), "Design")

    def search(self, by_keys):
        if by_keys:
            self.window.key("F6")
        else:
            self.window.click_on("Search things")
        self.window.until(lambda: self.window.has_focus("Search things"), "the keyboard in the search")

    @contextlib.contextmanager
    def in_common(self):
        """The actions in it are the same in both ways."""
        begun = self.window.count
        yield
        self.common += self.window.count - begun
        self.window.count = begun

    def fail(self, what):
        sys.exit(f"{what}\n{self.read() if os.path.exists(self.path) else ''}")


def place_six(bench, by_keys):
    bench.begin()
    bench.design()
    bench.search(by_keys)
    bench.window.type("6 button")
    bench.window.key("Return", "ctrl+s")
    bench.saved(re.compile(r'(?s)(kind: "button".*){6}'))
    if bench.problems():
        bench.fail("six controls with problems")


def upright(bench, by_keys):
    window = bench.window
    bench.begin()
    if by_keys:
        while not window.has_focus("Zoom", "Slider"):
            window.key("shift+Tab")
        window.hold("Return")
        window.until(lambda: '"pressed"' in window.events(), "a press by keys")
        window.release("Return")
        window.note("hold Return on Zoom")
        window.until(lambda: '"released"' in window.events(), "the end of the press")
    else:
        window.press(*window.at("Zoom", "Slider"), lambda: '"pressed"' in window.events(), "Zoom")
    bench.design()
    window.until(lambda: is_on(window, "Control zoom"), "the slider selected")
    window.key("r", "ctrl+s")
    bench.saved(re.compile(r'id: "zoom".*size: \(0\.6, 1\.35\).*axis: North'))
    if bench.problems():
        bench.fail("the slider has problems")


def light_presses(bench, names):
    """A visitor who steps too lightly on each of these controls."""
    window = bench.window
    window.wheel(*window.at(names[0], "Button"), 10)
    for number, name in enumerate(names, 1):
        window.move(*window.at(name, "Button"))
        window.send("mousedown", 1, buttons=1)
        # The foot is down for some frames, however slow these are.
        begun = window.report()["frame"]
        window.until(lambda: window.report()["frame"] > begun + 40, "a short step")
        window.send("mouseup", 1, buttons=1)
        window.until(lambda: len(ignored(window)) >= number, "the ignored press")


def ignored(window):
    """The controls of the presses that the list of events explains, as far as they can be seen."""
    return [widget["name"].split()[0] for widget in window.all(re.compile(r"^\w+ ignored .*too light"))]


def why_one(bench, _):
    light_presses(bench, ["Home"])
    bench.begin()
    if ignored(bench.window) != ["home"]:
        bench.fail("the list does not say why home did nothing")


def why_three(bench, _):
    light_presses(bench, ["Home", "North", "South"])
    bench.begin()
    told = ignored(bench.window)
    if sorted(told) != ["home", "pan_north", "pan_south"]:
        bench.fail(f"the list does not say why all three did nothing: {told}")


def press_each(window, names):
    """Presses of people, one after the other."""
    for number, name in enumerate(names, 1):
        window.press(*window.at(name, "Button"), lambda: window.events().count('"pressed"') >= number, name)
        window.until(lambda: window.events().count('"released"') >= number, "the end of the press")


def threshold(bench, _):
    window = bench.window
    bench.begin()
    with bench.in_common():
        press_each(window, ["Home"] * 3)
    window.until(lambda: any(not it["is_off"] for it in window.all("Use and save")), "a threshold to use")
    window.click_on("Use and save")
    bench.saved(re.compile(r'id: "home".*press_n: '))


def museum(bench, by_keys):
    window = bench.window
    bench.begin()
    bench.design()
    bench.search(by_keys)
    window.type(SIX_LABELS)
    window.key("Return", "ctrl+s")
    bench.saved(*(f'label: "{label}"' for label in ("Welcome", "Map", "Help", "Volume", "Light", "Guide")))
    if bench.problems():
        bench.fail("the museum has problems")


def alike(bench, by_keys):
    window = bench.window
    bench.begin()
    bench.design()
    if by_keys:
        window.key("ctrl+a")
    else:
        floor = Floor(window)
        window.drag(floor.at(0.4, 1.6), floor.at(5.6, 3.2), what="around the sliders")
    window.until(lambda: window.shows("3 selected"), "three selected")
    window.key("ctrl+e", "ctrl+s")
    bench.saved(re.compile(r'(?s)(size: \(1\.35, 0\.6\).*){3}'), re.compile(r'(?s)(press_n: 80.*){3}'),
                re.compile(r'(?s)(face: "#dde6f2".*){3}'))
    if bench.problems():
        bench.fail("the sliders have problems")


def mend_twelve(bench, _):
    if bench.problems() != 12:
        bench.fail(f"{bench.problems()} findings before")
    bench.begin()
    bench.design()
    bench.window.click_on(re.compile("^Mend all"))
    bench.window.until(lambda: not bench.window.all(re.compile("^Problem: ")), "a layout without problems")
    bench.window.key("ctrl+s")
    bench.window.until(lambda: bench.read() != TWELVE, "the saved file")
    if bench.problems():
        bench.fail(f"{bench.problems()} findings are left")


def visit(bench, _):
    window = bench.window
    bench.begin()
    window.key("F9")
    window.find(re.compile("^Stop "))
    with bench.in_common():
        press_each(window, ["Home", "North", "South"])
    window.key("F9")
    window.click_on("Play again")
    other = window.opened("Time line")
    left, top, right, bottom = window.find("Time line", window=other)["seen"]
    along = lambda share: (left + (right - left) * share, (top + bottom) / 2)
    window.drag(along(0.25), along(0.75), keys=["shift"], window=other, what="over the middle of the time line")
    window.click_on("Visit", window=other)
    window.click_on(re.compile(r"^Export \d.* s$"), window=other)
    def exported():
        found = [os.path.join(at, name) for at, _, names in os.walk(bench.folder) for name in names]
        return [path for path in found if path.endswith(".gif") and os.path.getsize(path) > 1000
                and not window.all(re.compile("%$"), window=other)]
    path = window.until(exported, "the exported picture")[0]
    with open(path, "rb") as file:
        if file.read(6) not in (b"GIF89a", b"GIF87a"):
            bench.fail(f"{path} is no GIF")


def project(bench, _):
    window = bench.window
    bench.begin()
    window.key("F11")
    other = window.opened("Projected Home")
    # It fills a second screen by itself; this display has one, so the script moves it beside the main window.
    window.x("windowmove", window.appeared(f"^{re.escape(other)}$"), SIZE[0], 0)
    if not window.all("Corner 1", window=other):
        window.key("c", window=other)
    with bench.in_common():
        for corner, (east, north) in enumerate(((19, -17), (-18, -16), (19, 17), (-18, 16)), 1):
            x, y = window.at(f"Corner {corner}", window=other)
            window.drag((x, y), (x + east, y + north), window=other, what=f"corner {corner}")
            moved = lambda: not near(window.at(f"Corner {corner}", window=other), (x, y))
            window.until(moved, f"corner {corner} at its new place")
    # Back to the main window.
    window.move(SIZE[0] / 2, SIZE[1] / 2)
    window.until(lambda: not window.all("Corner 1", window=other), "the end of the adjustment")
    data = os.path.join(bench.folder, "data", "underfoot")
    window.until(lambda: os.path.isdir(data) and os.listdir(data), "the saved corners")


# Name, its task, the layout that it begins with, before: each way with its number of actions, without those that both
# ways have in common: the presses of a visit, the presses for a threshold, the drags of the four corners.
TASKS = {
    "six": (place_six, None, "place six controls", 14,
            "F2; six times: its kind at the left, the floor; Ctrl+S"),
    "upright": (upright, "map", "make the slider upright that was tried", 6,
                "press it; F2; click on it; R; drag it back into its region; Ctrl+S"),
    "why": (why_one, "map", "find out why a press did nothing", 1, "press once more"),
    "threshold": (threshold, "map", "set a threshold from three presses", 2, "Use this press; Ctrl+S"),
    "project": (project, "map", "project with corners", 4, "F11; move the window; C; C"),
    "museum": (museum, None, "six controls for a museum from nothing", 26,
               "F2; six times: kind, floor, field of the label, a word; Ctrl+S"),
    "alike": (alike, SLIDERS, "make three sliders alike", 20,
              "F2; drag around them; two thresholds in common (click, value); the section Look; the face (click, "
              "value); twice: click on one, its width and depth (click, value, Tab, value); Ctrl+S"),
    "twelve": (mend_twelve, TWELVE, "mend a layout with twelve findings", 26,
               "F2; twelve times: the count in the bar, then its repair or a drag; Ctrl+S"),
    "three": (why_three, "map", "find why three presses failed", 1, "the wheel, down to the list of events"),
    "visit": (visit, "map", "record, trim and export a visit", 26,
              "Ctrl+Q; preview --record FILE LAYOUT (5 words); Enter; Ctrl+Q; preview FILE (3 words); Enter; drag with "
              "Shift; Ctrl+Q; export FILE --out FOLDER (5 words); Enter; in each of the three tables delete what is "
              "before and behind"),
}
# By keys alone: before, with the way.
BY_KEYS = {
    "six": (9, "F2; F6; six times Enter; Ctrl+S"),
    "upright": (18, "Shift+Tab; Enter; F2; F6, F6; eight arrows; Enter; R; Ctrl+Shift+arrow, Ctrl+arrow; Ctrl+S"),
    "museum": (50, "F2; six times at least: F6, an arrow, Enter, Shift+F6, Tab, Tab, a word, Tab; Ctrl+S"),
    "alike": (30, "F2; Ctrl+A; F6, F6, F6; three fields (Tab after Tab, value); twice: F6 to the list, an arrow, Enter, "
                  "F6, Tab after Tab, width, Tab, depth, Tab; Ctrl+S: at least so many"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of {', '.join(TASKS)}")
    parser.add_argument("--shots", help="folder for the pictures")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    is_good = True
    print("| task | before | now | share | all: before, now, share | steps now |\n|---|---|---|---|---|---|")
    for name in args.names or TASKS:
        task, layout, title, before, way = TASKS[name]
        ways = [(False, before, way)] + ([(True, *BY_KEYS[name])] if name in BY_KEYS else [])
        for by_keys, before, way in ways:
            shots = args.shots and os.path.join(args.shots, name + "-keys" * by_keys)
            bench = Bench(program, shots, text_of(layout))
            try:
                task(bench, by_keys)
            finally:
                close(bench)
            now = bench.window.count
            is_good &= 3 * now <= 2 * before
            steps = "; ".join(bench.window.actions) or "read it in the list"
            common = bench.common
            all_of = f"{before + common}, {now + common}, {(now + common) / (before + common):.2f}"
            print(f"| {title}{', by keys' * by_keys} | {before}: {way} | {now} | {now / before:.2f} | {all_of} | {steps} |",
                  flush=True)
    sys.exit(0 if is_good else 1)


def text_of(layout):
    if layout == "map":
        with open(os.path.join(ROOT, "layouts", "map.ron")) as file:
            return file.read()
    return layout


def close(bench):
    """Ends the program, and the window in which it plays a visit."""
    for name in os.listdir(bench.window.reports):
        number = re.match(r"\d+", name)
        if number and int(number[0]) != bench.window.program.pid:
            try:
                os.kill(int(number[0]), signal.SIGTERM)
            except ProcessLookupError:
                pass
    bench.window.close()


if __name__ == "__main__":
    main()
