"""A rigid frictionless ball on an elastic, perfectly plastic half-space, by axisymmetric finite elements of small strains.

Independent of condyle: four-node rings with the mean dilatation (B-bar), return along the radius (von Mises), Newton's method over
displacements and the set of nodes that touch at once. Prints force, and what the last ring that touches tells of radius and mean
pressure. Usage: axisymmetric.py EDGE_MM MODULUS_OVER_YIELD DEEPEST_MM, with numpy and scipy.
"""

import sys

import numpy as np
import scipy.sparse as sp
from scipy.sparse import linalg

YOUNGS_MPA, POISSON, BALL_MM = 463.0, 0.3, 24.0
STEPS = 48
ONE = np.array([1.0, 1.0, 1.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(ONE, ONE) / 3
# Strains are rr, zz, tt and twice rz; in products of stresses rz counts twice.
TWICE = np.array([1.0, 1.0, 1.0, 2.0])
SHEAR = YOUNGS_MPA / 2 / (1 + POISSON)
BULK = YOUNGS_MPA / 3 / (1 - 2 * POISSON)
CONTACT_MPA = YOUNGS_MPA / (1 - POISSON**2)


def graded(edge_mm, even_mm=3.0, more=18, growth=1.3):
    places = list(np.arange(round(even_mm / edge_mm) + 1) * edge_mm)
    for _ in range(more):
        edge_mm *= growth
        places.append(places[-1] + edge_mm)
    return np.array(places)


class Rings:
    def __init__(self, edge_mm):
        self.radii = radii = graded(edge_mm)
        count = len(radii)
        self.grid = np.arange(count * count).reshape(count, count)
        r, z = (axis.ravel() for axis in np.meshgrid(radii, -radii, indexing="ij"))
        g = self.grid
        corners = np.stack([g[:-1, 1:], g[1:, 1:], g[1:, :-1], g[:-1, :-1]], -1).reshape(-1, 4)
        self.dofs = np.stack([2 * corners, 2 * corners + 1], -1).reshape(-1, 8)
        self.dof_count = 2 * count * count
        self.strain_of, self.volume = self.operators(np.stack([r[corners], z[corners]], -1))
        self.rows, self.columns = np.repeat(self.dofs, 8, 1).ravel(), np.tile(self.dofs, (1, 8)).ravel()
        self.held = np.zeros(self.dof_count, bool)
        self.held[2 * g[0]] = True
        for side in (g[:, -1], g[-1]):
            self.held[2 * side] = self.held[2 * side + 1] = True
        self.top = 2 * g[:, 0] + 1

    @staticmethod
    def operators(places):
        elements = len(places)
        operators, volumes = np.zeros((elements, 4, 4, 8)), np.zeros((elements, 4))
        s = 1 / np.sqrt(3)
        for point, (a, b) in enumerate([(-s, -s), (s, -s), (s, s), (-s, s)]):
            shape = np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 + a) * (1 + b), (1 - a) * (1 + b)]) / 4
            slopes = np.array([[b - 1, 1 - b, 1 + b, -1 - b], [a - 1, -1 - a, 1 + a, 1 - a]]) / 4
            jacobian = np.einsum("ij,ejk->eik", slopes, places)
            by_place = np.linalg.solve(jacobian, np.broadcast_to(slopes, (elements, 2, 4)))
            radius = places[:, :, 0] @ shape
            of = operators[:, point]
            of[:, 0, 0::2] = of[:, 3, 1::2] = by_place[:, 0]
            of[:, 1, 1::2] = of[:, 3, 0::2] = by_place[:, 1]
            of[:, 2, 0::2] = shape / radius[:, None]
            volumes[:, point] = np.linalg.det(jacobian) * radius * 2 * np.pi
        dilatation = operators[:, :, :3].sum(2)
        mean = (dilatation * volumes[..., None]).sum(1) / volumes.sum(1)[:, None]
        operators[:, :, :3] += ((mean[:, None] - dilatation) / 3)[:, :, None, :]
        return operators, volumes


