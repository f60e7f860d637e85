"""The package itself: small, quick to import, typed, and documented by examples that run."""

import doctest
import importlib
import pkgutil
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path

import pytest

import condyle

from conftest import ROOT

IMPORT = """
import time
start = time.perf_counter()
import condyle
print(time.perf_counter() - start)
import sys
assert "numpy" not in sys.modules
"""


def test_import_takes_less_than_a_tenth_of_a_second() -> None:
    def seconds() -> float:
        return float(subprocess.run([sys.executable, "-c", IMPORT], check=True, capture_output=True, text=True).stdout)

    assert min(seconds() for _ in range(5)) < 0.1


def test_the_wheel_is_below_8_mb_and_asks_for_numpy_and_a_progress_bar_alone(tmp_path: Path) -> None:
    compiled = Path(importlib.import_module("condyle._condyle").__file__ or "")
    folder = Path(condyle.__file__).parent
    assert ".abi3." in compiled.name or compiled.suffix == ".pyd"
    # A wheel is a zip file of the folder.
    wheel = tmp_path / "wheel.zip"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as packed:
        for file in folder.iterdir():
            if file.is_file():
                packed.write(file, file.name)
    assert wheel.stat().st_size < 8e6
    needed = [line for line in metadata.requires("condyle") or [] if "extra" not in line]
    assert [line.split(">")[0] for line in needed] == ["numpy", "tqdm"]
    assert condyle.__version__ == metadata.version("condyle")


MODULES = [module.name for module in pkgutil.iter_modules(condyle.__path__) if module.name != "_condyle"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_the_documentation_run(name: str) -> None:
    assert doctest.testmod(importlib.import_module(f"condyle.{name}")).failed == 0


def test_the_example_of_the_package_runs() -> None:
    assert doctest.testmod(condyle).attempted > 0


def test_all_that_is_public_is_documented() -> None:
    for name in condyle.__all__:
        thing = getattr(condyle, name)
        assert thing.__doc__, name
        if isinstance(thing, type):
            public = [key for key in vars(thing) if not key.startswith("_") and key not in ("count", "index")]
            assert [key for key in public if not getattr(thing, key).__doc__] == [], name


def test_stubs_are_those_of_the_compiled_module() -> None:
    tests = ROOT / "python" / "tests"
    command = [sys.executable, "-m", "mypy.stubtest", "condyle._condyle", "--mypy-config-file", tests / "stubtest.ini"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tests, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_pyright_is_content_with_the_examples() -> None:
    command = [sys.executable, "-m", "pyright", "--project", ".", "--pythonpath", sys.executable]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "python", check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_pyright_rejects_an_attribute_that_no_result_has(tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text("import condyle\n\nprint(condyle.run('').mass_los_mg)\n")
    command = [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "wrong.py"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 1 and '"mass_los_mg"' in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("example", sorted((ROOT / "python" / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    subprocess.run([sys.executable, example], check=True, cwd=tmp_path, capture_output=True)


def test_the_designs_of_the_example_have_their_masses(tmp_path: Path) -> None:
    example = ROOT / "python" / "examples" / "conformity.py"
    done = subprocess.run([sys.executable, example], check=True, cwd=tmp_path, capture_output=True, text=True)
    study = condyle.open_study(tmp_path / "conformity")
    means = {name: study["mass_loss_mg"][study["design"] == name].mean() for name in ("dished", "flat")}
    best, other = sorted(means, key=means.__getitem__)
    assert done.stdout.startswith(f"{best} {means[best]:.1f} mg, {other} {means[other]:.1f} mg\n{best} wears less in ")
