r"""Programs in other languages receive the same events as JSON lines, and end each hold in time.

    python3 bindings/try.py [--rounds N] [--at-once N] [--strict] UNDERFOOT LAYOUT \
        --own NAME COMMAND... [--web NAME COMMAND...] [--browser NAME COMMAND...]

UNDERFOOT is the program. A COMMAND after `--own` has a floor of its own: it gets the address of packets, the layout
and the name of a control. One after `--web` gets the address of the web server of `underfoot run`, and the name; one
after `--browser` as well, and has the machine for itself. Each prints {"listening":...}, then events as JSON lines, and
when that control begins and ends to be held. It is sent the same packets as `underfoot run --json`. Then, while the
control is held, each thing fails that may, `--rounds` times: the one who sends, what lies between, the floor, the
program. After `--same` stands a program that only needs to hear the events.

A program ends its floor on SIGTERM, fails in its own code on SIGUSR1, and gives back its handle or closes its connection
on SIGUSR2. `--strict` asks all rounds to be in time, for an idle machine.
"""

import argparse
import difflib
import itertools
import json
import random
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

VISIT = (Path(__file__).parent.parent / "crates/underfoot-cli/tests/program/visit.ron").read_text()
PAGE = """Layout(
    version: 1,
    regions: [(id: "floor", at: (0, 2), size: (6, 4))],
    stances: [(at: (2, 0), size: (2, 1))],
    widgets: [(id: "beam", kind: "dead_man", at: (0.2, 2.2), size: (0.6, 0.6), label: "Beam")],
)"""
HOLD = """Scenario(
    title: "A hold",
    person: (mass_kg: 70, foot_m: 0.27),
    steps: [
        Wait(ms: 300),
        Enter(from: South, at: (2.2, 0.5)),
        Press(widget: "beam", force_n: 160, hold_ms: 60000),
    ],
)"""
# Time after the last packet within which a program must end a hold, in seconds.
SOON = 0.150
TRIES = 5


class Relay:
    """Forwards packets to each of `targets`, until it is cut."""

    def __init__(self, targets):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.2)
        self.targets, self.cut_at, self.over = targets, None, False
        self.thread = threading.Thread(target=self.pass_on)
        self.thread.start()

    def address(self):
        return "127.0.0.1:%d" % self.socket.getsockname()[1]

    def pass_on(self):
        while not self.over:
            try:
                packet = self.socket.recv(65536)
            except TimeoutError:
                continue
            if self.cut_at is None:
                for target in self.targets:
                    self.socket.sendto(packet, target)

    def cut(self):
        self.cut_at = time.monotonic()

    def end(self):
        self.over = True
        self.thread.join()
        self.socket.close()


class Reader:
    """The lines that a program prints."""

    def __init__(self, command):
        self.lines, self.errors = [], tempfile.TemporaryFile()
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.errors, text=True)
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def read(self):
        for line in self.process.stdout:
            self.lines.append(json.loads(line))

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
        self.thread.join()

    def complaint(self):
        """The end of its standard error."""
        self.errors.seek(0)
        return self.errors.read().decode(errors="replace")[-2000:] or "it says nothing"

    def events(self):
        """The events of controls, with only the last value of each drag.

        Each program assembles the packets itself: where the system lost or delayed one, forces differ a little."""
        told = []
        for line in self.lines:
            if "id" not in line or line.get("event", "state") in ("state", "ignored"):
                continue
            event = (line["event"], line["id"], line["value"])
            if told and told[-1][:2] == event[:2] == ("changed", event[1]):
                told.pop()
            told.append(event)
        return told

    def wait_listening(self):
        end = time.monotonic() + 30
        while not any("listening" in line for line in list(self.lines)):
            if time.monotonic() > end or self.process.poll() is not None:
                raise SystemExit("%s does not listen: %s" % (self.process.args, self.complaint()))
            time.sleep(0.005)

    def wait_held(self, held, since=0.0):
        """First time after `since` at which the program printed that the control is held or not; None after 20 s."""
        end = time.monotonic() + 20
        while time.monotonic() < end:
            for line in list(self.lines):
                if line.get("held") is held and line.get("now_s", 0) > since:
                    return line["now_s"]
            time.sleep(0.005)
        return None

    def never_says(self, held):
        return SystemExit("%s never says: held %s: %s" % (self.process.args, held, self.complaint()))


