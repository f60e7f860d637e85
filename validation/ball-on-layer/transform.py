"""A rigid frictionless ball on an elastic layer that is bonded to a rigid base, by Hankel's transform.

Independent of condyle. Rings of even pressure move the surface by the half-space's closed form and an integral of what the layer
takes from it; which rings press follows from complementarity. The transform of a bonded layer is that of Hayes et al. 1972:
w(k) = 2 (1 - v^2) / E * M(k h) / k * p(k). Prints force, contact radius and highest pressure.
Usage: transform.py THICKNESS_MM DEPTH_MM..., with numpy and scipy.
"""

import itertools
import sys

import numpy as np
from scipy.special import ellipe, ellipk, j0, j1

YOUNGS_MPA, POISSON, BALL_MM = 463.0, 0.46, 121.0
RINGS = 240
COMPLIANCE = 2 * (1 - POISSON**2) / YOUNGS_MPA


def of_layer_less_half_space(k_h):
    """M - 1, with the exponentials that grow taken out."""
    v = POISSON
    growing = np.exp(-2 * k_h)
    sinh_cosh = (1 - growing**2) / 4
    sinh_2 = (1 - growing) ** 2 / 4
    above = (3 - 4 * v) * sinh_cosh - k_h * growing
    below = (k_h**2 + 4 * (1 - v) ** 2) * growing + (3 - 4 * v) * sinh_2
    return above / below - 1


def disc_on_half_space(radius, at):
    """How far unit pressure on a disc moves places, mm/MPa."""
    inside = at < radius
    part = np.where(inside, at / radius, radius / np.maximum(at, radius)) ** 2
    near = radius * ellipe(part)
    far = at * (ellipe(part) - (1 - part) * ellipk(np.where(part < 1, part, 0)))
    return 2 * COMPLIANCE / np.pi * np.where(inside, near, far)


def influence(edges, middles, thickness):
    """How far unit pressure on each ring moves the middle of each."""
    k, weights = np.polynomial.legendre.leggauss(60)
    panels = np.linspace(0, 25 / thickness, 40)
    k = np.concatenate([(b - a) / 2 * k + (a + b) / 2 for a, b in itertools.pairwise(panels)])
    weights = np.concatenate([(b - a) / 2 * weights for a, b in itertools.pairwise(panels)])
    of_disc = edges[:, None] * j1(np.outer(edges, k)) / k
    weighted = COMPLIANCE * weights * of_layer_less_half_space(k * thickness)
    layer = (j0(np.outer(middles, k)) * weighted) @ of_disc.T
    discs = np.array([disc_on_half_space(edge, middles) if edge > 0 else 0 * middles for edge in edges]).T
    return np.diff(layer + discs, axis=1)


def pressed(thickness, depth):
    """Force, contact radius and highest pressure."""
    reach = 1.02 * np.sqrt(2 * BALL_MM * depth)
    edges = np.linspace(0, reach, RINGS + 1)
    middles = (edges[1:] + edges[:-1]) / 2
    moves = influence(edges, middles, thickness)
    overclosure = np.sqrt(BALL_MM**2 - middles**2) - BALL_MM + depth
    count = RINGS
    while True:
        pressure = np.linalg.solve(moves[:count, :count], overclosure[:count])
        if pressure[-1] >= 0:
            break
        count -= 1
    area = np.pi * np.diff(edges**2)[:count]
    return pressure @ area, edges[count], pressure[0]


if __name__ == "__main__":
    thickness_mm = float(sys.argv[1])
    for argument in sys.argv[2:]:
        force_n, radius_mm, peak_mpa = pressed(thickness_mm, float(argument))
        print(f"{thickness_mm} mm, {argument} mm deep: {force_n:.2f} N, {radius_mm:.3f} mm, {peak_mpa:.3f} MPa")
