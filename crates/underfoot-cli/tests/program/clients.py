"""Independent clients on a real floor: python-osc and python-tuio against the program itself.

Usage: clients.py PROGRAM LAYOUT. Exit status 0: success; 1: a failure, described on standard error;
77: a client library is missing, nothing was tried.
"""

import signal
import socket
import subprocess
import sys
import threading
import time

try:
    from pythonosc.dispatcher import Dispatcher
    from pythonosc.osc_bundle import OscBundle
    from pythonosc.osc_message import OscMessage
    from pythonosc.osc_message_builder import OscMessageBuilder
    from pythonosc.osc_server import BlockingOSCUDPServer
    from pythontuio import TuioClient, TuioListener
except ImportError as missing:
    print(f"not run: {missing}; pip install python-osc python-tuio", file=sys.stderr)
    sys.exit(77)

LOOPBACK = "127.0.0.1"
LARGEST = 1500


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((LOOPBACK, 0))
        return probe.getsockname()[1]


def wait_until(what, happened, seconds=30.0):
    """Waits for an event that must happen."""
    end = time.monotonic() + seconds
    while not happened():
        if time.monotonic() > end:
            raise AssertionError(f"never happened: {what}")
        time.sleep(0.005)


class Osc(threading.Thread):
    """Datagrams as python-osc decodes them: addresses and arguments, in order, with the time of arrival."""

    def __init__(self):
        super().__init__(daemon=True)
        dispatcher = Dispatcher()
        dispatcher.set_default_handler(self.take)
        self.heard = []
        self.server = BlockingOSCUDPServer((LOOPBACK, 0), dispatcher)
        self.port = self.server.server_address[1]
        self.start()

    def take(self, address, *args):
        self.heard.append((time.monotonic(), address, args))

    def run(self):
        self.server.serve_forever(poll_interval=0.05)

    def of(self, address):
        return [args for _, heard, args in list(self.heard) if heard == address]


class Cursors(TuioListener):
    """The callbacks of python-tuio: cursors and blobs that come, move and leave."""

    def __init__(self):
        self.seen = {"cursor": [], "blob": []}
        self.places = []

    def add_tuio_cursor(self, cur):
        self.seen["cursor"].append(("add", cur.session_id))

    def update_tuio_cursor(self, cur):
        self.places.append(cur.position)

    def remove_tuio_cursor(self, cur):
        self.seen["cursor"].append(("remove", cur.session_id))

    def add_tuio_blob(self, blob):
        self.seen["blob"].append(("add", blob.session_id))

    def remove_tuio_blob(self, blob):
        self.seen["blob"].append(("remove", blob.session_id))


def listen_to_tuio(port):
    client = TuioClient((LOOPBACK, port))
    listener = Cursors()
    client.add_listener(listener)
    # It prints every bundle.
    sys.stdout = open("/dev/null", "w", encoding="utf-8")
    threading.Thread(target=client.start, daemon=True).start()
    return client, listener


class Tap(threading.Thread):
    """Forwards datagrams to a client and records their sizes."""

    def __init__(self, target):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((LOOPBACK, 0))
        self.port = self.socket.getsockname()[1]
        self.target = target
        self.sizes = []
        self.start()

    def run(self):
        while True:
            datagram = self.socket.recv(65536)
            self.sizes.append(len(datagram))
            self.socket.sendto(datagram, (LOOPBACK, self.target))


class App:
    """An app that sends requests to the floor, and receives the answers on the same socket."""

    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(5.0)
        self.target = (LOOPBACK, port)

    def send(self, address, *args):
        builder = OscMessageBuilder(address=address)
        for arg in args:
            builder.add_arg(arg)
        self.socket.sendto(builder.build().dgram, self.target)

    def ask(self, address, *args):
        """The messages of the answer, by address."""
        self.send(address, *args)
        datagram = self.socket.recv(65536)
        if OscBundle.dgram_is_bundle(datagram):
            messages = list(OscBundle(datagram))
        else:
            messages = [OscMessage(datagram)]
        return {message.address: message.params for message in messages}


def expect(condition, what):
    if not condition:
        raise AssertionError(what)


