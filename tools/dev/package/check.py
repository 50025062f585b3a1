#!/usr/bin/env python3
"""Checks the crates that are published, without building any: tools/dev/package/check.py [--order]

Their metadata, links, oldest compilers, dependencies on each other, and the files that each would hold. `--order` prints
their names instead, each after those that it depends on.
"""

import json
import pathlib
import re
import subprocess
import sys

# The oldest compiler that knows the edition of these crates.
EDITION = {"2024": "1.85"}

# Folders that belong to the repository alone.
LEFT_OUT = {"benches", "bindings", "crates", "docs", "examples", "firmware", "fuzz", "tests", "tools"}

LINK = re.compile(r"\]\(([^)]+)\)|(?:src|href)=\"([^\"]+)\"")


def version(text):
    """The version of a compiler as numbers; nothing is older than all."""
    return tuple(int(part) for part in (text or "0").split("."))[:2]


class Workspace:
    """The crates of the workspace, and all that they stand on."""

    def __init__(self):
        command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
        found = json.loads(subprocess.check_output(command))
        self.packages = {package["id"]: package for package in found["packages"]}
        self.nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
        self.members = [self.packages[member] for member in found["workspace_members"]]
        self.names = {member["name"] for member in self.members}

    def published(self):
        """Crates that may be published, each after those that it depends on."""
        waiting = [member for member in self.members if member["publish"] != []]
        ordered = []
        while waiting:
            there = {crate["name"] for crate in ordered}
            ready = [crate for crate in waiting if self.own(crate) <= there]
            if not ready:
                raise SystemExit(f"these depend on each other: {', '.join(crate['name'] for crate in waiting)}")
            ordered += sorted(ready, key=lambda crate: crate["name"])
            waiting = [crate for crate in waiting if crate not in ready]
        return ordered

    def own(self, crate):
        """Names of the workspace's crates that must be published before this one."""
        needed = {need["name"] for need in crate["dependencies"] if need["kind"] != "dev" or need["req"] != "*"}
        return needed & self.names

    def oldest(self, member):
        """The oldest compiler with which `member`'s edition and all of its dependencies agree, and the reason."""
        needed = (EDITION[member["edition"]], f"edition {member['edition']}")
        seen, waiting = {member["id"]}, [member["id"]]
        while waiting:
            for need in self.nodes[waiting.pop()]["deps"]:
                is_used = any(kind["kind"] in (None, "build") for kind in need["dep_kinds"])
                if not is_used or need["pkg"] in seen:
                    continue
                seen.add(need["pkg"])
                waiting.append(need["pkg"])
                package = self.packages[need["pkg"]]
                # The crates of the workspace are judged by themselves.
                if package["name"] not in self.names and version(package["rust_version"]) > version(needed[0]):
                    needed = (package["rust_version"], f"{package['name']} {package['version']}")
        return needed


def wrong_metadata(workspace, crate):
    """Problems of the fields of Cargo.toml."""
    for field in ("description", "license", "documentation", "readme"):
        if not crate[field]:
            yield f"has no {field}"
    for field in ("keywords", "categories"):
        if not 1 <= len(crate[field]) <= 5:
            yield f"has {len(crate[field])} {field}; a registry takes 1 to 5"
    is_library = any("lib" in target["kind"] for target in crate["targets"])
    if is_library and not ((crate["metadata"] or {}).get("docs") or {}).get("rs"):
        yield "has no settings for docs.rs"
    for need in crate["dependencies"]:
        if need["name"] in workspace.names and (need["kind"] == "dev") != (need["req"] == "*"):
            yield f"needs {need['name']} {need['req']}: by path alone for tests, with a version for all else"


def wrong_compiler(workspace, member):
    """A rust-version older than the edition or a dependency asks for; clippy judges the functions of the standard library."""
    needed, reason = workspace.oldest(member)
    if version(member["rust_version"]) < version(needed):
        yield f"says rust-version {member['rust_version']}, but {reason} asks for {needed}"


def wrong_files(crate):
    """Problems of the files that the package would hold."""
    command = ["cargo", "package", "--list", "--allow-dirty", "--locked", "--quiet", "--package", crate["name"]]
    files = [pathlib.PurePosixPath(line) for line in subprocess.check_output(command, text=True).splitlines()]
    readme = crate["readme"] or ""
    for needed in ("LICENSE-APACHE", "LICENSE-MIT", readme):
        if pathlib.PurePosixPath(needed) not in files:
            yield f"would hold no {needed}"
    for file in files:
        if file.parts[0] in LEFT_OUT or "tests" in file.parts or file.name.endswith("tests.rs"):
            yield f"would hold {file}"


def wrong_links(crate):
    """Links of its page that lead nowhere without the repository."""
    page = pathlib.Path(crate["manifest_path"]).parent / (crate["readme"] or "")
    for link in LINK.findall(page.read_text(encoding="utf-8")) if page.is_file() else []:
        if not "".join(link).startswith("https://"):
            yield f"{page.name} leads to {''.join(link)}, which the package does not have"


def main():
    workspace = Workspace()
    crates = workspace.published()
    if sys.argv[1:] == ["--order"]:
        print(*(crate["name"] for crate in crates), sep="\n")
        return
    problems = [(member, problem) for member in workspace.members for problem in wrong_compiler(workspace, member)]
    for crate in crates:
        for found in (wrong_metadata(workspace, crate), wrong_files(crate), wrong_links(crate)):
            problems += [(crate, problem) for problem in found]
    for crate, problem in problems:
        print(f"{crate['name']}: {problem}", file=sys.stderr)
    if problems:
        raise SystemExit(1)
    print(f"{len(crates)} crates could be packed")


if __name__ == "__main__":
    main()
