#!/usr/bin/env python3
"""Times a study of few tests on one worker and on two, beside the run alone, and one of ten thousand on two."""

import argparse
import json
import os
import re
import subprocess
import time
from pathlib import Path

WHOLE = 10_000


def of_size(given: Path, tests: int, work: Path) -> Path:
    """The study with so many tests, beside its results."""
    text = given.read_text()
    case = given.parent / re.search(r'case = "(.*)"', text)[1]
    text = re.sub(r"size = [0-9_]+", f"size = {tests}", text)
    path = work / f"study-{tests}.toml"
    path.write_text(re.sub(r'case = ".*"', f'case = "{case.resolve()}"', text))
    return path


def study(command: str, path: Path, out: Path, threads: int) -> tuple[float, float]:
    """Seconds, and the most memory it held, MB."""
    started = time.monotonic()
    process = subprocess.Popen(
        [command, "study", path, "--out", out, "--threads", str(threads)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, used = os.wait4(process.pid, 0)
    assert os.waitstatus_to_exitcode(status) == 0, "the study failed"
    return time.monotonic() - started, used.ru_maxrss / 1024


def run_alone(command: str, case: Path, work: Path) -> float:
    """Seconds of the march of one run, the median of five."""
    seconds = []
    for number in range(5):
        out = work / f"run-{number}"
        subprocess.run([command, "run", case, "--out", out], check=True, capture_output=True)
        seconds.append(json.loads((out / "summary.json").read_text())["wall_s"])
    return sorted(seconds)[2]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("condyle", type=os.path.abspath)
    parser.add_argument("study", type=Path)
    parser.add_argument("work", type=Path)
    parser.add_argument("--tests", type=int, default=400)
    given = parser.parse_args()
    case = given.study.parent / re.search(r'case = "(.*)"', given.study.read_text())[1]
    path = of_size(given.study, given.tests, given.work)
    alone = run_alone(given.condyle, case, given.work)
    one, memory_one = study(given.condyle, path, given.work / "one", 1)
    two, memory_two = study(given.condyle, path, given.work / "two", 2)
    same = (given.work / "one/table.csv").read_bytes() == (given.work / "two/table.csv").read_bytes()
    whole, memory_whole = study(given.condyle, of_size(given.study, WHOLE, given.work), given.work / "whole", 2)
    a_test = one / given.tests
    rows = [
        ("tests", f"{given.tests}"),
        ("solver time of one run alone, as `condyle run` reports it", f"{1000 * alone:.0f} ms"),
        ("a test of the study on one worker", f"{1000 * a_test:.0f} ms, {100 * (a_test / alone - 1):+.1f} %"),
        ("throughput of two workers relative to one", f"{one / two:.2f}"),
        (f"{WHOLE:,} tests on two workers, with their answers", f"{whole / 60:.1f} minutes"),
        (
            "memory: one worker; two; two with the 10,000 tests",
            f"{memory_one:.0f} MB, {memory_two:.0f} MB, {memory_whole:.0f} MB",
        ),
        ("table has the same bytes", "yes" if same else "no"),
    ]
    print("| quantity | measured |\n| --- | --- |")
    for row in rows:
        print("| " + " | ".join(row) + " |")


main()
