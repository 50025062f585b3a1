"""How long a save takes to be seen: `python3 tools/design/reload.py target/release/underfoot`.

Twenty saves by each of three kinds of editors, from the moment the editor is done to the first changed pixel on the
screen; then saves while a foot presses, which must wait for it.
"""
import ctypes
import os
import sys
import tempfile
import time

from window import Window

ROUNDS = 20
LAYOUT = """Layout(
    version: 1,
    title: "Reload",
    regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "home", kind: "button", at: (1, 1), size: (4, 4), label: "", look: (face: "FACE"))],
)
"""
COLOURS = ["#c02020", "#20a040"]


class Eye:
    """One pixel of a display."""

    def __init__(self, display, at):
        self.x11 = ctypes.CDLL("libX11.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x11.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
        self.x11.XGetImage.restype = ctypes.c_void_p
        self.x11.XGetImage.argtypes = [ctypes.c_void_p, ctypes.c_ulong] + [ctypes.c_int] * 2 + [ctypes.c_uint] * 2 + [
            ctypes.c_ulong, ctypes.c_int]
        self.x11.XGetPixel.restype = ctypes.c_ulong
        self.x11.XGetPixel.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int]
        self.x11.XDestroyImage.argtypes = [ctypes.c_void_p]
        self.display = self.x11.XOpenDisplay(display.encode())
        self.root = self.x11.XDefaultRootWindow(self.display)
        self.at = at

    def look(self):
        image = self.x11.XGetImage(self.display, self.root, *self.at, 1, 1, 0xFFFFFF, 2)
        pixel = self.x11.XGetPixel(image, 0, 0)
        self.x11.XDestroyImage(image)
        return pixel

    def wait(self, before, seconds):
        """Seconds until the pixel differs, or None."""
        start = time.monotonic()
        while time.monotonic() - start < seconds:
            if self.look() != before:
                return time.monotonic() - start
            time.sleep(0.002)
        return None


def in_place(path, text):
    with open(path, "w") as file:
        file.write(text)


def rename_over(path, text):
    with open(path + ".tmp", "w") as file:
        file.write(text)
    os.replace(path + ".tmp", path)


def backup_and_create(path, text):
    os.rename(path, path + "~")
    with open(path, "x") as file:
        file.write(text)
    os.remove(path + "~")


def main():
    program = os.path.abspath(sys.argv[1])
    folder = tempfile.mkdtemp(prefix="underfoot-reload-")
    path = os.path.join(folder, "mine.ron")
    in_place(path, LAYOUT.replace("FACE", COLOURS[0]))
    window = Window(program, [path], folder)
    late = 0
    try:
        # Both on the control; the drawing of a foot does not reach the eye.
        left, top, right, bottom = window.find("home")["seen"]
        at = lambda east, north: (round(left + east * (right - left)), round(bottom - north * (bottom - top)))
        eye, foot = Eye(window.env["DISPLAY"], at(0.85, 0.85)), at(0.2, 0.2)
        turn = 0
        for editor in (in_place, rename_over, backup_and_create):
            times = []
            for _ in range(ROUNDS):
                turn += 1
                before = eye.look()
                editor(path, LAYOUT.replace("FACE", COLOURS[turn % 2]))
                times.append(eye.wait(before, 3))
                time.sleep(0.37)
            seen = sorted(time for time in times if time is not None)
            late += ROUNDS - len(seen) + sum(time > 0.3 for time in seen)
            print(f"{editor.__name__}: {len(seen)} of {ROUNDS} seen, median {seen[len(seen) // 2] * 1e3:.0f} ms, "
                  f"longest {seen[-1] * 1e3:.0f} ms")
        window.move(*foot)
        window.x("mousedown", 1)
        time.sleep(1.0)
        events = window.events().count('"pressed"')
        before = eye.look()
        turn += 1
        rename_over(path, LAYOUT.replace("FACE", COLOURS[turn % 2]))
        held = eye.wait(before, 2)
        window.x("mouseup", 1)
        freed = eye.wait(before, 3)
        late += bool(held) + (freed is None)
        print(f"while a foot presses ({events} press): {'changed' if held else 'unchanged for 2 s'}; "
              f"then {f'after {freed * 1e3:.0f} ms' if freed else 'never'}")
    finally:
        window.close()
    sys.exit(1 if late else 0)


if __name__ == "__main__":
    main()
