"""Standard problems of constrained optimisation on the unit cube.

Each function returns the output to be minimised and what must not be positive. Formulas and optima: Liang et al. (2006) for the
G problems, Coello (2000) for the welded beam, Surjanovic and Bingham (2013) for the others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Point = Sequence[float]
Found = tuple[float, list[float]]


@dataclass(frozen=True)
class Problem:
    """A problem, its optimum, and the number of tests that a search of it has."""

    of: Callable[[Point], Found]
    inputs: int
    limits: int
    optimum: float
    tests: int


def along(point: Point, low: Point, high: Point) -> np.ndarray:
    return np.asarray(low) + np.asarray(point) * (np.asarray(high) - np.asarray(low))


def branin(point: Point) -> Found:
    x, y = along(point, [-5, 0], [10, 15])
    b = y - 5.1 / (4 * math.pi**2) * x * x + 5 / math.pi * x - 6
    return b * b + 10 * (1 - 1 / (8 * math.pi)) * math.cos(x) + 10, []


HARTMANN_A = np.array([
    [10, 3, 17, 3.5, 1.7, 8], [0.05, 10, 17, 0.1, 8, 14], [3, 3.5, 1.7, 10, 17, 8], [17, 8, 0.05, 10, 0.1, 14],
])  # fmt: skip
HARTMANN_P = np.array([
    [0.1312, 0.1696, 0.5569, 0.0124, 0.8283, 0.5886], [0.2329, 0.4135, 0.8307, 0.3736, 0.1004, 0.9991],
    [0.2348, 0.1451, 0.3522, 0.2883, 0.3047, 0.6650], [0.4047, 0.8828, 0.8732, 0.5743, 0.1091, 0.0381],
])  # fmt: skip


def hartmann(point: Point) -> Found:
    squares = (HARTMANN_A * (np.asarray(point) - HARTMANN_P) ** 2).sum(1)
    return -float(np.array([1, 1.2, 3, 3.2]) @ np.exp(-squares)), []


def g1(point: Point) -> Found:
    x = np.asarray(point) * np.array([1] * 9 + [100] * 3 + [1])
    pairs = [(0, 1, 9, 10), (0, 2, 9, 11), (1, 2, 10, 11)]
    limits = [2 * x[a] + 2 * x[b] + x[c] + x[d] - 10 for a, b, c, d in pairs]
    limits += [x[9 + n] - 8 * x[n] for n in range(3)]
    limits += [x[9 + n] - 2 * x[3 + 2 * n] - x[4 + 2 * n] for n in range(3)]
    return 5 * (x[:4] - x[:4] ** 2).sum() - x[4:].sum(), limits


def g4(point: Point) -> Found:
    a, b, c, d, e = along(point, [78, 33, 27, 27, 27], [102, 45, 45, 45, 45])
    u = 85.334407 + 0.0056858 * b * e + 0.0006262 * a * d - 0.0022053 * c * e
    v = 80.51249 + 0.0071317 * b * e + 0.0029955 * a * b + 0.0021813 * c * c
    w = 9.300961 + 0.0047026 * c * e + 0.0012547 * a * c + 0.0019085 * c * d
    limits = [u - 92, -u, v - 110, 90 - v, w - 25, 20 - w]
    return 5.3578547 * c * c + 0.8356891 * a * e + 37.293239 * a - 40792.141, limits


def g6(point: Point) -> Found:
    x, y = along(point, [13, 0], [100, 100])
    limits = [100 - (x - 5) ** 2 - (y - 5) ** 2, (x - 6) ** 2 + (y - 5) ** 2 - 82.81]
    return (x - 10) ** 3 + (y - 20) ** 3, limits


def g7(point: Point) -> Found:
    a, b, c, d, e, f, g, h, i, j = along(point, [-10] * 10, [10] * 10)
    output = a * a + b * b + a * b - 14 * a - 16 * b + (c - 10) ** 2 + 4 * (d - 5) ** 2 + (e - 3) ** 2
    output += 2 * (f - 1) ** 2 + 5 * g * g + 7 * (h - 11) ** 2 + 2 * (i - 10) ** 2 + (j - 7) ** 2 + 45
    limits = [
        4 * a + 5 * b - 3 * g + 9 * h - 105,
        10 * a - 8 * b - 17 * g + 2 * h,
        -8 * a + 2 * b + 5 * i - 2 * j - 12,
        3 * (a - 2) ** 2 + 4 * (b - 3) ** 2 + 2 * c * c - 7 * d - 120,
        5 * a * a + 8 * b + (c - 6) ** 2 - 2 * d - 40,
        a * a + 2 * (b - 2) ** 2 - 2 * a * b + 14 * e - 6 * f,
        0.5 * (a - 8) ** 2 + 2 * (b - 4) ** 2 + 3 * e * e - f - 30,
        -3 * a + 6 * b + 12 * (i - 8) ** 2 - 7 * j,
    ]
    return output, limits


def g8(point: Point) -> Found:
    x, y = along(point, [0.01, 0], [10, 10])
    waves = math.sin(2 * math.pi * x) ** 3 * math.sin(2 * math.pi * y)
    return -waves / (x**3 * (x + y)), [x * x - y + 1, 1 - x + (y - 4) ** 2]


def g9(point: Point) -> Found:
    a, b, c, d, e, f, g = along(point, [-10] * 7, [10] * 7)
    output = (a - 10) ** 2 + 5 * (b - 12) ** 2 + c**4 + 3 * (d - 11) ** 2 + 10 * e**6 + 7 * f * f + g**4
    limits = [
        2 * a * a + 3 * b**4 + c + 4 * d * d + 5 * e - 127,
        7 * a + 3 * b + 10 * c * c + d - e - 282,
        23 * a + b * b + 6 * f * f - 8 * g - 196,
        4 * a * a + b * b - 3 * a * b + 2 * c * c + 5 * f - 11 * g,
    ]
    return output - 4 * f * g - 10 * f - 8 * g, limits


def g10(point: Point) -> Found:
    a, b, c, d, e, f, g, h = along(point, [100, 1000, 1000] + [10] * 5, [10000] * 3 + [1000] * 5)
    limits = [
        0.0025 * (d + f) - 1,
        0.0025 * (e + g - d) - 1,
        0.01 * (h - e) - 1,
        833.33252 * d + 100 * a - a * f - 83333.333,
        1250 * e + b * d - b * g - 1250 * d,
        1250000 + c * e - c * h - 2500 * e,
    ]
    return a + b + c, limits


def g12(point: Point) -> Found:
    x = along(point, [0] * 3, [10] * 3)
    nearest = np.clip(np.round(x), 1, 9)
    return (((x - 5) ** 2).sum() - 100) / 100, [((x - nearest) ** 2).sum() - 0.0625]


def g24(point: Point) -> Found:
    x, y = along(point, [0, 0], [3, 4])
    limits = [
        -2 * x**4 + 8 * x**3 - 8 * x * x + y - 2,
        -4 * x**4 + 32 * x**3 - 88 * x * x + 96 * x + y - 36,
    ]
    return -x - y, limits


def welded_beam(point: Point) -> Found:
    h, w, t, b = along(point, [0.1] * 4, [2, 10, 10, 2])
    load, length, young, shear = 6000, 14, 30e6, 12e6
    arm = math.hypot(w, h + t) / 2
    polar = 2 * math.sqrt(2) * h * w * (w * w / 12 + ((h + t) / 2) ** 2)
    direct = load / (math.sqrt(2) * h * w)
    twist = load * (length + w / 2) * arm / polar
    stress = math.sqrt(direct**2 + direct * twist * w / arm + twist**2)
    bending = 6 * load * length / (b * t * t)
    deflection = 4 * load * length**3 / (young * t**3 * b)
    buckling = 4.013 * young * math.sqrt(t * t * b**6 / 36) / length**2
    buckling *= 1 - t / (2 * length) * math.sqrt(young / (4 * shear))
    limits = [stress / 13600 - 1, bending / 30000 - 1, h - b, deflection - 0.25, 1 - buckling / load]
    return 1.10471 * h * h * w + 0.04811 * t * b * (14 + w), limits


PROBLEMS = {
    "Branin": Problem(branin, 2, 0, 0.397887, 40),
    "Hartmann 6": Problem(hartmann, 6, 0, -3.32237, 80),
    "G1": Problem(g1, 13, 9, -15.0, 100),
    "G4": Problem(g4, 5, 6, -30665.539, 60),
    "G6": Problem(g6, 2, 2, -6961.814, 60),
    "G7": Problem(g7, 10, 8, 24.306, 100),
    "G8": Problem(g8, 2, 2, -0.095825, 60),
    "G9": Problem(g9, 7, 4, 680.630, 100),
    "G10": Problem(g10, 8, 6, 7049.248, 100),
    "G12": Problem(g12, 3, 1, -1.0, 60),
    "G24": Problem(g24, 2, 2, -5.508013, 40),
    "welded beam": Problem(welded_beam, 4, 5, 1.724852, 80),
}
