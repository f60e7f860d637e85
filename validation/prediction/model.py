"""Predictions of the tests by the law `power-law`, as functions of its constants, and the hierarchical fit.

The logarithm of the rate measured in test i of laboratory l is log prediction_i + laboratory_l + scatter_i. laboratory_l has Student's
distribution with 4 degrees of freedom and the scale tau: a laboratory that is far off does not widen the interval of all others.
scatter_i is normal with the deviation of the specimens and of what is assumed. The laboratories' factors are integrated out.
"""

import csv
import math
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline

CIRCLE_FACTOR = 1.63e-6
REFERENCE_MPA = 1.1
DENSITY_MG_PER_MM3 = 0.93
EXPONENTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
SATURATIONS = np.array([0.002, 0.005, 0.0125, 0.03, 0.08, 0.2, 0.5])
POWERS = np.array([0.0, 0.1, 0.2, 0.4, 0.8, 1.6])
PINS = ["pins", "pins-newcastle"]
KNEES = ["generic", "dm", "cams"]
# Orders of the rotations of the hip simulator, from the cup to the head: the standard leaves them open.
ISO_HIPS = {
    "iso-hip fae": ["flexion", "abduction", "rotation"],
    "iso-hip aef": ["abduction", "rotation", "flexion"],
    "iso-hip efa": ["rotation", "flexion", "abduction"],
}
# Tracks of the disc: an arc that is bent by the sphere, and an ellipse.
DISC_CROSS_SHEAR = [3e-4, 0.3]
BALL_RADIUS_MM, BALL_LOAD_N, BALL_WORK_NM, BALL_CYCLES = 28.0, 126.0, 0.106, 200e6
DEGREES_OF_FREEDOM = 4
# Of Student's distribution of scale 1, over the sum of the weights.
LOG_DENSITY_AT_0 = math.log(3 / 8) - 0.5 * math.log(2 * math.pi)
HERMITE_POINTS, HERMITE_WEIGHTS = np.polynomial.hermite_e.hermegauss(24)
PLANE_STRAIN_MODULUS_MPA = 463.0 / (1 - 0.46**2)


