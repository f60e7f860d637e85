"""Compares every wear law with published measurements.

Usage: study.py LAWS_ON_PATHS CONDYLE RUNS OUT. Writes table.md, findings.md, results.json and ratios.svg into OUT. Nothing
is tuned: laws have their default constants, and a calibrated law is calibrated on the one source that is named.
"""

import csv
import json
import math
import sys
from pathlib import Path

import knees
import picture
from closed_forms import Laws
from findings import findings
from tables import head, line, number

HERE = Path(__file__).parent
# Tests with a level of their own, whose source also says how far specimens scatter.
SOURCES = ["pins", "haider", "stable", "unstable"]
IN_A_KNEE = {"haider": "stable", "stable": "stable", "unstable": "unstable", "dreyer": "stable"}


def measured():
    with open(HERE / "measured.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["value"] = float(row["value"])
        row["scatter"] = float(row["scatter"]) / 100.0 if row["scatter"] else None
    return {row["test"]: row for row in rows}


def predict(laws, rates, knee, law, times=1.0):
    """What a law that wears `times` as much as by its defaults says of every test, with one knee."""
    said = {
        "pins": times * laws.factor(law, "pins"),
        "ball": laws.ball(law, times),
        "random": laws.factor(law, "random") / laws.factor(law, "pins"),
    }
    own = rates[knee]
    said |= {test: times * own[condition][law] for test, condition in IN_A_KNEE.items()}
    if "measured gait" in own:
        said["in-vivo"] = said["walking"] = own["measured gait"][law] / own["stable"][law]
    return said


def is_inside(row, value, deviations=1.0):
    """Whether it is within what the source says of its scatter; none where it says nothing."""
    if row["scatter"] is None:
        return None
    return abs(value / row["value"] - 1.0) <= deviations * row["scatter"]


def shown(row, value):
    inside = is_inside(row, value)
    return number(value) + {None: "", True: " **in**", False: " out"}[inside]


def by_default(rows, said, words):
    text = head(["test", "measured", "with", *(f"`{word}`" for word in words)])
    for test, row in rows.items():
        scatter = f" +/- {100 * row['scatter']:.3g} %" if row["scatter"] else ""
        value = f"{number(row['value'])}{scatter} {row['unit']}"
        for knee in said:
            if test not in said[knee][words[0]] or (test in ("pins", "ball", "random") and knee != "generic"):
                continue
            with_knee = knee if test in IN_A_KNEE or test in ("in-vivo", "walking") else ""
            each = [shown(row, said[knee][word][test]) for word in words]
            text += line([f"{row['what']} [{row['source']}]", value, with_knee, *each])
    return text


def is_inside_both(row, value, source):
    """Whether it is within two standard deviations of both, the source that it was calibrated on and what was measured."""
    scatter = math.hypot(source["scatter"] * value, row["scatter"] * row["value"])
    return abs(value - row["value"]) <= 2.0 * scatter


def calibrated(rows, laws, rates, words):
    """For each law, knee and source: which of the other sources are predicted within their scatter."""
    counts = []
    for knee in rates:
        for source in SOURCES:
            for law in words:
                times = rows[source]["value"] / predict(laws, rates, knee, law)[source]
                said = predict(laws, rates, knee, law, times)
                others = [test for test in SOURCES if test != source]
                inside = {
                    test: [
                        is_inside(rows[test], said[test]),
                        is_inside(rows[test], said[test], 2),
                        is_inside_both(rows[test], said[test], rows[source]),
                    ]
                    for test in others
                }
                counts.append({"knee": knee, "source": source, "law": law, "times": times, "inside": inside, "said": said})
    return counts


def total(counts, tests=SOURCES):
    """How many predictions of these tests are inside, by each of the three rules, and how many there are."""
    inside = [each for count in counts for test, each in count["inside"].items() if test in tests]
    return [sum(rule) for rule in zip(*inside)], len(inside)


def counted(counts, words):
    text = head(["knee", "calibrated on", *(f"`{word}`" for word in words)])
    for knee in dict.fromkeys(count["knee"] for count in counts):
        for source in SOURCES:
            each = []
            for word in words:
                own = [c for c in counts if (c["knee"], c["source"], c["law"]) == (knee, source, word)]
                (one, two, both), of = total(own)
                each.append(f"{one} / {two} / {both} of {of}")
            text += line([knee, source, *each])
    return text + "\n" + totals(counts, words)


def totals(counts, words):
    """The counts over all knees and sources, by law: of everything, and of knees calibrated on knees."""
    text = head(["predicted", "rule", *(f"`{word}`" for word in words), "all"])
    in_knees = [test for test in SOURCES if test != "pins"]
    on_knees = [count for count in counts if count["source"] in in_knees]
    for what, own, tests in [("all sources", counts, SOURCES), ("knees calibrated on a knee", on_knees, in_knees)]:
        for rule, name in enumerate(["one deviation", "two", "two of both"]):
            cells = []
            for law in [*words, None]:
                inside, of = total([c for c in own if law in (c["law"], None)], tests)
                cells.append(f"{inside[rule]} of {of}")
            text += line([what, name, *cells])
    return text


def calibrated_values(rows, counts, words, source):
    """What the laws say once calibrated on one source, with the generic knee."""
    others = [test for test in SOURCES if test != source]
    text = head([f"calibrated on `{source}`", "times", *(f"{test}, measured {number(rows[test]['value'])}" for test in others)])
    for law in words:
        [count] = [c for c in counts if (c["knee"], c["source"], c["law"]) == ("generic", source, law)]
        each = [shown(rows[test], count["said"][test]) for test in others]
        text += line([f"`{law}`", f"{count['times']:.3g}", *each])
    return text


def main():
    program, condyle, folder, out = sys.argv[1:]
    laws, rows, runs = Laws(program), measured(), knees.Runs(condyle, folder)
    words = laws.words
    known = ["generic", *(knee for knee in ("dm", "cams") if Path(f"../shared/data/{knee}-knee").exists())]
    rates = knees.rates(runs, words, known)
    said = {knee: {law: predict(laws, rates, knee, law) for law in words} for knee in rates}
    counts = calibrated(rows, laws, rates, words)
    found, told = findings(laws, runs, rates, words)
    text = by_default(rows, said, words)
    text += "\n### Calibrated on one source\n\n" + (HERE / "calibrated.md").read_text() + "\n" + counted(counts, words)
    text += "\n" + calibrated_values(rows, counts, words, "haider") + "\n" + calibrated_values(rows, counts, words, "pins")
    text += "\n### Known findings\n\n" + found
    out = Path(out)
    (out / "table.md").write_text(text)
    (out / "ratios.svg").write_text(picture.svg(rows, said, words))
    results = {"said": said, "rates_mg_per_million_cycles": rates, "calibrated": counts, "findings": told}
    (out / "results.json").write_text(json.dumps(results, indent=1, default=float) + "\n")
    assert all(math.isfinite(value) for knee in said.values() for law in knee.values() for value in law.values())


main()
