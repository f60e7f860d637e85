#!/usr/bin/env python3
"""What limits a study on many workers: times measured here, and a simulation of a cluster that has them."""

import argparse
import heapq
import os
import random
import re
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import dask
import distributed

import condyle
from condyle import _workers

TESTS_A_TASK = 64
WORKERS = [1, 10, 100, 1000, 4000]
STUDIES = [10_000, 1_000_000]
# Workers of Dask give memory back to the system at once unless told otherwise, and ask for it again with every test.
KEPT_MEMORY = {"MALLOC_TRIM_THRESHOLD_": 2**28, "MALLOC_MMAP_THRESHOLD_": 2**25}


def study_of(path: Path, tests: int) -> condyle.Study:
    text = path.read_text(encoding="utf-8")
    return condyle.Study.from_text(re.sub(r"size = [0-9_]+", f"size = {tests}", text), folder=path.parent)


def test_times_s(study: condyle.Study, tests: int) -> list[float]:
    """Of tests one after the other, the first, which builds what all share, left out."""
    source = study._source
    _workers.run_rows(source, [0])
    seconds = []
    for row in range(1, tests):
        started = time.perf_counter()
        _workers.run_rows(source, [row])
        seconds.append(time.perf_counter() - started)
    return seconds


def start_s(study: condyle.Study) -> float:
    """What a worker takes to read the study and to build its bodies, beyond a test."""
    started = time.perf_counter()
    _workers._study_of.cache_clear()
    _workers.run_rows(study._source, [0])
    first = time.perf_counter() - started
    started = time.perf_counter()
    _workers.run_rows(study._source, [0])
    return first - (time.perf_counter() - started)


def nothing(source: _workers.Source, rows: list[int]) -> list[tuple[int, list[float] | str]]:
    """A task that takes no time: what is left is what a task costs here."""
    return [(row, [1.0] * 10) for row in rows]


def task_cost_s(path: Path, client: distributed.Client, tasks: int) -> float:
    """What one task costs the machine that sends it and keeps what it found."""
    study = study_of(path, tasks * TESTS_A_TASK)
    real, _workers.run_rows = _workers.run_rows, nothing
    try:
        with tempfile.TemporaryDirectory() as work:
            executor = client.get_executor(pure=False)
            started = time.perf_counter()
            _workers.run_on(executor, study._raw, study._source, work, TESTS_A_TASK, None)
            return (time.perf_counter() - started) / tasks
    finally:
        _workers.run_rows = real


def seconds_of(study: condyle.Study, **where: object) -> float:
    with tempfile.TemporaryDirectory() as work:
        started = time.perf_counter()
        study.run(Path(work) / "out", **where)
        return time.perf_counter() - started


def simulated_s(tests: int, workers: int, times_s: Sequence[float], cost_s: float, first_s: float) -> float:
    """When the last test is kept: one machine sends and keeps, a task at a time, and each worker has one task after another."""
    numbers = random.Random(1)
    left = -(-tests // TESTS_A_TASK)
    sender_s = 0.0
    # When each busy worker is done; all others wait for the sender.
    busy: list[float] = []
    for _ in range(min(workers, left)):
        sender_s += cost_s
        heapq.heappush(busy, sender_s + first_s + sum(numbers.choices(times_s, k=TESTS_A_TASK)))
        left -= 1
    while busy:
        done_s = heapq.heappop(busy)
        sender_s = max(sender_s, done_s) + cost_s
        if left > 0:
            left -= 1
            heapq.heappush(busy, sender_s + sum(numbers.choices(times_s, k=TESTS_A_TASK)))
    return sender_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=Path)
    parser.add_argument("--tests", type=int, default=400)
    given = parser.parse_args()
    study = study_of(given.study, given.tests)
    times_s = test_times_s(study, min(given.tests, 200))
    first_s = start_s(study)
    threads_s = seconds_of(study, threads=2)
    dask.config.set({f"distributed.nanny.pre-spawn-environ.{name}": size for name, size in KEPT_MEMORY.items()})
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        dask_s = seconds_of(study, client=client)
        cost_s = task_cost_s(given.study, client, 500)
    mean_s = sum(times_s) / len(times_s)
    print("| quantity | measured |\n| --- | --- |")
    print(f"| processors | {os.cpu_count()} |")
    print(f"| a test | {1e3 * mean_s:.0f} ms |")
    print(f"| start of a worker | {1e3 * first_s:.0f} ms |")
    print(
        f"| {given.tests} tests on two threads; on two processes of Dask | {threads_s:.1f} s, {dask_s:.1f} s ({100 * (dask_s / threads_s - 1):+.1f} %) |"
    )
    print(
        f"| a task of {TESTS_A_TASK} tests: time of the sender and Dask | {1e3 * cost_s:.1f} ms, {100 * cost_s / (TESTS_A_TASK * mean_s):.2f} % of the time of its tests |"
    )
    print("\n| workers, simulated | " + " | ".join(f"{tests:,} tests" for tests in STUDIES) + " |")
    print("| --- |" + " --- |" * len(STUDIES))
    for workers in WORKERS:
        cells = []
        for tests in STUDIES:
            whole_s = simulated_s(tests, workers, times_s, cost_s, first_s)
            cells.append(f"{whole_s:,.0f} s, {100 * tests * mean_s / (workers * whole_s):.0f} % of the workers' time")
        print(f"| {workers} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
