"""Follows the recipes of the book literally, in a copy of the committed files.

A page has steps of three forms, and every block of it belongs to one:

- "Create `FILE`:" and a block, the whole text of the file;
- "In `FILE`, after the line `LINE`, add" and a block, which goes below the one line that reads so;
- a block of `sh`, the commands, and where it matters a line that ends in "prints" and a block of `text`.

The output must contain the lines of the text in their order; `...` matches anything, and runs of blanks are equal. All pages are
followed first and their commands run afterwards, so that one build is enough.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

from book import copy_of_the_repository

BLOCK = r"```\w+\n(?P<{}>.*?)^```$"
STEP = re.compile(
    rf"^Create `(?P<created>[^`]+)`:\n\n{BLOCK.format('whole')}"
    rf"|^In `(?P<changed>[^`]+)`,\s+after\s+the\s+line\s+`(?P<line>[^`]+)`,\s+add\n\n{BLOCK.format('added')}"
    rf"|^```sh\n(?P<commands>.*?)^```$(?:\n\n[^\n]*prints\n\n```text\n(?P<printed>.*?)^```$)?",
    re.MULTILINE | re.DOTALL,
)
# Files and lines that a page adds below crates/, where the page promises a number.
PROMISED = {"add-a-wear-law.md": (1, 1), "add-a-result.md": (1, 1)}


def steps(page):
    """The steps of a page in their order."""
    text = page.read_text(encoding="utf-8")
    found = list(STEP.finditer(text))
    followed = sum(step[0].count("\n```") + step[0].startswith("```") for step in found)
    fences = len(re.findall("^```", text, re.MULTILINE))
    if followed != fences:
        sys.exit(f"{page}: {fences - followed} fences belong to no step; see {__file__} for the forms")
    return found


def with_lines_below(text, line, added):
    """The text with lines added below the one that reads `line`.

    >>> with_lines_below("a {\\n    b\\n}\\n", "b", "    c\\n")
    'a {\\n    b\\n    c\\n}\\n'
    >>> with_lines_below("b\\nb\\n", "b", "c\\n")
    Traceback (most recent call last):
    ValueError: 2 lines read "b"
    """
    lines = text.splitlines(keepends=True)
    places = [place for place, each in enumerate(lines) if each.strip() == line]
    if len(places) != 1:
        raise ValueError(f'{len(places)} lines read "{line}"')
    return "".join([*lines[: places[0] + 1], added, *lines[places[0] + 1 :]])


def follow(page, step, copy):
    """Performs one step in the copy, unless it is a command; returns the numbers of files and lines added to the crates."""
    name = step["created"] or step["changed"]
    if name is None:
        return 0, 0
    file = copy / name
    of_crates = name.startswith("crates/")
    if step["created"]:
        if file.exists():
            sys.exit(f"{page}: {name} is there already")
        file.write_text(step["whole"], encoding="utf-8")
        return int(of_crates), 0
    try:
        text = with_lines_below(file.read_text(encoding="utf-8"), step["line"], step["added"])
    except (OSError, ValueError) as error:
        sys.exit(f"{page}: {name}: {error}")
    file.write_text(text, encoding="utf-8")
    return 0, step["added"].count("\n") * of_crates


def first_missing(printed, output):
    """The first line of a page's text that is missing from the output, or out of order, or None.

    >>> output = "mass loss    10.91 mg\\nresults in out"
    >>> first_missing("mass loss 10.9... mg\\n...\\nresults in out\\n", output)
    >>> first_missing("results in out\\nmass loss 10.91 mg\\n", output)
    'mass loss 10.91 mg'
    """
    rest = iter(" ".join(line.split()) for line in output.splitlines())
    for line in filter(None, (" ".join(line.split()) for line in printed.splitlines())):
        pattern = ".*".join(map(re.escape, line.split("...")))
        if line != "..." and not any(re.fullmatch(pattern, each) for each in rest):
            return line
    return None


def run(page, step, copy):
    """Runs commands; prints their output and returns False if they fail or do not print the text of the page."""
    done = subprocess.run(
        ["bash", "-c", "set -euo pipefail\n" + step["commands"]],
        cwd=copy,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    missing = first_missing(step["printed"] or "", done.stdout)
    if done.returncode == 0 and missing is None:
        return True
    print(f"{page}: FAILED", step["commands"], done.stdout, sep="\n---\n")
    print(f"code {done.returncode}" if missing is None else f"missing or out of order: {missing}")
    return False


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("--copy", type=Path, required=True, help="an empty folder")
    arguments.add_argument("pages", type=Path, nargs="+")
    given = arguments.parse_args()
    copy_of_the_repository(given.copy)
    pages = {page: steps(page) for page in given.pages}
    if lacking := set(PROMISED) - {page.name for page in pages}:
        sys.exit(f"these pages are missing: {lacking}")
    for page, found in pages.items():
        made = [follow(page, step, given.copy) for step in found]
        files, lines = (sum(counts) for counts in zip(*made))
        print(f"{page}: {files} files and {lines} lines in the crates")
        if (files, lines) != PROMISED.get(page.name, (files, lines)):
            sys.exit(f"{page}: it promises files and lines {PROMISED[page.name]}")
    commands = [(page, step) for page, found in pages.items() for step in found if step["commands"]]
    results = [run(page, step, given.copy) for page, step in commands]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
