"""Hips whose geometry has a closed form: a ball in a cup on a rigid shell, driven by an ISO-like cycle or an orbital bearing.

The pressure at an angle t from the load is K e (cos t - cos a), with e = d + c the approach d plus the radial clearance c,
cos a = c / e, and the force F = 2 pi R^2 K e [(1 - cos^3 a) / 3 - cos a (1 - cos^2 a) / 2]. The slip of a point r of the cup is
the rotation of the head relative to the cup times r. Lengths in mm, forces in N, pressures in MPa; the frame is that of the cup.
"""

import numpy as np

STEPS = 200
CLEARANCE_MM = 0.1
# Cup of 8 mm on a rigid shell: K = (1 - v) E / ((1 + v) (1 - 2 v) h), E 463 MPa and Poisson's ratio 0.46.
STIFFNESS_MPA_PER_MM = (1 - 0.46) * 463.0 / (1.46 * 0.08 * 8.0)
CUP_INCLINATION_DEG = 30.0
ORBITAL_TILT_DEG = 23.0
# Knots (part of the cycle, value) between which half cosines run: quoted from memory, not checked in ISO 14242-1.
FLEXION_DEG = [(0.0, 25), (0.5, -18), (1.0, 25)]
ABDUCTION_DEG = [(0.0, 3), (0.21, 7), (0.5, -4), (1.0, 3)]
ROTATION_DEG = [(0.0, -10), (0.5, 2), (1.0, -10)]
LOAD_N = [(0.0, 300), (0.12, 3000), (0.32, 1500), (0.5, 3000), (0.62, 300), (1.0, 300)]


def half_cosines(knots, at):
    times, values = np.array(knots).T
    low = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    part = (at - times[low]) / (times[low + 1] - times[low])
    return values[low] + (values[low + 1] - values[low]) * (1 - np.cos(np.pi * part)) / 2


def rotation(axis, angle_rad):
    """Rotation matrices about a coordinate axis, one per angle."""
    matrices = np.zeros((len(angle_rad), 3, 3))
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrices[:, axis, axis] = 1.0
    matrices[:, first, first] = matrices[:, second, second] = np.cos(angle_rad)
    matrices[:, second, first] = np.sin(angle_rad)
    matrices[:, first, second] = -np.sin(angle_rad)
    return matrices


def directions(count=4000):
    """Points of the unit sphere, each with an equal share of its area."""
    height = 1 - 2 * (np.arange(count) + 0.5) / count
    turn = np.pi * (1 + np.sqrt(5)) * np.arange(count)
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)


def approach_mm(force_n, radius_mm):
    """Approach plus clearance for each force, by bisection: the force grows with it."""

    def force(e):
        cosine = CLEARANCE_MM / e
        bracket = (1 - cosine**3) / 3 - cosine * (1 - cosine**2) / 2
        return 2 * np.pi * radius_mm**2 * STIFFNESS_MPA_PER_MM * e * bracket

    low, high = np.full_like(force_n, CLEARANCE_MM), np.full_like(force_n, CLEARANCE_MM + 10.0)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = np.where(force(middle) < force_n, middle, low), np.where(force(middle) < force_n, high, middle)
    return (low + high) / 2


class Hip:
    """The histories of a head of a radius in a cup: pressure, slip length and direction at every point and step."""

    def __init__(self, radius_mm, machine, order="fea"):
        at = np.arange(STEPS + 1) / STEPS
        force_n = half_cosines(LOAD_N, (at[1:] + at[:-1]) / 2)
        if machine == "orbital":
            phase, tilt = 2 * np.pi * at, np.full(STEPS + 1, np.radians(ORBITAL_TILT_DEG))
            # The block turns and the cup on it does not: it nutates. The head stands still under a vertical load.
            cup = rotation(2, phase) @ rotation(1, tilt) @ rotation(2, -phase)
            head = np.swapaxes(cup, 1, 2)
            load = head[:-1] @ np.array([0.0, 0.0, 1.0])
        else:
            angles = {
                "f": rotation(1, np.radians(half_cosines(FLEXION_DEG, at))),
                "a": rotation(0, np.radians(half_cosines(ABDUCTION_DEG, at))),
                "e": rotation(2, np.radians(half_cosines(ROTATION_DEG, at))),
            }
            head = np.eye(3)[None]
            for name in order:
                head = head @ angles[name]
            load = np.tile([0.0, 0.0, 1.0], (STEPS, 1))
        points = directions()
        if machine != "orbital":
            # Points outside of the rim, whose plane is inclined to the load, belong to no cup.
            tilt = np.radians(CUP_INCLINATION_DEG)
            points = points[points @ np.array([np.sin(tilt), 0.0, np.cos(tilt)]) > 0]
        self.area_mm2 = 4 * np.pi * radius_mm**2 / 4000
        e = approach_mm(force_n, radius_mm)
        self.pressure = STIFFNESS_MPA_PER_MM * np.maximum(e[:, None] * (load @ points.T) - CLEARANCE_MM, 0.0)
        step = head[1:] @ np.swapaxes(head[:-1], 1, 2)
        spin = (
            np.stack([step[:, 2, 1] - step[:, 1, 2], step[:, 0, 2] - step[:, 2, 0], step[:, 1, 0] - step[:, 0, 1]], axis=1) / 2
        )
        slip = radius_mm * np.cross(spin[:, None, :], points[None])
        # Two directions in the surface at every point.
        east = np.cross([0.0, 1.0, 0.0], points)
        east /= np.linalg.norm(east, axis=1, keepdims=True)
        north = np.cross(points, east)
        self.slip = np.stack([np.einsum("spx,px->sp", slip, east), np.einsum("spx,px->sp", slip, north)], axis=-1)
        self.distance = np.linalg.norm(self.slip, axis=-1)

    def work_n_m(self):
        """Sum of p |ds| over surface and cycle, N m."""
        return (self.pressure * self.distance).sum() * self.area_mm2 / 1000

    def cross_shear(self):
        """Cross-shear ratio of every point."""
        weight = self.pressure / np.maximum(self.distance, 1e-12)
        first, mixed, second = (
            (weight * self.slip[..., i] * self.slip[..., j]).sum(axis=0) for i, j in [(0, 0), (0, 1), (1, 1)]
        )
        total = first + second
        across = 0.5 * total - np.hypot(0.5 * (first - second), mixed)
        return np.maximum(across, 0.0) / np.maximum(total, 1e-12)

    def volume_mm3(self, effect, exponent, reference_mpa=1.1):
        """Volume of a cycle for a wear factor of 1 mm3/(N m) at the reference, with `effect` of cross-shear."""
        work = (self.pressure ** (1 - exponent) * self.distance * (self.pressure > 0)).sum(axis=0) * reference_mpa**exponent
        return (effect(self.cross_shear()) * work).sum() * self.area_mm2 / 1000
