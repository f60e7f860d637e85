"""The judge of random designs can say no, and what it measures is known in closed form."""

import json
import os
import shutil
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest

STUDY = Path(__file__).resolve().parents[2] / "validation" / "random-designs"
sys.path.insert(0, str(STUDY))

from designs import design, refined, toml  # noqa: E402
from judge import corner_volumes, judge, silent  # noqa: E402
from study import Ended, _hold_against_refined  # noqa: E402


@pytest.fixture
def folder(tmp_path):
    """A copy of the default case's results, to be spoilt."""
    copy = tmp_path / "results"
    shutil.copytree(os.environ["CONDYLE_RESULTS"], copy)
    for path in sorted(copy.glob("insert_*.vtu"))[1:-1]:
        path.unlink()
    return copy


def last(folder):
    path = sorted(folder.glob("insert_*.vtu"))[-1]
    return path, meshio.read(path)


def found(folder):
    return [finding.what for finding in judge(folder)]


def without_doubts(folder):
    summary = json.loads((folder / "summary.json").read_text())
    return {**summary, "plausibility": [], "notes": []}


def change(folder, **numbers):
    path = folder / "summary.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **numbers}))


def change_column(folder, name, value):
    path = folder / "kinematics.csv"
    header, *rows = path.read_text().splitlines()
    at = header.split(",").index(name)
    rows = [",".join(value if i == at else word for i, word in enumerate(row.split(","))) for row in rows]
    path.write_text("\n".join([header, *rows]) + "\n")


def test_default_case_is_pressed_beyond_yield_and_nothing_else(folder):
    assert found(folder) == ["pressure beyond yield"]
    assert [finding.what for finding in silent(judge(folder), without_doubts(folder))] == ["pressure beyond yield"]


def test_corner_volumes_are_those_of_a_box():
    points = np.array([[x, y, z] for z in (0, 4) for x, y in ((0, 0), (2, 0), (2, 3), (0, 3))], float)
    box = meshio.Mesh(points, [("hexahedron", [list(range(8))])])
    assert corner_volumes(box) == pytest.approx(24.0)


def test_an_element_inside_out_is_found(folder):
    path, mesh = last(folder)
    corner = mesh.cells_dict["hexahedron"][100][0]
    mesh.points[corner] += [0, 30, 0]
    mesh.write(path)
    assert "element inside out" in found(folder)


def test_wear_and_pressure_at_the_rim_are_found(folder):
    path, mesh = last(folder)
    articulating = np.flatnonzero(mesh.point_data["articulating"])
    edge = articulating[mesh.points[articulating][:, 0].argmin()]
    mesh.point_data["wear_depth_mm"][edge] = 5.0
    mesh.point_data["peak_pressure_mpa"][edge] = 90.0
    mesh.write(path)
    assert {"wear at the rim", "highest pressure at the rim"} <= set(found(folder))


def test_a_volume_that_the_mesh_did_not_lose_is_found(folder):
    volume = json.loads((folder / "summary.json").read_text())["volume_loss_mm3"]
    change(folder, volume_loss_mm3=1.02 * volume)
    assert "volumes of mesh and wear differ" in found(folder)


def test_thin_polyethylene_is_found(folder):
    path, mesh = last(folder)
    mesh.point_data["thickness_mm"] -= 3.5
    mesh.write(path)
    assert "thin under the scar" in found(folder)


@pytest.mark.parametrize(
    "column, value, what",
    [
        ("contact_area_mm2", "0", "femur off the insert under load"),
        ("ml_mm", "nan", "not a number"),
        ("contact_area_mm2", "-1", "negative wear or area"),
    ],
)
def test_a_spoilt_motion_is_found(folder, column, value, what):
    change_column(folder, column, value)
    assert what in found(folder)


def test_a_design_is_the_same_each_time_and_another_for_another_number():
    assert toml(design(7, "data")) == toml(design(7, "data"))
    assert toml(design(7, "data")) != toml(design(8, "data"))


def test_a_refined_design_leaves_the_coarse_one_alone():
    coarse = design(3, "data")
    fine = refined(coarse)
    assert fine["insert"]["edge_mm"] == coarse["insert"]["edge_mm"] / 2
    assert coarse == design(3, "data")


@pytest.mark.parametrize("doubts, silent_count", [([], 1), (["updates_overshoot"], 0), (["error_of_mass"], 0)])
def test_a_refined_run_that_doubts_its_own_error_is_no_reference(tmp_path, monkeypatch, doubts, silent_count):
    errors = {"mass_loss_percent": {"total": 1.0}, "max_depth_percent": {"total": 1.0}}
    coarse = {"mass_loss_mg": 10.0, "max_depth_mm": 0.1, "error": errors, "plausibility": [], "notes": []}
    finer = {**coarse, "mass_loss_mg": 12.0, "plausibility": [{"check": check} for check in doubts]}

    def run(_condyle, _case, folder):
        (folder / "results").mkdir()
        (folder / "results" / "summary.json").write_text(json.dumps(finer))
        return 0, ""

    monkeypatch.setattr("study.run", run)
    ended = Ended(1, "good", summary=coarse)
    _hold_against_refined(ended, "condyle", {}, tmp_path)
    assert len(ended.silent) == silent_count
    assert (ended.refined_mass_percent is None) == bool(doubts)
