"""Judges a results folder from its files alone, with none of condyle's code.

Each finding names what is wrong with the answer and the checks of condyle of which one must have said so. An answer
with a finding of which nothing was said is silently wrong.
"""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np

# The eight corners of a hexahedron, each with its three neighbours in right-handed order.
CORNERS = np.array(
    [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3)]
)
FACES = np.array([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])

NEAR_RIM_MM = 1.5
# The judge's limits stand a little beyond the program's, so that a number on the border is no finding.
MAX_AT_RIM = 0.012
COUNTS_APART = 0.012
MAX_AP_MM = 26.0
MAX_IE_DEG = 36.0
THINNEST_MM = 5.9
YIELD_UNDER_A_BALL_MPA = 1.65 * 14.0

# Bearings that wear up to their rim: a worn cup embraces its head, and a pin touches with its whole end.
TOUCHED_WHOLE = ("hip", "specimen")

RIM_CHECKS = ("wear_at_rim", "pressure_at_rim", "femur_beyond_rim")


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong, and the checks that may have told it; none, where only an error would do."""

    what: str
    told_by: tuple


def judge(folder):
    """What is wrong with the answer in a results folder."""
    folder = Path(folder)
    summary = json.loads((folder / "summary.json").read_text())
    meshes = [meshio.read(path) for path in sorted(folder.glob("insert_*.vtu"))]
    motion = _table(folder / "kinematics.csv")
    findings = [
        *_numbers(summary, motion, meshes[-1]),
        *_inverted(meshes),
        *_volumes(summary, meshes),
        *_pressure(summary, motion),
    ]
    if summary["joint"] not in TOUCHED_WHOLE:
        findings += _rim(meshes[0], meshes[-1])
    if summary["joint"] == "knee":
        findings += [*_thickness(meshes[-1]), *_motion(motion), *_loads(motion)]
    return list(dict.fromkeys(findings))


def silent(findings, summary):
    """The findings of which the summary says nothing."""
    said = {warning["check"] for warning in [*summary["plausibility"], *summary["notes"]]}
    return [finding for finding in findings if not said.intersection(finding.told_by)]


def _table(path):
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def _numbers(summary, motion, mesh):
    """Not a number, or negative where that cannot be."""
    arrays = [*motion.values(), mesh.points, *mesh.point_data.values()]
    if not all(np.isfinite(array).all() for array in arrays):
        yield Finding("not a number", ())
    if min(summary["mass_loss_mg"], summary["max_depth_mm"], motion["contact_area_mm2"].min()) < 0:
        yield Finding("negative wear or area", ())


def _inverted(meshes):
    if any(corner_volumes(mesh).min() <= 0 for mesh in meshes):
        yield Finding("element inside out", ())


def corner_volumes(mesh):
    """The triple product of the edges at each corner of each hexahedron, mm3."""
    corners = mesh.points[_hexahedra(mesh)][:, CORNERS]
    first, second, third = (corners[:, :, side] - corners[:, :, 0] for side in (1, 2, 3))
    return np.einsum("eci,eci->ec", np.cross(first, second), third)


def _hexahedra(mesh):
    return mesh.cells_dict["hexahedron"]


def _articulating_faces(mesh):
    """Faces of one element only, whose four nodes articulate."""
    faces = _hexahedra(mesh)[:, FACES].reshape(-1, 4)
    _, index, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outside = faces[index[count == 1]]
    return outside[mesh.point_data["articulating"][outside].all(axis=1)]


def _node_areas(mesh, faces):
    """A quarter of the area of every face around each node, mm2."""
    corners = mesh.points[faces]
    diagonals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    areas = np.zeros(len(mesh.points))
    np.add.at(areas, faces.ravel(), np.repeat(np.linalg.norm(diagonals, axis=1) / 8, 4))
    return areas


def _distance_to_rim(mesh, faces, nodes):
    """From each node to the nearest edge of one articulating face only, mm."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    start, end = (mesh.points[edges[count == 1][:, side]] for side in (0, 1))
    along = end - start
    length2 = np.einsum("ei,ei->e", along, along)
    nearest = np.full(len(nodes), np.inf)
    for which, point in enumerate(mesh.points[nodes]):
        part = np.clip(np.einsum("ei,ei->e", point - start, along) / length2, 0, 1)
        nearest[which] = np.linalg.norm(point - start - part[:, None] * along, axis=1).min()
    return nearest


def _rim(unworn, worn):
    """Wear, or the highest pressure, at the rim of the articulating surface."""
    faces = _articulating_faces(unworn)
    volume = worn.point_data["wear_depth_mm"] * _node_areas(unworn, faces)
    nodes = np.flatnonzero(volume > 0)
    near = _distance_to_rim(unworn, faces, nodes) < NEAR_RIM_MM
    if volume[nodes[near]].sum() > MAX_AT_RIM * volume.sum():
        yield Finding("wear at the rim", RIM_CHECKS)
    pressed = worn.point_data["peak_pressure_mpa"].argmax()
    is_pressed = worn.point_data["peak_pressure_mpa"][pressed] > 0
    if is_pressed and _distance_to_rim(unworn, faces, [pressed])[0] < 0.9 * NEAR_RIM_MM:
        yield Finding("highest pressure at the rim", RIM_CHECKS)


def _volume(mesh):
    """By the divergence theorem over the outside, mm3: each face as two triangles, the mean of both ways to cut it."""
    faces = _hexahedra(mesh)[:, FACES].reshape(-1, 4)
    _, index, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    a, b, c, d = (mesh.points[faces[index[count == 1]][:, corner]] for corner in range(4))
    triangles = ((a, b, c), (a, c, d), (a, b, d), (b, c, d))
    return sum((np.cross(second, third) * first).sum() for first, second, third in triangles) / 12


def _volumes(summary, meshes):
    crept = summary.get("creep_volume_mm3", 0.0)
    lost = _volume(meshes[0]) - _volume(meshes[-1]) - crept
    if abs(lost - summary["volume_loss_mm3"]) > COUNTS_APART * summary["volume_loss_mm3"] + 0.01:
        yield Finding("volumes of mesh and wear differ", ("counts_of_volume",))


def _thickness(mesh):
    depth, left = mesh.point_data["wear_depth_mm"], mesh.point_data["thickness_mm"]
    scar = depth > 0.1 * depth.max()
    if scar.any() and left[scar].min() < THINNEST_MM:
        yield Finding("thin under the scar", ("thin_polyethylene",))


def _pressure(summary, motion):
    if "max_plastic_strain" in summary:
        return  # The insert of the model yields.
    highest = max(summary["peak_pressure_mpa"], motion["peak_pressure_mpa"].max())
    if highest > YIELD_UNDER_A_BALL_MPA:
        yield Finding("pressure beyond yield", ("pressure_beyond_yield",))


def _motion(motion):
    for cycle in np.unique(motion["cycles"]):
        rows = motion["cycles"] == cycle
        if np.ptp(motion["ap_mm"][rows]) > MAX_AP_MM:
            yield Finding("AP beyond that of knees", ("ap_range", "femur_beyond_rim", *RIM_CHECKS))
        if np.ptp(motion["ie_deg"][rows]) > MAX_IE_DEG:
            yield Finding("IE beyond that of knees", ("ie_range",))


def _loads(motion):
    """The femur is off the insert, or the two sides do not bear what the machine presses with."""
    loaded = motion["axial_force_n"] > 0.2 * motion["axial_force_n"].max()
    if (motion["contact_area_mm2"][loaded] == 0).any():
        yield Finding("femur off the insert under load", ("load_not_reached", "femur_beyond_rim", *RIM_CHECKS))
