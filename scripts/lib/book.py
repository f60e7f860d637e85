"""Runs the fenced blocks marked `sh run` of Markdown pages.

A page's blocks run in order, in one shell, in a fresh copy of the committed files. In it `condyle` is
the command just built, and `cargo run --release -- ARGS` stands for `condyle ARGS`, so that a page
may show either without a second build.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^```sh run\n(.*?)^```$", re.MULTILINE | re.DOTALL)

PRELUDE = """\
set -euo pipefail
cargo() {
    [[ "$1 $2 $3" == "run --release --" ]] || { echo "the book cannot run: cargo $*" >&2; return 1; }
    shift 3
    condyle "$@"
}
"""


def blocks(page):
    """The commands of a page, or an empty string."""
    return "\n".join(BLOCK.findall(page.read_text(encoding="utf-8")))


def copy_of_the_repository(folder):
    """Copies the committed files as they are in the work tree."""
    listed = subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True).stdout
    for name in filter(None, listed.decode().split("\0")):
        if Path(name).is_file():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(name, target)


def run(page, commands, condyle):
    """Runs the commands of a page; prints their output and returns False if one fails."""
    with tempfile.TemporaryDirectory() as name:
        copy_of_the_repository(Path(name))
        path = f"{condyle.parent}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(
            ["bash", "-c", PRELUDE + commands],
            cwd=name,
            env={**os.environ, "PATH": path},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
    print(f"{page}: {'done' if done.returncode == 0 else 'FAILED'}")
    if done.returncode != 0:
        print(commands, done.stdout, sep="\n---\n")
    return done.returncode == 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--condyle", type=Path, required=True)
    arguments.add_argument("pages", type=Path, nargs="+")
    given = arguments.parse_args()
    runnable = [(page, blocks(page)) for page in given.pages if page.is_file() and blocks(page)]
    if not runnable:
        sys.exit("no page has a block marked `sh run`")
    results = [run(page, commands, given.condyle) for page, commands in runnable]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
