"""The firmware of the Pico, built as its users build it, in the emulator."""

import os
import re
import struct
import subprocess
import sys
import typing

from served import FIRMWARE, need, write_script

PICO = FIRMWARE / "pico"
EMULATOR = FIRMWARE / "emulate/pico"

INPUTS = 32

# The sector of the identity, as firmware/pico/src/identity.rs has it.
IDENTITY = 0x101F_F000


def build(out, rate_hz):
    """Builds the firmware for this rate; the file of its program."""
    command = ["cargo", "build", "--release", "--locked", "--quiet"]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(out / "cargo"), "UNDERFOOT_RATE_HZ": str(rate_hz)}
    made = subprocess.run(command, cwd=PICO, env=environment, capture_output=True, text=True)
    need(made.returncode == 0, made.stderr)
    program = out / f"pico_{rate_hz}.elf"
    program.write_bytes((out / "cargo/thumbv6m-none-eabi/release/underfoot-pico").read_bytes())
    return program


def flashed(program, board=None):
    """The file to copy to the board's drive, made by the tool of its users."""
    out = program.with_name(f"{program.stem}_{board}.uf2")
    number = [] if board is None else ["--board", str(board)]
    subprocess.run([sys.executable, PICO / "uf2.py", "--elf", program, *number, out], check=True)
    return out


def damaged(uf2):
    """The same file with one wrong bit in the identity."""
    bytes_ = bytearray(uf2.read_bytes())
    for at in range(0, len(bytes_), 512):
        if struct.unpack_from("<I", bytes_, at + 12)[0] == IDENTITY:
            bytes_[at + 32 + 4] ^= 1
    out = uf2.with_name(f"damaged_{uf2.name}")
    out.write_bytes(bytes_)
    return out


class Run(typing.NamedTuple):
    """What a run off line gave."""

    # Messages without their SLIP frames.
    messages: list
    # Lines of the emulator.
    said: str

    def number(self, pattern):
        """The number that the emulator says there; `None` if it does not."""
        found = re.search(pattern, self.said)
        return found and float(found[1])


class Emulator:
    """Boards without a clock."""

    def __init__(self, folder, modules):
        self.folder, self.modules = folder, modules

    def command(self, uf2):
        return "node", EMULATOR / "main.mjs", self.modules, uf2

    def terminal(self, uf2):
        """The command of a board at a pseudo terminal, in real time."""
        return sys.executable, EMULATOR / "terminal.py", *self.command(uf2)

    def run(self, uf2, changes, until_ms, options=()):
        script = write_script(self.folder / "script.txt", changes)
        out = self.folder / "out.bin"
        command = [*self.command(uf2), script, "--out", out, "--until", str(until_ms), *map(str, options)]
        # Far slower than any machine: a program that hangs fails.
        patience_s = 60 + until_ms / 50
        said = subprocess.run(command, capture_output=True, text=True, timeout=patience_s)
        need(said.returncode == 0, said.stderr)
        return Run(list(unframed(out.read_bytes())), said.stdout)


def unframed(data):
    """Yields the messages in SLIP frames; bytes outside of frames are messages too, and none of a board."""
    need(data.endswith(b"\xc0") or not data, "the last frame has no end")
    for frame in data.split(b"\xc0"):
        if frame:
            yield frame.replace(b"\xdb\xdc", b"\xc0").replace(b"\xdb\xdd", b"\xdb")


def decoded(message, board):
    """The number and the counts of a packet of this board."""
    address = f"/underfoot/board/{board}".encode()
    head = address + bytes(4 - len(address) % 4) + b",i" + INPUTS * b"i" + bytes(2)
    need(message.startswith(head) and len(message) == len(head) + 4 * (1 + INPUTS), f"no packet of board {board}: {message}")
    return struct.unpack_from(f">{1 + INPUTS}i", message, len(head))
