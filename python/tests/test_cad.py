"""STEP files as bodies, written by OpenCASCADE itself."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import condyle
from condyle._ply import ply_bytes
from condyle.cad import _joined, read_step

RADIUS_MM = 24.0


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ball away from the origin, in a file of metres."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere
    from OCP.gp import gp_Pnt
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    path = tmp_path_factory.mktemp("step") / "ball.step"
    writer = STEPControl_Writer()
    set_text = getattr(Interface_Static, "SetCVal_s", None) or Interface_Static.SetCVal
    set_text("write.step.unit", "M")
    writer.Transfer(BRepPrimAPI_MakeSphere(gp_Pnt(1.0, 30.0, -5.0), RADIUS_MM).Shape(), STEPControl_AsIs)
    writer.Write(str(path))
    return path


@pytest.mark.parametrize("deflection_mm", [0.1, 0.01])
def test_verify_a_ball_is_closed_faces_outwards_and_keeps_the_deflection(step: Path, deflection_mm: float) -> None:
    vertices, triangles = read_step(step, deflection_mm=deflection_mm)
    from_centre = vertices - [1.0, 30.0, -5.0]
    assert np.allclose(np.linalg.norm(from_centre, axis=1), RADIUS_MM)
    a, b, c = (from_centre[corner] for corner in triangles.T)
    middles = np.concatenate([(a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3])
    assert np.linalg.norm(middles, axis=1).min() > RADIUS_MM - deflection_mm
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert set(np.unique(edges, axis=0, return_counts=True)[1]) == {2}, "every edge has two triangles"
    volume_mm3 = np.linalg.det(from_centre[triangles]).sum() / 6.0
    assert volume_mm3 == pytest.approx(4 / 3 * np.pi * RADIUS_MM**3, rel=3 * deflection_mm / RADIUS_MM)


def test_a_ball_of_step_presses_like_the_ball(step: Path) -> None:
    vertices, triangles = read_step(step)
    on_flat = {
        "insert": {"shape": "flat", "edge_mm": 1.0},
        "machine": {"freedoms": {"vv": {"drive": "locked"}, "ml": {"drive": "locked"}}},
    }
    ball = condyle.Case.from_dict({**on_flat, "femur": {"shape": "sphere", "radius_mm": RADIUS_MM}})
    of_step = condyle.Case.from_dict(on_flat).with_femur(vertices - [1.0, 30.0, -5.0], triangles, flexion_axis_mm=[0.0, 0.0])
    place = [0.0, RADIUS_MM - 0.2, 0.0]
    exact, meshed = (condyle.Knee(case).contact(np.eye(3), place) for case in (ball, of_step))
    assert meshed.force_n[1] == pytest.approx(exact.force_n[1], rel=0.01)


def test_faces_that_lie_on_each_other_cancel() -> None:
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    sheet = square[[[0, 1, 2], [0, 2, 3]]]
    # A thin face whose third corner coincides with a neighbour's within the tolerance, on both sides.
    flap = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-4, 0.0]])
    vertices, triangles = _joined([sheet, flap[None], flap[None, ::-1] + 1e-9])
    assert len(triangles) == 2 and np.allclose(vertices[triangles], sheet)


def test_the_module_converts_a_file_for_the_command(step: Path, tmp_path: Path) -> None:
    mesh = tmp_path / "ball.ply"
    command = [sys.executable, "-m", "condyle.cad"]
    ran = subprocess.run([*command, step, mesh], capture_output=True, text=True, check=True)
    assert "48.0 x 48.0 x 48.0 mm, at most 0.01 mm from" in ran.stdout
    vertices, triangles = read_step(step)
    assert mesh.read_bytes().endswith(ply_bytes(vertices, triangles, "ball")[-1000:])
    refused = subprocess.run([*command, tmp_path / "no.step", mesh], capture_output=True, text=True, check=False)
    assert refused.returncode == 1 and "no.step: this is not a STEP file" in refused.stderr


def test_what_is_no_step_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.step").write_text("no step")
    with pytest.raises(condyle.BadInput, match="not a STEP file"):
        read_step(tmp_path / "a.step")
    with pytest.raises(condyle.BadInput, match="not a STEP file"):
        read_step(tmp_path / "missing.step")
    with pytest.raises(condyle.BadInput, match="above 0"):
        read_step(tmp_path / "a.step", deflection_mm=0.0)
