"""The tables and pictures of docs/src/three-models.md.

Usage: three_models.py implants NAME=FOLDER..., dishes NAME=FOLDER..., layers NAME=FOLDER..., or pictures OUT FOLDER.

An implant's folder contains the runs `foundation`, `deformable` and `plastic`, each with its processor time in `NAME.seconds`; that of
a dish or a layer contains the first two.
"""

import csv
import json
import math
import re
import struct
import sys
from pathlib import Path

MODELS = ("foundation", "deformable", "plastic")
COLOURS = {"foundation": "#d55e00", "deformable": "#0072b2", "plastic": "#009e73"}
WORDS = {"foundation": "foundation", "deformable": "deformable", "plastic": "deformable, yields"}


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def first_cycle(folder):
    with open(folder / "kinematics.csv") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return [row for row in rows if row["cycles"] == rows[0]["cycles"]]


def rms(one, other, key):
    squares = [(a[key] - b[key]) ** 2 for a, b in zip(one, other)]
    return math.sqrt(sum(squares) / len(squares))


def print_row(cells):
    print(f"| {' | '.join(cells)} |")


def print_head(cells):
    print_row(cells)
    print_row(["---"] * len(cells))


def implants(folders):
    print_head(
        ["case", "insert", "peak, first and last cycle, MPa", "area, mm2", "mass, mg", "deepest wear, mm"]
        + ["difference of AP, mm; IE, deg", "permanent set, mm", "processor, s"]
    )
    for name, folder in folders:
        exact = first_cycle(folder / "deformable")
        for model in MODELS:
            numbers, rows = summary(folder / model), first_cycle(folder / model)
            permanent = numbers.get("max_permanent_set_mm")
            print_row(
                [
                    f"`{name}`",
                    WORDS[model],
                    f"{numbers['first_cycle_peak_pressure_mpa']:.1f}, {numbers['last_cycle_peak_pressure_mpa']:.1f}",
                    f"{numbers['first_cycle_contact_area_mm2']:.0f}, {numbers['last_cycle_contact_area_mm2']:.0f}",
                    f"{numbers['mass_loss_mg']:.2f}",
                    f"{numbers['max_depth_mm']:.3f}",
                    f"{rms(rows, exact, 'ap_mm'):.3f}; {rms(rows, exact, 'ie_deg'):.3f}",
                    f"{permanent:.4f}" if model == "plastic" and permanent is not None else "",
                    f"{float((folder / f'{model}.seconds').read_text()):.1f}",
                ]
            )


def both_models(folder):
    """First cycle's peak, MPa, and area, mm2, of both models."""
    numbers = [summary(folder / model) for model in MODELS[:2]]
    return [(one["first_cycle_peak_pressure_mpa"], one["first_cycle_contact_area_mm2"]) for one in numbers]


def changed(what, folders):
    print_head([what, "peak, MPa: foundation, deformable", "ratio", "area, mm2", "ratio"])
    for name, folder in folders:
        (peak, area), (exact_peak, exact_area) = both_models(folder)
        row = [name, f"{peak:.1f}, {exact_peak:.1f}", f"{peak / exact_peak:.2f}"]
        print_row([*row, f"{area:.0f}, {exact_area:.0f}", f"{area / exact_area:.2f}"])


def points_of(vtu):
    """Positions of the nodes of a .vtu file of condyle, whose numbers stand raw behind its text."""
    data = vtu.read_bytes()
    offset = int(re.search(rb'Name="Points" NumberOfComponents="3" format="appended" offset="(\d+)"', data)[1])
    start = data.index(b"_", data.index(b"<AppendedData")) + 1 + offset
    (size,) = struct.unpack_from("<Q", data, start)
    numbers = struct.unpack_from(f"<{size // 8}d", data, start + 8)
    return list(zip(numbers[::3], numbers[1::3], numbers[2::3]))


def pressures_at(folder, percent):
    """Where nodes press in the first cycle at a percent of it, and with how much: x, z, MPa."""
    points = points_of(folder / "insert_0000.vtu")
    with open(folder / "cycle_first_pressure.csv") as file:
        rows = [row for row in csv.DictReader(file) if float(row["percent"]) == percent]
    return [(points[int(row["node"])][0], points[int(row["node"])][2], float(row["pressure_mpa"])) for row in rows]


