"""Boards at many rates and with every source of time: when a press is decided, and how long a pulled cable holds.

    python3 tools/floors/rates.py target/release/underfoot [RATE_HZ...] [--seconds 60] [--at-once 3]

One tile, empty at first, bears a foot from second 4 to second 7, and again until the board falls silent while the foot still
stands. Each board counts packets, or milliseconds, or sends no number at all. The table has, in ms: how much later than the
force crossed the threshold (plus the dwell of 20 ms for a press) a press and a release were heard; how long the last press outlived the last packet; the floor's time against the clock from the first press to the last; and every
fault that was reported in between. A period of the board is part of each delay: a foot is seen at the next reading.
"""
import argparse
import concurrent.futures
import json
import math
import os
import queue
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

RATES = (20, 50, 80, 100, 200, 500, 1000, 2000, 4000)
BASES = {"packets": lambda n, hz: n, "milliseconds": lambda n, hz: n * 1000 // hz, "arrival": lambda n, hz: 0}
# Counts of a 16-bit converter: an empty sensor, a foot's load on it, and the noise.
EMPTY, LOAD, NOISE = 7680, 35840, 26
RAMP_S = 0.12
DWELL_S = 0.02
FLOOR = "Floor(columns: 1, rows: 1)\n"
LAYOUT = """Layout(version: 1, regions: [(id: "r", at: (0, 0), size: (1, 1))],
    widgets: [(id: "b", kind: "button", at: (0.1, 0.1), size: (0.8, 0.8), press_n: 60, release_n: 40)])
"""


def padded(text):
    return text.encode() + b"\0" * (4 - len(text) % 4)


class Board(threading.Thread):
    """Sends the packets of one board until `end_s`; the foot comes back three seconds before that."""

    def __init__(self, port, hz, base, end_s):
        super().__init__(daemon=True)
        self.port, self.hz, self.base, self.end_s = port, hz, base, end_s
        self.begun = time.monotonic()
        self.last = None

    def load(self, s):
        """Share of the foot's load at this second."""
        return max(0, min(1, (s - 4) / RAMP_S, (7 - s) / RAMP_S), min(1, (s - self.end_s + 3) / RAMP_S))

    def run(self):
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        n, head = 0, padded("/underfoot/board/0") + padded(",iiiii")
        while (now := time.monotonic() - self.begun) < self.end_s:
            while n <= now * self.hz:
                load = self.load(n / self.hz)
                counts = [int(EMPTY + LOAD * load + random.gauss(0, NOISE)) for _ in range(4)]
                udp.sendto(head + struct.pack(">5i", self.base(n, self.hz) & 0x7FFFFFFF, *counts), ("127.0.0.1", self.port))
                n += 1
                self.last = time.monotonic()
            time.sleep(max(0.0003, n / self.hz - (time.monotonic() - self.begun)))


class Program:
    """`underfoot run` on one tile; its events with the time at which each was read."""

    def __init__(self, program, folder):
        for name, text in (("floor.ron", FLOOR), ("layout.ron", LAYOUT)):
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        probe.bind(("127.0.0.1", 0))
        self.port = probe.getsockname()[1]
        probe.close()
        self.process = subprocess.Popen(
            [program, "run", "layout.ron", "--floor", "floor.ron", "--listen", f"127.0.0.1:{self.port}", "--no-osc", "--json",
             "--wav", "sound.wav"],
            cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.events = queue.Queue()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            self.events.put((time.monotonic(), json.loads(line)))
        self.events.put(None)

    def end(self):
        self.process.terminate()
        self.process.wait(20)
        events = []
        while (event := self.events.get(timeout=20)) is not None:
            events.append(event)
        return events


def crossing_s(newtons):
    """Seconds after the ramp's beginning at which the tile bears this force, by the nominal law F = 0.5 N (exp(1.34 V) - 1)."""
    empty_n = 0.5 * (math.exp(1.34 * EMPTY * 5 / 65536) - 1)
    volts = math.log((newtons / 4 + empty_n) / 0.5 + 1) / 1.34
    return (volts * 65536 / 5 - EMPTY) / LOAD * RAMP_S


def measure(program, hz, base, seconds):
    with tempfile.TemporaryDirectory(prefix="underfoot-rates-") as folder:
        running = Program(program, folder)
        time.sleep(0.6)
        board = Board(running.port, hz, BASES[base], seconds)
        board.start()
        board.join()
        time.sleep(1)
        return board, running.end()


def row(board, base, events):
    acts = [(at - board.begun, line) for at, line in events if line.get("event") in ("pressed", "released", "cancelled")]
    kinds = [line["event"] for _, line in acts]
    faults = sorted({line["event"] + ":" + str(line.get("cause", line.get("state", ""))) for at, line in events
                     if at > board.begun + 1.5 and at < board.last and (
                         line.get("event") == "link_cause" or line.get("event") == "link" and line.get("state") != "live"
                         or line.get("event") == "health" and (line.get("faulty") or line.get("stale")))})
    if kinds != ["pressed", "released", "pressed", "cancelled"]:
        return f"| {board.hz} | {base} | {' '.join(kinds) or 'no press'} | | | | {' '.join(faults) or 'none'} |"
    (down_s, down), (up_s, up), _, (end_s, end) = acts
    late = [1000 * (down_s - 4 - crossing_s(60) - DWELL_S), 1000 * (up_s - 7 + crossing_s(40))]
    clock, floor = end_s - down_s, end["t_s"] - down["t_s"]
    held = 1000 * (end_s + board.begun - board.last)
    return (f"| {board.hz} | {base} | {late[0]:.0f} | {late[1]:.0f} | {held:.0f} | {1000 * (floor - clock):+.0f} | "
            f"{' '.join(faults) or 'none'} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("rates", nargs="*", type=int, default=RATES)
    parser.add_argument("--seconds", type=float, default=60, help="how long each board sends")
    parser.add_argument("--at-once", type=int, default=3, help="boards measured at once")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    print("| Hz | time by | pressed after (ms) | released after (ms) | held without packets (ms) | floor - clock (ms) | faults |")
    print("|---|---|---|---|---|---|---|")
    with concurrent.futures.ThreadPoolExecutor(args.at_once) as pool:
        jobs = [(base, pool.submit(measure, program, hz, base, args.seconds)) for hz in args.rates for base in BASES]
        for base, job in jobs:
            print(row(*(lambda board, events: (board, base, events))(*job.result())), flush=True)


if __name__ == "__main__":
    sys.exit(main())
