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


def test_a_key_is_found_by_its_path() -> None:
    case = condyle.Case.read(ROOT / "cases" / "gait-and-stairs.toml")
    assert case["activity.stairs.share"] == 0.15 == case.replace({"activity.gait.share": 0.85})["activity.stairs.share"]
    assert "contact.friction" in case and "activity.stairs.flexion" in case
    for missing in ("contact.frictoin", "contact.friction.value", "activity.running"):
        assert missing not in case
        with pytest.raises(KeyError, match=missing):
            case[missing]
    with pytest.raises(TypeError, match="not iterable"):
        list(case)  # type: ignore[call-overload]


def test_a_new_law_drops_the_constants_that_were_set(small: condyle.Case) -> None:
    kang = small.replace({"wear.law": "kang", "wear.cross_shear_exponent": 0.3, "decay": 0.2, "march.updates": 2})
    again = kang.replace({"wear.law": "power-law"})
    assert again == small.replace({"wear.law": "power-law", "march.updates": 2})
    assert kang.replace({"wear.law": "kang"}) == kang
    assert again.replace({"wear.law": "kang", "wear.cross_shear_exponent": 0.3, "decay": 0.2}) == kang


BODY = ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[0, 1, 2]])


def test_a_body_leaves_the_processing_of_waveforms(tmp_path: Path) -> None:
    processed = {"machine.axial_force.scale": 1.1, "machine.flexion.offset": 2.0, "machine.ap_force.low_pass_harmonics": 5}
    changed = condyle.Case.read(STANMORE).replace({**processed, "femur.spacing_mm": 44.0, "distal_radius": 36.0, "edge": 2.0})
    again = {"machine.axial_force.scale": 1.2, "machine.flexion.offset": 3.0, "machine.ap_force.low_pass_harmonics": 9}
    expected = condyle.Case.read(STANMORE).with_insert(*BODY, thickness_mm=8.0).with_femur(*BODY)
    assert changed.with_insert(*BODY, thickness_mm=8.0).with_femur(*BODY).replace(again) == expected.replace(again)
    written = changed.with_femur(*BODY).written_in(tmp_path)
    assert written.replace(again) == changed.with_femur(*BODY).replace(again) and not written.has_arrays


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
        (np.ma.masked_equal([[0.0, 0.0, 9.0]], 9.0), [[0, 0, 0]], "masked"),
    ],
)
def test_arrays_that_are_no_body_are_refused(vertices: list, triangles: list, message: str) -> None:
    with pytest.raises(condyle.BadInput) as raised:
        condyle.Case.from_text("").with_femur(vertices, triangles)
    assert message in str(raised.value)
