"""Pictures of Try and Design in each theme, for `docs/design.md`.

    python3 tools/design/themes.py target/release/underfoot docs [--size 1280x800] [--layout FILE]

The window itself draws them, on a display of its own and worked by a real mouse: in Try somebody presses a control and
has cracked the ice, in Design one control is selected. They are saved as PNG with a palette.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile

from window import Floor, Window

THEMES = [("light", "light"), ("dark", "dark"), ("contrast", "high contrast")]

# Controls of every meaning: press, confirm, hold to run, hold, switch, choose, slide; ice, gravel and wood.
LAYOUT = """Layout(
    version: 1,
    title: "Meaning",
    regions: [(id: "work", at: (0, 2), size: (6, 2))],
    stances: [
        (at: (2, 0), size: (2, 1), label: "Stand here"),
        (at: (2, 5), size: (2, 1), label: "or here"),
    ],
    grounds: [
        Ice(at: (0, 4.1), size: (1.9, 1.9)),
        Gravel(at: (0, 0), size: (1.9, 1.9)),
        Wood(at: (4.1, 0), size: (1.9, 1.9)),
    ],
    widgets: [
        (id: "next", kind: "button", at: (0.1, 2.05), size: (0.7, 0.85), label: "Next"),
        (id: "light", kind: "switch", at: (1.05, 2.05), size: (0.7, 0.85), label: "Light", initial: true),
        (id: "delete", kind: "confirm_button", at: (2, 2.05), size: (0.85, 0.85), label: "Delete"),
        (id: "grip", kind: "hold", at: (3.1, 2.05), size: (0.7, 0.85), label: "Grip"),
        (id: "zoom", kind: "slider", at: (4.05, 2.05), size: (1.85, 0.85), label: "Zoom", initial: 0.6),
        (id: "home", kind: "round_button", at: (0.1, 3.1), size: (0.75, 0.85), label: "Home", look: (icon: Home)),
        (id: "drill", kind: "dead_man", at: (1.2, 3.25), size: (0.7, 0.7), label: "Drill"),
        (id: "view", kind: "selector", at: (2.25, 3.1), size: (1.75, 0.85), label: "View", options: ["Map", "Air", "3D"]),
        (id: "turn", kind: "dial", at: (4.25, 3.1), size: (0.85, 0.85), label: "Turn"),
        (id: "go", kind: "instant_button", at: (5.3, 3.1), size: (0.6, 0.85), label: "Go"),
    ],
)
"""


def pictures(program, layout, theme, size, folder, name):
    """Draws both modes in one theme."""
    state = tempfile.mkdtemp(prefix="underfoot-theme-")
    os.makedirs(os.path.join(state, "state", "underfoot"))
    with open(os.path.join(state, "state", "underfoot", "window"), "w") as settings:
        settings.write(f"underfoot window 1\nwindow {theme}\nprojected {theme}\ntext 10\nfirst_steps off\n")
    sound = os.path.join(state, "sound.wav")
    window = Window(program, [layout, "--wav", sound], folder=state, size=size)
    try:
        places = Floor(window)
        window.wheel(*places.at(1, 5), -12, "harder")
        for place in [(0.5, 4.7), (1.3, 5.2), (0.8, 5.6)]:
            window.drag(places.at(*place), places.at(place[0] + 0.05, place[1]))
        window.wheel(*places.at(1, 5), 12, "softer")
        for notice in window.all(re.compile("^Hide: ")):
            window.click_on(notice["name"])
        window.move(*places.at(0.45, 2.7))
        window.x("mousedown", 1)
        subprocess.run(["sleep", "1"], check=True)
        save(window, os.path.join(folder, f"window-try-{name}.png"))
        window.x("mouseup", 1)
        window.key("F2")
        window.click(*places.at(2.4, 2.5))
        window.move(*places.at(3.0, 1.5))
        subprocess.run(["sleep", "1"], check=True)
        save(window, os.path.join(folder, f"window-design-{name}.png"))
    finally:
        window.close()


def save(window, path):
    """Saves the screen with a palette, which halves the file."""
    shot = subprocess.run(["import", "-window", "root", "png:-"], env=window.env, check=True, capture_output=True)
    reduced = ["convert", "png:-", "-dither", "None", "-colors", "160", "-strip", "-define", "png:compression-level=9"]
    subprocess.run([*reduced, f"PNG8:{path}"], input=shot.stdout, check=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("folder")
    arguments.add_argument("--size", default="1280x800")
    arguments.add_argument("--layout")
    given = arguments.parse_args()
    size = tuple(int(side) for side in given.size.split("x"))
    os.makedirs(given.folder, exist_ok=True)
    layout = given.layout and os.path.abspath(given.layout)
    if layout is None:
        layout = os.path.join(tempfile.mkdtemp(prefix="underfoot-theme-"), "meaning.ron")
        with open(layout, "w") as file:
            file.write(LAYOUT)
    for name, theme in THEMES:
        pictures(os.path.abspath(given.program), layout, theme, size, given.folder, name)
    for name, _ in THEMES:
        for mode in ("try", "design"):
            path = os.path.join(given.folder, f"window-{mode}-{name}.png")
            print(f"{path}: {os.path.getsize(path) / 1000:.0f} kB")


if __name__ == "__main__":
    sys.exit(main())
