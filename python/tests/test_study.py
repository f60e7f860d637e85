"""Studies: the same bytes wherever tests run, whatever happens to the workers, and the answers of known functions."""

import json
import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import condyle

from conftest import ROOT

TABLES: dict[str, Any] = {
    "title": "Friction and load",
    "design": {"kind": "latin-hypercube", "size": 24, "seed": 3},
    "vary": [
        {"key": "contact.friction", "low": 0.03, "high": 0.1},
        {"key": "machine.axial_force.scale", "distribution": "normal", "standard_deviation": 0.02},
        {"key": "wear.law", "levels": ["archard", "kang"]},
    ],
    "limit": [{"output": "peak_pressure_mpa", "most": 40.0}],
}


@pytest.fixture(scope="module")
def study(small: condyle.Case) -> condyle.Study:
    return condyle.Study.from_dict(TABLES, case=small)


@pytest.fixture(scope="module")
def done(study: condyle.Study, tmp_path_factory: pytest.TempPathFactory) -> condyle.StudyResult:
    return study.run(tmp_path_factory.mktemp("study") / "one", threads=1)


def table(result: condyle.StudyResult) -> bytes:
    return (result.folder / "table.csv").read_bytes()


def test_the_table_has_every_test(study: condyle.Study, done: condyle.StudyResult) -> None:
    assert study.tests == done.answers["kept"] == len(done["row"]) == 24
    assert set(done.table["status"]) == {"done"} and set(done.table["wear.law"]) == {"archard", "kang"}
    friction = done["contact.friction"]
    assert friction.min() >= 0.03 and friction.max() <= 0.1 and len(set(friction)) == 24
    frame = done.to_pandas()
    assert frame.loc[7, "mass_loss_mg"] == done["mass_loss_mg"][7] and frame.attrs["units"]["mass_loss_mg"] == "mg"
    with pytest.raises(KeyError, match="there is no column 'mass'"):
        done["mass"]


def test_a_row_is_a_run(study: condyle.Study, done: condyle.StudyResult) -> None:
    row = 5
    case = study.case(row)
    assert case["contact.friction"] == done["contact.friction"][row]
    assert condyle.run(case, fields=False).mass_loss_mg == done["mass_loss_mg"][row]
    for missing in (24, -1):
        with pytest.raises(condyle.BadInput, match=f"the study has no row {missing}"):
            study.case(missing)


@pytest.mark.parametrize("workers", ["threads", "thread pool", "processes"])
def test_the_same_bytes_wherever_tests_run(
    study: condyle.Study, done: condyle.StudyResult, tmp_path: Path, workers: str
) -> None:
    if workers == "threads":
        other = study.run(tmp_path / "other", threads=3)
    elif workers == "thread pool":
        with ThreadPoolExecutor(2) as pool:
            other = study.run(tmp_path / "other", executor=pool, tests_a_task=5)
    else:
        with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
            other = study.run(tmp_path / "other", executor=pool, tests_a_task=5)
    assert table(other) == table(done) and other.answers == done.answers


def test_the_command_writes_the_same(command: str, small: condyle.Case, done: condyle.StudyResult, tmp_path: Path) -> None:
    from condyle._toml import document

    small.write(tmp_path / "case.toml")
    file = tmp_path / "study.toml"
    file.write_text('case = "case.toml"\n' + document(TABLES))
    subprocess.run([command, "study", file, "--out", tmp_path / "out"], check=True, capture_output=True)
    assert (tmp_path / "out" / "table.csv").read_bytes() == table(done)
    opened = condyle.open_study(tmp_path / "out")
    assert opened.answers == done.answers and opened["mass_loss_mg"].tolist() == done["mass_loss_mg"].tolist()
    read = condyle.Study.read(file)
    assert read.run(tmp_path / "out").answers == done.answers


