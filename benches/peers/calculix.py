"""CalculiX beside condyle: a ball pressed on a block and slid, the generic insert under the femur at places of the gait.

python calculix.py FOLDER NAME CONDYLE.csv DECK.inp... [--iterative]

Runs ccx on every deck, a row of CONDYLE.csv each (the block's deck has a row a step), and prints both sides. With
--iterative CalculiX solves by preconditioned conjugate gradients, which knows no friction but is several times quicker
here; else by its own default.
"""

import csv
import os
import re
import resource
import subprocess
import sys
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


def calculix(deck, iterative):
    """Runs ccx; rows of (time, force, highest pressure) at the end of every step, and its processor time, s."""
    job = deck.with_suffix("")
    text = deck.read_text(encoding="ascii")
    if iterative:
        job = deck.with_name(deck.stem + "-iterative")
        text = text.replace("*STATIC\n", "*STATIC, SOLVER=ITERATIVE CHOLESKY\n")
        job.with_suffix(".inp").write_text(text, encoding="ascii")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    with open(job.with_suffix(".log"), "w", encoding="utf-8") as log:
        subprocess.run(["ccx", job.name], cwd=deck.parent, env=environment, stdout=log, check=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    forces = total_forces(job.with_suffix(".dat").read_text(encoding="ascii"))
    with open(job.with_suffix(".frd"), encoding="ascii") as frd:
        pressures = highest_pressures(frd)
    ends = [row for row in forces if row[0] == round(row[0])]
    return [(force[1:], pressures[min(pressures, key=lambda time: abs(time - force[0]))]) for force in ends], seconds


def main():
    words = [word for word in sys.argv[1:] if word != "--iterative"]
    name, ours, decks = words[0], words[1], words[2:]
    with open(ours, newline="", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    number = 0
    for deck in decks:
        steps, seconds = calculix(Path(deck), "--iterative" in sys.argv)
        for force_n, peak_mpa in steps:
            row = rows[number]
            number += 1
            place = row.get("step") or f"{float(row['percent']):.1f} %"
            own_n, own_mpa = -float(row["force_y_n"]), float(row["highest_node_mpa"])
            their_n = force_n[1]
            print(f"{name:8} {place:8} | {own_n:9.2f} {their_n:9.2f} {100 * (own_n / their_n - 1):+6.2f} % |"
                  f" {own_mpa:7.3f} {peak_mpa:7.3f} {100 * (own_mpa / peak_mpa - 1):+6.2f} % {float(row['peak_mpa']):7.3f} |"
                  f" {float(row['time_s']):8.4f} {seconds:8.1f}", flush=True)


if __name__ == "__main__":
    main()
