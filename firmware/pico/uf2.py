#!/usr/bin/env python3
"""The file to copy to a Pico's drive: uf2.py [--board N] [--elf FILE] OUT.uf2

With --board, the file also writes the board's number; without it, the board keeps the one that it has, or is number 0.
"""

import argparse
import pathlib
import struct

HERE = pathlib.Path(__file__).resolve().parent
BUILT = HERE / "target/thumbv6m-none-eabi/release/underfoot-pico"

PAGE = 256
FLASH, FLASH_END = 0x1000_0000, 0x1020_0000

# As src/identity.rs reads it: a mark, the number, and its complement.
IDENTITY, MARK = 0x101F_F000, b"UFid"

# UF2: the marks of a block, the flag and the number of the RP2040's family.
BEGIN, SECOND, END = 0x0A32_4655, 0x9E5D_5157, 0x0AB1_6F30
HAS_FAMILY, FAMILY = 0x2000, 0xE48B_FF56


def segments(elf):
    """Yields (address, bytes) of what the program has in flash."""
    if elf[:6] != b"\x7fELF\x01\x01":
        raise SystemExit("uf2.py: this is no program for a Pico")
    (offset,) = struct.unpack_from("<I", elf, 28)
    size, count = struct.unpack_from("<HH", elf, 42)
    for at in range(offset, offset + size * count, size):
        kind, begin, _, address, length = struct.unpack_from("<5I", elf, at)
        if kind == 1 and length and FLASH <= address < FLASH_END:
            yield address, elf[begin : begin + length]


def pages(parts):
    """Maps the address of each page from the first to the last byte of `parts` to its bytes."""
    made = {}
    for address, data in parts:
        for at, byte in enumerate(data, address):
            made.setdefault(at - at % PAGE, bytearray(PAGE))[at % PAGE] = byte
    # The boot loader erases a sector at its first page, so that no page may be left out.
    for at in range(min(made), max(made), PAGE):
        made.setdefault(at, bytearray(PAGE))
    return made


def identity(board):
    return MARK + struct.pack("<HH", board, 0xFFFF ^ board)


def blocks(made):
    for number, address in enumerate(sorted(made)):
        head = BEGIN, SECOND, HAS_FAMILY, address, PAGE, number, len(made), FAMILY
        yield struct.pack("<8I", *head) + made[address].ljust(476, b"\0") + struct.pack("<I", END)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--elf", type=pathlib.Path, default=BUILT, help="the program; without it, the one built here")
    parser.add_argument("--board", type=int, choices=range(16_384), metavar="N", help="the board's number, from 0")
    given = parser.parse_args()
    try:
        made = pages(segments(given.elf.read_bytes()))
    except FileNotFoundError:
        raise SystemExit(f"uf2.py: there is no {given.elf}: run `cargo build --release` in {HERE}") from None
    if given.board is not None:
        made.update(pages([(IDENTITY, identity(given.board))]))
    given.out.write_bytes(b"".join(blocks(made)))


if __name__ == "__main__":
    main()
