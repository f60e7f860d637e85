"""Errors are exceptions with the command's text and their fields."""

import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest

import condyle

WRONG = "[contact]\nfrictoin = 0.04\n[march]\nupdates = 0\n"


def test_a_wrong_case_names_its_places() -> None:
    with pytest.raises(condyle.BadInput) as raised:
        condyle.Case.from_text(WRONG)
    first, second = raised.value.problems
    assert (first.key, first.line, first.column, first.file) == ("contact.frictoin", 2, 1, "case")
    assert first.advice == "did you mean `friction`?"
    assert (second.key, second.line) == ("march.updates", 4)
    again = pickle.loads(pickle.dumps(raised.value))
    assert (str(again), again.problems) == (str(raised.value), raised.value.problems)


def test_the_text_is_that_of_the_command(command: str, tmp_path: Path) -> None:
    case = tmp_path / "wrong.toml"
    case.write_text(WRONG)
    message = subprocess.run([command, "check", "wrong.toml"], cwd=tmp_path, capture_output=True, text=True, check=False)
    with pytest.raises(condyle.BadInput) as raised:
        condyle.Case.from_text(WRONG, name="wrong.toml")
    assert message.returncode == 2 and message.stderr.strip() == str(raised.value).strip()


@pytest.mark.parametrize(
    ("case", "kind", "message"),
    [
        ("not-there.toml", condyle.BadInput, "not-there.toml cannot be read"),
        ({"femur": {"start_mm": [80.0, 0.0]}}, condyle.BadInput, "counterface and insert are apart"),
        ({"limits": {"memory_gb": 0.01}}, condyle.BadInput, "memory"),
        ({"contact": {"friction": "slippery"}}, condyle.BadInput, "friction"),
        ({"contact": {"friction": object()}}, condyle.BadInput, "no value of a case"),
        ("title = 'a\n", condyle.BadInput, "this is not TOML"),
    ],
)
def test_every_refusal_has_a_reason(case: object, kind: type, message: str) -> None:
    with pytest.raises(kind) as raised:
        condyle.run(case)  # type: ignore[arg-type]
    assert message in str(raised.value)


@pytest.mark.parametrize("value", [None, [1.0, None], np.ma.masked_equal([1.0, 9.0], 9.0), float("nan")])
def test_values_that_a_case_cannot_have_are_named(small: condyle.Case, value: object) -> None:
    with pytest.raises(condyle.BadInput, match="is no value of a case; give finite numbers"):
        small.replace({"contact.friction": value})


def test_physics_that_cannot_be_solved_has_its_own_exception() -> None:
    # As much wear as goes through any insert.
    worn = {"wear": {"wear_factor_mm3_per_nm": 1e-5}, "march": {"updates": 3}, "insert": {"edge_mm": 3.0}}
    with pytest.raises(condyle.NotSolved) as raised:
        condyle.run(worn)
    assert "update" in str(raised.value) and "kept in" not in str(raised.value)


def test_folders_are_refused_as_the_command_does(small: condyle.Case, tmp_path: Path) -> None:
    with pytest.raises(condyle.BadInput, match="holds no run"):
        condyle.open(tmp_path)
    condyle.run(small, out=tmp_path / "out")
    with pytest.raises(condyle.BadInput, match="already holds a run"):
        condyle.run(small, out=tmp_path / "out")
    condyle.run(small, out=tmp_path / "out", force=True)
    mesh = tmp_path / "out" / "insert_0002.vtu"
    mesh.write_bytes(mesh.read_bytes()[:-1] + b"x")
    with pytest.raises(condyle.BadInput, match="damaged"):
        condyle.open(tmp_path / "out")


def test_characters_that_steer_a_terminal_are_shown_as_escapes() -> None:
    for name in ["\x1b[31m.toml", "\u202e.toml"]:
        with pytest.raises(condyle.BadInput) as raised:
            condyle.Case.read(name)
        assert name[0] not in str(raised.value) and f"\\u{{{ord(name[0]):x}}}" in str(raised.value)


def test_an_extra_that_is_missing_is_named(result: condyle.Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(ImportError, match=r"condyle with \[pandas\]"):
        result.to_pandas()