def test_half_of_the_workers_die_and_nothing_is_lost(study: condyle.Study, done: condyle.StudyResult, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=4, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = sorted(client.run(os.getpid).values())
        reported: list[int] = []

        def kill_half(progress: condyle.StudyProgress) -> None:
            reported.append(progress.kept)
            if 0 < progress.kept < study.tests and pids:
                for pid in pids[:2]:
                    os.kill(pid, signal.SIGKILL)
                pids.clear()

        other = study.run(tmp_path / "other", kill_half, client=client, tests_a_task=2)
    assert not pids, "no worker was killed"
    assert reported[0] == 0 and reported[-1] == study.tests
    assert table(other) == table(done) and other.answers == done.answers


def test_a_scheduler_that_dies_ends_the_study_with_the_command_that_resumes(small: condyle.Case, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from condyle._toml import document

    small.write(tmp_path / "case.toml")
    file, out, address = tmp_path / "study.toml", tmp_path / "out", tmp_path / "scheduler.json"
    file.write_text('case = "case.toml"\n' + document(TABLES))
    run = (sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0")
    scheduler = subprocess.Popen([*run, "--no-dashboard", "--scheduler-file", str(address)])
    worker = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(address), "--no-dashboard"]
    )
    died: list[float] = []

    def kill_the_scheduler(progress: condyle.StudyProgress) -> None:
        if progress.kept and not died:
            scheduler.kill()
            died.append(time.monotonic())

    client = distributed.Client(scheduler_file=str(address), timeout=60)
    try:
        client.wait_for_workers(1, timeout=60)
        with pytest.raises(condyle.StudyInterrupted, match="the Dask scheduler") as lost:
            condyle.Study.read(file).run(out, kill_the_scheduler, client=client, tests_a_task=2)
        assert time.monotonic() - died[0] < 30.0
        assert f"condyle study {file} --out {out}" in str(lost.value) and 0 < lost.value.kept < 24
    finally:
        scheduler.kill()
        worker.kill()
        client.close(timeout=1)
    assert condyle.Study.read(file).run(out, threads=1).answers["kept"] == 24


def test_a_study_that_was_stopped_goes_on(study: condyle.Study, done: condyle.StudyResult, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(condyle.StudyInterrupted, match="the same call resumes") as stopped:
        study.run(out, lambda progress: progress.kept < 4, threads=1)
    assert 4 <= stopped.value.kept < study.tests
    with ThreadPoolExecutor(1) as pool, pytest.raises(condyle.StudyInterrupted):
        study.run(out, lambda progress: progress.kept < 12, executor=pool, tests_a_task=3)
    with pytest.raises(RuntimeError, match="mine"):
        study.run(out, _raise, threads=1)
    with pytest.raises(condyle.BadInput, match="an unfinished study"):
        condyle.open_study(out)
    reported: list[float] = []
    result = study.run(out, lambda progress: reported.append(progress.part), threads=2)
    assert reported[0] >= 0.5 and reported[-1] == 1.0
    assert table(result) == table(done)


def test_answers_of_a_part_are_not_those_of_the_tests(study: condyle.Study, tmp_path: Path) -> None:
    for kept in (4, 12):
        with pytest.raises(condyle.StudyInterrupted):
            study.run(tmp_path, lambda progress, kept=kept: progress.kept < kept, threads=1)
        if kept == 4:
            assert study.answered(tmp_path).answers.kept == condyle.open_study(tmp_path).answers.kept < 12
    with pytest.raises(condyle.BadInput, match=r"holds \d+ tests, and answers of \d+"):
        condyle.open_study(tmp_path)
    assert study.answered(tmp_path).answers.kept == len(condyle.open_study(tmp_path)["row"]) >= 12


def test_a_waveform_is_processed_once(small: condyle.Case, tmp_path: Path) -> None:
    tables = {"design": {"kind": "one-at-a-time"}, "vary": [{"key": "machine.axial_force.scale", "levels": [1.0, 1.1]}]}
    file = tmp_path / "case.toml"
    file.write_text("[machine.axial_force]\nwaveform = 'iso-like'\nscale = 1.2\n")
    by_file = condyle.Study.from_dict({"case": "case.toml", **tables}, folder=tmp_path)
    case = condyle.Case.read(file)
    for same in (case, condyle.Case.from_text(file.read_text())):
        study = condyle.Study.from_dict(tables, case=same)
        assert [study.case(row) for row in range(3)] == [by_file.case(row) for row in range(3)]
    changed = case.replace({"contact.friction": 0.05})
    with pytest.raises(condyle.BadInput, match=r"varies the processing of machine\.axial_force"):
        condyle.Study.from_dict(tables, case=changed)
    named = {"name": "a", "set": ["machine.axial_force.offset=10"]}
    other = {"vary": TABLES["vary"][:1], "design": TABLES["design"]}
    with pytest.raises(condyle.BadInput, match=r"varies the processing of machine\.axial_force"):
        condyle.Study.from_dict({**other, "alternative": [named]}, case=changed)
    assert condyle.Study.from_dict(other, case=changed).tests == 24
    plain = condyle.Study.from_dict(tables, case=small.replace({"contact.friction": 0.05}))
    assert plain.case(2)["machine.axial_force.knots_n"] == by_file.case(2)["machine.axial_force.knots_n"]


@pytest.mark.parametrize("is_replaced", [False, True])
def test_a_low_pass_is_of_its_own_waveform(is_replaced: bool) -> None:
    low_pass = {"machine.flexion.low_pass_harmonics": 8}
    case = condyle.Case.from_text(
        "[machine.flexion]\nwaveform = 'iso-like'\n" + ("" if is_replaced else "low_pass_harmonics = 8\n")
    )
    changed = case.replace({"contact.friction": 0.05, **(low_pass if is_replaced else {})})
    for key, levels in {"scale": [0.9, 1.1], "low_pass_harmonics": [8, 9]}.items():
        tables = {"design": {"kind": "one-at-a-time"}, "vary": [{"key": f"machine.axial_force.{key}", "levels": levels}]}
        study = condyle.Study.from_dict(tables, case=changed)
        assert study.case(2) == changed.replace({f"machine.axial_force.{key}": levels[1]})
        tables["vary"] = [{"key": f"machine.flexion.{key}", "levels": levels}]
        with pytest.raises(condyle.BadInput, match=r"varies the processing of machine\.flexion, which"):
            condyle.Study.from_dict(tables, case=changed)


def test_a_waveform_that_a_case_cannot_process_is_said_to_be_so() -> None:
    tables = {"design": {"kind": "one-at-a-time"}, "vary": [{"key": "machine.joints.penetration.load.scale", "levels": [0.9]}]}
    case = condyle.Case.read(ROOT / "cases" / "hip-iso.toml")
    for one in (case, case.replace({"contact.friction": 0.05})):
        with pytest.raises(condyle.BadInput, match=r"\[machine\.joints\] has no key\s+(\| )?`penetration`"):
            condyle.Study.from_dict(tables, case=one)


def test_a_low_pass_is_known_of_every_waveform() -> None:
    # The bodies of some cases are not part of the repository.
    own = [path for path in sorted((ROOT / "cases").glob("*.toml")) if "shared/data" not in path.read_text()]
    for path in own:
        case = condyle.Case.read(path)
        as_run = condyle.Case.from_text(case.text).replace({"contact.friction": 0.05})
        activities = [f"activity.{one['name']}" for one in case.to_dict().get("activity", [])]
        for above in ["machine", *activities]:
            for name, value in case[above].items():
                if isinstance(value, dict) and "interpolation" in value:
                    low_passed = as_run.replace({f"{above}.{name}.low_pass_harmonics": 8})
                    assert not as_run.has_processed(f"{above}.{name}") and low_passed.has_processed(f"{above}.{name}"), path


def test_a_case_in_a_study_keeps_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = "".join(f"{percent},{500 + percent * (100 - percent) / 5}\n" for percent in range(0, 101, 5))
    (tmp_path / "load.csv").write_text("percent,axial_force_n\n" + rows)
    text = "[machine.axial_force]\nfile = 'load.csv'\n"
    (tmp_path / "case.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    cases = [condyle.Case.read("case.toml"), condyle.Case.from_text(text)]
    monkeypatch.chdir("/")
    for case in cases:
        study = condyle.Study.from_dict({**TABLES, "vary": TABLES["vary"][:1]}, case=case)
        assert pickle.loads(pickle.dumps(study)).case(3)["machine.axial_force"] == case["machine.axial_force"]


def _raise(progress: condyle.StudyProgress) -> None:
    raise RuntimeError("mine")


def test_shards_are_merged(
    study: condyle.Study, command: str, small: condyle.Case, done: condyle.StudyResult, tmp_path: Path
) -> None:
    from condyle._toml import document

    small.write(tmp_path / "case.toml")
    (tmp_path / "study.toml").write_text('case = "case.toml"\n' + document(TABLES))
    parts = [tmp_path / f"part-{number}" for number in (1, 2)]
    for number, part in enumerate(parts, 1):
        shard = ["--shard", f"{number}/2", "--out", part]
        subprocess.run([command, "study", tmp_path / "study.toml", *shard], check=True, capture_output=True)
    read = condyle.Study.read(tmp_path / "study.toml")
    assert table(read.merge(parts, tmp_path / "whole")) == table(done)


def test_a_test_that_fails_is_a_row(small: condyle.Case, tmp_path: Path) -> None:
    # Each value is in its range; the second insert is too fine for the memory that it may take, which is seen as it is built.
    (tmp_path / "rows.csv").write_text("insert.edge_mm,limits.memory_gb\n4,2\n0.2,0.1\n")
    tables = {"design": {"kind": "rows", "file": "rows.csv"}}
    study = condyle.Study.from_dict(tables, folder=tmp_path, case=small)
    with ThreadPoolExecutor(1) as pool:
        other = study.run(tmp_path / "pool", executor=pool)
    result = study.run(tmp_path / "here")
    assert result.table["status"].tolist() == ["done", "failed"] and "memory" in result.table["reason"][1]
    assert np.isnan(result["mass_loss_mg"][1]) and result["mass_loss_mg"][0] > 0.0
    assert table(other) == table(result) and result.answers["failed"][0]["tests"] == 1


def test_bodies_may_be_arrays(small: condyle.Case, result: condyle.Result, tmp_path: Path) -> None:
    case = small.with_femur(result.femur_points_mm, result.femur_triangles)
    tables = {"design": {"kind": "one-at-a-time"}, "vary": [{"key": "contact.friction", "levels": [0.04]}]}
    study = condyle.Study.from_dict(tables, case=case)
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = pickle.loads(pickle.dumps(study)).run(tmp_path / "out", executor=pool)
    assert found["contact.friction"].tolist() == [0.07, 0.04]
    assert found["mass_loss_mg"][1] == condyle.run(study.case(1), fields=False).mass_loss_mg


def test_bad_input_says_where(small: condyle.Case, study: condyle.Study, done: condyle.StudyResult, tmp_path: Path) -> None:
    wrong = {**TABLES, "vary": [{"key": "contact.frictoin", "low": 0.0, "high": 1.0}]}
    with pytest.raises(condyle.BadInput, match="frictoin") as error:
        condyle.Study.from_dict(wrong, case=small)
    assert error.value.problems[0].line is not None
    with pytest.raises(condyle.BadInput, match="case"):
        condyle.Study.from_dict(TABLES)
    other = condyle.Study.from_dict({**TABLES, "design": {"kind": "sobol", "size": 8}}, case=small)
    with pytest.raises(condyle.BadInput, match="another study"):
        other.run(done.folder)
    with pytest.raises(condyle.BadInput, match="no study"):
        condyle.open_study(tmp_path)
    search = {"kind": "optimise", "size": 40, "minimise": "mass_loss_mg"}
    vary = [{"key": "insert.sagittal_radius_mm", "low": 45.0, "high": 60.0}]
    with (
        ThreadPoolExecutor(1) as pool,
        pytest.raises(condyle.BadInput, match="the tests of this design depend on earlier ones"),
    ):
        condyle.Study.from_dict({"design": search, "vary": vary}, case=small).run(tmp_path / "search", executor=pool)
    with pytest.raises(ValueError, match="not both"), ThreadPoolExecutor(1) as pool:
        study.run(tmp_path / "both", executor=pool, client=object())


def test_an_adaptive_study_ends_when_its_output_is_known(small: condyle.Case, tmp_path: Path) -> None:
    design = {"kind": "adaptive", "until": "mass_loss_mg known to 2 %", "size": 40}
    vary = [{"key": "contact.friction", "low": 0.04, "high": 0.1}]
    result = condyle.Study.from_dict({"design": design, "vary": vary}, case=small).run(tmp_path / "out")
    aim = result.answers.aim
    assert aim.is_known and aim.error <= aim.part == 0.02
    assert aim.tests == result.answers.kept < 40
    emulated = result.answers.emulated
    assert all((one.distribution is None) == (one.q2 < 0.9) for one in emulated)
    for one in filter(lambda one: one.distribution, emulated):
        assert one.distribution.percentiles[0] <= one.distribution.mean <= one.distribution.percentiles[6]
        assert f"{one.distribution.percentiles[3]:.5g}" in result.answers._repr_html_()
    other = condyle.run(small.replace({"contact.friction": 0.083}), fields=False).mass_loss_mg
    mass, _ = result.emulator("mass_loss_mg").predict({"contact.friction": 0.083})
    assert abs(mass / other - 1.0) < 0.02


def test_a_worker_with_other_files_is_refused(small: condyle.Case, result: condyle.Result, tmp_path: Path) -> None:
    from condyle._workers import Source, run_rows

    study = condyle.Study.from_dict(TABLES, case=small)
    other = Source(*study._source[:4], "0" * 64, condyle.__version__)
    with pytest.raises(condyle.BadInput, match="other meshes"):
        run_rows(other, [0])
    with pytest.raises(condyle.BadInput, match="a worker has condyle"):
        run_rows(study._source._replace(version="0.0.1"), [0])


def ishigami(x: np.ndarray) -> np.ndarray:
    """On (0, 1)^3, scaled to (-pi, pi)."""
    x = np.pi * (2.0 * x - 1.0)
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def g_function(x: np.ndarray) -> np.ndarray:
    """Of Sobol, with a = 0, 1, 4.5."""
    a = np.array([0.0, 1.0, 4.5])
    return np.prod((np.abs(4.0 * x - 2.0) + a) / (1.0 + a), axis=1)


# First and total indices in closed form (Saltelli et al. 2008).
EXACT = {
    "ishigami": ([0.3139, 0.4424, 0.0], [0.5576, 0.4424, 0.2437]),
    "g-function": ([0.7200, 0.1800, 0.0238], [0.7873, 0.2423, 0.0343]),
}


def made_up(
    design: dict[str, Any], function: Any, case: condyle.Case, out: Path
) -> tuple[np.ndarray, np.ndarray, dict[str, Any]]:
    """A study whose tests are not run: places of its inputs in (0, 1), ``function`` of them, and what the study makes of it."""
    ranges = {"contact.friction": (0.02, 0.12), "material.poissons_ratio": (0.3, 0.46), "insert.thickness_mm": (8.0, 12.0)}
    vary = [{"key": key, "low": low, "high": high} for key, (low, high) in ranges.items()]
    study = condyle.Study.from_dict({"design": design, "vary": vary, "answers": {"outputs": ["mass_loss_mg"]}}, case=case)
    places = np.empty((study.tests, 3))
    for row in range(study.tests):
        changes = dict(change.split("=") for change in study._raw.changes(row, None))
        places[row] = [(float(changes[key]) - low) / (high - low) for key, (low, high) in ranges.items()]
    found = function(places)
    held = study._raw.hold(os.fspath(out))
    held.keep(study._raw, [(row, ([float(value)] + [0.0] * 9, "")) for row, value in enumerate(found)])
    held.close()
    return places, found, study.answered(out).answers


@pytest.mark.parametrize(("name", "function"), [("ishigami", ishigami), ("g-function", g_function)])
def test_sobol_indices_are_those_of_salib(name: str, function: Any, small: condyle.Case, tmp_path: Path) -> None:
    salib = pytest.importorskip("SALib.analyze.sobol")
    design = {"kind": "saltelli", "size": 2048, "seed": 5}
    _, found, answers = made_up(design, function, small, tmp_path / "out")
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[0.0, 1.0]] * 3}
    own = answers["indices"]
    first, total = ([index[kind] for index in own] for kind in ("first", "total"))
    theirs = salib.analyze(problem, found, calc_second_order=False, seed=1)
    np.testing.assert_allclose(first, theirs["S1"], atol=0.01)
    np.testing.assert_allclose(total, theirs["ST"], atol=0.01)
    exact_first, exact_total = EXACT[name]
    np.testing.assert_allclose(first, exact_first, atol=0.03)
    np.testing.assert_allclose(total, exact_total, atol=0.03)
    for index, exact in zip(own, exact_total):
        low, high = index["total_interval"]
        assert low - 0.01 <= exact <= high + 0.01


def test_an_emulator_predicts_and_does_not_extrapolate(small: condyle.Case, tmp_path: Path) -> None:
    design = {"kind": "sobol", "size": 128, "seed": 5}
    places, found, answers = made_up(design, ishigami, small, tmp_path / "out")
    emulator = condyle.open_study(tmp_path / "out").emulator("mass_loss_mg")
    assert emulator.q2 == answers["emulated"][0]["q2"] > 0.9
    first = [index["first"] for index in answers["indices"]]
    np.testing.assert_allclose(first, EXACT["ishigami"][0], atol=0.03)
    ranges = emulator.ranges
    ends = np.array(list(ranges.values()))

    def at(points: np.ndarray) -> dict[str, np.ndarray]:
        return dict(zip(ranges, (ends[:, 0] + points * (ends[:, 1] - ends[:, 0])).T))

    # In coordinates from 0 to 1 over the tests; the nugget is small, so that tests are nearly interpolated.
    scaled = (places - places.min(axis=0)) / np.ptp(places, axis=0)
    mean, deviation = emulator.predict(at(scaled))
    np.testing.assert_allclose(mean, found, atol=1e-3)
    assert deviation.max() < 0.01
    between, deviation = emulator.predict(at(np.full((1, 3), 0.4)))
    assert between.shape == (1,) and deviation[0] > 0.0
    with pytest.raises(condyle.BadInput, match="do not extrapolate"):
        emulator.predict(at(np.full((1, 3), 1.01)))
    with pytest.raises(condyle.BadInput, match="needs a value"):
        emulator.predict({})
    with pytest.raises(condyle.BadInput, match="has no emulator of 'ap_range_mm'"):
        condyle.open_study(tmp_path / "out").emulator("ap_range_mm")


def test_every_design_has_its_own_emulator(small: condyle.Case, tmp_path: Path) -> None:
    study = condyle.Study.from_dict(
        {
            "design": {"kind": "sobol", "size": 16},
            "vary": [{"key": "contact.friction", "low": 0.05, "high": 0.1}],
            "alternative": [{"name": str(radius), "set": [f"insert.sagittal_radius_mm={radius}"]} for radius in (60, 80)],
        },
        case=small,
    )
    done = study.run(tmp_path / "out")
    for design in ("60", "80"):
        emulator = done.emulator("mass_loss_mg", design)
        own = done["design"] == design
        mean, _ = emulator.predict({"contact.friction": done["contact.friction"][own]})
        np.testing.assert_allclose(mean, done["mass_loss_mg"][own], rtol=0.05)
        assert emulator.design == design
    with pytest.raises(condyle.BadInput, match="it has 'mass_loss_mg' of the design '60'"):
        done.emulator("mass_loss_mg")


def test_elementary_effects_are_those_of_salib(small: condyle.Case, tmp_path: Path) -> None:
    salib = pytest.importorskip("SALib.analyze.morris")
    design = {"kind": "morris", "walks": 40, "levels": 8, "seed": 5}
    places, found, answers = made_up(design, ishigami, small, tmp_path / "out")
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[0.0, 1.0]] * 3}
    theirs = salib.analyze(problem, places, found, num_levels=8, seed=1)
    own = answers["elementary"]
    np.testing.assert_allclose([one["mu"] for one in own], theirs["mu"], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose([one["mu_star"] for one in own], theirs["mu_star"], rtol=1e-6)
    np.testing.assert_allclose([one["sigma"] for one in own], theirs["sigma"], rtol=1e-6)


def test_the_table_goes_to_parquet(done: condyle.StudyResult, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    done.to_parquet(tmp_path / "table.parquet")
    read = pandas.read_parquet(tmp_path / "table.parquet")
    assert read["mass_loss_mg"].tolist() == done["mass_loss_mg"].tolist()


def test_answers_are_those_in_the_folder(done: condyle.StudyResult) -> None:
    assert json.loads((done.folder / "answers.json").read_text()) == done.answers
    assert (done.folder / "study.html").stat().st_size > 10_000


def test_notebooks_show_studies_and_their_answers(study: condyle.Study, done: condyle.StudyResult) -> None:
    assert all(f"<td>{key}</td>" in study._repr_html_() for key in study.inputs)
    shown = done._repr_html_()
    assert "<td>mass loss</td><td>mg</td>" in shown and shown.count("<tr>") == 1 + len(done.answers["spreads"])
    assert not done["mass_loss_mg"].flags.writeable


SEARCH: dict[str, Any] = {
    "design": {"kind": "optimise", "size": 12, "seed": 2},
    "vary": [
        {"key": "contact.friction", "low": 0.03, "high": 0.1},
        {"key": "insert.thickness_mm", "levels": [8, 9.5, 12]},
    ],
    "limit": [{"output": "peak_pressure_mpa", "most": 40.0}],
}


def test_a_search_tested_elsewhere_is_that_of_the_study(small: condyle.Case, tmp_path: Path) -> None:
    study = condyle.Study.from_dict(SEARCH, case=small)
    inside = study.run(tmp_path / "inside")
    with study.search(tmp_path / "outside") as search:
        designs = search.ask(6)
        while designs:
            assert search.pending == designs
            search.tell(designs, [condyle.run(search.case(design), fields=False) for design in designs])
            designs = search.ask(2)
        assert search.tested == 12 and search.pending == []
        outside = search.answered()
    assert table(outside) == table(inside) and outside.answers == inside.answers
    assert set(outside["insert.thickness_mm"]) <= {8.0, 9.5, 12.0}


def test_results_that_do_not_fit_a_search_are_errors(study: condyle.Study, small: condyle.Case, tmp_path: Path) -> None:
    with condyle.Study.from_dict(SEARCH, case=small).search(tmp_path / "out") as search:
        (design,) = search.ask()
        for wrong, result, expected in [
            (design, {"mass_loss_mg": 1.0}, "lack `peak_pressure_mpa`"),
            (design, {"mass": 1.0}, "a test has no output 'mass'"),
            ({"contact.friction": 0.05}, "failed", "a design has the inputs contact.friction, insert.thickness_mm"),
            ({**design, "contact.friction": 0.3}, "failed", "`contact.friction = 0.3` is not within the range"),
        ]:
            with pytest.raises(condyle.BadInput, match=expected):
                search.tell([wrong], [result])
        with pytest.raises(condyle.BadInput, match="not that of the case of its design"):
            search.tell([design], [condyle.run(small.replace({"insert.thickness_mm": 8.25}), fields=False)])
        with pytest.raises(condyle.BadInput, match="has a wear_law of its own"):
            search.tell([design], [condyle.run(search.case(design), fields=False, wear_law=lambda _: 0.0)])
        assert search.tested == 0 and search.pending == [design]
        search.tell([design], [condyle.NotSolved("no equilibrium\nat 3 %")])
        assert search.tested == 1 and search.pending == []
        assert search.answered().table["reason"].tolist() == ["no equilibrium"]
    with (
        study.search(tmp_path / "other") as search,
        pytest.raises(condyle.BadInput, match="a design of the kind `latin-hypercube` proposes no tests"),
    ):
        search.ask()


def test_formulas_are_computed_from_results_unless_they_are_given(small: condyle.Case, tmp_path: Path) -> None:
    formula = {"name": "twice_mg", "formula": "2 * mass_loss_mg + 0 * newton_iterations"}
    with pytest.raises(condyle.BadInput, match="no output `newton_iterations`"):
        condyle.Study.from_dict({**SEARCH, "output": [formula]}, case=small)
    formula["formula"] = "2 * mass_loss_mg + 0 * cycles"
    limit = [{"output": "twice_mg", "most": 4.0}]
    study = condyle.Study.from_dict({**SEARCH, "output": [formula], "limit": limit}, case=small)
    with study.search(tmp_path / "out") as search:
        given, tested = search.ask(2)
        result = condyle.run(search.case(tested), fields=False)
        search.tell([given, tested], [{"mass_loss_mg": 1.0, "twice_mg": 3.0}, result])
        table = search.answered().table
    assert table["twice_mg"].tolist() == [3.0, 2 * result.mass_loss_mg]


def test_answers_are_attributes_that_cannot_be_changed(done: condyle.StudyResult) -> None:
    answers = done.answers
    assert answers == condyle.Answers(json.loads((done.folder / "answers.json").read_text()))
    assert answers.kept == answers["kept"] == 24 and answers.best is None and "spreads" in dir(answers)
    spread = answers.spreads[0]
    assert spread.output == "mass_loss_mg" and "percentiles" in dir(spread)
    assert pickle.loads(pickle.dumps(answers)) == answers
    with pytest.raises(AttributeError, match="the answer has no 'percentile'; it has output, title"):
        spread.percentile  # noqa: B018
    with pytest.raises(AttributeError, match="read-only: kept cannot be assigned"):
        answers.kept = 3
    with pytest.raises(TypeError):
        answers["kept"] = 3  # type: ignore[index]
    assert spread.title in spread._repr_html_() and "24 of 24 tests, latin-hypercube" in answers._repr_html_()