def pictures(out, folder):
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update(
        {"svg.hashsalt": "condyle", "font.size": 10, "axes.spines.top": False, "axes.spines.right": False}
    )
    import matplotlib.pyplot as plt

    def save(figure, name):
        figure.tight_layout()
        figure.savefig(out / name, metadata={"Date": None})

    names = [name for name in ("knight-2007", "dm-knee") if (folder / name).exists()]
    figure, all_axes = plt.subplots(2, len(names), figsize=(4.6 * len(names), 5.2), sharex=True, squeeze=False)
    for column, name in zip(all_axes.T, names):
        for model in MODELS:
            rows = first_cycle(folder / name / model)
            percent = [row["percent"] for row in rows]
            style = {"color": COLOURS[model], "label": WORDS[model], "linestyle": "--" if model == "plastic" else "-"}
            column[0].plot(percent, [row["peak_pressure_mpa"] for row in rows], **style)
            column[1].plot(percent, [row["contact_area_mm2"] for row in rows], **style)
        column[0].set(title=name, ylabel="peak pressure, MPa", ylim=(0, None))
        column[1].set(xlabel="gait cycle, %", ylabel="contact area, mm2", ylim=(0, None))
    all_axes[1][0].legend(frameon=False, loc="upper right")
    save(figure, "cycle.svg")

    figure, all_axes = plt.subplots(1, 2, figsize=(9.2, 3.2), sharey=True)
    for axes, what, label in zip(all_axes, ("dishes", "layers"), ("radius of the dish from the front, mm", "thickness, mm")):
        runs = sorted((float(run.name.split(",")[0]), both_models(run)) for run in (folder / what).iterdir() if run.is_dir())
        radii_or_mm = [number for number, _ in runs]
        at = list(range(len(runs))) if what == "dishes" else radii_or_mm
        over = [[found[i] / exact[i] for _, (found, exact) in runs] for i in range(2)]
        axes.plot(at, over[0], "o-", color=COLOURS["foundation"], label="peak pressure")
        axes.plot(at, over[1], "s--", color="#555555", label="contact area")
        axes.axhline(1.0, color="#bbbbbb", linewidth=1)
        axes.set(xlabel=label, ylim=(0.7, 1.65))
        if what == "dishes":
            axes.set(ylabel="foundation over deformable", xticks=at, xticklabels=[f"{radius:g}" for radius in radii_or_mm])
    all_axes[0].legend(frameon=False)
    save(figure, "conformity-and-thickness.svg")

    if "dm-knee" in names:
        rows = first_cycle(folder / "dm-knee" / "foundation")
        percent = max(rows, key=lambda row: row["peak_pressure_mpa"])["percent"]
        by_model = {model: pressures_at(folder / "dm-knee" / model, percent) for model in MODELS}
        x, z, _ = max(by_model["foundation"], key=lambda node: node[2])
        figure, (along, across) = plt.subplots(1, 2, figsize=(9.2, 3.2), sharey=True)
        for model, nodes in by_model.items():
            style = {
                "color": COLOURS[model],
                "label": WORDS[model],
                "linestyle": "--" if model == "plastic" else "-",
                "marker": ".",
            }
            near = sorted((node[0], node[2]) for node in nodes if abs(node[1] - z) < 0.55)
            along.plot(*zip(*near), **style)
            near = sorted((node[1], node[2]) for node in nodes if abs(node[0] - x) < 0.55 and abs(node[1] - z) < 15)
            across.plot(*zip(*near), **style)
        along.set(
            xlabel="x (anterior), mm", ylabel="pressure, MPa", title=f"dm-knee at {percent:g} % of the cycle", ylim=(0, None)
        )
        across.set(xlabel="z (right), mm")
        along.legend(frameon=False)
        save(figure, "edge.svg")


def main():
    what, *given = sys.argv[1:]
    if what == "pictures":
        pictures(*map(Path, given))
        return
    folders = [(name, Path(folder)) for name, folder in (argument.split("=", 1) for argument in given)]
    if what == "implants":
        implants(folders)
    else:
        changed({"dishes": "dish, front and side, mm", "layers": "thickness, mm"}[what], folders)


main()
