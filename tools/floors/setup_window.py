"""The set-up in the window, from boards that send to a pressed button: the actions that it takes a person.

    python3 tools/floors/setup_window.py target/release/underfoot [--columns 2 --rows 2] [--shots FOLDER]

`underfoot simulate` is the boards and the person on them: it sends real packets over loopback, and begins anew with
the person at each place that the window asks for. Mouse and keys are real (Xvfb, xdotool). Boards of the second row
are where those of the first should be. The exit status is 1 if the button is never pressed, or if a sensor of the
calibrated floor needs more stands. With `--shots`, each page has a picture.
"""
import argparse
import os
import re
import socket
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(ROOT, "tools", "design"))
from window import Window  # noqa: E402

PITCH = 0.304
KILOGRAMS = 72
EMPTY_LAYOUT = """Layout(version: 1, regions: [(id: "all", at: (0, 0), size: (1, 1))],
    widgets: [(id: "none", kind: "button", at: (0.1, 0.1), size: (0.8, 0.8))])
"""
LETTERS = {"north": "North", "south": "South"}


class Boards:
    """The boards of a simulated floor, whose person stands where `stand` says."""

    def __init__(self, program, folder, port, columns, rows):
        self.program, self.folder, self.port = program, folder, port
        self.floor = os.path.join(folder, "wired.ron")
        lists = [f'Board(address: "/underfoot/board/{(row + 1) % rows}", tiles: ['
                 + ", ".join(f"({column}, {row})" for column in range(columns)) + "])" for row in range(rows)]
        with open(self.floor, "w") as file:
            file.write(f"Floor(version: 3, columns: {columns}, rows: {rows}, boards: [{', '.join(lists)}])\n")
        with open(os.path.join(folder, "none.ron"), "w") as file:
            file.write(EMPTY_LAYOUT)
        self.process = None

    def play(self, steps, layout="none.ron"):
        """The person does this from now on; the boards pause for the moment in between."""
        self.stop()
        with open(os.path.join(self.folder, "person.ron"), "w") as file:
            file.write(f'Scenario(title: "A person", person: (mass_kg: {KILOGRAMS}, stand_m: 0.12), steps: [{steps}])\n')
        command = [self.program, "simulate", layout, "--floor", self.floor, "--seed", "3", "--scenario", "person.ron",
                   "--send", f"127.0.0.1:{self.port}", "--write-floor", os.path.join(self.folder, "fitted.ron")]
        self.process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL,
                                        stderr=open(os.path.join(self.folder, "boards"), "w"))

    def leave(self):
        self.play("Wait(ms: 600000)")

    def stand(self, east, north, facing="North"):
        """The middle between the feet at this place, in tiles."""
        self.play(f"Stand(at: ({east:.4f}, {north:.4f}), facing: {facing}), Wait(ms: 600000)")

    def stop(self):
        if self.process:
            self.process.terminate()
            self.process.wait()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def tiles(text):
    """The tile in a text such as `Tile (1, 0): step here`."""
    return tuple(map(int, re.search(r"\((\d+), (\d+)\)", text).groups()))


def mark(text):
    """Place in tiles and direction of a mark such as `tile (1, 0), 5.3 cm west of the middle, facing north`."""
    column, row = tiles(text)
    way = {side: float(cm) / 100 / PITCH for cm, side in re.findall(r"([\d.]+) cm (west|east|south|north)", text)}
    east = column + 0.5 + way.get("east", 0) - way.get("west", 0)
    north = row + 0.5 + way.get("north", 0) - way.get("south", 0)
    return east, north, LETTERS[re.search(r"facing (\w+)", text).group(1)]


