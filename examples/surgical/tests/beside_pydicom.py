#!/usr/bin/env python3
"""Shows the files that the Python package pydicom brings for its own tests, beside pydicom's own answer to each.

    pip install numpy pydicom==3.0.2 pylibjpeg pylibjpeg-libjpeg pylibjpeg-openjpeg pylibjpeg-rle
    examples/surgical/tests/beside_pydicom.py target/debug/underfoot-surgical
    examples/surgical/tests/beside_pydicom.py target/debug/underfoot-surgical --damage 60

Prints a line for each file: what pydicom makes of it, what the viewer makes of it, and the largest difference between
the values of their first frames. Fails if fewer files are shown than a floor says, if values differ, if a file ends the
viewer, or if one takes longer or more memory than is allowed. With `--damage` it then damages the files for as many
seconds, by flipped bits, changed lengths and cuts, and fails if one of these ends the viewer.
"""

import argparse
import json
import logging
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
import pydicom
from pydicom.pixels import apply_color_lut, apply_modality_lut, pixel_array

# Of the files that pydicom 3.0.2 decodes, JPEG-LS apart, as many must be shown: all of them.
FLOOR = 96
# Seconds and bytes that one file may take.
SECONDS = 20
MEMORY = 2 << 30
# Decoders of lossy formats round differently, and then colours are converted.
LOSSY_GREY = 1
LOSSY_COLOUR = 3

NOT_DICOM = {".py", ".pyc", ".json", ".txt", ".dump", ".icc", ".md"}


def files():
    """All files of the package that may be DICOM."""
    root = pathlib.Path(pydicom.__file__).parent / "data"
    found = (path for folder in ("test_files", "charset_files", "palettes") for path in (root / folder).rglob("*"))
    return root, sorted(path for path in found if path.is_file() and path.suffix not in NOT_DICOM)


def bounded():
    """In the child: no more memory than is allowed."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def check(program, paths, values=None):
    """The viewer's results for files: a list of its answers, or a sentence that says how it ended."""
    command = [program, "check", *(["--values", values] if values else []), *map(str, paths)]
    try:
        run = subprocess.run(command, capture_output=True, timeout=SECONDS * len(paths), preexec_fn=bounded)
    except subprocess.TimeoutExpired:
        return "takes too long"
    if run.returncode not in (0, 1):
        return f"ends with status {run.returncode}: {run.stderr.decode(errors='replace')[-300:]}"
    answers = [json.loads(line) for line in run.stdout.splitlines()]
    return answers if len(answers) == len(paths) else "answers for other files than it was given"


def reference(path):
    """pydicom's results for a file: its data set, the values of the first frame, and why there are none."""
    try:
        data = pydicom.dcmread(path, force=True)
        if not any(name in data for name in ("PixelData", "FloatPixelData", "DoubleFloatPixelData")):
            return data, None, "no pixels"
        return data, first_frame(data), None
    except Exception as error:  # Whatever a damaged file trips.
        return None, None, f"{type(error).__name__}: {error}".splitlines()[0][:60]


def first_frame(data):
    """Values after the modality's scale, or colours of 8 bits."""
    frame = pixel_array(data, index=0, raw=False)
    if data.get("PhotometricInterpretation") == "PALETTE COLOR":
        colours = apply_color_lut(frame, data)
        return eighths(colours, colours.dtype.itemsize * 8)
    if data.get("SamplesPerPixel", 1) == 3:
        return eighths(frame, data.BitsStored)
    return np.asarray(apply_modality_lut(frame, data)).astype(np.float32)


def eighths(colours, bits):
    return (colours >> (bits - 8)).astype(np.uint8) if bits > 8 else colours.astype(np.uint8)


def shown_values(folder, answer, number=0):
    """The values that the viewer shows of a file's first frame."""
    width, height = answer["size"]
    if answer["is_colour"]:
        return np.fromfile(folder / f"{number}.rgb", np.uint8).reshape(height, width, 3)
    return np.fromfile(folder / f"{number}.f32", "<f4").reshape(height, width)


def difference(expected, shown, is_lossy):
    """The largest difference, and whether it is too large."""
    if expected.shape != shown.shape:
        return f"shape {shown.shape}, not {expected.shape}", True
    apart = np.abs(expected.astype(np.float64) - shown.astype(np.float64))
    # A number of 32 bits is shown with the 24 bits of a float.
    allowed = 1e-6 * float(np.abs(expected.astype(np.float64)).max(initial=0))
    if is_lossy:
        allowed = max(allowed, LOSSY_COLOUR if expected.ndim == 3 else LOSSY_GREY)
    most = float(apart.max(initial=0))
    return f"{most:g}", most > allowed


