"""Fits the law `power-law` to all tests that can be computed, and to all but each laboratory.

Usage: fit.py RATES DRAWS PAGE PICTURE. RATES is the output of rates.py. Writes a table of posterior draws, the tables of the page
and a picture of each laboratory predicted by a fit without it.
"""

import json
import math
import sys
from pathlib import Path

import emcee
import numpy as np
from model import DEGREES_OF_FREEDOM, KNEES, Fit, Power, Saturating, log_laboratory, row_is_ratio, tests

sys.path.append(str(Path(__file__).parents[1] / "published"))
from tables import head, line, number

WALKERS, STEPS, WARM_UP, SEED = 32, 3000, 1000, 1
DRAWS = 500
# Least part of the left-out tests within the 90 % interval: the scatter of the laboratories is widened until it holds.
LEAST_COVERED = 0.85


def sampled(fit):
    """Posterior samples, one a row; emcee raises an error unless the chains are 30 times as long as their autocorrelation."""
    start = np.random.default_rng(SEED).normal(fit.start, 0.01, (WALKERS, len(fit.start)))
    start[:, 4:] = np.abs(start[:, 4:])
    sampler = emcee.EnsembleSampler(WALKERS, len(fit.start), fit.log_posterior, vectorize=True)
    sampler.random_state = np.random.RandomState(SEED).get_state()
    sampler.run_mcmc(start, STEPS + WARM_UP)
    sampler.get_autocorr_time(discard=WARM_UP, tol=30)
    return sampler.get_chain(discard=WARM_UP, flat=True)


def predictive(fit, samples, row, log_sd, rng):
    """Logarithms of what a new laboratory would measure: by the law with the scatter of specimens, and its laboratory's part."""
    log_factor, exponent, log_tau, *constants = samples.T
    logs = fit.form.log_predictions(log_factor, exponent, constants)[row["test"]]
    is_ratio = row_is_ratio(fit.rows, row["laboratory"])
    laboratory = np.zeros_like(logs) if is_ratio else np.exp(log_tau) * rng.standard_t(DEGREES_OF_FREEDOM, len(logs))
    return logs + log_sd * rng.normal(size=len(logs)), laboratory


def left_out(form, rows, geometry_log_sd):
    """By test: quantiles of what another laboratory would measure, and whether what was measured is inside the intervals.

    Also the factor on the laboratories' scatter with which 90 % intervals are honest.
    """
    rng, found, logs_of = np.random.default_rng(SEED), {}, {}
    for laboratory in dict.fromkeys(row["laboratory"] for row in rows):
        own = [row for row in rows if row["laboratory"] == laboratory]
        fit = Fit(form, [row for row in rows if row["laboratory"] != laboratory], geometry_log_sd)
        samples = sampled(fit)
        whole = Fit(form, rows, geometry_log_sd)
        for row in own:
            log_sd = whole.log_sd[rows.index(row)]
            logs_of[row["test"]] = predictive(whole, samples, row, log_sd, rng)
            density = np.exp(log_density(whole, samples, row, log_sd)).mean()
            found[row["test"]] = {"log_density": math.log(density)}

    def below(row, spread):
        law, laboratory = logs_of[row["test"]]
        return (law + spread * laboratory < row["log_value"]).mean()

    def covered(spread):
        return np.mean([abs(below(row, spread) - 0.5) <= 0.45 for row in rows])

    spread = next(spread for spread in np.arange(1.0, 3.0, 0.01) if covered(spread) >= LEAST_COVERED)
    for row in rows:
        law, laboratory = logs_of[row["test"]]
        found[row["test"]] |= {
            "quantiles": np.exp(np.quantile(law + spread * laboratory, [0.05, 0.25, 0.5, 0.75, 0.95])),
            "inside": [abs(below(row, spread) - 0.5) <= each for each in (0.25, 0.45)],
        }
    return found, spread


def log_density(fit, samples, row, log_sd):
    log_factor, exponent, log_tau, *constants = samples.T
    logs = fit.form.log_predictions(log_factor, exponent, constants)[row["test"]]
    residual = row["log_value"] - logs
    if row_is_ratio(fit.rows, row["laboratory"]):
        return -0.5 * ((residual / log_sd) ** 2 + np.log(2 * np.pi * log_sd**2))
    return log_laboratory(residual, log_sd, np.exp(log_tau))


def table_of_tests(rows, found):
    text = head(["test", "laboratory", "measured", "predicted without it", "over measured", "50 %", "90 %"])
    for row in rows:
        own = found[row["test"]]
        low, _, median, _, high = own["quantiles"]
        inside = ["yes" if each else "**no**" for each in own["inside"]]
        cells = [f"{row['what']} [{row['source']}]", row["laboratory"], f"{number(float(row['value']))} {row['unit']}"]
        ratio = median / float(row["value"])
        text += line([*cells, f"{number(median)} ({number(low)} to {number(high)})", f"{ratio:.2f}", *inside])
    return text


def table_of_coverage(rows, found):
    text = head(["joint", "tests", "inside 50 %", "inside 90 %"])
    joints = list(dict.fromkeys(row["joint"] for row in rows))
    for joint in [*joints, "all"]:
        own = [found[row["test"]]["inside"] for row in rows if joint in (row["joint"], "all")]
        text += line([joint, str(len(own)), *(str(sum(each)) for each in zip(*own, strict=True))])
    return text


