"""The programs of the gallery run, with the libraries that they use."""

import re
import subprocess
import sys

from conftest import ROOT


def printed(name: str) -> str:
    command = [sys.executable, ROOT / "python" / "gallery" / f"{name}.py"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_the_search_is_a_sampler_of_optuna() -> None:
    found = re.match(r"(\d+) trials; the best within the limit: ([\d.]+) mg", printed("optuna_sampler"))
    assert found and int(found[1]) <= 20, found


def test_a_case_is_a_problem_of_pymoo() -> None:
    hypervolumes = re.findall(r"hypervolume ([\d.]+)", printed("pymoo_problem"))
    evolved, searched = map(float, hypervolumes)
    assert searched > evolved > 0.0
