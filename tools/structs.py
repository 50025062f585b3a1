#!/usr/bin/env python3
"""How large structs are, how far their methods are spread, and which type names are used twice: tools/structs.py [--check]

Prints the structs with most fields, the types with inherent methods in most files, and the names of types that are
visible outside their own module and stand in more than one place. Types of tests do not count. `--check` fails above
the limits below.
"""

import argparse
import collections
import pathlib
import re
import sys

MOST_FIELDS = 20
MOST_FILES = 5

# Plain public records of data, and what is about to be replaced.
MAY_BE_LARGER = {"Snapshot", "LinkCounters", "Track", "Tracker", "Line"}

STRUCT = re.compile(r"^(?P<indent>[ ]*)(?P<vis>pub(?:\([^)]*\))? )?struct (?P<name>\w+)[^;{(]*\{\n(?P<body>.*?)^(?P=indent)\}", re.M | re.S)
FIELD = re.compile(r"^\s*(?:pub(?:\([^)]*\))? )?(?:r#)?\w+: ", re.M)
TYPE = re.compile(r"^(?P<vis>pub(?:\([^)]*\))? )(?:struct|enum|trait|type|union) (?P<name>\w+)", re.M)
IMPL = re.compile(r"^impl(?:<[^{]*?>)? (?P<name>(?:\w+::)*\w+)(?:<[^{]*>)?(?: where[^{]*)? \{", re.M)
TESTS = re.compile(r"^#\[cfg\((?:test|all\(test\b[^)]*\))\)\]\nmod \w+ \{.*?^\}", re.M | re.S)


def sources():
    for folder in ["src", *sorted(pathlib.Path("crates").glob("*/src"))]:
        for path in sorted(pathlib.Path(folder).rglob("*.rs")):
            if "tests" not in path.parts and not path.stem.endswith("tests"):
                text = TESTS.sub("", path.read_text())
                yield path, re.sub(r"^\s*//[^\n]*\n", "", text, flags=re.M)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    fields, files, names = {}, collections.defaultdict(set), collections.defaultdict(list)
    for path, text in sources():
        crate = path.parts[1] if path.parts[0] == "crates" else "underfoot"
        for struct in STRUCT.finditer(text):
            fields[crate, struct["name"], str(path)] = len(FIELD.findall(struct["body"]))
        for found in IMPL.finditer(text):
            files[crate, found["name"].split("::")[-1]].add(str(path))
        for found in TYPE.finditer(text):
            names[found["name"]].append(str(path))
    largest = sorted(fields.items(), key=lambda entry: -entry[1])
    print("fields  struct")
    for (_, name, path), count in largest[:12]:
        print(f"{count:6}  {name} ({path})")
    print("\n files  type with methods of its own")
    spread = sorted(files.items(), key=lambda entry: -len(entry[1]))
    for (crate, name), places in spread[:12]:
        print(f"{len(places):6}  {name} ({crate})")
    twice = {name: places for name, places in names.items() if len(places) > 1}
    print(f"\n{len(twice)} names of types stand in more than one place:")
    for name, places in sorted(twice.items(), key=lambda entry: (-len(entry[1]), entry[0])):
        print(f"{len(places):6}  {name}: {', '.join(places)}")
    large = [key for key, count in largest if count > MOST_FIELDS and key[1] not in MAY_BE_LARGER]
    wide = [key for key, places in spread if len(places) > MOST_FILES and key[1] not in MAY_BE_LARGER]
    if options.check and (large or wide):
        sys.exit(f"more than {MOST_FIELDS} fields: {large}; methods in more than {MOST_FILES} files: {wide}")


main()
