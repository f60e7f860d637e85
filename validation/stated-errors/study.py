"""Compares the stated discretisation errors of forty varied cases with what finer runs change.

    study.py CONDYLE DATA OUT

DATA is the folder of the real implants; without it only generic implants run. A finer run has half the edge length, twice
the layers and increments, and four times the updates. OUT gets results.csv, a row per case and quantity, and table.md.
"""

import csv
import json
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

QUANTITIES = {
    "mass_loss_mg": "mass loss",
    "max_depth_mm": "maximum depth",
    "peak_pressure_mpa": "peak pressure",
    "peak_contact_area_mm2": "largest contact area",
    "peak_von_mises_mpa": "von Mises stress below the surface",
    "peak_max_shear_mpa": "shear stress below the surface",
    "ap_range_mm": "AP range",
    "ie_range_deg": "IE range",
}
# Name, base case, settings, whether it needs the real implants, edges in mm, and the number of cases.
KINDS = [
    ("foundation", "stanmore-force", [], (1.2, 3.0), 14),
    ("displacement", "stanmore-displacement", [], (1.2, 3.0), 4),
    ("creep", "creep", [], (1.2, 3.0), 4),
    ("deformable", "stanmore-force", ["contact.model=deformable"], (2.0, 3.0), 6),
    ("plastic", "stanmore-force", ["contact.model=deformable", "contact.deformable.plasticity=j2"], (2.4, 3.0), 3),
    ("dm", "dm-knee", [], (1.2, 2.5), 4),
    ("cad", "cad-knee", [], (1.2, 2.5), 3),
    ("hip", "hip-iso", [], (1.2, 2.5), 2),
]
NEEDS_DATA = {"dm-knee"}


def cases():
    """Name, base case, settings, and the settings of the finer run; the same on every machine."""
    draw = random.Random("condyle stated errors")
    for kind, base, own, (least_mm, most_mm), count in KINDS:
        for number in range(count):
            edge_mm = round(draw.uniform(least_mm, most_mm), 2)
            increments, updates = draw.randint(80, 200), draw.randint(5, 12)
            settings = [
                *own,
                f"machine.frequency_hz={draw.uniform(0.9, 1.2):.2f}",
                f"contact.friction={draw.uniform(0.02, 0.1):.3f}",
            ]
            if base in ("stanmore-force", "stanmore-displacement", "creep"):
                settings += [
                    f"insert.sagittal_radius_mm={draw.uniform(42, 75):.1f}",
                    f"insert.coronal_radius_mm={draw.uniform(27, 38):.1f}",
                    f"insert.thickness_mm={draw.uniform(7, 12):.1f}",
                ]
            elif base == "hip-iso":
                settings.append(f"insert.radius_mm={draw.uniform(14.05, 14.3):.2f}")

            def mesh(edge_mm, layers, increments, updates):
                steps = [f"time.increments={increments}", f"march.updates={updates}"]
                return [f"insert.edge_mm={edge_mm}", f"insert.layers={layers}", *steps]

            yield (
                f"{kind} {number + 1}",
                base,
                [*settings, *mesh(edge_mm, 4, increments, updates)],
                [*settings, *mesh(edge_mm / 2, 8, 2 * increments, 4 * updates), "accuracy.estimate=false"],
            )


def summary(condyle, base, settings):
    """That of a run; none if it cannot be solved."""
    with tempfile.TemporaryDirectory() as folder:
        sets = [word for setting in settings for word in ("--set", setting)]
        command = [condyle, "run", f"cases/{base}.toml", *sets, "--out", f"{folder}/results"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            print(f"{base} {settings}: {ran.stderr}", file=sys.stderr)
            return None
        return json.loads((Path(folder) / "results" / "summary.json").read_text())


def compared(condyle, name, base, settings, finer):
    """Rows of a case: quantity, stated error and change in the finer run, %, and the doubts of the run."""
    coarse, fine = summary(condyle, base, settings), summary(condyle, base, finer)
    if coarse is None or fine is None:
        return []
    doubts = " ".join(doubt["check"] for doubt in coarse["plausibility"])
    rows = []
    for key in QUANTITIES:
        error = coarse["error"].get(f"{key.rsplit('_', 1)[0]}_percent")
        if error and error["total"] is not None and coarse.get(key):
            change = 100 * (fine[key] / coarse[key] - 1)
            rows.append([name, key, f"{error['total']:.3f}", f"{change:.3f}", doubts])
    return rows


def table(rows):
    lines = ["| quantity | cases | within half the stated error | within the stated error | within twice | largest change |"]
    lines.append("| --- | ---: | ---: | ---: | ---: | ---: |")
    for key, label in [*QUANTITIES.items(), (None, "all")]:
        of_key = [(float(stated), abs(float(change))) for _, each, stated, change, _ in rows if key in (None, each)]
        if of_key:
            within = [f"{sum(change <= factor * stated for stated, change in of_key)}" for factor in (0.5, 1, 2)]
            largest = max(change for _, change in of_key)
            lines.append(f"| {label} | {len(of_key)} | {' | '.join(within)} | {largest:.1f} % |")
    return "\n".join(lines) + "\n"


def main():
    condyle, data, out = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    chosen = [case for case in cases() if data.exists() or case[1] not in NEEDS_DATA]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda case: compared(condyle, *case), chosen)
    rows = [row for rows in found for row in rows]
    out.mkdir(parents=True, exist_ok=True)
    with (out / "results.csv").open("w", newline="", encoding="utf-8") as file:
        head = ["case", "quantity", "stated_percent", "change_percent", "doubts"]
        csv.writer(file, lineterminator="\n").writerows([head, *rows])
    (out / "table.md").write_text(table(rows), encoding="utf-8")
    print(table(rows))


if __name__ == "__main__":
    main()
