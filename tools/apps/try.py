"""Programs of others, worked by simulated feet with a layout alone: `python3 tools/apps/try.py UNDERFOOT [aeskulap|marble] [--twice]
[--shots FOLDER]`.

Aeskulap (a viewer of DICOM images) with `layouts/dicom_viewer.ron` and Marble (a globe) with `layouts/globe.ron`, each on a
display of its own. After each step the picture of the screen must show what the step asks for; with `--twice`, a second
visit must give the same pictures. Needs aeskulap, marble, xvfb, xdotool and imagemagick, and pydicom for Python; what is
missing is named, and what needs it is not tried.
"""
import os
import sys
import tempfile

import numpy

from floor import Floor
from screen import Screen, difference
from series import IMAGES, write as write_series
from display import PROGRAMS, missing  # beside `screen`, which adds its folder

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def longest_bright_run(row):
    """The largest number of neighbouring pixels of a row that are as bright as its brightest."""
    bright = numpy.concatenate([[0], (row >= max(int(row.max()) - 4, 120)).astype(int), [0]])
    edges = numpy.flatnonzero(numpy.diff(bright))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def coarse(picture):
    """The picture in blocks of 16 x 16 pixels, each repeated to its full size."""
    blocks = picture.reshape(50, 16, 80, 16, 3).mean(axis=(1, 3))
    return blocks.repeat(16, axis=0).repeat(16, axis=1)


class Viewer:
    """Aeskulap: the number of the image by the length of its bar, and how bright the image is."""

    name, layout, target, window_class = "aeskulap", "dicom_viewer", "viewer", "aeskulap"
    needs = ("aeskulap",)
    env = {}

    def __init__(self):
        self.unit = None

    def command(self, folder):
        images = os.path.join(folder, "series")
        os.makedirs(images)
        return ["aeskulap", *write_series(images)]

    def prepare(self, screen):
        for _ in range(20):
            self.unit = self.bar(screen.settled())
            if self.unit >= 20:
                # Wheel and drag go to the image that the pointer has come to.
                screen.x("mousemove", 630, 410)
                screen.x("mousemove", 640, 420)
                return
        raise SystemExit("aeskulap shows no image")

    def bar(self, picture):
        """Length of the white bar, in pixels of the screen."""
        rows = picture[120:190, 305:960].mean(axis=2)
        return int(numpy.median(sorted(longest_bright_run(row) for row in rows)[-20:]))

    def image(self, picture):
        return round(self.bar(picture) / self.unit)

    def steps(self):
        def image_is(number):
            def check(_, now, __):
                return self.image(now) == number, f"shows image {self.image(now)} of {IMAGES}; {number} is due"
            return check

        def window_changes(before, now, _):
            inside = (slice(220, 640), slice(320, 960))
            changed = abs(float(now[inside].mean() - before[inside].mean()))
            return changed > 2 and self.image(now) == 3, f"the image's brightness changes by {changed:.1f} of 255"

        return [
            ("pressed", "on", image_is(2)), ("pressed", "on", image_is(3)), ("released", "window", window_changes),
            ("pressed", "back", image_is(2)), ("pressed", "on", image_is(3)), ("pressed", "on", image_is(4)),
        ]


class Globe:
    """Marble: moved and moved back, nearer and farther, and home."""

    name, layout, target, window_class = "marble", "globe", "globe", "marble"
    needs = ("marble",)
    # Its pages of places are of a browser that root may not start otherwise.
    env = {"QTWEBENGINE_DISABLE_SANDBOX": "1"}

    def command(self, _):
        return ["marble"]

    def prepare(self, screen):
        screen.settled()
        screen.x("mousemove", 800, 250)
        screen.x("click", 1)
        screen.settled()

    def steps(self):
        def moves(before, now, _):
            return difference(before, now) > 3, f"the picture changes by {difference(before, now):.1f} of 255"

        def is_back(_, now, first):
            return difference(first, now) < 2, f"the picture differs from the first by {difference(first, now):.1f} of 255"

        # Its arrows turn the globe about axes that turn with it, and its steps outwards are smaller: back is only nearer than
        # before.
        def leads_back(before, now, first):
            away, left = difference(coarse(first), coarse(before)), difference(coarse(first), coarse(now))
            return left < 0.9 * away, f"the picture's large parts differ from the first by {left:.1f} of 255, before by {away:.1f}"

        return [("pressed", "west", moves), ("pressed", "east", leads_back), ("clicked", "home", is_back),
                ("pressed", "nearer", moves), ("pressed", "farther", leads_back), ("pressed", "north", moves),
                ("clicked", "home", is_back)]


def visit(program, app, shots):
    """Plays the visit of `app` once; returns the pictures after its steps."""
    with tempfile.TemporaryDirectory(prefix="underfoot-apps-") as folder:
        screen = Screen(app.command(folder), app.window_class, folder, app.env)
        try:
            app.prepare(screen)
            floor = Floor(program, os.path.join(ROOT, "layouts", f"{app.layout}.ron"), os.path.join(HERE, f"{app.layout}.ron"),
                          app.target, screen.env, folder)
            try:
                return played(screen, floor, app, shots)
            finally:
                floor.close()
        finally:
            screen.close()


def played(screen, floor, app, shots):
    first = before = screen.settled()
    pictures = [first]
    if shots:
        screen.save(os.path.join(shots, f"{app.name}_0.png"))
    floor.play()
    for number, (event, control, check) in enumerate(app.steps(), 1):
        floor.wait_for(event, control)
        now = screen.changed(before)
        if shots:
            screen.save(os.path.join(shots, f"{app.name}_{number}_{control}.png"))
        is_good, found = check(before, now, first)
        print(f"{app.name}: {number}. {control}: {found}", flush=True)
        if not is_good:
            raise SystemExit(f"{app.name}: step {number}, \"{control}\", does not show what it should")
        pictures.append(now)
        before = now
    return pictures


def main():
    program = os.path.abspath(sys.argv[1])
    shots = sys.argv[sys.argv.index("--shots") + 1] if "--shots" in sys.argv else None
    if shots:
        os.makedirs(shots, exist_ok=True)
    lacking = missing(*PROGRAMS)
    chosen = [app for app in (Viewer(), Globe()) if app.name in sys.argv] or [Viewer(), Globe()]
    for app in chosen:
        if lacks := lacking + missing(*app.needs):
            print(f"NOT RUN: {app.name} is not worked by feet: {', '.join(lacks)} missing")
            continue
        once = visit(program, app, shots)
        if "--twice" not in sys.argv:
            continue
        again = visit(program, app, None)
        worst = max(difference(one, other) for one, other in zip(once, again))
        print(f"{app.name}: two visits differ by at most {worst:.2f} of 255")
        if worst > 2:
            raise SystemExit(f"{app.name}: the same visit gives other pictures")


if __name__ == "__main__":
    main()
