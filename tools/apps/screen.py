"""One program of others in a window that fills a display of its own."""
import os
import subprocess
import sys
import time

import numpy

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from display import Display, end  # noqa: E402

SIZE = (1280, 800)


class Screen(Display):
    """Starts `command`, waits for its window of this class, fills the screen with it and gives it the keyboard."""

    def __init__(self, command, window_class, folder, env=None):
        home = os.path.join(folder, "home")
        os.makedirs(home, exist_ok=True)
        super().__init__(SIZE, {"HOME": home, "LC_ALL": "C.UTF-8", **(env or {})})
        self.log = open(os.path.join(folder, "app"), "w")
        self.app = subprocess.Popen(command, env=self.env, stdout=self.log, stderr=self.log)
        try:
            self.window = self.await_window(window_class)
        except BaseException:
            self.close()
            raise
        self.x("windowmove", self.window, 0, 0)
        self.x("windowsize", self.window, *SIZE)
        self.x("windowfocus", self.window)

    def await_window(self, window_class, seconds=120):
        """The last window of this class, once it is shown and stays: a program's first window may be its greeting."""
        until, before = time.monotonic() + seconds, None
        while self.app.poll() is None and time.monotonic() < until:
            found = self.windows("--class", window_class)
            if found and found[-1] == before:
                return before
            before = found[-1] if found else None
            time.sleep(0.5)
        with open(self.log.name) as log:
            raise SystemExit(f"there is no window of the class {window_class}; its program's last words: {log.read()[-1000:]}")

    def picture(self):
        """The pixels of the screen: rows, columns, red, green, blue."""
        return numpy.frombuffer(self.pixels(), numpy.uint8).reshape(SIZE[1], SIZE[0], 3).astype(numpy.int16)

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

    def close(self):
        end(self.app)
        super().close()
        self.log.close()


def difference(one, other):
    """Mean difference of two pictures per pixel and colour, of 255; without the last rows, where programs show the time."""
    return float(numpy.abs(one[:-48] - other[:-48]).mean())
