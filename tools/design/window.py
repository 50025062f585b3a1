"""A window of underfoot on a display of its own, worked by real mouse and key input (Xvfb, xdotool, ImageMagick)."""
import os
import shutil
import subprocess
import sys
import tempfile
import time

SIZE = (1400, 900)


class Window:
    """`underfoot preview` with `arguments`, its state and its files in a folder of their own; ends with `close`."""

    def __init__(self, program, arguments, folder=None, shots=None, pace=0.15, size=SIZE, env=None):
        for needed in ("Xvfb", "xdotool", "import"):
            if shutil.which(needed) is None:
                sys.exit(f"{needed} is missing: apt-get install xvfb xdotool imagemagick")
        self.folder = folder or tempfile.mkdtemp(prefix="underfoot-design-")
        self.shots = shots
        self.steps = 0
        # What comes sooner than the next frame may count as one: on a busy machine, slower.
        self.pace = pace
        read, write = os.pipe()
        screen = ["-screen", "0", f"{size[0]}x{size[1]}x24"]
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), *screen], pass_fds=[write],
                                       stderr=subprocess.DEVNULL)
        os.close(write)
        number = os.read(read, 16).decode().strip()
        self.env = dict(os.environ, DISPLAY=f":{number}", LIBGL_ALWAYS_SOFTWARE="1",
                        XDG_STATE_HOME=os.path.join(self.folder, "state"),
                        XDG_DATA_HOME=os.path.join(self.folder, "data"), **(env or {}))
        self.env.pop("WAYLAND_DISPLAY", None)
        self.program = subprocess.Popen([program, "preview", *arguments, "--no-osc", "--json"], env=self.env,
                                        cwd=self.folder, stdout=open(os.path.join(self.folder, "events"), "w"),
                                        stderr=open(os.path.join(self.folder, "messages"), "w"))
        self.id = self.appeared()
        self.x("windowsize", "--sync", self.id, *size)
        self.x("windowmove", self.id, 0, 0)
        self.x("windowfocus", self.id)
        time.sleep(2)

    def appeared(self):
        """The number of the program's window, once it is there."""
        search = ["xdotool", "search", "--onlyvisible", "--name", "underfoot"]
        while self.program.poll() is None:
            found = subprocess.run(search, env=self.env, capture_output=True).stdout.split()
            if found:
                return found[-1].decode()
            time.sleep(0.1)
        self.server.terminate()
        with open(os.path.join(self.folder, "messages")) as messages:
            sys.exit(f"{self.program.args[0]} has ended: {messages.read()}")

    def x(self, *arguments):
        """One command of xdotool."""
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.env, check=True, capture_output=True)
        return done.stdout.decode()

    def move(self, x, y):
        self.x("mousemove", x, y)
        time.sleep(self.pace)

    def click(self, x, y, settle=0.0):
        self.steps += 1
        self.move(x, y)
        self.x("mousedown", 1)
        time.sleep(self.pace)
        self.x("mouseup", 1)
        time.sleep(max(self.pace, settle))

    def drag(self, start, end, seconds=0.5, hold=0.0, shot=None):
        self.steps += 1
        self.move(*start)
        self.x("mousedown", 1)
        time.sleep(0.1)
        for step in range(1, 21):
            share = step / 20
            self.x("mousemove", *(round(a + (b - a) * share) for a, b in zip(start, end)))
            time.sleep(seconds / 20)
        time.sleep(hold)
        if shot:
            self.shot(shot)
        self.x("mouseup", 1)
        time.sleep(0.25)

    def key(self, *keys, settle=0.0):
        for key in keys:
            self.steps += 1
            self.x("key", "--clearmodifiers", key)
            time.sleep(max(self.pace, settle))

    def type(self, text):
        """Types into the field that has the keyboard, in place of what it says."""
        self.steps += 1
        self.x("key", "--clearmodifiers", "ctrl+a")
        time.sleep(self.pace)
        self.x("type", "--clearmodifiers", "--delay", 15, text)
        time.sleep(self.pace)

    def shot(self, name):
        if self.shots:
            os.makedirs(self.shots, exist_ok=True)
            subprocess.run(["import", "-window", "root", os.path.join(self.shots, name + ".png")], env=self.env,
                           check=True)

    def look(self):
        """What is on the screen."""
        ppm = subprocess.run(["import", "-window", "root", "-depth", "8", "ppm:-"], env=self.env, check=True,
                             capture_output=True).stdout
        return Screen(ppm)

    def events(self):
        with open(os.path.join(self.folder, "events")) as events:
            return events.read()

    def close(self):
        self.program.terminate()
        self.program.wait(10)
        self.server.terminate()
        self.server.wait(10)


class Screen:
    """The pixels of a screen, as numbers 0xRRGGBB."""

    def __init__(self, ppm):
        magic, width, height, most = ppm.split(maxsplit=4)[:4]
        if (magic, most) != (b"P6", b"255"):
            sys.exit("the picture of the screen is in a form that this script does not read")
        self.width, self.height = int(width), int(height)
        self.pixels = ppm[len(ppm) - 3 * self.width * self.height:]

    def column(self, x):
        channels = [self.pixels[3 * x + channel::3 * self.width] for channel in range(3)]
        return [red << 16 | green << 8 | blue for red, green, blue in zip(*channels)]

    def down(self, x, colour, lengths, start=0):
        """The first and the last row of each run of this colour in column `x` that is so many pixels long."""
        return [(top, end) for of, top, end in runs(self.column(x)) if of == colour and top >= start
                and end + 1 - top in lengths]

    def plain(self, x, lengths):
        """The same of any one colour."""
        return [(top, end) for _, top, end in runs(self.column(x)) if end + 1 - top in lengths]

    def part(self, left, top, right, bottom):
        """The pixels of a part of it."""
        rows = (3 * self.width * y for y in range(top, bottom))
        return b"".join(self.pixels[row + 3 * left:row + 3 * right] for row in rows)

    def count_down(self, x, colour):
        return self.column(x).count(colour)

    def count_across(self, y, colour):
        row = self.pixels[3 * y * self.width:3 * (y + 1) * self.width]
        return row.count(colour.to_bytes(3, "big"))


def runs(row):
    """Each run of one colour: the colour, its first and its last place."""
    begun = 0
    for place in range(1, len(row) + 1):
        if place == len(row) or row[place] != row[begun]:
            yield row[begun], begun, place - 1
            begun = place
