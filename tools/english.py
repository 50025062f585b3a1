#!/usr/bin/env python3
"""How plain the comments are, for each module: tools/english.py [--list N] [--check] [FOLDER...]

Counts "what", "who", "whose" and "whom" per 100 words of comments (those of documentation too) in Rust, RON, TOML, Python
and shell files, and of text in Markdown pages; and sentences that begin with one of them without asking anything. Words within backquotes,
code blocks and addresses do not count. `--list N` prints the N worst files, `--check` fails above the limits below.
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys

# Most that `--check` lets pass, per 100 words: of everything together, and of any module.
LIMIT_OF_ALL = 0.3
LIMIT_OF_MODULE = 0.6

# Modules with fewer words than this are judged with their neighbours only: one word more would decide.
FEW_WORDS = 300

CODE = re.compile(r"```.*?```|~~~.*?~~~|`[^`]*`|https?://\S+|<!--.*?-->", re.DOTALL)
WORD = re.compile(r"[A-Za-z][A-Za-z'’-]*")
WATCHED = {"what", "who", "whose", "whom", "whatever", "whoever"}
SENTENCE = re.compile(r"(?:^|(?<=[.!?:;]\s)|(?<=\n\n)|(?<=\| ))\s*[-*]?\s*(?:What|Who|Whose|Whatever|Whoever)\b[^.!?|]*[.!?|]?")

# A comment up to the end of its line, or a text, which may hold two slashes.
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*)|(?P<raw>\bb?r(?P<hashes>\#*)".*?"(?P=hashes))|b?"(?:[^"\\]|\\.)*"|b?'(?:[^'\\\n]|\\[^\n]{1,10}?)'""",
    re.DOTALL | re.VERBOSE,
)


def comments(code):
    """The comments of a Rust file, those on neighbouring lines as one paragraph."""
    blocks, last = [], None
    for found in TOKEN.finditer(code):
        if not (comment := found["comment"]):
            continue
        line = code.count("\n", 0, found.start())
        text = re.sub(r"^//[/!]?\s?", "", comment)
        if last is not None and line == last + 1:
            blocks[-1] += "\n" + text
        else:
            blocks.append(text)
        last = line
    return blocks


def lines_of_comment(text):
    """The comments of a file in which they begin with `#`, those on neighbouring lines as one paragraph."""
    lines = [re.sub(r"^# ?", "", line.strip()) if line.lstrip().startswith("#") else "" for line in text.splitlines()]
    return [block for block in re.split(r"\n{2,}", "\n".join(lines)) if block.strip()]


# How the texts of a file are found, by its suffix.
TEXTS = {
    ".rs": comments, ".ron": comments, ".toml": lines_of_comment, ".py": lines_of_comment, ".sh": lines_of_comment,
    ".md": lambda text: [text],
}


def module_of(path):
    """The group in which `path` is counted: a folder below `src`, or a folder of the workspace."""
    parts = path.parts
    if "src" in parts:
        at = parts.index("src")
        owner = "/".join(parts[:at])
        inner = parts[at + 1 : -1] or (path.stem,)
        return "/".join(filter(None, [owner, "/".join(inner[:2])]))
    return "/".join(parts[: 2 if len(parts) > 2 else 1]) if len(parts) > 1 else path.name


def count(path):
    """Words, watched words and crooked sentences of one file."""
    text = path.read_text(encoding="utf-8")
    blocks = TEXTS[path.suffix](text)
    words = watched = 0
    crooked = []
    for block in blocks:
        plain = CODE.sub(" x ", block)
        found = WORD.findall(plain)
        words += len(found)
        watched += sum(word.lower() in WATCHED for word in found)
        crooked += [s.group().strip() for s in SENTENCE.finditer(plain) if not s.group().rstrip().endswith("?")]
    return words, watched, crooked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", help="only files below these")
    parser.add_argument("--list", type=int, default=0, metavar="N", help="also print the N worst files")
    parser.add_argument("--check", action="store_true", help="exit status 1 above the limits")
    arguments = parser.parse_args()
    names = subprocess.run(["git", "ls-files", "--", *arguments.folders], check=True, capture_output=True, text=True)
    modules, files = collections.defaultdict(lambda: [0, 0, 0]), []
    for name in names.stdout.splitlines():
        path = pathlib.Path(name)
        if path.suffix not in TEXTS or not path.is_file() or "fixtures" in path.parts:
            continue
        words, watched, crooked = count(path)
        files.append((watched, words, len(crooked), name))
        for at, number in enumerate((words, watched, len(crooked))):
            modules[module_of(path)][at] += number
    print(f"{'module':44}{'words':>9}{'watched':>9}{'per 100':>9}{'begin so':>10}")
    worst = 0.0
    for module, (words, watched, crooked) in sorted(modules.items()):
        share = 100 * watched / max(words, 1)
        worst = max(worst, share if words >= FEW_WORDS else 0.0)
        print(f"{module:44}{words:9,}{watched:9,}{share:9.2f}{crooked:10,}")
    words, watched, crooked = (sum(of[at] for of in modules.values()) for at in range(3))
    share = 100 * watched / max(words, 1)
    print(f"{'all':44}{words:9,}{watched:9,}{share:9.2f}{crooked:10,}")
    for of_watched, of_words, of_crooked, name in sorted(files, reverse=True)[: arguments.list]:
        print(f"{of_watched:5}{of_words:7}{of_crooked:5}  {name}")
    if arguments.check and (share > LIMIT_OF_ALL or worst > LIMIT_OF_MODULE or crooked):
        sys.exit(f"limits: {LIMIT_OF_ALL} in all, {LIMIT_OF_MODULE} in a module, no sentence that begins so")


if __name__ == "__main__":
    main()
