"""Rates of knees and hips by the law `power-law` on a grid of its constants, mg a million cycles, each law moving the surface itself.

Usage: rates.py CONDYLE RUNS OUT. Writes OUT as JSON: by test a row per exponent of pressure, with the columns of
the saturating form (its saturations, then no cross-shear) and of powers.
"""

import json
import os
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from model import CIRCLE_FACTOR, EXPONENTS, ISO_HIPS, KNEES, POWERS, SATURATIONS

sys.path.append(str(Path(__file__).parents[1] / "published"))
from knees import KNEES as CASES
from knees import Runs

TRANSLATIONS = ["lateral", "anterior", "penetration"]
HIPS = {name: ("hip-iso", [f"machine.order={json.dumps([*TRANSLATIONS, *order])}"]) for name, order in ISO_HIPS.items()}
HIPS["orbital-28"] = ("../validation/prediction/hip-orbital", [])
HIPS["orbital-22"] = ("../validation/prediction/hip-orbital", ["femur.radius_mm=11", "insert.radius_mm=11.1"])
# A saturation far above any cross-shear leaves a plain power.
UNSATURATED = 1000.0


def constants():
    """Those of cross-shear: exponent, saturation and part on a line."""
    saturating = [(1.0, saturation, 0.0) for saturation in SATURATIONS] + [(0.0, UNSATURATED, 1.0)]
    return {"saturating": saturating, "power": [(power, UNSATURATED, 0.0) for power in POWERS]}


def main():
    condyle, folder, out = sys.argv[1:]
    tests = {f"{knee} {condition}": CASES[knee][condition] for knee in KNEES for condition in ("stable", "unstable")} | HIPS
    jobs = [
        (test, form, exponent, each)
        for test in tests
        for form, own in constants().items()
        for exponent in EXPONENTS
        for each in own
    ]

    def rate(number):
        test, _, exponent, (power, saturation, line) = jobs[number]
        case, changes = tests[test]
        own = [
            "wear.law=power-law",
            f"wear.circle_factor_mm3_per_nm={CIRCLE_FACTOR}",
            f"wear.pressure_exponent={exponent}",
            f"wear.cross_shear_exponent={power}",
            f"wear.cross_shear_saturation={saturation}",
            f"wear.line_factor_ratio={line}",
        ]
        place = Path(folder) / str(number)
        place.mkdir()
        summary = Runs(condyle, place).summary(case, [*changes, *own])
        # Some hundred results folders would fill 10 GB.
        shutil.rmtree(place)
        return summary["wear_laws"][0]["mass_loss_mg_per_million_cycles"]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(rate, range(len(jobs))))
    rates = {}
    for (test, form, exponent, _), each in zip(jobs, found, strict=True):
        rows = rates.setdefault(form, {}).setdefault(test, {})
        rows.setdefault(f"{exponent:g}", []).append(each)
    Path(out).write_text(json.dumps(rates, indent=1) + "\n", encoding="utf-8")


main()
