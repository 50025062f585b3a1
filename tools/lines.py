#!/usr/bin/env python3
"""Lines of code of each module of the library and of each crate beside it: tools/lines.py [REVISION [REVISION]].

Of one revision (HEAD unless told), or of two with what changed between them. Blank lines, comments (those of
documentation too) and what is compiled for tests only do not count.
"""

import collections
import io
import re
import subprocess
import sys
import tarfile

# Of a raw string only its beginning is found: it ends behind as many hashes.
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*)|(?P<block>/\*)|(?P<raw>\bb?r(?P<hashes>\#*)")|(?P<text>b?"(?:[^"\\]|\\.)*")"""
    r"""|(?P<char>b?'(?:[^'\\\n]|\\[^\n]{1,10}?)')|(?P<test>\#\[cfg\(test\)\]|\#\[cfg\(all\(test\b[^\]]*\])""",
    re.DOTALL | re.VERBOSE,
)

# The word that names the sort of an item, behind its attributes and `pub`.
FIRST_WORD = re.compile(
    r"\s*(?:#\[[^\]]*\]\s*)*(?:pub(?:\([^)]*\))?\s+)?(?:(?:const|unsafe|async)\s+)*(\w*)"
)
ITEMS = ("fn", "impl", "macro_rules", "mod", "struct", "enum", "trait")


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def filled(text):
    return re.sub(r"[^\n]", "x", text)


def plain(code):
    """`code` with comments as spaces, and texts without brackets; line ends stay."""
    parts, at = [], 0
    while found := TOKEN.search(code, at):
        parts.append(code[at : found.start()])
        end = found.end()
        if found["comment"]:
            parts.append(blank(found[0]))
        elif found["block"]:
            depth = 1
            while depth:
                mark = re.compile(r"/\*|\*/").search(code, end)
                depth += 1 if mark[0] == "/*" else -1
                end = mark.end()
            parts.append(blank(code[found.start() : end]))
        elif found["raw"]:
            end = code.index('"' + found["hashes"], end) + 1 + len(found["hashes"])
            parts.append(filled(code[found.start() : end]))
        elif found["test"]:
            parts.append(found[0])
        else:
            parts.append(filled(found[0]))
        at = end
    return "".join(parts) + code[at:]


def end_of_item(code, at):
    """Where the item that begins at `at` ends, behind what closes it."""
    first = FIRST_WORD.match(code, at)[1]
    closing = ";" if first in ("use", "type", "static") else ";}" if first in ITEMS else ";},"
    depth = 0
    for place in range(at, len(code)):
        char = code[place]
        depth += (char in "([{") - (char in ")]}")
        # The brackets around it close.
        if depth < 0:
            return place
        if depth == 0 and char in closing:
            return place + 1
    return len(code)


def without_tests(code):
    """`code` without what is compiled for tests only, and the modules in files of their own that are."""
    modules = []
    while found := re.search(r"#\[cfg\((?:test|all\(test\b[^\]]*)\)\]", code):
        end = end_of_item(code, found.end())
        item = code[found.end() : end]
        if named := re.search(r"\bmod\s+(\w+)\s*;", item):
            path = re.search(r"#\[path", item)
            modules.append(None if path else named[1])
        code = code[: found.start()] + blank(code[found.start() : end]) + code[end:]
    return code, modules


def count(revision):
    """Lines of code by module or crate."""
    listed = subprocess.run(["git", "ls-tree", "--name-only", revision, "src", "crates"], check=True, capture_output=True)
    folders = listed.stdout.decode().split()
    packed = subprocess.run(["git", "archive", revision, *folders], check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        files = {
            member.name: archive.extractfile(member).read().decode()
            for member in archive
            if re.match(r"(crates/[^/]+/)?src/.*\.rs$", member.name)
        }
    codes, tests = {}, set()
    for name, text in files.items():
        # Of a file that is for tests as a whole nothing is left.
        if re.match(r"\s*#!\[cfg\(test\)\]", plain(text)):
            codes[name] = ""
            continue
        codes[name], modules = without_tests(plain(text))
        folder, stem = name.rsplit("/", 1)
        if stem not in ("mod.rs", "lib.rs", "main.rs"):
            folder += "/" + stem.removesuffix(".rs")
        tests.update(f"{folder}/{module}" for module in modules if module)
    lines = collections.Counter()
    for name, code in codes.items():
        if not any(name == test + ".rs" or name.startswith(test + "/") for test in tests):
            # Of the crates beside the library, each is one.
            module = name.split("/")[1].removesuffix(".rs")
            lines[module] += sum(1 for line in code.splitlines() if line.strip())
    return lines


def main(revisions):
    counts = [count(revision) for revision in revisions]
    print(f"{'module':20}" + "".join(f"{revision[:12]:>14}" for revision in revisions), end="")
    print(f"{'change':>10}" if len(counts) == 2 else "")
    rows = sorted(set().union(*counts)) + ["all"]
    for row in rows:
        of_row = [count.total() if row == "all" else count[row] for count in counts]
        print(f"{row:20}" + "".join(f"{lines:14,}" for lines in of_row), end="")
        print(f"{of_row[1] - of_row[0]:+10,}" if len(counts) == 2 else "")


if __name__ == "__main__":
    main(sys.argv[1:3] or ["HEAD"])
