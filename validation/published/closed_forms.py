"""Tests whose geometry has a closed form: pins on circles, pins that grow, a ball on a flat, random paths.

The laws are those of the program `laws_on_paths`, asked once for all paths; here is only geometry.
"""

import json
import math
import random
import subprocess

CIRCLE = 0.5
ROUND_MM = math.pi * 10.0
PIN_MPA = 1.1
LOAD_N = 126.0
PIN_DIAMETERS_MM = [3.0, 6.0, 9.0, 12.0, 18.0, 24.0, 30.0]
# Sides of rectangles of one length, the longer over the shorter; none of a line.
RECTANGLES = [1, 2, 4, 9, None]
PRESSURES_MPA = [0.05 * 1.15**step for step in range(48)]
BALL_MM = 28.0
BALL_WORK_NM = 0.106
BALL_CYCLES = 200e6
# Of polyethylene under a rigid ball: E 463 MPa, Poisson's ratio 0.46.
PLANE_STRAIN_MODULUS_MPA = 463.0 / (1.0 - 0.46**2)


def circle(pressure_mpa, parts=360):
    step = ROUND_MM / parts
    angle = [2.0 * math.pi * part / parts for part in range(parts)]
    return [[pressure_mpa, step * math.cos(a), step * math.sin(a)] for a in angle]


def rectangle(pressure_mpa, ratio, parts=100):
    """Round a rectangle; to and fro on a line where there is no ratio."""
    half = ROUND_MM / 2.0
    short = half / (1.0 + ratio) if ratio else 0.0
    long = half - short
    sides = [(long, 0.0), (0.0, short), (-long, 0.0), (0.0, -short)]
    return [[pressure_mpa, x / parts, z / parts] for x, z in sides for _ in range(parts)]


def wandering(mean_mpa, seed, parts=40000):
    """Steps of one length whose direction and pressure wander; the pressure is even between 0 and twice its mean."""
    steps, draw, heading, phase = [], random.Random(seed), 0.0, 0.0
    for _ in range(parts):
        heading += draw.gauss(0.0, 1.0)
        phase += draw.gauss(0.0, 0.6)
        # A triangle wave of a phase that wanders is even.
        part = abs((phase / math.pi) % 2.0 - 1.0)
        steps.append([2.0 * mean_mpa * part, 0.1 * math.cos(heading), 0.1 * math.sin(heading)])
    return steps


def paths():
    all_paths = {f"at {pressure}": circle(pressure) for pressure in PRESSURES_MPA}
    all_paths |= {f"pin {diameter}": circle(LOAD_N / area(diameter)) for diameter in PIN_DIAMETERS_MM}
    all_paths |= {f"rectangle {ratio}": rectangle(PIN_MPA, ratio) for ratio in RECTANGLES}
    return all_paths | {"pins": circle(PIN_MPA), "random": wandering(PIN_MPA, 1)}


def area(diameter_mm):
    return math.pi / 4.0 * diameter_mm**2


class Laws:
    """Wear factors of every law, mm3/(N m)."""

    def __init__(self, program):
        ran = subprocess.run([program], input=json.dumps(paths()), capture_output=True, text=True, check=True)
        self.on = json.loads(ran.stdout)
        for on in self.on.values():
            on["laws"] = {worn["law"]: worn for worn in on["laws"]}
        # The default law is fitted to such measurements, and has a page of its own.
        self.words = [word for word in self.on["pins"]["laws"] if word != "power-law"]

    def factor(self, law, path):
        on = self.on[path]
        return 1000.0 * on["laws"][law]["depth_mm"] / on["pressure_slip_mpa_mm"]

    def outside(self, law, path):
        return self.on[path]["laws"][law]["part_outside"]

    def factor_at(self, law, pressure_mpa):
        """On a circle under any pressure, between those that were asked for."""
        logs = [math.log(pressure) for pressure in PRESSURES_MPA]
        place = min(max(math.log(pressure_mpa), logs[0]), logs[-1])
        low = min(int((place - logs[0]) / (logs[1] - logs[0])), len(logs) - 2)
        part = (place - logs[low]) / (logs[low + 1] - logs[low])
        ends = [math.log(self.factor(law, f"at {PRESSURES_MPA[low + end]}")) for end in (0, 1)]
        return math.exp(ends[0] + part * (ends[1] - ends[0]))

    def growing_pins(self, law):
        """Wear factors of pins of growing diameter under one load."""
        return [self.factor(law, f"pin {diameter}") for diameter in PIN_DIAMETERS_MM]

    def ball(self, law, scale=1.0, steps=4000):
        """The mean factor of a ball that digs its own socket: a cap of volume V is pi a^4 / (4 R) wide.

        It starts from the circle of Hertz. The worn volume stays under the ball.
        """
        hertz_mm = (0.75 * LOAD_N * BALL_MM / PLANE_STRAIN_MODULUS_MPA) ** (1.0 / 3.0)
        volume, cycles = 0.0, BALL_CYCLES / steps
        for _ in range(steps):
            worn_mm = (4.0 * BALL_MM * volume / math.pi) ** 0.25
            pressed = math.pi * max(hertz_mm, worn_mm) ** 2
            volume += scale * self.factor_at(law, LOAD_N / pressed) * BALL_WORK_NM * cycles
        return volume / (BALL_WORK_NM * BALL_CYCLES)
