"""Prints how much production code there is: Rust under crates/ and python/src.

Not counted are tests, benches and examples: files under folders of these names, files called tests.rs, and modules marked
#[cfg(test)] within a file.
"""

import re
import subprocess
from pathlib import Path

LEFT_OUT = re.compile(r"/(tests|benches|examples)/|/tests\.rs$")
INLINE_TESTS = re.compile(r"^( *)#\[cfg\(test\)\]\n(?: *#\[.*\]\n)*\1mod \w+ \{\n.*?^\1\}\n", re.MULTILINE | re.DOTALL)


def production(text):
    """The text of a source file without its inline test modules.

    >>> production("fn a() {}\\n#[cfg(test)]\\nmod tests {\\n    fn b() {}\\n}\\n")
    'fn a() {}\\n'
    """
    return INLINE_TESTS.sub("", text)


def main():
    listed = subprocess.run(["git", "ls-files", "crates", "python/src"], check=True, capture_output=True, text=True)
    lines = [
        production(Path(path).read_text(encoding="utf-8")).count("\n")
        for path in listed.stdout.splitlines()
        if path.endswith(".rs") and not LEFT_OUT.search(path)
    ]
    print(f"production code: {sum(lines):,} lines in {len(lines)} files")


if __name__ == "__main__":
    main()
