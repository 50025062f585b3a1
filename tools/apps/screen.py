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
        found = self.x("search", "--sync", "--onlyvisible", "--class", window_class).split()
        self.window = found[-1]
        self.x("windowmove", self.window, 0, 0)
        self.x("windowsize", self.window, *SIZE)
        self.x("windowfocus", self.window)

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