def material(strain, plastic, yield_mpa):
    """Stress, tangent and plastic strain after a strain."""
    elastic = strain - plastic
    dilatation = elastic[..., :3].sum(-1)
    deviator = 2 * SHEAR * elastic / TWICE
    deviator[..., :3] -= (2 * SHEAR / 3 * dilatation)[..., None]
    length = np.maximum(np.sqrt((TWICE * deviator**2).sum(-1)), 1e-300)
    part = np.minimum(1.0, yield_mpa / (np.sqrt(1.5) * length))
    flow = deviator / length[..., None]
    stress = deviator * part[..., None]
    stress[..., :3] += (BULK * dilatation)[..., None]
    along = np.where(part < 1, 2 * SHEAR * part, 0)[..., None, None]
    tangent = BULK * np.outer(ONE, ONE) + 2 * SHEAR * part[..., None, None] * DEVIATOR
    tangent = tangent - along * flow[..., :, None] * flow[..., None, :]
    return stress, tangent, plastic + deviator * TWICE * ((1 - part) / (2 * SHEAR))[..., None]


def press(rings, moved, touches, plastic, depth_mm, yield_mpa):
    """Presses the ball to a depth: forces on the top, N, who touches, and the plastic strain."""
    ball = np.zeros(rings.dof_count)
    ball[rings.top] = BALL_MM - np.sqrt(np.maximum(BALL_MM**2 - rings.radii**2, 0)) - depth_mm
    for iteration in range(60):
        strain = np.einsum("epij,ej->epi", rings.strain_of, moved[rings.dofs])
        stress, tangent, next_plastic = material(strain, plastic, yield_mpa)
        on_nodes = np.einsum("epij,epi,ep->ej", rings.strain_of, stress, rings.volume)
        force = np.bincount(rings.dofs.ravel(), on_nodes.ravel(), rings.dof_count)
        overlaps = moved[rings.top] - ball[rings.top] > 1e-12
        now = np.where(touches, force[rings.top] < 1e-13, overlaps) if iteration else touches
        is_same, touches = iteration > 0 and (now == touches).all(), now
        fixed = rings.held.copy()
        fixed[rings.top] |= touches
        step = np.where(fixed & ~rings.held, ball - moved, 0)
        left = -force[~fixed]
        if is_same and np.abs(step).max() < 1e-13 and np.linalg.norm(left) < 1e-8 * np.linalg.norm(force):
            return force[rings.top], touches, next_plastic
        ke = np.einsum("epia,epij,epjb,ep->eab", rings.strain_of, tangent, rings.strain_of, rings.volume, optimize=True)
        stiffness = sp.csc_matrix((ke.ravel(), (rings.rows, rings.columns)), (rings.dof_count,) * 2)[~fixed]
        step[~fixed] = linalg.spsolve(stiffness[:, ~fixed], left - stiffness @ step)
        moved += step
    sys.exit(f"no balance at {depth_mm} mm")


def main():
    edge_mm, modulus_over_yield, deepest_mm = map(float, sys.argv[1:])
    rings, yield_mpa = Rings(edge_mm), CONTACT_MPA / modulus_over_yield
    moved = np.zeros(rings.dof_count)
    plastic = np.zeros((len(rings.dofs), 4, 4))
    depths = deepest_mm / STEPS * np.concatenate([np.arange(1, 10) / 10, np.arange(1, STEPS + 1)])
    touches = rings.radii < 0.6 * np.sqrt(BALL_MM * depths[0])
    print("| depth, mm | force, N | a E'/(R Y) | mean pressure / Y |\n| --- | --- | --- | --- |")
    for place, depth_mm in enumerate(depths):
        force, touches, plastic = press(rings, moved, touches, plastic, depth_mm, yield_mpa)
        if place >= 9 and (place - 8) % 4 == 0:
            total, last = -force[touches].sum(), touches.sum() - 1
            radius = rings.radii[last : last + 2].mean()
            at = radius * CONTACT_MPA / BALL_MM / yield_mpa
            print(f"| {depth_mm:.4f} | {total:.2f} | {at:.1f} | {total / np.pi / radius**2 / yield_mpa:.2f} |", flush=True)


main()