def alike(one, other):
    """Whether two lists of events are the same, numbers to 2 % of the range from 0 to 1."""
    def same(one, other):
        numbers = [value for value in (one[2], other[2]) if isinstance(value, float)]
        close = abs(numbers[0] - numbers[1]) < 0.02 if len(numbers) == 2 else one[2] == other[2]
        return one[:2] == other[:2] and close
    return len(one) == len(other) and all(map(same, one, other))


# Below the ports that the system assigns by itself: none of these is taken between the check and its use.
PORTS = itertools.count(random.randrange(10_000, 20_000))


def free_address(kind):
    for port in itertools.islice(PORTS, 10_000):
        with socket.socket(socket.AF_INET, kind) as taken:
            try:
                taken.bind(("127.0.0.1", port))
            except OSError:
                continue
            return taken.getsockname()
    raise SystemExit("no free port")


def said(address):
    return "%s:%d" % address


class Trial:
    """A listening program, with a floor that reports to it if it has none of its own, and the feet.

    The feet send to it directly unless their packets are relayed (`is_relayed`): a relay may lag behind on a busy
    machine, and forwards its backlog after they have gone."""

    def __init__(self, underfoot, layout, way, command, control, folder, floor=(), is_relayed=True):
        self.underfoot, self.layout, self.folder = underfoot, layout, Path(tempfile.mkdtemp(dir=folder))
        self.floor, self.feet, addresses = None, None, [free_address(socket.SOCK_DGRAM)]
        if way in ("--web", "--browser"):
            web = free_address(socket.SOCK_STREAM)
            self.serve(addresses[0], "--web", said(web), *["--floor=" + path for path in floor])
            wait_open(web, self.floor)
            self.reader = Reader([*command, said(web), control])
        else:
            self.reader = Reader([*command, said(addresses[0]), layout, control, *floor])
            if not floor:
                addresses.append(free_address(socket.SOCK_DGRAM))
                self.serve(addresses[1])
        self.relay = Relay(addresses) if is_relayed else None
        self.target = self.relay.address() if self.relay else said(addresses[0])
        self.reader.wait_listening()

    def serve(self, address, *more):
        self.floor = Reader([self.underfoot, "run", self.layout, "--listen", said(address), "--json", "--no-osc",
                             "--wav", str(self.folder / "out.wav"), *more])

    def walk(self, scenario, layout):
        path = self.folder / "visit.ron"
        path.write_text(scenario)
        command = [self.underfoot, "simulate", layout, "--quality", "paper", "--scenario", str(path), "--send", self.target]
        self.feet = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def end(self):
        self.reader.end()
        if self.floor:
            self.floor.end()
        self.feet.kill()
        self.feet.wait()
        if self.relay:
            self.relay.end()


def wait_open(address, floor):
    end = time.monotonic() + 30
    while time.monotonic() < end and floor.process.poll() is None:
        try:
            return socket.create_connection(address).close()
        except OSError:
            time.sleep(0.02)
    raise SystemExit("nobody listens at %s: %s" % (said(address), floor.complaint()))


def same_events(underfoot, layout, way, name, command, folder):
    trial = Trial(underfoot, layout, way, command, "home", folder)
    # The program reports that on standard error only.
    time.sleep(1)
    trial.walk(VISIT, layout)
    trial.feet.wait()
    time.sleep(1)
    trial.end()
    wanted, reader = trial.floor, trial.reader
    same = ("clicked", "home", None) in wanted.events() and alike(reader.events(), wanted.events())
    print("%s: %d lines, %s" % (name, len(reader.lines), "the same events as JSON lines" if same else "OTHER EVENTS"))
    if not same:
        lines = [[str(event) for event in heard.events()] for heard in (wanted, reader)]
        print(*difflib.unified_diff(*lines, "JSON lines", name, n=0, lineterm=""), sep="\n")
    return same


def tell(name):
    return lambda trial: trial.reader.process.send_signal(name)


