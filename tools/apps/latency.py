"""From the packet to the key: how long after a foot has pressed a window gets the key.

    python3 tools/apps/latency.py PROGRAM [--presses 200]

A board sends 1000 packets a second to `underfoot run`, whose layout types a key at each press. A window of this script on a
display of its own takes the time at which each key press arrives. Each press counts from the packet with which the foot has
stood above the threshold for the dwell; a packet is late by up to a millisecond. Prints median, 95 % and 99 %.
"""
import argparse
import ctypes
import os
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

TOOLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, TOOLS)
from display import Display, end  # noqa: E402
from floor import free_port  # noqa: E402

# Counts of a 16-bit converter: an empty sensor, a foot's load on it, and the noise.
EMPTY, LOAD, NOISE = 7680, 35840, 26
DWELL_S = 0.02
# The foot stands for half of each period.
PERIOD_S = 0.6
BEGIN_S = 3
LAYOUT = """Layout(version: 4, targets: [(name: "viewer", to: Keyboard((display: "{display}")))],
    regions: [(id: "r", at: (0, 0), size: (1, 1))],
    widgets: [(id: "b", kind: "button", at: (0.1, 0.1), size: (0.8, 0.8), press_n: 60, release_n: 40,
        send: [On(pressed, Key("viewer", "space"))])])
"""
KEY_PRESS, KEY_PRESS_MASK = 2, 1


class Window(threading.Thread):
    """A window with the focus of the keyboard, and the times at which it gets key presses."""

    def __init__(self, display):
        super().__init__(daemon=True)
        self.x11 = ctypes.CDLL("libX11.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x11.XCreateSimpleWindow.restype = ctypes.c_ulong
        self.connection = ctypes.c_void_p(self.x11.XOpenDisplay(display.encode()))
        root = ctypes.c_ulong(self.x11.XDefaultRootWindow(self.connection))
        window = ctypes.c_ulong(self.x11.XCreateSimpleWindow(self.connection, root, 0, 0, 100, 100, 0, 0, 0))
        self.x11.XSelectInput(self.connection, window, ctypes.c_long(KEY_PRESS_MASK))
        self.x11.XMapWindow(self.connection, window)
        self.x11.XSync(self.connection, 0)
        self.x11.XSetInputFocus(self.connection, window, 1, ctypes.c_ulong(0))
        self.x11.XSync(self.connection, 0)
        self.times = []

    def run(self):
        event = (ctypes.c_long * 24)()
        while True:
            self.x11.XNextEvent(self.connection, event)
            if ctypes.c_int.from_buffer(event).value == KEY_PRESS:
                self.times.append(time.monotonic())


def padded(text):
    return text.encode() + b"\0" * (4 - len(text) % 4)


def send(port, presses):
    """Sends the packets of a board; returns the times at which each press was due."""
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    head = padded("/underfoot/board/0") + padded(",iiiii")
    begun, due, n = time.monotonic(), [], 0
    # Feet do not follow the program's clock.
    starts = [BEGIN_S + PERIOD_S * (press + random.uniform(0, 0.3)) for press in range(presses)]
    stands = False
    while n < 1000 * (BEGIN_S + PERIOD_S * (presses + 1)):
        now = time.monotonic() - begun
        while n <= 1000 * now:
            at = n / 1000
            loaded = any(start <= at < start + PERIOD_S / 2 for start in starts[max(0, len(due) - 1):len(due) + 1])
            if loaded and not stands:
                due.append(begun + at + DWELL_S)
            stands = loaded
            counts = [int(EMPTY + LOAD * loaded + random.gauss(0, NOISE)) for _ in range(4)]
            udp.sendto(head + struct.pack(">5i", n, *counts), ("127.0.0.1", port))
            n += 1
        time.sleep(max(0.0002, n / 1000 - (time.monotonic() - begun)))
    return due


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program `underfoot`")
    parser.add_argument("--presses", type=int, default=200, help="number of presses")
    options = parser.parse_args()
    screen = Display((640, 480))
    name = screen.env["DISPLAY"]
    window = Window(name)
    window.start()
    with tempfile.TemporaryDirectory(prefix="underfoot-latency-") as folder:
        for file, text in (("floor.ron", "Floor(columns: 1, rows: 1)\n"), ("layout.ron", LAYOUT.format(display=name))):
            with open(os.path.join(folder, file), "w") as out:
                out.write(text)
        port = free_port()
        command = [os.path.abspath(options.program), "run", "layout.ron", "--floor", "floor.ron", "--listen",
                   f"127.0.0.1:{port}", "--no-osc", "--wav", "sound.wav"]
        program = subprocess.Popen(command, cwd=folder, env=screen.env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1)
        due = send(port, options.presses)
        end(program)
    fault = report(due, window.times)
    # libX11 ends a process whose display goes away.
    screen.server.terminate()
    sys.stdout.flush()
    os._exit(fault)


def report(due, keys):
    """Prints how late the keys are, each after the last press before it; returns whether a press has none."""
    late = sorted(1000 * (key - max(press for press in due if press <= key)) for key in keys if key >= due[0])
    if not late:
        print("no key came")
        return 1
    at = [late[min(len(late) - 1, int(share * len(late)))] for share in (0.5, 0.95, 0.99)]
    print(f"{len(due)} presses, {len(late)} keys: median {at[0]:.1f} ms, 95 % {at[1]:.1f} ms, 99 % {at[2]:.1f} ms, "
          f"longest {late[-1]:.1f} ms")
    return int(len(late) != len(due))


if __name__ == "__main__":
    main()
