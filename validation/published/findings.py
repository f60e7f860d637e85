"""What is known of wear, and what each law says to it: a row each, with a rule that can say no."""

import itertools

import knees
from closed_forms import LOAD_N, PIN_DIAMETERS_MM, RECTANGLES, area
from tables import head, line

# What changes by less than this part is no change.
NO_CHANGE = 0.02


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


def flattening(values):
    """Whether each is less than the one before, by more than no change."""
    return all(a * (1.0 - NO_CHANGE) > b for a, b in itertools.pairwise(values))


def on_pins(laws, words):
    pins = {word: laws.growing_pins(word) for word in words}
    rise = {word: max(pins[word]) / min(pins[word]) for word in words}
    yield (
        f"Pins under {LOAD_N:.0f} N: the factor rises linearly with the area from 3 to 30 mm [saikko2017]",
        "rises by half or more, along a line with r2 above 0.95; in brackets the largest over the least",
        [f"{yes(is_linear(pins[word]))} ({rise[word]:.3g})" for word in words],
    )
    factors = {word: [laws.factor(word, f"rectangle {ratio}") for ratio in RECTANGLES] for word in words}
    yield (
        "Pins on rectangles of one length: the longest and a line wear less than a square [turell2005]",
        f"falls from 1:1 to 1:{RECTANGLES[-2]} to a line; in brackets that and the line over the square",
        [
            f"{yes(flattening([f[0], f[-2], f[-1]]))} ({f[-2] / f[0]:.2g}, {f[-1] / f[0]:.2g})"
            for f in (factors[word] for word in words)
        ],
    )


def on_given_motion(runs, words):
    dishes = [
        runs.beside("stanmore-displacement", [f"insert.coronal_radius_mm={across}", f"insert.sagittal_radius_mm={along}"])
        for across, along in knees.DISHES_MM
    ]
    falls = {word: [dish[word] for dish in dishes] for word in words}
    yield (
        "Less conforming inserts wear less under the area and cross-shear laws; fixed bearings of less area do [fisher2010]",
        "falls from each dish to the next flatter one; in brackets the flattest over the most conforming",
        [f"{yes(all(a > b for a, b in zip(falls[w], falls[w][1:])))} ({falls[w][-1] / falls[w][0]:.2f})" for w in words],
    )
    usual = runs.beside("stanmore-displacement", [])

    def largest(all_changes):
        said = [runs.beside("stanmore-displacement", changes) for changes in all_changes]
        return {word: max(abs(one[word] / usual[word] - 1.0) for one in said) for word in words}

    flexion, placement = largest(knees.FLEXION), largest(knees.PLACEMENT)
    yield (
        "Volume is very sensitive to flexion and hardly to placement [lin2009]",
        "10 % of flexion changes it by more than 2 degrees of slope or turn, or 1 of tilt; in brackets by how many percent",
        [f"{yes(flexion[w] > placement[w])} ({100 * flexion[w]:.1f}, {100 * placement[w]:.1f})" for w in words],
    )


def of_ligaments(rates, words):
    for knee, own in rates.items():
        ratio = {word: own["unstable"][word] / own["stable"][word] for word in words}
        yield (
            f"The {knee} knee wears more without its ligaments [reinders2014, johnston2019]",
            "measured 1.83 times as much",
            [f"{yes(ratio[word] > 1.0)} ({ratio[word]:.2f})" for word in words],
        )


def of_alignment(runs, rates, words):
    """With the knees whose contact stays off the rim where the insert lies straight; each law on the histories of Archard's."""
    for name, changes, rule, holds in knees.ALIGNMENTS:
        ratios = {word: [] for word in words}
        for knee in [knee for knee in ("generic", "dm") if knee in rates]:
            case, usual = knees.KNEES[knee]["stable"]
            before = runs.beside(case, usual)
            for change in changes:
                after = runs.beside(case, [*usual, change])
                for word in words:
                    ratios[word].append(after[word] / before[word])
        each = [f"{yes(all(holds(r) for r in ratios[w]))} ({', '.join(f'{r:.2f}' for r in ratios[w])})" for w in words]
        yield f"{name} [johnston2019b]", rule, each


def of_activities(runs, words):
    by_law = {word: runs.alone("daily-life", [f"wear.law={word}"]) for word in words}
    yield (
        "A cycle of stairs wears less than one of walking, and rising and sitting less still [reinders2015]",
        "the same here; in brackets stairs and chair over walking, each on its own",
        [
            f"{yes(1.0 > own['stairs'] / own['walking'] > own['chair'] / own['walking'])} "
            f"({own['stairs'] / own['walking']:.2f}, {own['chair'] / own['walking']:.2f})"
            for own in (by_law[word] for word in words)
        ],
    )


def of_cross_linking(runs, rates, words):
    case, usual = knees.KNEES["generic"]["stable"]
    linked = [*usual, "material.cross_linking=high"]
    ratio = {word: runs.by_itself(case, linked, word) / rates["generic"]["stable"][word] for word in words}
    low, high = 0.125, 0.2
    yield (
        "Highly cross-linked inserts wear a fifth to an eighth [tsukamoto2006]",
        "within this range, if each law changes the surface itself; in brackets the ratio",
        [f"{yes(low <= ratio[word] <= high)} ({ratio[word]:.3f})" for word in words],
    )


def findings(laws, runs, rates, words):
    """The table, and its rows as they were found."""
    rows = [
        *on_pins(laws, words),
        *on_given_motion(runs, words),
        *of_ligaments(rates, words),
        *of_alignment(runs, rates, words),
        *of_activities(runs, words),
        *of_cross_linking(runs, rates, words),
    ]
    text = head(["known", "the rule", *(f"`{word}`" for word in words)])
    return text + "".join(line([known, rule, *each]) for known, rule, each in rows), rows
