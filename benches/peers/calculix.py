"""CalculiX beside condyle: a ball pressed on a block and slid, the generic insert under the femur at places of the gait.

python calculix.py NAME CONDYLE.csv [DECK.inp...] [--iterative] [--limit=SECONDS]

Runs ccx on every deck, a row of CONDYLE.csv for each of its steps, and prints both sides. A step that ccx does not end is
"not finished", and rows without a deck are "not asked". With --iterative CalculiX solves by preconditioned conjugate
gradients, which knows no friction but is several times quicker here; else by its own default. After so many SECONDS of
processor time (an hour, if nothing is said) ccx is stopped.
"""

import argparse
import csv
import os
import re
import resource
import subprocess
from pathlib import Path


def total_forces(dat):
    """Total force on the held nodes at the end of every increment, N, with its time in steps."""
    found = re.findall(r"total force \(fx,fy,fz\) for set BACKSIDE and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", dat)
    return [tuple(map(float, row)) for row in found]


def highest_pressures(frd):
    """Highest contact pressure at a node at every time that has any, MPa."""
    highest, time, within = {}, 0.0, False
    for line in frd:
        if line.startswith("  100CL"):
            time = float(line[12:24])
        elif line.startswith(" -4"):
            within = line.split()[1] == "CONTACT"
        elif line.startswith(" -3"):
            within = False
        elif within and line.startswith(" -1"):
            highest[time] = max(highest.get(time, 0.0), float(line[13 + 36:13 + 48]))
    return highest


def processor_s():
    """Processor time of all that was run until now, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def calculix(deck, iterative, limit_s):
    """Runs ccx; (force down, highest pressure) or None at the end of every step, and its processor time, s."""
    job = deck.with_suffix("")
    text = deck.read_text(encoding="ascii")
    if iterative:
        job = deck.with_name(deck.stem + "-iterative")
        text = text.replace("*STATIC\n", "*STATIC, SOLVER=ITERATIVE CHOLESKY\n")
        job.with_suffix(".inp").write_text(text, encoding="ascii")
    before = processor_s()
    environment = dict(os.environ, OMP_NUM_THREADS="1")

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s))

    with open(job.with_suffix(".log"), "w", encoding="utf-8") as log:
        subprocess.run(["ccx", job.name], cwd=deck.parent, env=environment, stdout=log, check=False, preexec_fn=limit)
    seconds = processor_s() - before
    forces, pressures = [], {}
    if job.with_suffix(".dat").exists() and job.with_suffix(".frd").exists():
        forces = total_forces(job.with_suffix(".dat").read_text(encoding="ascii"))
        with open(job.with_suffix(".frd"), encoding="ascii") as frd:
            pressures = highest_pressures(frd)
    forces_n = {time: force_n for time, _, force_n, _ in forces}
    steps = range(1, 1 + sum(line.startswith("*STEP") for line in text.splitlines()))
    ended = [time in forces_n and time in pressures for time in steps]
    return [(forces_n[time], pressures[time]) if end else None for time, end in zip(steps, ended)], seconds


def show(name, row, theirs):
    """A line of the table; `theirs` is what CalculiX has, or the word for why it has nothing."""
    place = row.get("step") or f"{float(row['percent']):.1f} %"
    own_n, own_mpa, peak_mpa = -float(row["force_y_n"]), float(row["highest_node_mpa"]), float(row["peak_mpa"])
    own_s = float(row["time_s"])
    if isinstance(theirs, str):
        print(f"{name:8} {place:8} | {own_n:9.2f} {theirs:>18} | {own_mpa:7.3f} {'':16} {peak_mpa:7.3f} | {own_s:8.4f}", flush=True)
        return
    (their_n, their_mpa), seconds = theirs
    print(f"{name:8} {place:8} | {own_n:9.2f} {their_n:9.2f} {100 * (own_n / their_n - 1):+6.2f} % |"
          f" {own_mpa:7.3f} {their_mpa:7.3f} {100 * (own_mpa / their_mpa - 1):+6.2f} % {peak_mpa:7.3f} |"
          f" {own_s:8.4f} {seconds:8.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("ours")
    parser.add_argument("decks", nargs="*", type=Path)
    parser.add_argument("--iterative", action="store_true")
    parser.add_argument("--limit", type=int, default=3600)
    words = parser.parse_args()
    with open(words.ours, newline="", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    left = iter(rows)
    for deck in words.decks:
        steps, seconds = calculix(deck, words.iterative, words.limit)
        for step in steps:
            show(words.name, next(left), (step, seconds) if step else f"not finished, {seconds:.0f} s")
    for row in left:
        show(words.name, row, "not asked")
    if "since_start_s" in rows[-1]:
        print(f"{words.name:8} condyle has all in {float(rows[-1]['since_start_s']):.2f} s, with the case read and its first cycle solved")


if __name__ == "__main__":
    main()
