"""Running the tests of a study on the workers of an executor."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path
from shlex import quote
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


# Seconds without a finished task after which the scheduler is asked whether it is there, and seconds that it has for an
# answer: a scheduler with much to do answers within a few.
ASK_AFTER_S = 5.0
ANSWER_WITHIN_S = 20.0


class Cluster:
    """The scheduler of a ``dask.distributed.Client``, whose failure futures do not report."""

    def __init__(self, client: Any) -> None:
        self._client = client

    def answers(self) -> bool:
        """True if the scheduler answers in time."""
        client = self._client
        try:
            client.sync(client.scheduler.identity, callback_timeout=ANSWER_WITHIN_S)
        # Dask raises its own errors, those of sockets and those of time limits, by version.
        except Exception:
            return False
        return True


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
    cluster: Cluster | None,
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
        _run_all(executor, cluster, study, source, out, held, tasks, study.tests - len(missing), listener)
    finally:
        held.close()


def _run_all(
    executor: Executor,
    cluster: Cluster | None,
    study: _condyle.RawStudy,
    source: Source,
    out: str,
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
            finished = wait(sent, ASK_AFTER_S, return_when=FIRST_COMPLETED).done
            if not finished and cluster is not None and not cluster.answers():
                cause = f"the Dask scheduler has not answered for {ANSWER_WITHIN_S:.0f} s"
                raise StudyInterrupted(kept, study.tests, cause, _resume(source.path, out))
            for future in finished:
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


def _resume(study: str, out: str) -> str:
    """The command that resumes a study after the loss of its cluster."""
    again = "the same call with a new client resumes"
    # A study from text has no file that the command could read.
    return f"{again}, or: condyle study {quote(study)} --out {quote(out)}" if Path(study).is_file() else again


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
