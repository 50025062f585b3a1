"""A board in real time, with `underfoot run` on its port."""

import json
import os
import pathlib
import queue
import subprocess
import sys
import threading
import time
import typing

FIRMWARE = pathlib.Path(__file__).resolve().parent.parent

# The test that runs.
NAME = f"firmware/{pathlib.Path(sys.argv[0]).name}"


def come_first():
    """Puts this process before others, where its user may: it keeps real time, as a board does."""
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    except PermissionError:
        pass


def need(is_so, otherwise):
    if not is_so:
        sys.exit(f"{NAME}: {otherwise}")


def write_script(path, changes):
    """Writes (milliseconds, pin, value), by time."""
    path.write_text("".join(f"{ms:.3f} {pin} {value}\n" for ms, pin, value in changes))
    return path


def start(command, **options):
    """A process whose lines are read, before others."""
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=come_first, **options)


class Pad(typing.NamedTuple):
    """A board, its floor file, and the sensors at its inputs."""

    name: str
    # The emulator and the program of the board; the script and the options follow.
    command: tuple
    floor: pathlib.Path
    side_m: float
    sensor: typing.Callable
    options: tuple = ()
    # The inputs of sensors that no foot loads.
    idle: tuple = ()


class Served:
    """A board in real time, and `underfoot run` on its port; both end with it."""

    def __init__(self, folder, pad, script, underfoot):
        self.command = pad.command, pad.options
        # A name that stays, as the one by the number of a USB device does.
        self.port = folder / "port"
        self.events, self.marks = queue.Queue(), queue.Queue()
        self.plug_in(script)
        layout = FIRMWARE / "arduino/go.ron"
        command = [underfoot, "run", layout, "--floor", pad.floor, "--serial", self.port, "--json", "--no-osc"]
        command += ["--listen", "127.0.0.1:0", "--wav", folder / "out.wav", "--seconds", "30"]
        self.log = open(folder / "log.txt", "w+")
        self.program = start(command, stderr=self.log)
        self.listen(self.program, self.events)

    def plug_in(self, script):
        """Starts the board, whose script begins when the program opens its port."""
        program, options = self.command
        self.board = start([*program, script, *options])
        path = self.board.stdout.readline().strip()
        self.port.unlink(missing_ok=True)
        self.port.symlink_to(path)
        self.listen(self.board, self.marks)

    def listen(self, process, sink):
        threading.Thread(target=self.read, args=(process.stdout, sink), daemon=True).start()

    @staticmethod
    def read(source, sink):
        for line in source:
            sink.put((time.time(), line))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.board, self.program:
            process.kill()
            process.wait()

    def said(self):
        self.log.seek(0)
        return self.log.read()

    def mark(self):
        """Unix seconds of the next mark of the script."""
        try:
            line = self.marks.get(timeout=15)[1]
        except queue.Empty:
            sys.exit(f"{NAME}: nobody opens the port: {self.said()}")
        return float(line.split()[2])

    def event(self, patience_s):
        """The next event of the button, and its arrival in Unix seconds."""
        until = time.monotonic() + patience_s
        while True:
            try:
                at, line = self.events.get(timeout=max(until - time.monotonic(), 0.001))
            except queue.Empty:
                sys.exit(f"{NAME}: an event is missing; the program says: {self.said()}")
            event = json.loads(line)
            if event.get("id") == "go" and event.get("event") in ("pressed", "released", "clicked", "cancelled"):
                return event, at

    def pull_cable(self):
        at = time.time()
        self.board.terminate()
        self.board.wait()
        return at

    def last_words(self):
        """The emulator's counts, at its end."""
        while True:
            line = self.marks.get(timeout=5)[1].strip()
            if line.startswith("sent "):
                return line
