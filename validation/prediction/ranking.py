"""Compares stated probabilities of a ranking with what simulated laboratories find.

Usage: ranking.py CONDYLE OUT. Runs random designs with the default law, each of which states its mass by draws of the
posterior; of two designs this gives the part of laboratories in which one wears less. Each simulated laboratory has a law of its
own, a draw that the runs do not use, which moves the surface itself, and settings that scatter as in `condyle uncertainty`: those
of its machine are the same for all designs that it tests, those of the parts and their set-up are not. Writes OUT, a table of
stated probabilities with the part of laboratories that agree.
"""

import csv
import itertools
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

DESIGNS, LABORATORIES = 24, 40
# Every draw whose number is a multiple of this is one of those by which a run states its mass.
OF_RUN = 5
CASE = "cases/stanmore-force.toml"
# Of the logarithm of the mass, by the inputs of a test; as in crates/condyle-results/src/prediction.rs.
INPUTS_LOG_SD = 0.08
# Standard deviations of crates/condyle-study/src/scatters.csv. Of a laboratory, as a part of the value:
FRICTION, AXIAL_FORCE, AP_FORCE, SPRINGS, YOUNGS_MODULUS = 0.2, 0.02, 0.02, 0.05, 0.1
# Of every set-up, around these values:
SET_UP = {
    "femur.flexion_deg": (0, 0.5),
    "femur.external_rotation_deg": (0, 0.5),
    "insert.posterior_slope_deg": (0, 0.5),
    "insert.axial_rotation_deg": (0, 0.5),
    "machine.vv_axis_medial_mm": (5, 0.5),
    "machine.springs.free_play_mm": (2.5, 0.25),
}


def designs(draw):
    for _ in range(DESIGNS):
        yield [
            f"insert.sagittal_radius_mm={draw.uniform(42, 75):.1f}",
            f"insert.coronal_radius_mm={draw.uniform(27, 38):.1f}",
            f"insert.thickness_mm={draw.uniform(7, 12):.1f}",
            f"femur.distal_radius_mm={draw.uniform(33, 40):.1f}",
        ]


def laboratories(draw):
    lines = Path("crates/condyle-results/src/posterior.csv").read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    unused = [row for number, row in enumerate(rows) if number % OF_RUN]

    def scattered(mean, part):
        return f"{mean * max(0.2, draw.gauss(1, part)):.4g}"

    for law in draw.sample(unused, LABORATORIES):
        yield [
            *(f"wear.{key}={value}" for key, value in law.items() if key != "laboratory_factor"),
            f"contact.friction={scattered(0.07, FRICTION)}",
            f"machine.axial_force.scale={scattered(1, AXIAL_FORCE)}",
            f"machine.ap_force.scale={scattered(1, AP_FORCE)}",
            f"machine.springs.posterior_n_per_mm={scattered(33.8, SPRINGS)}",
            f"material.youngs_modulus_mpa={scattered(463, YOUNGS_MODULUS)}",
        ]


def summary(condyle, settings):
    with tempfile.TemporaryDirectory() as folder:
        sets = [word for setting in [*settings, "accuracy.estimate=false"] for word in ("--set", setting)]
        subprocess.run([condyle, "run", CASE, *sets, "--out", f"{folder}/run"], check=True, capture_output=True)
        return json.loads((Path(folder) / "run" / "summary.json").read_text())


def main():
    condyle, out = sys.argv[1:]
    draw = random.Random("condyle ranking")
    of_designs, of_laboratories = list(designs(draw)), list(laboratories(draw))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        stated = list(pool.map(lambda design: summary(condyle, design)["prediction"]["mass_loss_mg_by_draw"], of_designs))
        tests = [
            [*design, *laboratory, *(f"{key}={draw.gauss(*scatter):.3f}" for key, scatter in SET_UP.items())]
            for design, laboratory in itertools.product(of_designs, of_laboratories)
        ]
        masses = list(pool.map(lambda test: summary(condyle, test)["mass_loss_mg"], tests))
    weighed = [masses[first : first + LABORATORIES] for first in range(0, len(masses), LABORATORIES)]

    def part_below(own, other):
        """As `Prediction::part_below` of crates/condyle-results."""
        parts = [1 / (1 + math.exp(-1.702 * math.log(y / x) / INPUTS_LOG_SD)) for x, y in zip(own, other, strict=True)]
        return sum(parts) / len(parts)

    bins = {}
    for a, b in itertools.combinations(range(DESIGNS), 2):
        own = part_below(stated[a], stated[b])
        found = sum(x < y for x, y in zip(weighed[a], weighed[b], strict=True)) / LABORATORIES
        # The design that more laboratories are stated to prefer.
        own, found = (own, found) if own >= 0.5 else (1 - own, 1 - found)
        bins.setdefault(min(int(10 * own), 9), []).append((own, found))
    lines = ["| stated | pairs | mean of the stated | laboratories that agree |", "| --- | ---: | ---: | ---: |"]

    def row(label, pairs):
        means = [100 * sum(pair[i] for pair in pairs) / len(pairs) for i in (0, 1)]
        lines.append(f"| {label} | {len(pairs)} | {means[0]:.0f} % | {means[1]:.0f} % |")

    for tenth in sorted(bins):
        row(f"{10 * tenth} to {10 * tenth + 10} %", bins[tenth])
    row("all", [pair for pairs in bins.values() for pair in pairs])
    Path(out).write_text("\n".join(lines) + "\n")
    print(Path(out).read_text())


if __name__ == "__main__":
    main()
