"""Receives DMX by libraries of others: stupidArtnet for Art-Net, sacn for sACN.

Usage: lights.py ART_NET_PORT SACN_PORT. Prints `ready`, then `art-net CHANNEL LEVEL` or `sacn CHANNEL LEVEL` for each level
that changes in the channels 1 and 12 of universe 1, until standard input ends. Exit status 77: a library is missing.
"""

import sys
import threading

try:
    import sacn
    from stupidArtnet import StupidArtnetServer
except ImportError as missing:
    print(f"not run: {missing}; pip install sacn stupidArtnet", file=sys.stderr)
    sys.exit(77)

CHANNELS = (1, 12)
art_net_port, sacn_port = map(int, sys.argv[1:])
turn = threading.Lock()
known = {}


def note(protocol, levels):
    """Prints the levels that have changed."""
    with turn:
        for channel in CHANNELS:
            level = levels[channel - 1]
            if known.get((protocol, channel)) != level:
                known[protocol, channel] = level
                print(protocol, channel, level, flush=True)


art_net = StupidArtnetServer(port=art_net_port)
art_net.register_listener(universe=1, callback_function=lambda levels: note("art-net", levels))
receiver = sacn.sACNreceiver(bind_address="127.0.0.1", bind_port=sacn_port)
receiver.register_listener("universe", lambda packet: note("sacn", packet.dmxData), universe=1)
receiver.start()
print("ready", flush=True)
sys.stdin.read()
receiver.stop()
