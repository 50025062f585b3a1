"""A window of underfoot on a display of its own, worked by real mouse and key input (Xvfb, xdotool, ImageMagick).

The program reports its screen frame by frame (`UNDERFOOT_SCREEN_REPORT`, see CONTRIBUTING): where each widget is, by its
name, and which input has come. Nothing here is paced by time: each action waits until the program has taken it in.
"""
import json
import mmap
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from display import PROGRAMS, Display, missing  # noqa: E402

SIZE = (1400, 900)
VARIABLE = "UNDERFOOT_SCREEN_REPORT"
# Seconds after which something that never comes counts as a failure; no action waits for them.
NEVER = 300
# A window that wants its next frame later than this is calm; one that never is calm has shown the change by then.
CALM_S, FRAMES = 0.04, 12


class Window(Display):
    """`underfoot preview` with `arguments`, its state and its files in a folder of their own; ends with `close`.

    `command` is another command of the program with a window, and `arguments` all that follows it.

    `actions` lists what a user did, and `count` counts it: each click, drag, key chord and typed word is one. With
    `pictures`, each entry has a picture in the folder `shots`. The screen has `beside` pixels more at the right, as for
    a projector. Without `reports`, the program does only what it does for a user, and actions are not waited for.
    """

    def __init__(self, program, arguments, folder=None, shots=None, size=SIZE, env=None, beside=0,
                 command=None, reports=True):
        if lacks := missing(*PROGRAMS):
            sys.exit(f"{', '.join(lacks)} missing: apt-get install xvfb xdotool imagemagick")
        self.folder = folder or tempfile.mkdtemp(prefix="underfoot-design-")
        self.reports = os.path.join(self.folder, "screen")
        os.makedirs(self.reports, exist_ok=True)
        self.shots, self.pictures = shots, False
        self.actions, self.count = [], 0
        self.has_reports = reports and reports_screen(program)
        super().__init__((size[0] + beside, size[1]), {
            "XDG_STATE_HOME": os.path.join(self.folder, "state"), "XDG_DATA_HOME": os.path.join(self.folder, "data"),
            **({VARIABLE: self.reports} if self.has_reports else {}), **(env or {})})
        self.program = subprocess.Popen([program, *(command or ["preview"]), *arguments,
                                         *([] if command else ["--no-osc", "--json"])], env=self.env,
                                        cwd=self.folder, stdout=open(os.path.join(self.folder, "events"), "w"),
                                        stderr=open(os.path.join(self.folder, "messages"), "w"))
        self.id = self.appeared("underfoot")
        self.x("windowsize", "--sync", self.id, *size)
        self.x("windowmove", self.id, 0, 0)
        self.x("windowfocus", self.id)
        if self.has_reports:
            self.until(lambda: near(self.report().get("size", (0, 0)), size), "the window in its size")
        else:
            time.sleep(2)

    def appeared(self, name):
        """The number of the program's window of this name, once it is there."""
        while self.program.poll() is None:
            found = self.windows("--name", name)
            if found:
                return found[-1]
            time.sleep(0.1)
        super().close()
        with open(os.path.join(self.folder, "messages")) as messages:
            sys.exit(f"{self.program.args[0]} has ended: {messages.read()}")

    # Reading the screen.

    def report(self, window=None):
        """The last report of the main window, or of the one with this title; empty before the first."""
        if window is None:
            return read_report(os.path.join(self.reports, f"{self.program.pid}.json"))
        return next((report for report in self.others() if report["title"] == window), {})

    def others(self):
        """The last reports of all windows but the main one, the latest first: windows that have closed come last."""
        paths = [os.path.join(self.reports, name) for name in os.listdir(self.reports)
                 if name.endswith(".json") and name != f"{self.program.pid}.json"]
        paths.sort(key=os.path.getmtime, reverse=True)
        return [report for report in map(read_report, paths) if report]

    def opened(self, name):
        """The title of the other window with a widget of this name, once there is one; it gets the keyboard."""
        def title():
            for report in self.others():
                if any(widget["name"] == name for widget in report["widgets"]):
                    return report["title"]
            return None
        found = self.until(title, f"a window with {name}")
        self.x("windowfocus", self.appeared(f"^{re.escape(found)}$"))
        return found

    def until(self, condition, what):
        """Waits for a condition, and returns its value."""
        begun = time.monotonic()
        while not (value := condition()):
            if self.program.poll() is not None or time.monotonic() - begun > NEVER:
                self.shot("failed")
                with open(os.path.join(self.folder, "messages")) as messages:
                    sys.exit(f"it never came: {what}\nafter {', '.join(self.actions[-5:])}\n{messages.read()}")
            time.sleep(0.01)
        return value

    def all(self, name, role=None, window=None):
        """The widgets with this name that can be seen; the name may be a compiled pattern."""
        fits = name.search if isinstance(name, re.Pattern) else name.__eq__
        return [widget for widget in self.report(window).get("widgets", ())
                if widget["seen"] and fits(widget["name"]) and role in (None, widget["role"])]

    def find(self, name, role=None, window=None):
        """The first widget with this name, once it can be seen."""
        found = self.until(lambda: self.all(name, role, window), f"a widget called {name}")
        return found[0]

    def at(self, name, role=None, window=None):
        """The middle of what can be seen of the widget with this name."""
        return middle(self.find(name, role, window)["seen"])

    def shows(self, text):
        """Whether a widget that can be seen has this text in its name."""
        return bool(self.all(re.compile(re.escape(text))))

    def has_focus(self, name, role=None):
        return any(widget["has_focus"] for widget in self.all(name, role))

    def events(self):
        with open(os.path.join(self.folder, "events")) as events:
            return events.read()

    # Actions of a user.

    def send(self, *arguments, window=None, **counts):
        """Input by xdotool; waits until the program has counted it and is calm."""
        before = self.report(window)
        self.x(*arguments)
        if not self.has_reports:
            return time.sleep(0.2)
        taken = lambda: all(self.report(window).get(name, 0) >= before.get(name, 0) + count
                            for name, count in counts.items())
        self.until(taken, f"the input {' '.join(map(str, arguments))}")
        self.calm(window)

    def calm(self, window=None):
        """Waits until the window stands still, or for some frames if it never does."""
        begun = self.report(window).get("frame", 0)
        def is_calm():
            report = self.report(window)
            next_s = report.get("next_s")
            return next_s is None or next_s > CALM_S or report["frame"] >= begun + FRAMES
        self.until(is_calm, "a calm window")

    def move(self, x, y, window=None):
        """Moves the mouse to a place of the window."""
        x, y = round(x), round(y)
        is_there = lambda: near(self.report(window).get("pointer") or (-9, -9), (x, y))
        if self.has_reports and is_there():
            return
        left, top = self.origin(window)
        self.x("mousemove", left + x, top + y)
        if not self.has_reports:
            return time.sleep(0.2)
        self.until(is_there, f"the mouse at {x}, {y}")
        self.calm(window)

    def origin(self, window):
        """The place of a window on the screen; the main one is in the corner."""
        if window is None:
            return 0, 0
        shell = self.x("getwindowgeometry", "--shell", self.appeared(f"^{re.escape(window)}$"))
        numbers = dict(line.split("=") for line in shell.split())
        return int(numbers["X"]), int(numbers["Y"])

    def click(self, x, y, button=1, keys=(), window=None, what=None):
        self.move(x, y, window)
        self.hold(*keys)
        # Down and up together: a click that a slow machine parts is a long press.
        self.send("mousedown", button, "mouseup", button, window=window, buttons=2)
        self.release(*keys)
        self.note(f"{'+'.join([*keys, 'click'])} {what or f'{round(x)}, {round(y)}'}")

    def click_on(self, name, role=None, keys=(), button=1, window=None):
        """A click on the widget with this name."""
        shown = name.pattern if isinstance(name, re.Pattern) else name
        self.click(*self.at(name, role, window), button=button, keys=keys, window=window, what=shown)

    def press(self, x, y, until, what):
        """A foot, for as long as it takes until a condition holds."""
        self.move(x, y)
        self.send("mousedown", 1, buttons=1)
        self.until(until, f"what the press on {what} does")
        self.send("mouseup", 1, buttons=1)
        self.note(f"press {what}")

    def drag(self, start, end, keys=(), window=None, steps=8, until=None, shot=None, what=None):
        self.move(*start, window)
        self.hold(*keys)
        self.send("mousedown", 1, window=window, buttons=1)
        for step in range(1, steps + 1):
            self.move(*(a + (b - a) * step / steps for a, b in zip(start, end)), window)
        if until:
            self.until(until, "what the drag does")
        if shot:
            self.shot(shot)
        self.send("mouseup", 1, window=window, buttons=1)
        self.release(*keys)
        self.note(f"{'+'.join([*keys, 'drag'])} {what or ''}".strip())

    def wheel(self, x, y, notches, what="the wheel"):
        """One turn of the wheel, down for positive `notches`."""
        self.move(x, y)
        for _ in range(abs(notches)):
            self.send("click", 5 if notches > 0 else 4, wheel=1)
        self.note(what)

    def key(self, *chords, window=None):
        for chord in chords:
            self.send("key", "--clearmodifiers", chord, window=window, keys=1)
            self.note(chord)

    def hold(self, *keys):
        if keys:
            self.x("keydown", *keys)

    def release(self, *keys):
        if keys:
            self.x("keyup", *keys)

    def type(self, text):
        """Types into the field that has the keyboard, in place of what it says; each word is an action."""
        self.send("key", "--clearmodifiers", "ctrl+a", keys=1)
        self.send("type", "--clearmodifiers", "--delay", 2, text, letters=len(text))
        self.note(f"type {text}", max(1, len(text.split())))

    def note(self, action, count=1):
        self.actions.append(action)
        self.count += count
        if self.pictures:
            self.shot(f"{len(self.actions):02}-{re.sub('[^a-z0-9]+', '-', action.lower())[:40].strip('-')}")

    # Pictures.

    def shot(self, name):
        if not self.shots:
            return
        os.makedirs(self.shots, exist_ok=True)
        if self.has_reports and self.program.poll() is None:
            # A frame is reported before it is on the screen: once the next ones come, it is there. The mouse stays where
            # it is, also outside this window: in it, it would end what goes on in another one.
            begun = self.report().get("frame", 0)
            at = dict(line.split("=") for line in self.x("getmouselocation", "--shell").split())
            for nudge in (1, 0, 1, 0):
                self.x("mousemove", int(at["X"]) + nudge, at["Y"])
            deadline = time.monotonic() + 5
            while self.report().get("frame", 0) < begun + 2 and time.monotonic() < deadline:
                time.sleep(0.01)
        self.save(os.path.join(self.shots, name + ".png"))

    def close(self):
        self.program.terminate()
        self.program.wait(NEVER)
        super().close()


class Floor:
    """Where the floor of so many tiles in a row is in the window."""

    def __init__(self, window, tiles=6):
        west, north, east, south = window.find("Whole floor")["place"]
        self.west, self.south, self.tile = west, south, (east - west) / tiles

    def at(self, east, north):
        """A place in tiles, in the window."""
        return self.west + self.tile * east, self.south - self.tile * north


def read_report(path):
    try:
        with open(path) as report:
            return json.load(report)
    except FileNotFoundError:
        return {}


def reports_screen(program):
    """Whether the program knows how to report its screen; older ones do not."""
    with open(program, "rb") as binary, mmap.mmap(binary.fileno(), 0, access=mmap.ACCESS_READ) as content:
        return content.find(VARIABLE.encode()) >= 0


def middle(place):
    left, top, right, bottom = place
    return (left + right) / 2, (top + bottom) / 2


def near(one, other):
    return all(abs(a - b) <= 1 for a, b in zip(one, other))
