"""How many frames a second the window draws, and what it takes at rest: `python3 tools/design/frames.py BINARY`.

A hundred controls on 36 tiles at 1920 x 1080, drawn without a graphics card (Mesa's llvmpipe counts the frames), while
the mouse drags a foot over them: with the usual layers and with all. Then the share of a core that the program takes
with nobody on the floor.
"""
import os
import statistics
import sys
import tempfile
import time

from window import Window

SIZE = (1920, 1080)
# Where the menu of layers is at this size, and its button for all of them.
LAYERS, ALL = (1421, 22), (1409, 368)
SECONDS = 15
CONTROL = '(id: "c{n}", kind: "{kind}", at: ({x:.2f}, {y:.2f}), size: (0.5, 0.5), label: "{n}")'


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


def frames(window, folder):
    """Frames a second, second by second, of a drag that goes round and round."""
    counted = os.path.join(folder, "fps")
    begun = os.path.getsize(counted) if os.path.exists(counted) else 0
    middle, end = (SIZE[0] * 0.4, SIZE[1] * 0.5), time.monotonic() + SECONDS
    window.move(*middle)
    window.x("mousedown", 1)
    step = 0
    while time.monotonic() < end:
        step += 1
        across, up = step * 37 % 600 - 300, step * 23 % 500 - 250
        window.x("mousemove", int(middle[0] + across), int(middle[1] + up))
        time.sleep(0.02)
    window.x("mouseup", 1)
    time.sleep(2)
    with open(counted) as file:
        file.seek(begun)
        rates = [float(line) for line in file if line.strip()]
    # The first and the last are partly at rest.
    return sorted(rates[2:-3])


def share_of_a_core(process, seconds):
    def ticks():
        with open(f"/proc/{process.pid}/stat") as stat:
            return sum(int(field) for field in stat.read().rsplit(")", 1)[1].split()[11:13])
    before = ticks()
    time.sleep(seconds)
    return (ticks() - before) / os.sysconf("SC_CLK_TCK") / seconds


def main():
    program = os.path.abspath(sys.argv[1])
    folder = tempfile.mkdtemp(prefix="underfoot-frames-")
    path = os.path.join(folder, "hundred.ron")
    with open(path, "w") as file:
        file.write(layout())
    hud = {"GALLIUM_HUD": "fps", "GALLIUM_HUD_DUMP_DIR": folder, "GALLIUM_HUD_PERIOD": "1", "GALLIUM_HUD_VISIBLE": "0"}
    shots = sys.argv[2] if len(sys.argv) > 2 else None
    window = Window(program, [path], folder, shots, size=SIZE, env=hud)
    try:
        window.shot("usual")
        rates = frames(window, folder)
        print(f"usual layers: {statistics.median(rates):.1f} frames/s in the middle, {rates[0]:.1f} at least")
        window.click(*LAYERS, settle=0.5)
        window.click(*ALL, settle=0.5)
        window.key("Escape", settle=0.5)
        window.shot("all")
        rates = frames(window, folder)
        print(f"all layers: {statistics.median(rates):.1f} frames/s in the middle, {rates[0]:.1f} at least")
    finally:
        window.close()
    window = Window(program, [path], tempfile.mkdtemp(prefix="underfoot-frames-"), size=(1280, 800))
    try:
        window.move(5, 5)
        time.sleep(5)
        print(f"at rest: {100 * share_of_a_core(window.program, 60):.1f} % of a core")
    finally:
        window.close()


if __name__ == "__main__":
    main()