def table_of_constants(fit, samples):
    names = ["wear factor on the circle, 1e-6 mm3/(N m)", "exponent of pressure", "scale of the laboratories, log"]
    values = [1.63 * np.exp(samples[:, 0]), samples[:, 1], np.exp(samples[:, 2])]
    for name, each in zip(fit.form.names, samples.T[3:], strict=True):
        is_log = name.startswith("log_")
        names.append(name.removeprefix("log_").replace("_", " "))
        values.append(np.exp(each) if is_log else each)
    text = head(["constant", "median", "90 % interval"])
    for name, each in zip(names, values, strict=True):
        low, median, high = np.quantile(each, [0.05, 0.5, 0.95])
        text += line([name, f"{median:.3g}", f"{low:.3g} to {high:.3g}"])
    return text


def row_of_form(fit, samples, found, spread):
    """Constants, evidence, and predicted over measured with each laboratory left out."""
    factor, exponent = 1.63 * math.exp(np.median(samples[:, 0])), np.median(samples[:, 1])
    ratio = {row["test"]: found[row["test"]]["quantiles"][2] / float(row["value"]) for row in fit.rows}
    knees, hips = ("fixed", "stable"), ("orbital-22", "orbital-28", "iso-hip-bovine", "iso-hip-calf")
    inside = [sum(each) for each in zip(*(each["inside"] for each in found.values()), strict=True)]
    return [
        type(fit.form).__name__,
        f"{factor:.3g}, {exponent:.2f}",
        f"{sum(each['log_density'] for each in found.values()):.1f}",
        ", ".join(f"{ratio[test]:.2f}" for test in knees),
        ", ".join(f"{ratio[test]:.2f}" for test in hips),
        f"{spread:.2f}",
        f"{inside[0]}, {inside[1]} of {len(found)}",
    ]


def draws(samples, spread):
    chosen = samples[np.linspace(0, len(samples) - 1, DRAWS).astype(int)]
    rng = np.random.default_rng(SEED)
    text = "circle_factor_mm3_per_nm,pressure_exponent,cross_shear_saturation,line_factor_ratio,laboratory_factor\n"
    for log_factor, exponent, log_tau, log_saturation, part in chosen:
        laboratory = math.exp(spread * math.exp(log_tau) * rng.standard_t(DEGREES_OF_FREEDOM))
        each = [1.63e-6 * math.exp(log_factor), exponent, math.exp(log_saturation), part, laboratory]
        text += ",".join(f"{value:.5g}" for value in each) + "\n"
    return text


def picture(rows, found):
    left, width, step, top, low, high = 330.0, 860.0, 30.0, 20.0, 0.1, 10.0

    def across(ratio):
        return left + (width - left - 30) * math.log(min(max(ratio, low), high) / low) / math.log(high / low)

    bottom = top + step * len(rows)
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {bottom + 46:.0f}" role="img" '
        'font-family="system-ui, sans-serif" font-size="12" fill="#1a1a1a">\n<title>Predicted over measured wear, each '
        f'laboratory left out of its fit</title>\n<rect width="{width:.0f}" height="{bottom + 46:.0f}" fill="#ffffff"/>\n'
    )
    for tick in [0.1, 0.2, 0.5, 1, 2, 5, 10]:
        text += f'<path d="M{across(tick):.1f} {top}V{bottom}" stroke="{"#1a1a1a" if tick == 1 else "#dddddd"}"/>\n'
        text += f'<text x="{across(tick):.1f}" y="{bottom + 18}" text-anchor="middle">{tick:g}</text>\n'
    text += f'<text x="{across(1):.1f}" y="{bottom + 38}" text-anchor="middle">predicted over measured</text>\n'
    for place, row in enumerate(rows):
        y = top + step * (place + 0.5)
        ratios = [across(each / float(row["value"])) for each in found[row["test"]]["quantiles"]]
        text += f'<text x="{left - 14}" y="{y + 4}" text-anchor="end">{row["what"]}</text>\n'
        text += f'<path d="M{ratios[0]:.1f} {y}H{ratios[4]:.1f}" stroke="#0072b2" stroke-width="2"/>\n'
        text += f'<path d="M{ratios[1]:.1f} {y}H{ratios[3]:.1f}" stroke="#0072b2" stroke-width="8" stroke-opacity="0.5"/>\n'
        text += f'<circle cx="{ratios[2]:.1f}" cy="{y}" r="5" fill="#0072b2"/>\n'
    return text + "</svg>\n"


def main():
    rates_path, draws_path, page_path, picture_path = map(Path, sys.argv[1:])
    stored = json.loads(rates_path.read_text(encoding="utf-8"))
    rows = tests()
    page, evidence = "", []
    for form_of in (Saturating, Power):
        own = {test: np.array(list(by_m.values())) for test, by_m in stored[form_of.__name__.lower()].items()}
        form = form_of(own)
        # Between the knees here, at the law in the middle of the prior: the implants of two laboratories are unknown.
        middle = [np.array([each]) for each in form.start]
        logs = [np.log(form.rate(f"{knee} stable", np.array([0.5]), middle)) for knee in KNEES]
        geometry_log_sd = float(np.std(logs, ddof=1))
        fit = Fit(form, rows, geometry_log_sd)
        samples = sampled(fit)
        found, spread = left_out(form, rows, geometry_log_sd)
        evidence.append(row_of_form(fit, samples, found, spread))
        if form_of is Saturating:
            draws_path.write_text(draws(samples, spread), encoding="utf-8")
            picture_path.write_text(picture(rows, found), encoding="utf-8")
            page += (
                table_of_constants(fit, samples) + "\n" + table_of_tests(rows, found) + "\n" + table_of_coverage(rows, found)
            )
    names = [
        "form",
        "factor, exponent",
        "log predictive density",
        "fixed, stable knee",
        "hips",
        "widened by",
        "inside 50 %, 90 %",
    ]
    page += "\n" + head(names) + "".join(line(each) for each in evidence)
    page_path.write_text(page, encoding="utf-8")


main()
