"""How many frames a second the window draws, and what it takes at rest.

    python3 tools/design/frames.py PROGRAM [BEFORE] [--rounds N] [--seconds S] [--rest S] [--shots FOLDER]

A hundred controls on 36 tiles at 1920 x 1080, drawn without a graphics card (Mesa's llvmpipe counts the frames), while
simulated people walk over them: one with the usual layers; three with all layers; and three while other programs keep
every core busy. Then the share of a core that the program takes with nobody on the floor. With a second program, both
are measured in turn. Prints a table: frames in the middle second of all rounds and in the slowest one, and the time of
a core that the program takes for a frame, on all its threads, with sensing and simulation.
"""
import argparse
import contextlib
import os
import statistics
import subprocess
import sys
import tempfile
import time

from window import Window

SIZE = (1920, 1080)
CONTROL = '(id: "c{n}", kind: "{kind}", at: ({x:.2f}, {y:.2f}), size: (0.5, 0.5), label: "{n}")'

# Number of walkers, layers, and whether other programs keep the cores busy.
CASES = [(1, "usual", False), (3, "all", False), (1, "usual", True), (3, "all", True)]

# The way of each walker: where they enter, and the corners of their round, in tiles.
ROUNDS = [("West", [(1.2, 1.2), (4.8, 1.2), (4.8, 4.8), (1.2, 4.8)]),
          ("East", [(4.4, 4.0), (2.0, 4.0), (2.0, 1.8), (4.4, 1.8)]),
          ("North", [(3.0, 5.2), (0.9, 3.2), (3.0, 0.9), (5.1, 3.2)])]

# Seconds until the walkers are on the floor and the window has its size.
BEGIN = 4


def layout():
    """Ten rows of ten: buttons, switches, sliders and dials by turns."""
    kinds = ["button", "switch", "slider", "dial"]
    controls = [CONTROL.format(n=10 * row + column, kind=kinds[(row + column) % len(kinds)], x=0.05 + 0.59 * column,
                               y=0.05 + 0.59 * row) for row in range(10) for column in range(10)]
    return f"""Layout(
    version: 1,
    title: "A hundred",
    regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [{", ".join(controls)}],
)
"""


def scenario(walkers, seconds):
    """So many people who walk round and round for longer than `seconds`."""
    def steps(side, corners):
        # A round takes more than two seconds.
        rounds = [corner for _ in range(seconds // 2 + 8) for corner in corners[1:] + corners[:1]]
        walks = ", ".join(f"WalkTo(at: {corner})" for corner in rounds)
        return f'steps: [Enter(from: {side}, at: {corners[0]}), {walks}, Leave(to: {side})]'
    first, *others = (steps(*way) for way in ROUNDS[:walkers])
    others = ", ".join(f"({one})" for one in others)
    return f'Scenario(title: "Rounds", {first}, others: [{others}])\n'


@contextlib.contextmanager
def busy(is_busy):
    """Other programs that keep every core busy."""
    spins = [sys.executable, "-c", "while True: pass"]
    others = [subprocess.Popen(spins) for _ in range(os.cpu_count() if is_busy else 0)]
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.wait()


def core_seconds(process):
    """The time of a core that all threads of a process have taken so far."""
    with open(f"/proc/{process.pid}/stat") as stat:
        ticks = sum(int(field) for field in stat.read().rsplit(")", 1)[1].split()[11:13])
    return ticks / os.sysconf("SC_CLK_TCK")


class Measured:
    """Results of the runs of one program in one case: frames second by second, and milliseconds of a core a frame."""

    def __init__(self):
        self.rates, self.costs = [], []


def measure(program, path, case, options, into, name):
    walkers, layers, is_busy = case
    folder = tempfile.mkdtemp(prefix="underfoot-frames-")
    people = os.path.join(folder, "rounds.ron")
    with open(people, "w") as file:
        file.write(scenario(walkers, options.seconds))
    hud = {"GALLIUM_HUD": "fps", "GALLIUM_HUD_DUMP_DIR": folder, "GALLIUM_HUD_PERIOD": "1", "GALLIUM_HUD_VISIBLE": "0"}
    window = Window(program, [path, "--scenario", people, "--layers", layers], folder, options.shots, size=SIZE, env=hud,
                    reports=False)
    try:
        time.sleep(BEGIN)
        window.shot(name)
        with busy(is_busy):
            time.sleep(1)
            begun, before = os.path.getsize(os.path.join(folder, "fps")), core_seconds(window.program)
            time.sleep(options.seconds)
            with open(os.path.join(folder, "fps")) as counted:
                counted.seek(begun)
                # The last line may not be whole yet.
                rates = [float(line) for line in counted.read().splitlines()[:-1] if line.strip()]
            taken = core_seconds(window.program) - before
    finally:
        window.close()
    into.rates += rates
    into.costs.append(1000 * taken / (statistics.mean(rates) * options.seconds))


def at_rest(program, path, seconds):
    """The share of a core with nobody on the floor."""
    window = Window(program, [path], size=(1280, 800), reports=False)
    try:
        window.move(5, 5)
        time.sleep(5)
        before = core_seconds(window.program)
        time.sleep(seconds)
        return (core_seconds(window.program) - before) / seconds
    finally:
        window.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program `underfoot`")
    parser.add_argument("before", nargs="?", help="another one, measured in turn with it")
    parser.add_argument("--rounds", type=int, default=3, help="number of runs of each case")
    parser.add_argument("--seconds", type=int, default=15, help="length of each run")
    parser.add_argument("--rest", type=int, default=60, help="seconds without anybody on the floor; 0 for none")
    parser.add_argument("--shots", help="folder for pictures of each case")
    options = parser.parse_args()
    programs = {"before": options.before, "now": options.program} if options.before else {"now": options.program}
    programs = {name: os.path.abspath(program) for name, program in programs.items()}
    path = os.path.join(tempfile.mkdtemp(prefix="underfoot-frames-"), "hundred.ron")
    with open(path, "w") as file:
        file.write(layout())
    all_measured = {(case, name): Measured() for case in CASES for name in programs}
    for _ in range(options.rounds):
        for (case, name), into in all_measured.items():
            measure(programs[name], path, case, options, into, f"{name}-{case[0]}-{case[1]}")
    print("| walkers, layers | program | frames/s | slowest second | core ms a frame |\n|---|---|---|---|---|")
    for ((walkers, layers, is_busy), name), of in all_measured.items():
        what = f"{walkers}, {layers}" + (", busy cores" if is_busy else "")
        middle, least = statistics.median(of.rates), min(of.rates)
        print(f"| {what} | {name} | {middle:.1f} | {least:.1f} | {statistics.median(of.costs):.1f} |")
    for name, program in programs.items() if options.rest else []:
        print(f"{name}, at rest: {100 * at_rest(program, path, options.rest):.1f} % of a core")


if __name__ == "__main__":
    main()
