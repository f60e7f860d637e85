"""Running the tests of a study on the workers of an executor."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _condyle
from .errors import BadInput, CondyleError, StudyInterrupted
from .progress import StudyProgress

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future

# Tasks submitted at a time: enough for a thousand workers, and a limit to the memory for a large study.
TASKS_AHEAD = 2000
# A task is at most this part of the remaining tests, so that no worker waits long for the last task of another.
LAST_TASKS = 32
# Attempts at a task whose worker dies; if all fail, the task itself is the likely cause.
MAX_TRIES = 10


class Source(NamedTuple):
    """The data from which a worker creates the study."""

    path: str
    text: str
    base: str
    files: tuple[tuple[str, bytes], ...]
    inputs_blake3: str
    version: str


class _Task(NamedTuple):
    rows: list[int]
    tries: int


def run_rows(source: Source, rows: list[int]) -> list[tuple[int, tuple[list[float], str] | str]]:
    """Runs the tests of ``rows``; called in the worker."""
    return _study_of(source).run_rows(rows)


@lru_cache(maxsize=1)
def _study_of(source: Source) -> _condyle.RawStudy:
    """The study of the worker, cached from task to task together with the bodies that do not vary."""
    if source.version != _condyle.VERSION:
        raise BadInput(
            f"a worker has condyle {_condyle.VERSION}, and the study is of {source.version}; install the same version"
        )
    study = _condyle.RawStudy(source.path, source.text, source.base, dict(source.files))
    if study.inputs_blake3 != source.inputs_blake3:
        raise BadInput("a worker reads other meshes than those of the study; copy the same files to its machine")
    return study


def run_on(
    executor: Executor,
    study: _condyle.RawStudy,
    source: Source,
    out: str,
    tests_a_task: int,
    listener: Callable[[StudyProgress], Any] | None,
) -> None:
    """Runs the tests that the folder ``out`` does not hold on an executor, and stores them here as they finish."""
    held = study.hold(out)
    try:
        missing = held.missing(study)
        tasks = deque(_Task(rows, 1) for rows in _parts(missing, tests_a_task))
        _run_all(executor, study, source, held, tasks, study.tests - len(missing), listener)
    finally:
        held.close()


def _run_all(
    executor: Executor,
    study: _condyle.RawStudy,
    source: Source,
    held: _condyle.RawHeldStudy,
    tasks: deque[_Task],
    kept: int,
    listener: Callable[[StudyProgress], Any] | None,
) -> None:
    from concurrent.futures import FIRST_COMPLETED, wait

    sent: dict[Future[Any], _Task] = {}
    try:
        _report(listener, kept, study.tests)
        while tasks or sent:
            while tasks and len(sent) < TASKS_AHEAD:
                task = tasks.popleft()
                sent[executor.submit(run_rows, source, task.rows)] = task
            for future in wait(sent, return_when=FIRST_COMPLETED).done:
                task = sent.pop(future)
                found = _found(future, task)
                if found is None:
                    tasks.append(_Task(task.rows, task.tries + 1))
                    continue
                held.keep(study, found)
                kept += len(task.rows)
            _report(listener, kept, study.tests)
    finally:
        for future in sent:
            future.cancel()


def _found(future: Future[Any], task: _Task) -> list[tuple[int, tuple[list[float], str] | str]] | None:
    """The results of a task; ``None`` if its worker died and the task is to be repeated."""
    from concurrent.futures import BrokenExecutor

    try:
        return future.result()
    except (CondyleError, BrokenExecutor):
        raise
    except Exception:
        if task.tries >= MAX_TRIES:
            raise
        return None


def _report(listener: Callable[[StudyProgress], Any] | None, kept: int, tests: int) -> None:
    if listener is not None and listener(StudyProgress(kept, tests)) is False:
        raise StudyInterrupted(kept, tests)


def _parts(rows: list[int], size: int) -> Iterator[list[int]]:
    """Divides rows into tasks of ``size`` tests, and smaller ones towards the end."""
    first = 0
    while first < len(rows):
        own = max(1, min(size, (len(rows) - first) // LAST_TASKS))
        yield rows[first : first + own]
        first += own
