"""Cases: read, changed, checked, written, compared, pickled."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import condyle

from conftest import ROOT, SMALL

STANMORE = ROOT / "cases" / "stanmore-force.toml"


def test_a_case_is_the_same_however_it_came(tmp_path: Path) -> None:
    case = condyle.Case.read(STANMORE)
    case.write(tmp_path / "written.toml")
    others = [
        condyle.Case.read(tmp_path / "written.toml"),
        condyle.Case.from_text(case.text),
        condyle.Case.from_dict(case.to_dict()),
        pickle.loads(pickle.dumps(case)),
        case.replace({"contact.friction": 0.04}).replace({"contact.friction": case["contact.friction"]}),
    ]
    assert all(other == case and hash(other) == hash(case) for other in others)
    assert case != case.replace({"contact.friction": 0.04})
    assert len({case, *others}) == 1


def test_changes_are_those_of_the_command() -> None:
    case = condyle.Case.read(STANMORE)
    changed = case.replace({"friction": np.float64(0.05), "wear.law": "kang", "insert.edge_mm": np.int64(2)})
    assert (changed["contact.friction"], changed["wear.law"], changed["insert.edge_mm"]) == (0.05, "kang", 2.0)
    assert case["contact.friction"] == 0.07, "the case itself stays"


def test_a_case_keeps_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "waves").mkdir()
    text = "[machine.ap_force]\nfile = 'waves/ap.csv'\n"
    rows = "".join(f"{percent},{percent * (100 - percent) / 25}\n" for percent in range(0, 101, 5))
    (tmp_path / "waves" / "ap.csv").write_text("percent,ap_force_n\n" + rows)
    (tmp_path / "case.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    case = condyle.Case.read("case.toml")
    monkeypatch.chdir("/")
    assert pickle.loads(pickle.dumps(case)).replace({"friction": 0.05}).replace({"friction": 0.07}) == case


def test_a_path_with_an_equals_sign_is_a_path(small: condyle.Case, tmp_path: Path) -> None:
    small.write(tmp_path / "friction=0.07.toml")
    assert condyle.run(str(tmp_path / "friction=0.07.toml"), fields=False).case == small
    assert condyle.run("march.updates = 1", fields=False).updates == 1


def test_a_check_says_what_the_command_says() -> None:
    check = condyle.Case.from_dict(SMALL).check()
    assert check.facts["side"] == "right" and check.warnings == []
    assert check.picture_svg.startswith("<svg")
    assert check.facts["at_rest"]["axial_force_n"] == pytest.approx(168, rel=0.02)


def test_bodies_come_from_arrays(tmp_path: Path) -> None:
    result = condyle.run(SMALL)
    neutral = result.neutral_pose
    origin, rotation = np.array(neutral["femoral_origin_mm"]), np.array(neutral["rotation"])
    vertices = (result.femur_points_mm - origin) @ rotation
    case = condyle.Case.from_dict(SMALL).with_femur(vertices, result.femur_triangles)
    meshed = condyle.run(case)
    assert meshed.mass_loss_mg == pytest.approx(result.mass_loss_mg, rel=0.05)
    assert pickle.loads(pickle.dumps(case)) == case
    case.write(tmp_path / "case.toml")
    assert condyle.Case.read(tmp_path / "case.toml") == case
    kept = condyle.run(case, out=tmp_path / "out")
    assert condyle.Case.read(tmp_path / "out" / "case.toml") == case
    assert kept.mass_loss_mg == meshed.mass_loss_mg
    moved = case.with_femur(vertices + [0.0, 0.0, 0.1], result.femur_triangles)
    assert moved != case and not moved.text.count("distal_radius")


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        ([[0.0, 0.0]], [[0, 0, 0]], "shape (1, 2)"),
        ([[0.0, 0.0, 0.0]], [[0, 0, 1]], "name vertices 0 to 1"),
        ([[0.0, 0.0, float("nan")]], [[0, 0, 0]], "no"),
        ([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]], "whole numbers"),
        ([], [], "shape (0,)"),
    ],
)
def test_arrays_that_are_no_body_are_refused(vertices: list, triangles: list, message: str) -> None:
    with pytest.raises(condyle.BadInput) as raised:
        condyle.Case.from_text("").with_femur(vertices, triangles)
    assert message in str(raised.value)
