"""CalculiX beside condyle: a ball pressed on a block and slid, the generic insert under the femur at places of the gait.

python calculix.py NAME CONDYLE.csv [DECK.inp...] [--iterative] [--limit=SECONDS]

Runs ccx on every deck and prints both sides: the rows of CONDYLE.csv that name a step of the deck, or the next row for a deck
of one step. A step that ccx does not end is "not finished", and rows without a deck are "not asked". With --iterative
CalculiX solves by preconditioned conjugate gradients, which knows no friction but is several times quicker here; else by its
own default. After so many SECONDS of processor time (an hour, if nothing is said) ccx is stopped.
"""

import argparse
import csv
import os
import re
import resource
import subprocess
from pathlib import Path
from typing import NamedTuple

# The contact of the decks as CalculiX finds its balance with: the facet over a node is looked for once an increment, and
# every node near the femur has its spring from the increment's beginning, so that none comes and goes between iterations.
# Of a node's edge 0.5 is near; where a spring is open it pulls with 1e-6 MPa.
TABLE = "PRESSURE-OVERCLOSURE=TABULAR\n0.0, 0.0\n1000000.0, 1.0\n"
CONTACT = {
    TABLE: "PRESSURE-OVERCLOSURE=LINEAR\n1000000.0, 0.000001, 0.5\n",
    "TYPE=NODE TO SURFACE\n": "TYPE=NODE TO SURFACE, SMALL SLIDING\n",
}
SOLVER = {"*STATIC\n": "*STATIC, SOLVER=ITERATIVE CHOLESKY\n"}
NUMBER = r"([-+.\dE]+)"


class Step(NamedTuple):
    """What CalculiX finds at the end of a step."""

    force_x_n: float
    force_y_n: float
    pressure_mpa: float
    plastic_strain: float


def total_forces(dat):
    """Total force on the held nodes at the end of every increment, N, by its time in steps."""
    of = r"total force \(fx,fy,fz\) for set BACKSIDE and time"
    rows = re.findall(rf"{of}\s+{NUMBER}\s+{NUMBER}\s+{NUMBER}\s+{NUMBER}", dat)
    return {float(time): (float(x), float(y)) for time, x, y, _ in rows}


def highest_strains(dat):
    """Highest equivalent plastic strain at a Gauss point at every time that is printed."""
    highest, time = {}, None
    for line in dat.splitlines():
        if "and time" in line:
            time = float(line.split()[-1]) if "plastic strain" in line else None
        elif time is not None and line.strip():
            highest[time] = max(highest.get(time, 0.0), float(line.split()[-1]))
    return highest


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
            highest[time] = max(highest.get(time, 0.0), float(line[13 + 36 : 13 + 48]))
    return highest


def processor_s():
    """Processor time of all that was run until now, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def for_calculix(text, iterative):
    """The text of a deck with contact and solver as CalculiX is to have them."""
    for old, new in (CONTACT | SOLVER if iterative else CONTACT).items():
        if old not in text:
            raise SystemExit(f"no {old!r} in the deck: benches/peers/calculix.py no longer knows what condyle writes")
        text = text.replace(old, new)
    return text


def run(job, limit_s):
    """Runs ccx on a job in its folder; its processor time, s."""
    before = processor_s()
    environment = dict(os.environ, OMP_NUM_THREADS="1")

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s))

    with open(job.with_suffix(".log"), "w", encoding="utf-8") as log:
        subprocess.run(["ccx", job.name], cwd=job.parent, env=environment, stdout=log, check=False, preexec_fn=limit)
    return processor_s() - before


def calculix(deck, iterative, limit_s):
    """Runs ccx on a deck; the Step or None at the end of every step by its name, and the processor time, s."""
    job = deck.with_name(deck.stem + "-calculix")
    text = for_calculix(deck.read_text(encoding="ascii"), iterative)
    job.with_suffix(".inp").write_text(text, encoding="ascii")
    seconds = run(job, limit_s)
    forces, pressures, strains = {}, {}, {}
    if job.with_suffix(".dat").exists() and job.with_suffix(".frd").exists():
        dat = job.with_suffix(".dat").read_text(encoding="ascii")
        forces, strains = total_forces(dat), highest_strains(dat)
        with open(job.with_suffix(".frd"), encoding="ascii") as frd:
            pressures = highest_pressures(frd)
    found = {}
    for time, name in enumerate(re.findall(r"^\*STEP, NAME=(\w+)", text, re.MULTILINE), start=1):
        ended = time in forces and time in pressures
        found[name] = Step(*forces[time], pressures[time], strains.get(time, 0.0)) if ended else None
    return found, seconds


def beside(own, their, digits):
    """Both sides and by how much condyle is off."""
    off = f"{100 * (own / their - 1):+6.2f} %" if their else ""
    return f"{own:9.{digits}f} {their:9.{digits}f} {off:>8}"


def show(name, row, theirs):
    """Lines of the table; `theirs` is a Step and the time of all steps, or the word for why there is nothing."""
    place = row.get("place") or f"{float(row['percent']):.1f} %"
    own_n, own_mpa, peak_mpa = -float(row["force_y_n"]), float(row["highest_node_mpa"]), float(row["peak_mpa"])
    head, own_s = f"{name:8} {place:8} |", float(row["time_s"])
    if isinstance(theirs, str):
        print(f"{head} {own_n:9.2f} {theirs:>18} | {own_mpa:9.3f} {'':18} {peak_mpa:7.3f} | {own_s:8.4f}", flush=True)
        return
    step, seconds = theirs
    print(
        f"{head} {beside(own_n, step.force_y_n, 2)} | {beside(own_mpa, step.pressure_mpa, 3)} {peak_mpa:7.3f} |"
        f" {own_s:8.4f} {seconds:8.1f}",
        flush=True,
    )
    if row.get("step") == "SLID":
        print(f"{head} {beside(float(row['force_x_n']), -step.force_x_n, 2)} | N forward", flush=True)
    if row.get("plastic_strain"):
        print(
            f"{head} {beside(1e4 * float(row['plastic_strain']), 1e4 * step.plastic_strain, 2)} | plastic strain, 1e-4,"
            f" largest at a Gauss point; of an elastic insert {-float(row['elastic_force_y_n']):.2f} N"
            f" and {float(row['elastic_node_mpa']):.3f} MPa",
            flush=True,
        )


def of_deck(rows, steps):
    """The rows that a deck of these steps answers, and the others."""
    if len(steps) == 1:
        return rows[:1], rows[1:]
    return [row for row in rows if row["step"] in steps], [row for row in rows if row["step"] not in steps]


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
    left = rows
    for deck in words.decks:
        steps, seconds = calculix(deck, words.iterative, words.limit)
        here, left = of_deck(left, steps)
        for row in here:
            step = steps[row.get("step") or "PRESSED"]
            show(words.name, row, (step, seconds) if step else f"not finished, {seconds:.0f} s")
    for row in left:
        show(words.name, row, "not asked")
    if "since_start_s" in rows[-1]:
        print(
            f"{words.name:8} condyle has all in {float(rows[-1]['since_start_s']):.2f} s, with the case read and its first cycle solved"
        )


if __name__ == "__main__":
    main()
