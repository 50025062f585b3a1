"""Sketches in the emulator, off line as fast as it can."""

import subprocess

from served import FIRMWARE, need


def build(out):
    made = subprocess.run(["make", "-C", FIRMWARE, f"OUT={out}"], capture_output=True, text=True)
    need(made.returncode == 0, made.stdout + made.stderr)


class Emulator:
    """Sketches without a clock: the text they send, the instant of the first sample, and lost bytes."""

    def __init__(self, folder, made):
        self.folder, self.made = folder, made

    def command(self, sketch):
        return self.made / "avr", self.made / f"{sketch}.elf"

    def text(self, sketch, script, until_ms, options=()):
        out = self.folder / "out.txt"
        command = [*self.command(sketch), script, "--out", out, "--until", str(until_ms)]
        said = subprocess.run([*command, *options], capture_output=True, text=True, check=True).stdout.splitlines()
        need(" took 0;" in said[-1], said[-1])
        first_ms = float(said[0].split()[-2])
        return first_ms, out.read_text()
