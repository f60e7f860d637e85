"""Tests of a study, sent to workers of an executor."""

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

# Tasks that are sent ahead: enough for a thousand workers, and few enough that memory does not grow with the study.
TASKS_AHEAD = 2000
# A task has no more than this part of what is left.
LAST_TASKS = 32
# A task whose worker died is sent so often; what kills every worker is then at fault itself.
MAX_TRIES = 10


class Source(NamedTuple):
    """What a worker makes a study of."""

    path: str
    text: str
    base: str
    files: tuple[tuple[str, bytes], ...]
    inputs_blake3: str
    version: str


class _Task(NamedTuple):
    rows: list[int]
    tries: int


def run_rows(source: Source, rows: list[int]) -> list[tuple[int, list[float] | str]]:
    """What the tests of ``rows`` find; called in the worker."""
    return _study_of(source).run_rows(rows)


@lru_cache(maxsize=1)
def _study_of(source: Source) -> _condyle.RawStudy:
    """Kept from task to task, with the bodies that do not vary."""
    if source.version != _condyle.VERSION:
        raise BadInput(f"a worker has condyle {_condyle.VERSION}, and the study is of {source.version}; install the same")
    study = _condyle.RawStudy(source.path, source.text, source.base, dict(source.files))
    if study.inputs_blake3 != source.inputs_blake3:
        raise BadInput("a worker reads other meshes than the study was made of; put the same files where it runs")
    return study


def run_on(
    executor: Executor,
    study: _condyle.RawStudy,
    source: Source,
    out: str,
    tests_a_task: int,
    listener: Callable[[StudyProgress], Any] | None,
) -> None:
    """Runs the tests that the folder ``out`` does not keep on an executor, and keeps them here as they come."""
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
        _tell(listener, kept, study.tests)
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
            _tell(listener, kept, study.tests)
    finally:
        for future in sent:
            future.cancel()


def _found(future: Future[Any], task: _Task) -> list[tuple[int, list[float] | str]] | None:
    """What a task found; none if its worker was lost, and it is to be sent again."""
    from concurrent.futures import BrokenExecutor

    try:
        return future.result()
    except (CondyleError, BrokenExecutor):
        raise
    except Exception:
        if task.tries >= MAX_TRIES:
            raise
        return None


def _tell(listener: Callable[[StudyProgress], Any] | None, kept: int, tests: int) -> None:
    if listener is not None and listener(StudyProgress(kept, tests)) is False:
        raise StudyInterrupted(kept, tests)


def _parts(rows: list[int], size: int) -> Iterator[list[int]]:
    """Tasks of ``size`` tests, and smaller ones towards the end: a worker would wait for another's last task."""
    first = 0
    while first < len(rows):
        own = max(1, min(size, (len(rows) - first) // LAST_TASKS))
        yield rows[first : first + own]
        first += own
