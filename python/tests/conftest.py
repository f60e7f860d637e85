"""What the tests have in common: a small case, and one run of it."""

import os
from pathlib import Path

import pytest

import condyle

ROOT = Path(__file__).resolve().parents[2]
SMALL = {
    "insert": {"edge_mm": 3.0, "layers": 2},
    "march": {"updates": 3},
    "time": {"increments": 60},
    "accuracy": {"estimate": False},
}


@pytest.fixture(scope="session")
def small() -> condyle.Case:
    """A coarse case that runs in some hundredths of a second."""
    return condyle.Case.from_dict(SMALL)


@pytest.fixture(scope="session")
def result(small: condyle.Case) -> condyle.Result:
    return condyle.run(small)


@pytest.fixture(scope="session")
def command() -> str:
    """The command `condyle`, built from the same sources."""
    path = os.environ.get("CONDYLE_COMMAND")
    if path is None:
        assert os.environ.get("CI") != "true", "CONDYLE_COMMAND is not set"
        pytest.skip("CONDYLE_COMMAND does not say where the command is")
    return path
