"""Runs: their progress, interruption, continuation and parallel execution."""

import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import condyle

from conftest import ROOT


def test_progress_reaches_the_end(small: condyle.Case) -> None:
    reported: list[condyle.Progress] = []
    condyle.run(small, progress=reported.append)
    assert [progress.updates for progress in reported if not progress.is_estimating][-1] == 3
    assert reported[-1].part == 1.0 and reported[0].part == 0.0


def test_a_bar_is_drawn_and_taken_away(small: condyle.Case, capsys: pytest.CaptureFixture[str]) -> None:
    condyle.run(small, progress=True)
    assert "100 %" in capsys.readouterr().err


def test_a_callback_stops_a_run_which_goes_on_to_the_same_numbers(small: condyle.Case, tmp_path: Path) -> None:
    whole = condyle.run(small)
    with pytest.raises(condyle.Interrupted) as stopped:
        condyle.run(small, out=tmp_path, progress=lambda progress: progress.updates < 2)
    assert stopped.value.updates == 2 and stopped.value.cycles < stopped.value.of_cycles
    begun = condyle.open(tmp_path)
    assert not begun.is_done and len(begun.wear.array) == 2
    with pytest.raises(AttributeError, match="a run that is not done does not have it"):
        _ = begun.mass_loss_mg
    done = condyle.run(small, out=tmp_path, resume=True)
    assert np.array_equal(done.wear.array, whole.wear.array)


def test_what_a_callback_raises_comes_out(small: condyle.Case) -> None:
    def fail(_: condyle.Progress) -> None:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        condyle.run(small, progress=fail)


LONG = """
import condyle
print("ready", flush=True)
condyle.run({"insert": {"edge_mm": 0.5, "layers": 1}, "march": {"updates": 1000}})
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_ctrl_c_stops_a_run() -> None:
    run = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert run.stdout is not None and run.stdout.readline() == "ready\n"
    time.sleep(2.0)
    assert run.poll() is None, "it still runs"
    run.send_signal(signal.SIGINT)
    sent = time.monotonic()
    _, message = run.communicate(timeout=60)
    assert "KeyboardInterrupt" in message
    assert time.monotonic() - sent < 10.0


def test_other_threads_work_meanwhile() -> None:
    ticks, done = [0], threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    ticking = threading.Thread(target=tick)
    ticking.start()
    condyle.run(ROOT / "cases" / "stanmore-force.toml")
    done.set()
    ticking.join()
    assert ticks[0] > 20


def test_runs_side_by_side_give_the_same_numbers(small: condyle.Case, result: condyle.Result) -> None:
    frictions = [0.03, 0.05, 0.07, 0.09]
    cases = [small.replace({"contact.friction": friction}) for friction in frictions]
    with ThreadPoolExecutor(4) as pool:
        together = [run.mass_loss_mg for run in pool.map(lambda case: condyle.run(case, fields=False), cases)]
    assert together == [condyle.run(case, fields=False).mass_loss_mg for case in cases]
    assert together[2] == result.mass_loss_mg and len(set(together)) == 4


def test_resume_without_a_folder_is_refused(small: condyle.Case) -> None:
    with pytest.raises(ValueError, match="give out"):
        condyle.run(small, resume=True)
