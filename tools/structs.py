#!/usr/bin/env python3
"""How large the types are: tools/structs.py [--list N] [--check] [FOLDER...]

Prints the structs with the most fields, the types with methods of their own in the most files, and names that more
than one type has. Of names only types count that are visible outside their own module (`pub`, `pub(crate)`,
`pub(super)`, `pub(in ...)`). Files and items for tests only do not count. `--check` fails above the limits below.
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys

from lines import plain, without_tests

# Most that `--check` lets pass: fields of one struct, and files that hold `impl` blocks of one type.
MOST_FIELDS = 20
MOST_FILES = 5

# Plain public records of data, and the tracker's state until it is replaced.
RECORDS = {"Snapshot", "LinkCounters", "Track", "Tracker"}

# Names that many types may have: the arguments of each command, as the crate clap usually has them.
SHARED = {"Args"}

DEFINED = re.compile(r"^[ \t]*(?P<seen>pub(?:\([^)]*\))?\s+)?(?P<word>struct|enum|trait|union|type)\s+(?P<name>\w+)", re.MULTILINE)
INHERENT = re.compile(r"^[ \t]*(?:unsafe\s+)?impl\b", re.MULTILINE)
FIELD = re.compile(r"\s*(?:#\[[^\]]*\]\s*)*(?:pub(?:\([^)]*\))?\s+)?(?:r#)?\w+\s*:")


def end_of(code, at, opening, closing):
    """Where the bracket that opens at `at` closes; the arrow of a function closes no angle."""
    depth = 0
    for place in range(at, len(code)):
        if code[place] == opening:
            depth += 1
        elif code[place] == closing and not (closing == ">" and code[place - 1] in "-="):
            depth -= 1
            if depth == 0:
                return place
    return len(code) - 1


def parts(code):
    """`code` cut at the commas outside all brackets."""
    found, depth, begin = [], 0, 0
    for place, char in enumerate(code):
        arrow = char == ">" and code[place - 1] in "-="
        depth += (char in "([{<") - (char in ")]}>" and not arrow)
        if char == "," and depth == 0:
            found.append(code[begin:place])
            begin = place + 1
    return [part for part in found + [code[begin:]] if part.strip()]


def fields(code, at):
    """How many fields the struct has whose name ends at `at`."""
    while at < len(code) and code[at] not in "{(;":
        at = end_of(code, at, "<", ">") + 1 if code[at] == "<" else at + 1
    if at >= len(code) or code[at] == ";":
        return 0
    closing = {"{": "}", "(": ")"}[code[at]]
    inner = parts(code[at + 1 : end_of(code, at, code[at], closing)])
    return len(inner) if closing == ")" else sum(1 for part in inner if FIELD.match(part))


def owner(code, at):
    """The type of the `impl` whose word ends at `at`, or nothing if it is that of a trait."""
    head = code[at:].lstrip()
    if head.startswith("<"):
        head = head[end_of(head, 0, "<", ">") + 1 :]
    head = head[: head.find("{")].split(" where ")[0]
    if re.search(r"\bfor\b(?!\s*<)", head):
        return None
    named = re.match(r"\s*(?:[\w]+::)*(\w+)", head)
    return named[1] if named else None


def crate_of(name):
    """The folder of the crate to which the file `name` belongs; the root's is empty."""
    at = name.find("src/")
    return name[:at].rstrip("/")


def read(folders):
    """Code without tests of each Rust file below `src` folders, by name."""
    listed = subprocess.run(["git", "ls-files", "--", *folders], check=True, capture_output=True, text=True)
    names = [name for name in listed.stdout.splitlines() if re.search(r"(^|/)src/.*\.rs$", name)]
    codes, tests = {}, set()
    for name in filter(lambda name: pathlib.Path(name).is_file(), names):
        text = plain(pathlib.Path(name).read_text(encoding="utf-8"))
        if re.match(r"\s*#!\[cfg\(test\)\]", text):
            continue
        codes[name], modules = without_tests(text)
        folder, stem = name.rsplit("/", 1)
        if stem not in ("mod.rs", "lib.rs", "main.rs"):
            folder += "/" + stem.removesuffix(".rs")
        tests.update(f"{folder}/{module}" for module in modules if module)
    return {
        name: code
        for name, code in codes.items()
        if not any(name == test + ".rs" or name.startswith(test + "/") for test in tests)
    }


def count(codes):
    """Fields of each struct, files of each type's methods, and places of each visible name."""
    structs, impls, names = [], collections.defaultdict(set), collections.defaultdict(list)
    for name, code in codes.items():
        for found in DEFINED.finditer(code):
            if found["word"] == "struct":
                structs.append((fields(code, found.end()), found["name"], name))
            # A type within a trait or an implementation of one has no `pub`.
            if found["seen"] and name not in names[found["name"]]:
                names[found["name"]].append(name)
        for found in INHERENT.finditer(code):
            if of := owner(code, found.end()):
                impls[crate_of(name), of].add(name)
    return structs, impls, names


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", help="only files below these")
    parser.add_argument("--list", type=int, default=20, metavar="N", help="how many lines of each list; 20 unless told")
    parser.add_argument("--check", action="store_true", help="exit status 1 above the limits")
    arguments = parser.parse_args()
    structs, impls, names = count(read(arguments.folders))
    print("fields of structs")
    for number, of, name in sorted(structs, key=lambda row: (-row[0], row[2]))[: arguments.list]:
        print(f"{number:5}  {of:28}{name}")
    print("files with methods of one type")
    for (crate, of), files in sorted(impls.items(), key=lambda row: (-len(row[1]), row[0]))[: arguments.list]:
        print(f"{len(files):5}  {of:28}{crate or '.'}")
    twice = sorted((of, places) for of, places in names.items() if len(places) > 1 and of not in SHARED)
    print(f"names of more than one type: {len(twice)}")
    for of, places in twice:
        print(f"{len(places):5}  {of:28}{', '.join(places)}")
    wide = [of for number, of, _ in structs if number > MOST_FIELDS and of not in RECORDS]
    spread = [of for (_, of), files in impls.items() if len(files) > MOST_FILES and of not in RECORDS]
    if arguments.check and (wide or spread):
        sys.exit(
            f"more than {MOST_FIELDS} fields: {', '.join(wide) or 'none'};"
            f" methods in more than {MOST_FILES} files: {', '.join(spread) or 'none'}"
        )


if __name__ == "__main__":
    main()