class Guide:
    """A person who does what the window says."""

    def __init__(self, window, boards):
        self.window, self.boards, self.stands = window, boards, 0
        self.places = 0

    def named(self, pattern):
        """The name of the first widget that fits."""
        found = self.window.all(re.compile(pattern))
        return found[0]["name"] if found else None

    def until(self, pattern):
        return self.window.until(lambda: self.named(pattern), pattern)

    def shot(self, name):
        self.window.shot(name)

    def find_boards(self, rows):
        self.until(rf"^{rows} boards? sends?$")
        time.sleep(1.5)
        self.shot("1-boards")
        self.window.click_on("Next: choose the shape")

    def choose_shape(self):
        self.until("they fit")
        self.shot("2-shape")
        self.window.click_on("Write floor.ron")
        self.until("Written to floor.ron")
        self.shot("2-shape-written")
        self.window.click_on("Next: check the wiring")

    def walk_boards(self, rows):
        for number in range(rows):
            tile = self.until(r"^Tile .*: step here$")
            self.shot(f"3-wiring-{number}")
            column, row = tiles(tile)
            self.boards.stand(column + 0.5, row + 0.5)
            self.places += 1
            self.until("^Good. Step off again$")
            if number == 0:
                self.shot("3-wiring-felt")
            self.boards.leave()
        self.until("^All boards are found$")
        self.shot("3-wiring-found")
        self.window.click_on("Next: look at the readings")

    def read(self, columns, rows):
        self.until("^Noise when empty")
        for row in range(rows):
            for column in range(columns):
                self.boards.stand(column + 0.5, row + 0.5)
                self.places += 1
                self.until(rf"^Sensor \({column}, {row}\) ne: .*answers$")
        self.shot("4-readings")
        self.boards.leave()
        self.window.click_on("Next: calibrate by standing")

    def calibrate(self):
        self.shot("5-weight")
        self.window.click_on("Weight in kilograms")
        self.window.type(str(KILOGRAMS))
        self.window.click_on("Start")
        self.walk_marks()
        for walk in range(3):
            again = self.named(r"^Repeat (the tile|\d+ tiles)$")
            if not again:
                break
            self.shot(f"5-repeat-{walk}")
            self.window.click_on(again)
            self.walk_marks()
        self.shot("5-calibrated")

    def walk_marks(self):
        """Stands on each mark that the window shows, until the laws are there."""
        begun, known = time.monotonic(), None
        self.until("^(Keep off the floor|Stand here: .*)$")
        while not self.named("^(The floor is calibrated|.* needs? more stands|Calculating the laws)$"):
            told = self.named("^Stand here: ")
            if told and told != known:
                # The person takes a moment to get there.
                self.boards.leave()
                time.sleep(0.4)
                self.boards.stand(*mark(told))
                known, self.stands = told, self.stands + 1
                if self.stands == 3:
                    self.until("^Stay$")
                    time.sleep(1)
                    self.shot("5-standing")
            if self.window.program.poll() is not None or time.monotonic() - begun > 900:
                self.shot("failed")
                sys.exit("the walk over the marks does not end")
            time.sleep(0.02)
        self.until("^(The floor is calibrated|.* needs? more stands)$")
        self.boards.leave()

    def press(self, columns, rows):
        """Opens the layout, and presses its last button; returns whether the window shows it."""
        self.window.click_on("Next: press a button")
        self.shot("6-layout")
        self.window.click_on("Open the first layout")
        self.window.until(lambda: any("first_layout" in (report["title"] or "") for report in self.window.others()),
                          "the window of the layout")
        time.sleep(3)
        last = f"tile_{columns - 1}_{rows - 1}"
        self.boards.play(f'Wait(ms: 1500), Enter(from: South, at: ({columns - 1.5 if columns > 1 else 0.5:.2f}, '
                         f'{rows - 1.5 if rows > 1 else 0.5:.2f}), facing: North), '
                         f'Press(widget: "{last}", force_n: 150, hold_ms: 600), Wait(ms: 600000)', "first_layout.ron")
        def is_pressed():
            return any(re.match(rf"{last} (pressed|clicked)\b", widget["name"])
                       for report in self.window.others() for widget in report["widgets"])
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not is_pressed():
            time.sleep(0.02)
        self.shot("6-pressed")
        return is_pressed()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--columns", type=int, default=2)
    parser.add_argument("--rows", type=int, default=2)
    parser.add_argument("--shots")
    args = parser.parse_args()
    program, shots = os.path.abspath(args.program), args.shots and os.path.abspath(args.shots)
    folder, port = tempfile.mkdtemp(prefix="underfoot-setup-"), free_port()
    begun = time.monotonic()
    boards = Boards(program, folder, port, args.columns, args.rows)
    window = Window(program, ["--listen", f"127.0.0.1:{port}"], folder, shots, command=["setup", "--window"])
    guide = Guide(window, boards)
    try:
        guide.shot("0-nothing")
        boards.leave()
        guide.find_boards(args.rows)
        guide.choose_shape()
        guide.walk_boards(args.rows)
        guide.read(args.columns, args.rows)
        guide.calibrate()
        needy = guide.named("^More stands are needed")
        is_pressed = guide.press(args.columns, args.rows)
    finally:
        boards.stop()
        window.close()
    print(f"{window.count} actions of mouse and keys: {', '.join(window.actions)}")
    print(f"{guide.places} tiles stepped on, {guide.stands} stands, {time.monotonic() - begun:.0f} s in all")
    print(f"sensors: {needy or 'all are calibrated'}")
    print(f"button: {'pressed' if is_pressed else 'never pressed'}; files in {folder}")
    return 0 if is_pressed and not needy else 1


if __name__ == "__main__":
    sys.exit(main())
