"""The programs of the gallery that use other libraries run where these are installed."""

import re
import subprocess
import sys

import pytest

from conftest import ROOT


def printed(name: str, library: str) -> str:
    pytest.importorskip(library, reason=f"{library} is not installed: python/gallery/{name}.py does not run")
    command = [sys.executable, ROOT / "python" / "gallery" / f"{name}.py"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_the_search_is_a_sampler_of_optuna() -> None:
    found = re.match(r"(\d+) trials; the best within the limit: ([\d.]+) mg", printed("optuna_sampler", "optuna"))
    assert found and int(found[1]) <= 20, found


def test_a_case_is_a_problem_of_pymoo() -> None:
    hypervolumes = re.findall(r"hypervolume ([\d.]+)", printed("pymoo_problem", "pymoo"))
    evolved, searched = map(float, hypervolumes)
    assert searched > evolved > 0.0
