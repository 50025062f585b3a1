"""The floor over WebSocket, without a browser: prints its events, and the beginning and end of each hold of a control.

    python3 lines.py 127.0.0.1:9002 beam

Like the floor's own page, it ends a hold after 100 ms without a report of it. SIGTERM ends it, SIGUSR1
makes it fail at each message, and SIGUSR2 closes its connection.
"""

import base64
import json
import os
import select
import signal
import socket
import struct
import sys
import time

BELIEVED_FOR = 0.1
TEXT, PING, PONG = 1, 9, 10

address, watched = sys.argv[1:3]
host, port = address.rsplit(":", 1)
floor = socket.create_connection((host, int(port)))
key = base64.b64encode(os.urandom(16)).decode()
floor.sendall(("GET / HTTP/1.1\r\nHost: %s\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
               "Sec-WebSocket-Key: %s\r\nSec-WebSocket-Version: 13\r\n\r\n" % (address, key)).encode())
waiting = b""
while b"\r\n\r\n" not in waiting:
    part = floor.recv(65536)
    if not part:
        sys.exit("the floor does not answer")
    waiting += part
head, _, waiting = waiting.partition(b"\r\n\r\n")
if not head.startswith(b"HTTP/1.1 101 "):
    sys.exit(head.decode(errors="replace"))

asked, was_held, held, held_at = set(), False, [], 0.0
for name in (signal.SIGUSR1, signal.SIGUSR2, signal.SIGTERM):
    signal.signal(name, lambda number, _: asked.add(number))


def frames():
    """Takes the whole frames out of the received bytes: RFC 6455, 5.2. A server does not mask."""
    global waiting
    while len(waiting) >= 2:
        opcode, length, begin = waiting[0] & 15, waiting[1] & 127, 2
        if length > 125:
            begin, form = (4, ">H") if length == 126 else (10, ">Q")
            if len(waiting) < begin:
                return
            (length,) = struct.unpack(form, waiting[2:begin])
        if len(waiting) < begin + length:
            return
        payload, waiting = waiting[begin:begin + length], waiting[begin + length:]
        yield opcode, payload


def take(line):
    global held, held_at
    if signal.SIGUSR1 in asked:
        raise RuntimeError("as it was asked to")
    if "held" in line:
        held, held_at = line["held"], time.monotonic()
    elif line.get("id") and line["event"] not in ("state", "ignored"):
        print(json.dumps(line), flush=True)


def look():
    global was_held
    now = time.monotonic()
    is_held = now - held_at < BELIEVED_FOR and watched in held
    if is_held != was_held:
        print(json.dumps({"now_s": now, "id": watched, "held": is_held}), flush=True)
    was_held = is_held


print(json.dumps({"listening": address}), flush=True)
while signal.SIGTERM not in asked:
    if signal.SIGUSR2 in asked and floor:
        floor = floor.close()
    if not floor:
        # The server is gone; the page would try again.
        time.sleep(0.01)
    elif select.select([floor], [], [], 0.01)[0]:
        try:
            part = floor.recv(65536)
        except ConnectionError:
            part = b""
        if not part:
            floor = floor.close()
        waiting += part
    for opcode, payload in frames():
        if opcode == PING and floor:
            # A client masks; a mask of zeros changes nothing.
            floor.sendall(bytes([0x80 | PONG, 0x80 | len(payload), 0, 0, 0, 0]) + payload)
        if opcode == TEXT:
            try:
                take(json.loads(payload))
            except RuntimeError as error:
                # Like in a browser: the message is lost and the page continues.
                print(error, file=sys.stderr)
    look()
