"""Runs the shipped cases of hips and discs with the default law, and compares their intervals with published rates.

Usage: simulators.py CONDYLE RUNS OUT. Writes a table in Markdown. Volumes of the sources were converted with 0.93 mg/mm3. A row is
inside where the measured mean lies in the run's 90 % interval of laboratories.
"""

import csv
import sys
from pathlib import Path

from knees import Runs
from tables import head, line, number


def row(runs, test):
    summary = runs.summary(test["case"], test["changes"].split())
    millions = summary["cycles"] / 1e6
    interval = summary["prediction"]["mass_loss_mg"]
    low, median, high = (interval[key] / millions for key in ("low", "median", "high"))
    measured = float(test["measured"])
    verdict = "yes" if low <= measured <= high else "**no**"
    doubts = ", ".join(f"`{doubt['check']}`" for doubt in summary["plausibility"])
    return line(
        [
            f"{test['what']} [{test['source']}]",
            f"{number(measured)} ({number(float(test['low']))} to {number(float(test['high']))})",
            f"{number(median)} ({number(low)} to {number(high)})",
            f"{median / measured:.2f}",
            verdict,
            doubts,
            test["assumed"],
        ]
    )


def main():
    condyle, folder, out = sys.argv[1:]
    runs = Runs(condyle, folder)
    with open(Path(__file__).parent / "simulators.csv", newline="", encoding="utf-8") as file:
        tests = list(csv.DictReader(file))
    names = ["test", "measured, mg/Mc", "predicted, mg/Mc", "over measured", "inside 90 %", "doubts of the run", "assumed"]
    Path(out).write_text(head(names) + "".join(row(runs, test) for test in tests), encoding="utf-8")


main()
