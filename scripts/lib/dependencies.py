"""Holds every dependency against deny.toml, and against the Rust version of Cargo.toml.

deny.toml is a file of cargo-deny, which whoever has it can run: `cargo deny check licenses bans sources`.
It takes minutes to build, so this reads the same lists and asks `cargo metadata` the same questions:
licences, versions beside each other, sources. It knows no advisories, and of the keys of deny.toml
those that stand there.
"""

import json
import re
import subprocess
import sys
import tomllib
from collections import defaultdict
from pathlib import Path

CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
WORD = re.compile(r"\(|\)|/|[^\s()/]+")
LICENCE = re.compile(r"[^\s()/]+(?: WITH [^\s()/]+)?")


def used_packages():
    """Every package that some build of the workspace takes, on any platform, tests included.

    `cargo metadata` knows the licences, and lists what no feature asks for; `cargo tree` does not.
    """
    told = json.loads(said_by("metadata", "--all-features", "--format-version", "1"))
    of_all = ["--workspace", "--all-features", "--target", "all"]
    lines = said_by("tree", *of_all, "--prefix", "none", "--format", "{p}")
    used = {tuple(line.split()[:2]) for line in lines.splitlines()}
    return [p for p in told["packages"] if (p["name"], f"v{p['version']}") in used]


def said_by(*arguments):
    command = ["cargo", *arguments, "--locked"]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def is_allowed(licence, allow):
    """Whether a licence expression can be met by licences of `allow`.

    >>> allow = {"MIT", "ISC"}
    >>> [is_allowed(text, allow) for text in ("MIT", "Zlib", "Zlib/MIT", "ISC AND (GPL-3.0 OR MIT)")]
    [True, False, True, True]
    >>> [is_allowed(text, allow) for text in ("MIT AND Zlib", "MIT WITH exception", "Zlib OR ISC AND MIT")]
    [False, False, True]
    """
    words = WORD.findall(licence)

    def either():
        met = both()
        while words and words[0] in ("OR", "/"):
            words.pop(0)
            met = both() or met
        return met

    def both():
        met = single()
        while words and words[0] == "AND":
            words.pop(0)
            met = single() and met
        return met

    def single():
        word = words.pop(0)
        if word == "(":
            met = either()
            words.pop(0)
            return met
        if words and words[0] == "WITH":
            word = f"{word} WITH {words[1]}"
            del words[:2]
        return word in allow

    return either()


def wrong_licences(packages, rules):
    allow = set(rules["allow"])
    for package in packages:
        licence = package["license"] or "no licence"
        if not is_allowed(licence, allow):
            yield f"{name(package)}: {licence} is not among the licences that deny.toml allows"
    needed = {word for p in packages for word in LICENCE.findall(p["license"] or "")}
    for licence in sorted(allow - needed):
        yield f"deny.toml allows {licence}, which nothing has: remove it"


def versions_beside_each_other(packages, rules):
    skipped = {entry["crate"] for entry in rules["skip"]}
    versions = defaultdict(list)
    for package in packages:
        versions[package["name"]].append(name(package))
    twice = [each for each in versions.values() if len(each) > 1]
    for each in twice:
        if len(left := [one for one in each if one not in skipped]) > 1:
            yield f"{' and '.join(left)} are built beside each other: use one, or say why in deny.toml"
    for entry in sorted(skipped - {one for each in twice for one in each}):
        yield f"deny.toml skips {entry}, of which there is no second version: remove it"


def wildcards(packages):
    for package in packages:
        for needed in package["dependencies"]:
            if not package["source"] and needed["req"] == "*" and "path" not in needed:
                yield f"{package['name']} takes any version of {needed['name']}: name one"


def strange_sources(packages):
    for package in packages:
        if package["source"] not in (None, CRATES_IO):
            yield f"{name(package)} comes from {package['source']}, not from crates.io"


def too_new_for(packages, ours):
    for package in packages:
        needed = package["rust_version"]
        if needed and version(needed) > version(ours):
            yield f"{name(package)} needs Rust {needed}; rust-version in Cargo.toml is {ours}"


def version(text):
    return [int(part) for part in text.split(".")]


def name(package):
    return f"{package['name']}@{package['version']}"


def main():
    rules = tomllib.loads(Path("deny.toml").read_text(encoding="utf-8"))
    ours = tomllib.loads(Path("Cargo.toml").read_text(encoding="utf-8"))
    packages = used_packages()
    others = [package for package in packages if package["source"]]
    rust = ours["workspace"]["package"]["rust-version"]
    problems = [
        *wrong_licences(packages, rules["licenses"]),
        *versions_beside_each_other(others, rules["bans"]),
        *wildcards(packages),
        *strange_sources(packages),
        *too_new_for(others, rust),
    ]
    silent = sum(package["rust_version"] is None for package in others)
    print(f"{len(others)} dependencies; {silent} do not say which Rust they need")
    for problem in problems:
        print(problem)
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