def compare(program):
    """Prints the table; gives what is wrong."""
    root, paths = files()
    wrong, counts = [], {"files": 0, "with pixels": 0, "decoded": 0, "JPEG-LS": 0, "shown": 0, "JPEG-LS shown": 0, "more": 0}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for path in paths:
            name = str(path.relative_to(root))
            data, expected, why = reference(path)
            answers = check(program, [path], str(folder))
            if isinstance(answers, str):
                wrong.append(f"{name}: {answers}")
                print(f"{name:58} | {why or 'decoded':40} | {answers}")
                continue
            answer = answers[0]
            counts["files"] += 1
            syntax = getattr(getattr(data, "file_meta", None), "TransferSyntaxUID", None)
            syntax = syntax.name if syntax else "no transfer syntax"
            is_lossy = any(word in syntax for word in ("Baseline", "Extended", "Lossy")) or syntax == "JPEG 2000 Image Compression"
            is_ls = "JPEG-LS" in syntax
            counts["with pixels"] += why != "no pixels"
            counts["decoded"] += expected is not None
            counts["JPEG-LS"] += expected is not None and is_ls
            outcome = answer.get("why") or f"{answer['size'][0]} x {answer['size'][1]}, {answer['frames']} frames"
            apart = ""
            if answer["shown"] and expected is not None:
                apart, is_wrong = difference(expected, shown_values(folder, answer), is_lossy and "Near" not in syntax)
                counts["JPEG-LS shown" if is_ls else "shown"] += 1
                if is_wrong:
                    wrong.append(f"{name}: values differ by {apart}")
                apart = f" | differs by {apart}"
            elif answer["shown"]:
                counts["more"] += 1
            print(f"{name:58} | {why or 'decoded, ' + syntax[:32]:40} | {'shown: ' if answer['shown'] else ''}{outcome}{apart}")
    print("\n" + ", ".join(f"{count} {name}" for name, count in counts.items()))
    if counts["shown"] < FLOOR:
        wrong.append(f"{counts['shown']} files are shown, and {FLOOR} must be")
    return wrong


def damaged(whole, chance):
    """A copy of some bytes with a few of them changed."""
    bytes_ = bytearray(whole)
    # Most of what is read lies before the pixels.
    reach = min(len(bytes_), chance.choice([400, 2000, 8000, len(bytes_)]))
    for _ in range(chance.choice([1, 1, 2, 4, 16])):
        at = chance.randrange(reach)
        kind = chance.random()
        if kind < 0.5:
            bytes_[at] ^= 1 << chance.randrange(8)
        elif kind < 0.7:
            bytes_[at] = chance.choice([0, 1, 0x7F, 0x80, 0xFF])
        elif kind < 0.85:
            bytes_[at : at + 4] = b"\xff\xff\xff\xff"
        else:
            bytes_[at : at + 2] = chance.randbytes(2)
    if chance.random() < 0.2:
        del bytes_[chance.randrange(len(bytes_)) :]
    return bytes(bytes_)


def damage(program, seconds, seed):
    """Damages files for some seconds; gives what is wrong."""
    chance, wrong, count, shown = random.Random(seed), [], 0, 0
    sources = [path.read_bytes() for path in files()[1]]
    sources = [whole for whole in sources if 0 < len(whole) < 1 << 20]
    kept = pathlib.Path(tempfile.mkdtemp(prefix="damaged-"))
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        batch = []
        for number in range(100):
            path = kept / f"{number}.dcm"
            path.write_bytes(damaged(chance.choice(sources), chance))
            batch.append(path)
        answers = check(program, batch)
        count += len(batch)
        if isinstance(answers, str):
            for path in batch:
                answer = check(program, [path])
                if isinstance(answer, str):
                    found = kept / f"found-{len(wrong)}.dcm"
                    found.write_bytes(path.read_bytes())
                    wrong.append(f"{found}: {answer}")
            wrong = wrong or [f"a hundred files together: {answers}"]
            continue
        shown += sum(answer["shown"] for answer in answers)
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"{count} damaged files (seed {seed}), {shown} of them shown; at most {most:.0f} MiB of memory")
    if not wrong:
        shutil.rmtree(kept)
    return wrong


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--damage", type=float, default=0, metavar="SECONDS")
    arguments.add_argument("--seed", type=int, default=1)
    arguments = arguments.parse_args()
    warnings.simplefilter("ignore")
    logging.getLogger("pydicom").setLevel(logging.CRITICAL)
    program = os.path.abspath(arguments.program)
    wrong = compare(program)
    if arguments.damage:
        wrong += damage(program, arguments.damage, arguments.seed)
    for sentence in wrong:
        print(f"WRONG: {sentence}")
    sys.exit(1 if wrong else 0)


main()