CUT = "the packets stop"
ENDS = {
    "the sender is killed": lambda trial: trial.feet.kill(),
    "the sender is asked to end": lambda trial: trial.feet.terminate(),
    CUT: lambda trial: trial.relay.cut(),
}
ENDS_OF = {
    "--own": ENDS | {
        "it is asked to end": tell(signal.SIGTERM),
        "its own code fails": tell(signal.SIGUSR1),
        "its handle is given back": tell(signal.SIGUSR2),
    },
    "--web": ENDS | {
        "the floor is killed": lambda trial: trial.floor.process.kill(),
        "the floor is asked to end": lambda trial: trial.floor.process.terminate(),
        "its own code fails": tell(signal.SIGUSR1),
        "its connection is closed": tell(signal.SIGUSR2),
    },
    "--same": {},
}
ENDS_OF["--browser"] = ENDS_OF["--web"]


def believed_for(underfoot, way, command, folder, what):
    """The time for which a program keeps a hold after `what` has ended it."""
    page, floor = Path(folder) / "beam.ron", Path(folder) / "floor.ron"
    for _ in range(TRIES):
        trial = Trial(underfoot, str(page), way, command, "beam", folder, [str(floor)], what == CUT)
        trial.walk(HOLD, str(page))
        held = trial.reader.wait_held(True)
        if held:
            break
        # The machine stopped the packets for 100 ms: a foot that presses then must lift first.
        print("%s: the hold did not begin, and is walked again" % " ".join(command), flush=True)
        trial.end()
    else:
        raise trial.reader.never_says(True)
    # After this time no message of the beginning is still on its way.
    time.sleep(0.2)
    ended_at = time.monotonic()
    ENDS_OF[way][what](trial)
    let_go = trial.reader.wait_held(False, held)
    trial.end()
    if let_go is None:
        raise trial.reader.never_says(False)
    return let_go - ended_at


def believed(underfoot, way, name, command, folder, args):
    good = True
    # Several browsers would use up the processor, and the floor would be lost before the feet press.
    with ThreadPoolExecutor(1 if way == "--browser" else args.at_once) as pool:
        def begin(what):
            return pool.submit(believed_for, underfoot, way, command, folder, what)
        rounds = [(what, [begin(what) for _ in range(args.rounds)]) for what in ENDS_OF[way]]
        for what, begun in rounds:
            times = [one.result() for one in begun]
            print("%s: %s, believed for %.0f ms (median of %d), %.0f ms at most"
                  % (name, what, 1000 * statistics.median(times), args.rounds, 1000 * max(times)), flush=True)
            # A busy machine delays one round; an error in a program delays all of them.
            good &= (max if args.strict else min)(times) <= SOON
    return good


def programs_of(own):
    """The programs in these arguments, each with its way, name and command; and the arguments before them."""
    starts = [at for at, word in enumerate(own) if word in ENDS_OF]
    ends = [*starts[1:], len(own)]
    rest = own[:starts[0]] if starts else own
    return [(own[at], own[at + 1], own[at + 2:end]) for at, end in zip(starts, ends)], rest


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=2)
    # Most of a round is spent waiting for the feet.
    parser.add_argument("--at-once", type=int, default=4)
    parser.add_argument("--strict", action="store_true")
    parser.add_argument("underfoot")
    parser.add_argument("layout")
    programs, rest = programs_of(sys.argv[1:])
    args = parser.parse_args(rest)
    with tempfile.TemporaryDirectory() as folder:
        good = True
        (Path(folder) / "beam.ron").write_text(PAGE)
        # The calibration that a lab would measure on the simulated floor.
        subprocess.run([args.underfoot, "simulate", "--quality", "paper", "--seconds", "0.1", "--send", said(free_address(socket.SOCK_DGRAM)),
                        "--write-floor", str(Path(folder) / "floor.ron")], check=True, capture_output=True)
        for way, name, command in programs:
            # A machine that stops for 100 ms interrupts both links, but not at the same time.
            good &= any(same_events(args.underfoot, args.layout, way, name, command, folder) for _ in range(TRIES))
            good &= believed(args.underfoot, way, name, command, folder, args)
    sys.exit(not good)


if __name__ == "__main__":
    main()
