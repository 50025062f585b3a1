"""A display of its own (Xvfb) with one program of others in a window that fills it."""
import os
import shutil
import subprocess
import time

import numpy

SIZE = (1280, 800)


class Screen:
    """Starts `command`, waits for its window of this class, fills the screen with it and gives it the keyboard."""

    def __init__(self, command, window_class, folder, env=None):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-nolisten", "tcp", "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        number = os.read(read, 16).decode().strip()
        home = os.path.join(folder, "home")
        os.makedirs(home, exist_ok=True)
        self.env = dict(os.environ, DISPLAY=f":{number}", HOME=home, LIBGL_ALWAYS_SOFTWARE="1", LC_ALL="C.UTF-8", **(env or {}))
        self.env.pop("WAYLAND_DISPLAY", None)
        self.log = open(os.path.join(folder, "app"), "w")
        self.app = subprocess.Popen(command, env=self.env, stdout=self.log, stderr=self.log)
        found = self.x("search", "--sync", "--onlyvisible", "--class", window_class).split()
        self.window = found[-1]
        self.x("windowmove", self.window, 0, 0)
        self.x("windowsize", self.window, *SIZE)
        self.x("windowfocus", self.window)

    def x(self, *arguments):
        """One command of xdotool."""
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.env, check=True, capture_output=True, timeout=90)
        return done.stdout.decode()

    def picture(self):
        """The pixels of the screen: rows, columns, red, green, blue."""
        done = subprocess.run(["import", "-window", "root", "-depth", "8", "rgb:-"], env=self.env, check=True, capture_output=True)
        return numpy.frombuffer(done.stdout, numpy.uint8).reshape(SIZE[1], SIZE[0], 3).astype(numpy.int16)

    def changed(self, before, seconds=10):
        """The picture once it has changed and stood still; after this time, the one that is there."""
        end = time.monotonic() + seconds
        while difference(before, self.picture()) < 0.01 and time.monotonic() < end:
            time.sleep(0.1)
        return self.settled()

    def settled(self, seconds=20):
        """The picture once it has stood still for most of a second."""
        end, last, same = time.monotonic() + seconds, self.picture(), 0
        while same < 3 and time.monotonic() < end:
            time.sleep(0.25)
            now = self.picture()
            same = same + 1 if difference(last, now) < 0.01 else 0
            last = now
        return last

    def save(self, path):
        subprocess.run(["import", "-window", "root", path], env=self.env, check=True)

    def close(self):
        for process in (self.app, self.server):
            process.terminate()
            try:
                process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.log.close()


def difference(one, other):
    """Mean difference of two pictures per pixel and colour, of 255; without the last rows, where programs show the time."""
    return float(numpy.abs(one[:-48] - other[:-48]).mean())


def missing(*programs):
    """Those of these programs that are not installed."""
    return [program for program in programs if shutil.which(program) is None]