def tests():
    with open(Path(__file__).parent / "tests.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["log_value"], row["log_sd"] = math.log(float(row["value"])), float(row["log_sd"])
    return rows


def ball_over_circle(exponent):
    """Mean factor of a ball that digs its own socket, a cap of volume pi a^4 / (4 R), over the factor on the circle."""
    hertz_mm = (0.75 * BALL_LOAD_N * BALL_RADIUS_MM / PLANE_STRAIN_MODULUS_MPA) ** (1 / 3)
    volume, steps = 0.0, 2000
    for _ in range(steps):
        radius_mm = max(hertz_mm, (4 * BALL_RADIUS_MM * volume / math.pi) ** 0.25)
        pressure = BALL_LOAD_N / (math.pi * radius_mm**2)
        volume += CIRCLE_FACTOR * (pressure / REFERENCE_MPA) ** -exponent * BALL_WORK_NM * BALL_CYCLES / steps
    return volume / (CIRCLE_FACTOR * BALL_WORK_NM * BALL_CYCLES)


class Surface:
    """The logarithm of a rate over the exponent of pressure and a constant of cross-shear, between computed points."""

    def __init__(self, constants, rates):
        self.spline = RectBivariateSpline(EXPONENTS, constants, np.log(rates), kx=3, ky=3)

    def __call__(self, exponent, constant):
        return np.exp(self.spline.ev(exponent, constant))


class Form:
    """A form of the effect of cross-shear: names and prior of its constants, and the predictions."""

    def __init__(self, rates):
        """`rates[test][m][k]`: mg a million cycles at the points of the grid, with the circle's factor."""
        self.rates = {test: self.surfaces(each) for test, each in rates.items()}
        self.ball = CubicSpline(EXPONENTS, [math.log(ball_over_circle(exponent)) for exponent in EXPONENTS])

    def log_predictions(self, log_factor, exponent, constants):
        """By test; every argument is an array of one value per sample."""
        rate = {name: np.log(self.rate(name, exponent, constants)) for name in self.rates}

        def mean(tests):
            return np.mean([rate[test] for test in tests], axis=0)

        stable, unstable = ([f"{knee} {condition}" for knee in KNEES[:2]] for condition in ("stable", "unstable"))
        at_circle = {
            **dict.fromkeys(PINS, np.zeros_like(exponent)),
            "ball": self.ball(exponent),
            "orbital-22": rate["orbital-22"],
            "orbital-28": rate["orbital-28"],
            "iso-hip-bovine": mean(ISO_HIPS),
            "iso-hip-calf": mean(ISO_HIPS),
            "fixed": mean(stable),
            "stable": mean(stable),
            "unstable": mean(unstable),
            "in-house": rate["cams stable"],
        }
        logs = {test: log_factor + value for test, value in at_circle.items()}
        for test in [*PINS, "ball"]:
            logs[test] = logs[test] + math.log(CIRCLE_FACTOR)
        low, high = (self.effect(cross_shear, constants) for cross_shear in DISC_CROSS_SHEAR)
        logs["disc"] = np.log(low) - np.log(high)
        return logs


class Saturating(Form):
    """g = f + (1 - f) CS / (CS + c), over g(0.5)."""

    names = ("log_saturation", "line_factor_ratio")
    start = (math.log(0.03), 0.03)

    @staticmethod
    def log_prior(log_saturation, line):
        # Factors on lines are some 20 times smaller than on circles; the saturation is hardly known.
        prior = -0.5 * ((log_saturation - math.log(0.03)) / 1.0) ** 2 - line / 0.05
        inside = (line >= 0) & (line < 0.3) & (log_saturation > math.log(0.002)) & (log_saturation < math.log(0.5))
        return np.where(inside, prior, -np.inf)

    @staticmethod
    def surfaces(rates):
        rates = np.asarray(rates)
        return Surface(np.log(SATURATIONS), rates[:, :-1]), CubicSpline(EXPONENTS, np.log(rates[:, -1]))

    def rate(self, name, exponent, constants):
        log_saturation, line = constants
        saturated, alone = self.rates[name]
        # Depth is linear in f + (1 - f) s, s = CS / (CS + c), of which the surfaces have s / s(0.5) and 1.
        at_circle = 0.5 / (0.5 + np.exp(log_saturation))
        rate = line * np.exp(alone(exponent)) + (1 - line) * at_circle * saturated(exponent, log_saturation)
        return rate / (line + (1 - line) * at_circle)

    @staticmethod
    def effect(cross_shear, constants):
        log_saturation, line = constants
        return line + (1 - line) * cross_shear / (cross_shear + np.exp(log_saturation))


class Power(Form):
    """g = (CS / 0.5)^b."""

    names = ("cross_shear_exponent",)
    start = (0.3,)

    @staticmethod
    def log_prior(power):
        return np.where((power >= 0) & (power < 1.6), -0.5 * ((power - 0.3) / 0.3) ** 2, -np.inf)

    @staticmethod
    def surfaces(rates):
        return Surface(POWERS, rates)

    def rate(self, name, exponent, constants):
        return self.rates[name](exponent, constants[0])

    @staticmethod
    def effect(cross_shear, constants):
        return (cross_shear / 0.5) ** constants[0]


class Fit:
    """Posterior of log factor, exponent of pressure, log tau and the constants of a form."""

    def __init__(self, form, rows, geometry_log_sd):
        self.form, self.rows = form, rows
        # The implants of two laboratories are unknown: their predictions scatter as those of the knees here.
        self.log_sd = [math.hypot(row["log_sd"], geometry_log_sd * ("three knees" in row["assumed"])) for row in rows]
        self.start = [0.0, 0.5, math.log(0.4), *form.start]

    def log_posterior(self, samples):
        log_factor, exponent, log_tau, *constants = np.atleast_2d(samples).T
        inside = (exponent > 0) & (exponent < 1)
        clipped = np.clip(exponent, 0, 1)
        # The factor's prior is wide: that of the pins is among the tests. Literature on the exponent: -0.84 and -0.65 (Barbour 1997, Vassiliou and Unsworth 2004, quoted from memory).
        prior = (
            -0.5 * ((exponent - 0.65) / 0.2) ** 2 - 0.5 * ((log_tau - math.log(0.4)) / 0.5) ** 2 - 0.5 * (log_factor / 1.0) ** 2
        )
        prior = np.where(inside, prior + self.form.log_prior(*constants), -np.inf)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            logs = self.form.log_predictions(log_factor, clipped, constants)
            posterior = prior + self.log_likelihood(logs, np.exp(log_tau))
        return np.where(np.isfinite(prior) & np.isfinite(posterior), posterior, -np.inf)

    def log_likelihood(self, logs, tau):
        """Of a laboratory: its residuals' normal likelihood, with their common part integrated over the laboratory's factor."""
        total = 0.0
        for laboratory in dict.fromkeys(row["laboratory"] for row in self.rows):
            weight = difference = square = log_determinant = 0.0
            for row, log_sd in zip(self.rows, self.log_sd, strict=True):
                if row["laboratory"] != laboratory:
                    continue
                residual = row["log_value"] - logs[row["test"]]
                weight += log_sd**-2
                difference = difference + residual / log_sd**2
                square = square + (residual / log_sd) ** 2
                log_determinant += 2 * math.log(log_sd)
            # A ratio within a laboratory has no factor of it.
            if row_is_ratio(self.rows, laboratory):
                total = total - 0.5 * (square + log_determinant)
                continue
            total = total - 0.5 * (square - difference**2 / weight + log_determinant + math.log(weight))
            total = total + log_laboratory(difference / weight, weight**-0.5, tau)
        return total


def log_laboratory(mean, deviation, tau):
    """Log of the density of Student's distribution of scale `tau`, averaged over a normal one, by Gauss and Hermite's rule."""
    at = np.asarray(mean)[..., None] + deviation * HERMITE_POINTS
    scaled = at / np.asarray(tau)[..., None]
    density = (1 + scaled**2 / DEGREES_OF_FREEDOM) ** (-(DEGREES_OF_FREEDOM + 1) / 2)
    return np.log(density @ HERMITE_WEIGHTS) - np.log(tau) + LOG_DENSITY_AT_0


def row_is_ratio(rows, laboratory):
    return all(row["unit"] == "ratio" for row in rows if row["laboratory"] == laboratory)