def play(program, layout):
    osc, other, pointers = Osc(), Osc(), Osc()
    tuio_port = free_port()
    client, cursors = listen_to_tuio(tuio_port)
    tap, tap2 = Tap(tuio_port), Tap(pointers.port)
    floor = free_port()
    run = subprocess.Popen(
        [program, "run", layout, "--listen", f"{LOOPBACK}:{floor}", "--osc", f"{LOOPBACK}:{osc.port}",
         "--osc", f"{LOOPBACK}:{other.port}", "--tuio", f"{LOOPBACK}:{tap.port}", "--tuio2", f"localhost:{tap2.port}", "--osc-prefix", "/lab"],
        stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
    simulate = None
    try:
        # The sound system may print a message first.
        expect(any(b"Listening" in line for line in run.stderr), "the program does not listen")
        simulate = subprocess.Popen([program, "simulate", "--quality", "paper", "--send", f"{LOOPBACK}:{floor}"],
                                    stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

        # An app drives controls while there is no foot on them.
        wait_until("the boards are heard", lambda: any(args[0] == "live" for args in osc.of("/lab/health")))
        app = App(floor)
        app.send("/lab/widget/satellite/set", 1)
        app.send("/lab/widget/satellite/label", "Karte")
        app.send("/lab/widget/satellite/indicator", "busy")
        answer = app.ask("/lab/widget/satellite/get")
        expect(answer["/lab/widget/satellite/value"] == [1], answer)
        expect(answer["/lab/widget/satellite/state"] == [1, 0, 0, 0, "busy", "Karte"], answer)
        app.send("/lab/widget/{home,satellite}/lock", 1)
        app.send("/lab/widget/[hs]*/lock", 0)
        last = lambda heard: heard.of("/lab/widget/home/state")[-1:]
        for heard in (osc, other):
            wait_until("all are told", lambda: [1, 1, 0, 0] in [list(args[:4]) for args in
                                                                heard.of("/lab/widget/home/state")])
            wait_until("and told again", lambda: last(heard) and list(last(heard)[0][:4]) == [1, 0, 0, 0])
        unknown = app.ask("/lab/widget/zoom/explode")
        expect(unknown["/lab/error"][0] == "/lab/widget/zoom/explode", unknown)
        refused = app.ask("/lab/widget/zoom/set", "wide")
        expect(refused["/lab/error"][0] == "/lab/widget/zoom/set", refused)

        # The built-in person presses `home` and drags `zoom`.
        wait_until("home clicked", lambda: osc.of("/lab/widget/home/clicked"))
        expect(len(osc.of("/lab/widget/home/pressed")) == 1, "home pressed once")
        wait_until("zoom changed", lambda: len(osc.of("/lab/widget/zoom/changed")) > 5)
        value, force, x, y = osc.of("/lab/widget/zoom/changed")[-1]
        expect(0.0 <= value <= 1.0 and force > 20.0 and 0.0 < x < 1.83 and 0.0 < y < 1.83, "zoom's arguments")
        wait_until("the other hears it as well", lambda: other.of("/lab/widget/home/clicked"))
        wait_until("a pointer", lambda: pointers.of("/tuio2/ptr"))

        # The program is ended while a foot is down.
        wait_until("cursors", lambda: client.cursors and client.blobs)
        run.send_signal(signal.SIGTERM)
        expect(run.wait(timeout=10) == 0, "the program did not end well")
        wait_until("goodbye, TUIO 1.1", lambda: not client.cursors and not client.blobs, 5.0)
        wait_until("goodbye, TUIO 2.0", lambda: pointers.of("/tuio2/alv")[-1] == (), 5.0)
        wait_until("goodbye, OSC", lambda: osc.of("/lab/contacts")[-1] == (0,), 5.0)
    finally:
        for process in (simulate, run):
            if process is not None and process.poll() is None:
                process.kill()
                process.wait()
    check_streams(osc, pointers, cursors, tap.sizes + tap2.sizes)


def check_streams(osc, pointers, cursors, sizes):
    expect(max(sizes) <= LARGEST, f"a datagram of {max(sizes)} bytes")
    for kind in ("cursor", "blob"):
        events = cursors.seen[kind]
        added = [session for what, session in events if what == "add"]
        removed = [session for what, session in events if what == "remove"]
        expect(len(added) >= 3 and len(added) == len(set(added)), f"each {kind} is added once: {events}")
        expect(sorted(added) == sorted(removed), f"each {kind} is removed: {events}")
    expect(all(0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 for x, y in cursors.places), "places within the floor")
    # TUIO counts from the north: a person in the south has a large y.
    expect(any(y > 0.6 for _, y in cursors.places), "nobody in the south")
    for args in pointers.of("/tuio2/ptr"):
        expect(len(args) == 14, args)
        session, _, _, x, y, _, _, _, press = args[:9]
        expect(isinstance(session, int) and 0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 and 0.0 < press <= 1.0, args)
    frames = [args[0] for args in pointers.of("/tuio2/frm")]
    expect(frames == sorted(frames) and len(frames) > 100, "frames are in order")
    # 100 Hz: within any second at most a hundred reports, and a few delayed ones.
    times = [when for when, address, _ in osc.heard if address == "/lab/contacts"]
    busiest = max(sum(1 for other in times if begun <= other < begun + 1.0) for begun in times[::20])
    changes = [when for when, address, _ in osc.heard if address == "/lab/widget/zoom/changed"]
    most = max(sum(1 for other in changes if begun <= other < begun + 1.0) for begun in changes)
    expect(most <= 66, f"{most} changes of zoom in a second")
    expect(50 < busiest <= 115, f"{busiest} reports of contacts in a second")


if __name__ == "__main__":
    try:
        play(sys.argv[1], sys.argv[2])
    except (AssertionError, OSError) as wrong:
        print(f"wrong: {wrong}", file=sys.stderr)
        sys.exit(1)
