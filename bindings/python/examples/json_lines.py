"""Prints events as JSON lines, and the beginning and end of each hold of a control.

    python json_lines.py 127.0.0.1:9000 map.ron home [floor.ron]

SIGTERM ends the floor, SIGUSR1 makes this program fail, and SIGUSR2 closes the floor.
"""

import json
import signal
import sys
import time

import underfoot

address, layout, watched, floor_file = (*sys.argv[1:], None)[:4]
was_held = False


def look():
    global was_held
    held = floor.held(watched)
    if held != was_held:
        print(json.dumps({"now_s": time.monotonic(), "id": watched, "held": held}), flush=True)
    was_held = held


def fail(*_):
    raise RuntimeError("as it was asked to")


try:
    with underfoot.listen(address, layout, floor=floor_file, every_change=True) as floor:
        signal.signal(signal.SIGTERM, lambda *_: floor.stop())
        signal.signal(signal.SIGUSR1, fail)
        signal.signal(signal.SIGUSR2, lambda *_: floor.close())
        print(json.dumps({"listening": address}), flush=True)
        while not floor.over:
            event = floor.next_event(0.01)
            if event is not None and event.kind == "control":
                fields = ("t_s", "id", "value", "force_n", "x_m", "y_m", "contact")
                line = {field: getattr(event, field) for field in fields}
                print(json.dumps({"event": event.name, **line}), flush=True)
            look()
finally:
    # After any kind of end.
    look()
