"""A foot that presses the pad, lets go and presses again, in real time; and the program's events, by the clock."""

import math
import random
import time

from served import Served, need, write_script

# The button's forces and the time for which a press must hold, of its kind.
PRESS_N, RELEASE_N, DWELL_MS = 60, 40, 20

# The foot's place in tiles, and its shares on the sensors SW, SE, NW and NE, which are a tenth from the edges.
PLACE = 0.4, 0.6
EAST, NORTH = ((at - 0.1) / 0.8 for at in PLACE)
SHARES = (1 - EAST) * (1 - NORTH), EAST * (1 - NORTH), (1 - EAST) * NORTH, EAST * NORTH

# Milliseconds from volt to event beyond which something is wrong.
PATIENCE_MS = 500

# Milliseconds within which holds end without the board, at any rate.
LOST_MS = 150

# Milliseconds that the emulator may be late. Beyond 100 ms the program rightly takes the link for lost.
LATE_MS = 80

# Attempts on a machine that does not keep up.
ATTEMPTS = 3


def ramp(ms, at_ms, load_n):
    """A foot's load, which it takes 120 ms to put on or off."""
    return load_n * min(max((ms - at_ms) / 120, 0), 1)


def load_at(ms):
    """Newtons of a foot that presses at 4 s, lets go at 5 s, and presses again at 6.5 s."""
    return ramp(ms, 4000, 140) - ramp(ms, 5000, 140) + ramp(ms, 6500, 140)


def moments(load_at):
    """Milliseconds at which such a foot loads the button enough, lets go of it, and loads it again."""
    loads = [load_at(ms) for ms in range(10_000)]
    press = next(ms for ms, load in enumerate(loads) if load >= PRESS_N)
    release = next(ms for ms, load in enumerate(loads) if ms > press and load < RELEASE_N)
    return press, release, next(ms for ms, load in enumerate(loads) if ms > release and load >= PRESS_N)


def standing_at(ms):
    """Newtons of a foot that stands there at first, lifts at 2 s, and presses at 3 s."""
    return 140 - ramp(ms, 2000, 140) + ramp(ms, 3000, 140)


def foot(path, pad, load_at, marked):
    """The script of such a foot, north-west of the middle, with a mark at each of these moments."""
    noise = random.Random(5)

    def changes():
        for pin in pad.idle:
            yield 0, pin, round(pad.sensor(2, 0))
        for ms in range(0, 20_000):
            for pin, share in enumerate(SHARES if ms % 2 == 0 else ()):
                # The plate's own weight is 2 N a sensor.
                yield ms, pin, round(pad.sensor(2 + load_at(ms) * share, noise.uniform(-1, 1)))
            if ms in marked:
                yield ms, -1, 0

    return write_script(path, changes())


def judge_foot(served, pad):
    """Press, release and click at the times of the script; then a press whose cable is pulled."""
    for events in ("pressed",), ("released", "clicked"), ("pressed",):
        begun = served.mark()
        for expected in events:
            judge_event(served, pad, expected, begun)
    time.sleep(0.5)
    pulled = served.pull_cable()
    event, arrived = served.event(2)
    need(event["event"] == "cancelled", f"{pad.name}: {event} when the cable is pulled")
    delay_ms = 1000 * (arrived - pulled)
    need(delay_ms <= LOST_MS, f"{pad.name}: cancelled {delay_ms:.0f} ms after the cable is pulled")
    print(f"{pad.name}: cancelled {delay_ms:.1f} ms after the cable is pulled; {served.last_words()}")


def judge_return(served, pad, script):
    """Plugged in again under a foot that stands there: nothing acts before it has lifted and pressed again."""
    served.plug_in(script)
    judge_event(served, pad._replace(name=f"{pad.name}, plugged in again"), "pressed", served.mark())


def judge_event(served, pad, expected, begun):
    """The next event, which the volts at `begun` cause."""
    event, arrived = served.event(15)
    delay_ms, name = 1000 * (arrived - begun), pad.name
    need(event["event"] == expected, f"{name}: {event} instead of {expected}")
    off_m = math.hypot(*(event[key] - at * pad.side_m for key, at in zip(("x_m", "y_m"), PLACE)))
    need(off_m < 0.01, f"{name}: the foot is {off_m:.3f} m from its place: {event}")
    # A press holds for its dwell first.
    least = DWELL_MS if expected == "pressed" else 0
    need(least - 5 <= delay_ms <= PATIENCE_MS, f"{name}: {expected} comes {delay_ms:.0f} ms after its volts")
    print(f"{name}: {expected} {delay_ms:.1f} ms after its volts{f', {DWELL_MS} of them its dwell' if least else ''}")


def try_foot(folder, pad, underfoot):
    """Judges the foot, and once more if this machine did not keep up."""
    for attempt in range(1, ATTEMPTS + 1):
        script = foot(folder / "foot.txt", pad, load_at, moments(load_at))
        again = foot(folder / "again.txt", pad, standing_at, moments(standing_at)[-1:])
        with Served(folder, pad, script, underfoot) as served:
            try:
                judge_foot(served, pad)
                return judge_return(served, pad, again)
            except SystemExit:
                served.pull_cable()
                late_ms = float(served.last_words().split()[-4])
                if late_ms < LATE_MS or attempt == ATTEMPTS:
                    raise
                print(f"{pad.name}: the emulator was late by {late_ms:.0f} ms; once more")
