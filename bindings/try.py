"""Programs in other languages hear what JSON lines say, and believe no hold for long.

    python3 bindings/try.py UNDERFOOT LAYOUT -- NAME COMMAND... [-- NAME COMMAND...]

UNDERFOOT is the program. Each COMMAND gets an address, the layout and the name of a control, and prints {"listening":...},
then events as JSON lines, and when that control begins and ends to be held. All are sent the same packets as `underfoot run --json`; then
the packets stop while the control is held, `--rounds` times, and the program is asked by SIGTERM to end its session, as often.
"""

import argparse
import difflib
import json
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

VISIT = """Scenario(
    title: "Home, then zoom",
    person: (mass_kg: 70, foot_m: 0.27),
    steps: [
        Wait(ms: 1200),
        Enter(from: South, at: (2.2, 0.5)),
        Press(widget: "home", force_n: 140, hold_ms: 350),
        Sidestep(at: (4.0, 0.5)),
        Drag(widget: "zoom", from: 0.3, to: 0.75, speed_m_s: 0.3, force_n: 110),
        Wait(ms: 300),
    ],
)"""
HOLD = VISIT.replace("hold_ms: 350", "hold_ms: 60000")
HELD = "home"
# What a program may still believe after the packets have stopped, in seconds.
SOON = 0.150
TRIES = 5


class Relay:
    """Passes what comes to each of `targets`, until it is cut."""

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
        self.lines = []
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
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

    def events(self):
        """What happened to controls, and of each drag the last value.

        Each program assembles the packets itself: where the system lost or delayed one, forces differ a little."""
        told = []
        for line in self.lines:
            if "id" not in line or line.get("event", "state") == "state":
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
                raise SystemExit("%s does not listen" % self.process.args)
            time.sleep(0.005)

    def wait_held(self, held, since=0.0):
        end = time.monotonic() + 20
        while time.monotonic() < end:
            for line in list(self.lines):
                if line.get("held") is held and line.get("now_s", 0) > since:
                    return line["now_s"]
            time.sleep(0.005)
        raise SystemExit("never heard that %s is %sheld" % (HELD, "" if held else "no longer "))


def alike(one, other):
    """Whether two lists of events are the same, numbers to 2 % of the range from 0 to 1."""
    def same(one, other):
        numbers = [value for value in (one[2], other[2]) if isinstance(value, float)]
        close = abs(numbers[0] - numbers[1]) < 0.02 if len(numbers) == 2 else one[2] == other[2]
        return one[:2] == other[:2] and close
    return len(one) == len(other) and all(map(same, one, other))


def free_address():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()


def said(address):
    return "%s:%d" % address


def simulate(underfoot, scenario, folder, address):
    path = Path(folder) / "visit.ron"
    path.write_text(scenario)
    command = [underfoot, "simulate", "--scenario", str(path), "--send", address]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def same_events(underfoot, layout, name, command, folder):
    addresses = [free_address(), free_address()]
    wanted = Reader([underfoot, "run", layout, "--listen", said(addresses[0]), "--json", "--no-osc",
                     "--wav", str(Path(folder) / "out.wav")])
    reader = Reader([*command, said(addresses[1]), layout, HELD])
    relay = Relay(addresses)
    reader.wait_listening()
    # The program says so to people only.
    time.sleep(1)
    simulate(underfoot, VISIT, folder, relay.address()).wait()
    time.sleep(1)
    reader.end()
    wanted.end()
    relay.end()
    same = ("clicked", "home", None) in wanted.events() and alike(reader.events(), wanted.events())
    print("%s: %d lines, %s" % (name, len(reader.lines), "the same events as JSON lines" if same else "OTHER EVENTS"))
    if not same:
        lines = [[str(event) for event in heard.events()] for heard in (wanted, reader)]
        print(*difflib.unified_diff(*lines, "JSON lines", name, n=0, lineterm=""), sep="\n")
    return same


def held_until(underfoot, layout, command, folder, end):
    """For how long a program believes that the control is held, once `end` of its relay or itself has ended that."""
    address = free_address()
    reader = Reader([*command, said(address), layout, HELD])
    relay = Relay([address])
    reader.wait_listening()
    feet = simulate(underfoot, HOLD, folder, relay.address())
    held = reader.wait_held(True)
    ended_at = time.monotonic()
    end(relay, reader)
    took = reader.wait_held(False, held) - ended_at
    feet.kill()
    feet.wait()
    relay.end()
    reader.end()
    return took


ENDS = [
    ("the packets stop", lambda relay, _: relay.cut()),
    ("its session is stopped", lambda _, reader: reader.process.send_signal(signal.SIGTERM)),
]


def believed(underfoot, layout, name, command, folder, rounds):
    good = True
    # A page has no session of its own: what it is told ends with its server.
    for what, end in ENDS[:1] if name == "web page" else ENDS:
        times = [held_until(underfoot, layout, command, folder, end) for _ in range(rounds)]
        print("%s: %s, believed for %.0f ms (median of %d), %.0f ms at most"
              % (name, what, 1000 * statistics.median(times), rounds, 1000 * max(times)))
        # A machine that has something else to do delays a round; a rule that is broken delays all of them.
        good &= min(times) <= SOON
    return good


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("underfoot")
    parser.add_argument("layout")
    own, programs = sys.argv[1:], []
    if "--" in own:
        at = own.index("--")
        own, rest = own[:at], own[at + 1:]
        while rest:
            end = rest.index("--") if "--" in rest else len(rest)
            programs.append((rest[0], rest[1:end]))
            rest = rest[end + 1:]
    args = parser.parse_args(own)
    with tempfile.TemporaryDirectory() as folder:
        good = True
        for name, command in programs:
            # A machine that stops for 100 ms takes the link from both, and not in the same moment.
            good &= any(same_events(args.underfoot, args.layout, name, command, folder) for _ in range(TRIES))
            good &= believed(args.underfoot, args.layout, name, command, folder, args.rounds)
    sys.exit(not good)


if __name__ == "__main__":
    main()
