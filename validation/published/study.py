"""Every wear law against measurements that anyone can read. Usage: study.py LAWS_ON_PATHS CONDYLE RUNS OUT

Writes table.md, findings.md, results.json and ratios.svg into OUT. Nothing is tuned: laws have the constants that a case
has which names none, and what is calibrated is calibrated on the one source that is named.
"""

import csv
import json
import math
import sys
from pathlib import Path

import knees
import picture
from closed_forms import LOAD_N, PIN_DIAMETERS_MM, Laws, area

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


def number(value):
    return f"{value:.2e}" if value < 1e-3 else f"{value:.3g}"


def shown(row, value):
    inside = is_inside(row, value)
    return number(value) + {None: "", True: " **in**", False: " out"}[inside]


def line(cells):
    return f"| {' | '.join(cells)} |\n"


def head(cells):
    return line(cells) + line(["---"] * len(cells))


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


def calibrated(rows, laws, rates, words):
    """For each law, knee and source: how many of the other sources are predicted within their scatter."""
    counts = []
    for knee in rates:
        for source in SOURCES:
            for law in words:
                times = rows[source]["value"] / predict(laws, rates, knee, law)[source]
                said = predict(laws, rates, knee, law, times)
                others = [test for test in SOURCES if test != source]
                inside = [sum(is_inside(rows[test], said[test], deviations) for test in others) for deviations in (1, 2)]
                counts.append({
                    "knee": knee, "source": source, "law": law, "times": times, "inside": inside, "others": len(others),
                    "said": said,
                })
    return counts


def counted(counts, words):
    text = head(["knee", "calibrated on", *(f"`{word}`" for word in words)])
    for knee in dict.fromkeys(count["knee"] for count in counts):
        for source in SOURCES:
            cells = {c["law"]: c for c in counts if (c["knee"], c["source"]) == (knee, source)}
            each = [f"{cells[w]['inside'][0]} / {cells[w]['inside'][1]} of {cells[w]['others']}" for w in words]
            text += line([knee, source, *each])
    most = sum(2 * count["inside"][0] > count["others"] for count in counts)
    inside = sum(count["inside"][0] for count in counts)
    of = sum(count["others"] for count in counts)
    text += f"\nIn all {inside} of {of} predictions are inside; most of the others in {most} of {len(counts)} calibrations.\n"
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


def is_linear(values):
    """Whether wear factors rise with the area, by half or more from end to end, along a line (r2 of 0.95)."""
    areas = [area(diameter) for diameter in PIN_DIAMETERS_MM]
    mean = [sum(all_of) / len(all_of) for all_of in (areas, values)]
    xx = sum((x - mean[0]) ** 2 for x in areas)
    yy = sum((y - mean[1]) ** 2 for y in values)
    xy = sum((x - mean[0]) * (y - mean[1]) for x, y in zip(areas, values))
    return values[-1] > 1.5 * values[0] and xy * xy > 0.95 * xx * yy


def yes(truth):
    return "yes" if truth else "no"


def findings(laws, runs, rates, words):
    """What is known of wear, and what each law says to it."""
    rows, numbers = [], {}
    pins = {word: laws.growing_pins(word) for word in words}
    rise = {word: max(pins[word]) / min(pins[word]) for word in words}
    rows.append((
        f"Pins under {LOAD_N:.0f} N: the factor rises linearly with the area from 3 to 30 mm [saikko2017]",
        "rises by half or more, along a line with r2 above 0.95; in brackets the largest over the least",
        [f"{yes(is_linear(pins[word]))} ({rise[word]:.3g})" for word in words],
    ))
    dishes = [runs.beside("stanmore-displacement", [
        f"insert.coronal_radius_mm={across}", f"insert.sagittal_radius_mm={along}"]) for across, along in knees.DISHES_MM]
    falls = {word: [dish[word] for dish in dishes] for word in words}
    rows.append((
        "Less conforming inserts wear less under the area and cross-shear laws",
        "falls from each dish to the next flatter one; in brackets the flattest over the most conforming",
        [f"{yes(all(a > b for a, b in zip(falls[w], falls[w][1:])))} ({falls[w][-1] / falls[w][0]:.2f})" for w in words],
    ))
    usual = runs.beside("stanmore-displacement", [])
    def largest(all_changes):
        said = [runs.beside("stanmore-displacement", changes) for changes in all_changes]
        return {word: max(abs(one[word] / usual[word] - 1.0) for one in said) for word in words}
    flexion, placement = largest(knees.FLEXION), largest(knees.PLACEMENT)
    rows.append((
        "Volume is very sensitive to flexion and hardly to placement [lin2009]",
        "10 % of flexion changes it by more than 2 degrees of slope or turn, or 1 of tilt; in brackets by how many percent",
        [f"{yes(flexion[w] > placement[w])} ({100 * flexion[w]:.1f}, {100 * placement[w]:.1f})" for w in words],
    ))
    numbers |= {"pins": pins, "dishes": falls, "flexion": flexion, "placement": placement}
    for knee, own in rates.items():
        ratio = {word: own["unstable"][word] / own["stable"][word] for word in words}
        rows.append((
            f"The {knee} knee wears more without its ligaments [pmc2014]",
            "measured 1.83 times as much",
            [f"{yes(ratio[w] > 1.0)} ({ratio[w]:.2f})" for w in words],
        ))
    text = head(["known", "the rule", *(f"`{word}`" for word in words)])
    return text + "".join(line([known, rule, *each]) for known, rule, each in rows), numbers


def main():
    program, condyle, folder, out = sys.argv[1:]
    laws, rows, runs = Laws(program), measured(), knees.Runs(condyle, folder)
    words = laws.words
    known = ["generic"] + (["dm"] if Path("../shared/data/dm-knee").exists() else [])
    rates = knees.rates(runs, words, known)
    said = {knee: {law: predict(laws, rates, knee, law) for law in words} for knee in rates}
    counts = calibrated(rows, laws, rates, words)
    found, numbers = findings(laws, runs, rates, words)
    text = by_default(rows, said, words)
    text += "\n### Calibrated on one source\n\n" + (HERE / "calibrated.md").read_text() + "\n" + counted(counts, words)
    text += "\n" + calibrated_values(rows, counts, words, "haider") + "\n" + calibrated_values(rows, counts, words, "pins")
    text += "\n### Known findings\n\n" + found
    out = Path(out)
    (out / "table.md").write_text(text)
    (out / "ratios.svg").write_text(picture.svg(rows, said, words))
    results = {"said": said, "rates_mg_per_million_cycles": rates, "calibrated": counts, "findings": numbers}
    (out / "results.json").write_text(json.dumps(results, indent=1, default=float) + "\n")
    assert all(math.isfinite(value) for knee in said.values() for law in knee.values() for value in law.values())


main()
