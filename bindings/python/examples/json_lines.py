"""Prints events as JSON lines, and when a control begins and ends to be held.

    python json_lines.py 127.0.0.1:9000 map.ron home
"""

import json
import signal
import sys
import time

import underfoot

address, layout, watched = sys.argv[1:4]
was_held = False
with underfoot.listen(address, layout, every_change=True) as floor:
    signal.signal(signal.SIGTERM, lambda *_: floor.stop())
    print(json.dumps({"listening": address}), flush=True)
    while not floor.over:
        event = floor.next_event(0.01)
        if event is not None and event.kind == "control":
            fields = ("t_s", "id", "value", "force_n", "x_m", "y_m", "contact")
            line = {field: getattr(event, field) for field in fields}
            print(json.dumps({"event": event.name, **line}), flush=True)
        held = floor.held(watched)
        if held != was_held:
            print(json.dumps({"now_s": time.monotonic(), "id": watched, "held": held}), flush=True)
        was_held = held
