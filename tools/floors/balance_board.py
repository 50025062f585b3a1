"""One person on one plate, read as seldom and irregularly as a balance board: contacts, presses and sway.

    python3 tools/floors/balance_board.py target/release/underfoot standing.csv [--rate 55] [--gap 0.3] [--seeds 5]

The recording is a CSV of the four corner forces of a rigid plate under one standing person: the columns
`t_s,fz1_N,fz2_N,fz3_N,fz4_N`, of the corners north-east, north-west, south-west and south-east (a force plate's usual
order), with the sensors at the distances --east and --north from its middle. Each seed thins it to about --rate readings a
second at irregular times, with some pauses of up to --gap seconds.

For each seed: the instants with no, one and several contacts (after the first second); how often a contact's identity
changed; and the greatest distance of the contact's place from the plate's own centre of pressure, by the moments of the four
forces. Then the same readings go to a floor at work, as packets in real time: the presses and releases of a button that covers
the plate, and the ends of its holds.
"""
import argparse
import csv
import json
import math
import random
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Corners in the order of a floor file (south-west, south-east, north-west, north-east) as positions in the recording.
ORDER = (2, 3, 1, 0)


def floor_text(east, north):
    places = ", ".join(f"({x}, {y})" for y in (-north, north) for x in (-east, east))
    return (
        f"Floor(version: 3, columns: 1, rows: 1, tile_m: ({2 * east + 0.1:.3f}, {2 * north + 0.1:.3f}), "
        f"sensors_m: [{places}], boards: [(tiles: [(0, 0)])], actuators: [])\n"
    )


LAYOUT = """Layout(version: 1, regions: [(id: "board", at: (0, 0), size: (1, 1))],
    widgets: [(id: "all", kind: "button", at: (0.02, 0.02), size: (0.96, 0.96))])
"""


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    forces = [[float(row[f"fz{1 + place}_N"]) for place in ORDER] for row in rows]
    return [float(row["t_s"]) for row in rows], forces


def thinned(times, forces, rate, gap, seed):
    """Readings at irregular instants: intervals of half to one and a half periods, and each hundredth a pause."""
    rng = random.Random(seed)
    kept, due = [], times[0]
    # The recording's own instants are coarse: the nearest one serves.
    half_step = 0.5 * (times[1] - times[0])
    for t, force in zip(times, forces):
        if t >= due - half_step:
            kept.append((t, force))
            due = t + (rng.uniform(2 / rate, gap) if rng.random() < 0.01 else rng.uniform(0.5, 1.5) / rate)
    return kept


def centre(force, east, north):
    sw, se, nw, ne = force
    total = sum(force)
    return east * (se + ne - sw - nw) / total, north * (nw + ne - sw - se) / total


def sensed(program, floor, readings, east, north, folder):
    table = folder / "forces.csv"
    with open(table, "w") as file:
        file.write("t_s,col,row,f_0,f_1,f_2,f_3\n")
        for t, force in readings:
            file.write(f"{t:.3f},0,0,{','.join(f'{one:.3f}' for one in force)}\n")
    done = subprocess.run([program, "sense", table, "--floor", floor], capture_output=True, text=True, check=True)
    middle = ((2 * east + 0.1) / 2, (2 * north + 0.1) / 2)
    counts, ids, off_mm = {0: 0, 1: 0, 2: 0}, set(), 0.0
    for line, (t, force) in zip(done.stdout.splitlines(), readings):
        contacts = json.loads(line)["contacts"]
        if t - readings[0][0] < 1:
            continue
        counts[min(2, len(contacts))] += 1
        ids.update(contact["id"] for contact in contacts)
        if len(contacts) == 1:
            x, y = centre(force, east, north)
            dx = contacts[0]["x_m"] - middle[0] - x
            dy = contacts[0]["y_m"] - middle[1] - y
            off_mm = max(off_mm, 1000 * math.hypot(dx, dy))
    return counts, len(ids), off_mm


def padded(text):
    return text.encode() + b"\0" * (4 - len(text) % 4)


def served(program, floor, layout, readings):
    """Events of the button while the readings come in real time, from two seconds of an empty plate on."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [program, "run", layout, "--floor", floor, "--listen", f"127.0.0.1:{port}", "--json"]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        time.sleep(1)
        udp, head = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), padded("/underfoot/board/0") + padded(",iffff")
        begun, rng = time.monotonic(), random.Random(1)
        empty = [(n / 55, [rng.gauss(0.3, 0.2) for _ in range(4)]) for n in range(110)]
        first = readings[0][0] - 2.02
        for t, force in empty + [(t - first, force) for t, force in readings]:
            time.sleep(max(0, begun + t - time.monotonic()))
            udp.sendto(head + struct.pack(">iffff", 0, *force), ("127.0.0.1", port))
        time.sleep(0.5)
    finally:
        running.terminate()
    events = [json.loads(line) for line in running.communicate()[0].splitlines()]
    named = [event["event"] for event in events if event.get("id") == "all" and "event" in event]
    return {name: named.count(name) for name in dict.fromkeys(named)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("recording", type=Path)
    parser.add_argument("--rate", type=float, default=55)
    parser.add_argument("--gap", type=float, default=0.3)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--east", type=float, default=0.12)
    parser.add_argument("--north", type=float, default=0.2)
    args = parser.parse_args()
    times, forces = read(args.recording)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        floor, layout = folder / "board.ron", folder / "layout.ron"
        floor.write_text(floor_text(args.east, args.north))
        layout.write_text(LAYOUT)
        print("seed  readings  none   one  more  identities  off, mm  events of the button")
        for seed in range(args.seeds):
            readings = thinned(times, forces, args.rate, args.gap, seed)
            counts, ids, off_mm = sensed(args.program, floor, readings, args.east, args.north, folder)
            events = served(args.program, floor, layout, readings)
            told = ", ".join(f"{count} {name}" for name, count in events.items())
            print(
                f"{seed:4}  {len(readings):8}  {counts[0]:4}  {counts[1]:4}  {counts[2]:4}  {ids:10}  {off_mm:7.3f}  {told}",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
