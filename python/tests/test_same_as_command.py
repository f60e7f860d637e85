"""A run from Python has the numbers of the command, to the last bit, from memory and from a folder."""

import csv
import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import condyle

from conftest import ROOT

CASES = ["stanmore-force", "stanmore-displacement", "gait-and-stairs", "creep"]


@pytest.mark.parametrize("name", CASES)
def test_numbers_are_those_of_the_command(name: str, command: str, tmp_path: Path) -> None:
    case, out = ROOT / "cases" / f"{name}.toml", tmp_path / "by-command"
    subprocess.run([command, "run", case, "--out", out], check=True, capture_output=True)
    result, opened = condyle.run(case), condyle.open(out)
    for table in result.tables:
        with open(out / f"{table}.csv", newline="") as file:
            header, *rows = csv.reader(file)
        assert list(result.tables[table].columns) == header
        assert np.array_equal(result.tables[table].array, np.array(rows, dtype=float))
        assert np.array_equal(opened.tables[table].array, result.tables[table].array)
    assert_same(result, opened)
    assert without_times(json.loads((out / "summary.json").read_text())) == without_times(result.summary)


def test_a_folder_from_python_is_that_of_the_command(command: str, tmp_path: Path) -> None:
    case = ROOT / "cases" / "stanmore-force.toml"
    subprocess.run([command, "run", case, "--out", tmp_path / "a"], check=True, capture_output=True)
    condyle.run(case, out=tmp_path / "b")
    names = sorted(path.name for path in (tmp_path / "a").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "b").iterdir())
    for name in set(names) - {"summary.json", "report.html"}:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name


def test_a_deformable_insert_has_stress_from_the_first_update_on(tmp_path: Path) -> None:
    changes = {"contact.model": "deformable", "march.updates": 2, "insert.edge_mm": 2.5, "accuracy.estimate": False}
    case = condyle.Case.read(ROOT / "cases" / "stanmore-force.toml").replace(changes)
    result = condyle.run(case, out=tmp_path / "out")
    assert_same(result, condyle.open(tmp_path / "out"))
    stress = result.fields["von_mises_mpa"]
    assert stress.shape == result.fields["wear_depth_mm"].shape
    assert np.isnan(stress[0]).all() and np.isfinite(stress[1:]).all()


def assert_same(one: condyle.Result, other: condyle.Result) -> None:
    assert one.fields.keys() == other.fields.keys()
    for name in one.fields:
        assert np.array_equal(one.fields[name], other.fields[name], equal_nan=True), name
    for name in ("points_mm", "hexes", "articulating", "femur_points_mm", "femur_triangles", "update_cycles"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    assert one.case == other.case


def without_times(summary: dict) -> dict:
    """A summary but for what a clock says."""
    kept = {name: value for name, value in summary.items() if name != "wall_s"}
    kept["error"] = {name: value for name, value in summary["error"].items() if name != "wall_s"}
    return kept
