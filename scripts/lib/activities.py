"""The tables of docs/src/activities-and-creep.md. Usage: activities.py FOLDER, which holds the runs of scripts/evidence.d/58-activities."""

import csv
import json
import sys
from pathlib import Path

LAWS = ["archard", "kang", "contact-area", "unified", "directional"]
SHARES = {"gait": 0.85, "stairs": 0.15}
# The smallest change of volume or depth that is significant relative to the discretisation error of a run, %.
TOLD = 1.0


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def wear(folder):
    with open(folder / "wear.csv", newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def rate(folder):
    return summary(folder)["wear_laws"][0]["mass_loss_mg_per_million_cycles"]


def print_row(cells):
    print(f"| {' | '.join(cells)} |")


def print_head(cells):
    print_row(cells)
    print_row(["---"] * len(cells))


def percent(part, whole):
    return f"{100 * (part / whole - 1):+.1f} %"


def adding_up(runs):
    print(
        "**Additivity of the wear of activities.** `gait-and-stairs`, in mg per million cycles, with each law changing the surface: "
        "each activity in its own test, their sum weighted by shares, and both in one test, relative to this sum. The last column "
        "compares the wear of the common test with that of activities with separate principal directions on the same surfaces: "
        "the effect of the directions alone.\n"
    )
    print_head(["law", "gait alone", "stairs alone", "sum by shares", "both in one test", "of the sum", "directions alone"])
    for law in LAWS:
        alone = {name: rate(runs / f"{law}-{name}") for name in SHARES}
        summed = sum(SHARES[name] * alone[name] for name in SHARES)
        both = rate(runs / f"{law}-both")
        found = summary(runs / f"{law}-both")
        own = sum(activity["volume_loss_alone_mm3"] for activity in found["activities"])
        numbers = [f"{value:.2f}" for value in (alone["gait"], alone["stairs"], summed, both)]
        print_row([f"`{law}`", *numbers, percent(both, summed), percent(found["volume_loss_mm3"], own)])
    print()


def row(finding, case, found, holds, why=""):
    print_row([finding, case, found, "yes" if holds else "no", why])


def in_vivo(runs):
    if not (runs / "in-vivo").exists():
        return
    iso, measured, same_load = (rate(runs / name) for name in ("iso-motion", "in-vivo", "in-vivo-iso-load"))
    row(
        "walking measured in vivo wears more than the ISO cycle",
        "`in-vivo-walking` against `stanmore-displacement` with `iso-like` load",
        f"{measured:.1f} against {iso:.1f} mg per million cycles; with the ISO-like load {same_load:.1f}",
        measured > iso,
        "Reinders 2015 found three times as much, Dreyer 2023 2.8 times. Here load and motion are of two people, on a generic implant.",
    )


def creep(runs):
    first = next(row for row in wear(runs / "creep") if row["cycles"] >= 5e5)
    crept, worn = first["creep_at_max_penetration_mm"], first["wear_at_max_penetration_mm"]
    row(
        "creep dominates the first half million cycles",
        "`creep`",
        f"after {first['cycles']:.0f} cycles the deepest place has receded by {crept:.3f} mm by creep and by {worn:.3f} mm by wear",
        crept > worn,
    )
    last, found = wear(runs / "creep")[-1], summary(runs / "creep")
    row(
        "wear dominates the rest of the test",
        "`creep`",
        f"from there to the end creep adds {last['max_creep_mm'] - first['max_creep_mm']:.3f} mm at most, wear "
        f"{last['max_depth_mm'] - first['max_depth_mm']:.3f} mm",
        last["max_depth_mm"] - first["max_depth_mm"] > last["max_creep_mm"] - first["max_creep_mm"],
    )
    slope = (last["max_depth_mm"] - at_million(runs)["max_depth_mm"]) / (last["cycles"] - 1e6) * 1e6
    rise = found["scan_rise_mm_per_million_cycles"]
    row(
        "the rise of scans from a million cycles on is the rate of wear",
        "`creep`",
        f"{rise:.4f} mm per million cycles, compared with {slope:.4f} mm of wear at its deepest; {found['scan_at_no_cycles_mm']:.3f} mm at no cycles",
        abs(rise / slope - 1) < 0.05,
        "Within 5 % counts as yes.",
    )
    without = summary(runs / "plus")
    row(
        "creep does not change the mass loss",
        "`creep` against `knight-2007` with `ap_force_sign = 1`",
        f"{last['mass_loss_mg']:.1f} against {without['mass_loss_mg']:.1f} mg",
        abs(last["mass_loss_mg"] / without["mass_loss_mg"] - 1) < TOLD / 100,
        "Creep, like wear, makes the insert conform, and the femur slides farther.",
    )


def at_million(runs):
    return next(row for row in wear(runs / "creep") if row["cycles"] >= 1e6)


def turned(runs):
    plain = summary(runs / "plus")
    for name, key in [("ap-turned", "ap_force_sign"), ("ie-turned", "ie_torque_sign")]:
        other = summary(runs / name)
        volume = 100 * (other["volume_loss_mm3"] / plain["volume_loss_mm3"] - 1)
        depth = 100 * (other["max_depth_mm"] / plain["max_depth_mm"] - 1)
        row(
            f"reversing an input changes scar and volume: `{key} = -1`",
            "`knight-2007` with `ap_force_sign = 1`",
            f"volume {volume:+.1f} %, deepest place {depth:+.1f} %",
            abs(volume) > TOLD and abs(depth) > TOLD,
        )


def main():
    runs = Path(sys.argv[1])
    adding_up(runs)
    print("**Known findings on knees**, and their agreement with the model:\n")
    print_head(["finding", "case", "model", "agrees", "remark"])
    in_vivo(runs)
    creep(runs)
    turned(runs)


main()
