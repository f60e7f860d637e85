"""The parts of a run compared with closed forms and finite differences."""

import numpy as np
import pytest

import condyle

SPHERE_ON_FLAT = {
    "femur": {"shape": "sphere", "radius_mm": 24.0},
    "insert": {"shape": "flat", "edge_mm": 1.0, "thickness_mm": 10.0},
    "contact": {"friction": 0.0},
    "machine": {"freedoms": {"vv": {"drive": "locked"}, "ml": {"drive": "locked"}}},
}


@pytest.fixture(scope="module")
def knee(small: condyle.Case) -> condyle.Knee:
    return condyle.Knee(small)


def test_verify_gap_and_normal_of_a_sphere() -> None:
    knee = condyle.Knee(SPHERE_ON_FLAT)
    directions = np.random.default_rng(1).normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    gap_mm, normals = knee.gap(directions * 23.7)
    assert np.allclose(gap_mm, -0.3) and np.allclose(normals, directions)


def test_verify_the_force_of_a_sphere_is_stiffness_times_the_volume_of_its_cap() -> None:
    knee = condyle.Knee(SPHERE_ON_FLAT)
    young, poisson, thickness, radius, depth = 463.0, 0.46, 10.0, 24.0, 0.2
    stiffness = (1 - poisson) * young / ((1 + poisson) * (1 - 2 * poisson)) / thickness
    cap_mm3 = np.pi * depth**2 * (3 * radius - depth) / 3
    pressed = knee.contact(np.eye(3), [0.0, radius - depth, 0.0])
    assert pressed.force_n[1] == pytest.approx(-stiffness * cap_mm3, rel=0.01)
    assert pressed.area_mm2 == pytest.approx(np.pi * (2 * radius * depth - depth**2), rel=0.02)


def test_the_tangent_is_the_derivative_of_the_wrench(knee: condyle.Knee) -> None:
    rotation, translation = knee.neutral_pose

    def wrench(shift: np.ndarray) -> np.ndarray:
        pressed = knee.contact(rotation, translation + shift)
        return np.concatenate([pressed.moment_nmm, pressed.force_n])

    tangent = knee.contact(rotation, translation).tangent
    step_mm = 1e-5
    for axis in range(3):
        shift = step_mm * np.eye(3)[axis]
        slope = (wrench(shift) - wrench(-shift)) / (2 * step_mm)
        assert np.allclose(tangent[:, 3 + axis], slope, rtol=1e-4, atol=1e-3 * abs(slope).max())


def test_the_first_cycle_is_that_of_the_run(knee: condyle.Knee, result: condyle.Result) -> None:
    cycle = knee.first_cycle()
    first = result.kinematics["cycles"] == 0
    assert np.array_equal(cycle.percent, result.kinematics["percent"][first])
    pose = result.femur_pose.array[first]
    assert np.array_equal(cycle.translation_mm, pose[:, 2:5])
    assert np.array_equal(cycle.rotation.reshape(-1, 9), pose[:, 5:])
    peaks = np.zeros(len(result.articulating))
    peaks[np.flatnonzero(result.articulating)] = cycle.pressure_mpa.max(axis=0)
    assert np.allclose(peaks, result.fields["peak_pressure_mpa"][1])


def test_what_is_no_pose_is_refused(knee: condyle.Knee) -> None:
    with pytest.raises(condyle.BadInput, match="no rotation"):
        knee.contact(-np.eye(3), [0, 0, 0])
    with pytest.raises(condyle.BadInput, match="shapes"):
        knee.contact(np.eye(3), [0, 0])
    with pytest.raises(condyle.BadInput, match="rows of x, y, z"):
        knee.gap([0.0, 0.0, 0.0])


def test_an_insert_that_yields_or_rests_does_so_under_the_load() -> None:
    def force_n(depth_mm: float, **contact: object) -> float:
        made = {**SPHERE_ON_FLAT, "contact": {"friction": 0.0, "model": "deformable", "deformable": contact}}
        insert = {"shape": "flat", "edge_mm": 1.5, "layers": 4, "thickness_mm": 10.0}
        knee = condyle.Knee({**made, "insert": insert})
        return float(-knee.contact(np.eye(3), [0.0, 24.0 - depth_mm, 0.0]).force_n[1])

    elastic_n = force_n(0.4)
    assert force_n(0.4, plasticity="j2") < 0.98 * elastic_n
    assert force_n(0.4, backside="resting") < 0.99 * elastic_n
    with pytest.raises(condyle.NotSolved, match="presses the insert flat"):
        force_n(8.0, plasticity="j2", yield_stress_mpa=2.0, hardening=[[0.0, 2.0]])
