"""Checks every dependency against deny.toml, and against the Rust version of Cargo.toml.

deny.toml is the file of cargo-deny: `cargo deny check licenses bans sources`. As cargo-deny takes minutes to build, this script
reads the same lists and checks licences, duplicate versions and sources with `cargo metadata`. It has no advisories, and
supports only the keys that deny.toml contains.
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
    """Every package that a build of the workspace uses, on any platform, including tests.

    `cargo metadata` has the licences, but also lists unused optional packages, which `cargo tree` omits.
    """
    metadata = json.loads(cargo("metadata", "--all-features", "--format-version", "1"))
    of_all = ["--workspace", "--all-features", "--target", "all"]
    lines = cargo("tree", *of_all, "--prefix", "none", "--format", "{p}")
    used = {tuple(line.split()[:2]) for line in lines.splitlines()}
    return [p for p in metadata["packages"] if (p["name"], f"v{p['version']}") in used]


def cargo(*arguments):
    command = ["cargo", *arguments, "--locked"]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def is_allowed(licence, allow):
    """Returns whether the licences of `allow` satisfy a licence expression.

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
        yield f"deny.toml allows {licence}, which no dependency has: remove it"


def duplicate_versions(packages, rules):
    skipped = {entry["crate"] for entry in rules["skip"]}
    versions = defaultdict(list)
    for package in packages:
        versions[package["name"]].append(name(package))
    twice = [each for each in versions.values() if len(each) > 1]
    for each in twice:
        if len(left := [one for one in each if one not in skipped]) > 1:
            yield f"{' and '.join(left)} are both built: use one version, or give the reason in deny.toml"
    for entry in sorted(skipped - {one for each in twice for one in each}):
        yield f"deny.toml skips {entry}, which has no second version: remove it"


def wildcards(packages):
    for package in packages:
        for needed in package["dependencies"]:
            if not package["source"] and needed["req"] == "*" and "path" not in needed:
                yield f"{package['name']} accepts any version of {needed['name']}: name one"


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
        *duplicate_versions(others, rules["bans"]),
        *wildcards(packages),
        *strange_sources(packages),
        *too_new_for(others, rust),
    ]
    silent = sum(package["rust_version"] is None for package in others)
    print(f"{len(others)} dependencies; {silent} do not name the Rust version that they need")
    for problem in problems:
        print(problem)
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
