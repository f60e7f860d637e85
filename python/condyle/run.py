"""Running a case, and opening a folder of results."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import _condyle
from ._raw import RawRun
from .case import Case, CaseLike, case_of
from .laws import NodeCycle
from .progress import Bar, Progress
from .result import Result

__all__ = ["open", "run"]


def run(
    case: CaseLike,
    progress: bool | Callable[[Progress], Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    resume: bool = False,
    force: bool = False,
    fields: bool = True,
    threads: int = 1,
    wear_law: Callable[[NodeCycle], float] | None = None,
) -> Result:
    """Runs a case to its end. The numbers are those of ``condyle run``, to the last bit.

    The interpreter's lock is released meanwhile: runs go side by side in threads. Ctrl-C stops a run within a
    fraction of a second.

    Args:
        case: a :class:`Case`, the path of a case file, its text, or nested dictionaries.
        progress: ``True`` for a bar, or what is called with a :class:`Progress` after every update and some twenty
            times a second; the run stops where it answers ``False``, with :class:`Interrupted`, and where it raises.
        out: a folder for what the command writes: results that ParaView reads, a report, and a checkpoint.
        resume: go on with the run that is in ``out``.
        force: write over the run that is in ``out``.
        fields: keep the insert and its results at every node for every update, about a megabyte each.
        threads: for the one-time work on a mesh; results do not depend on it.
        wear_law: what takes the place of the case's law: called with the :class:`NodeCycle` of every node that slides,
            it gives the depth that one cycle wears, mm. That is slow, some ten microseconds and what the function
            takes for each of some ten thousand calls an update. The case and its hash do not know it, so that there
            can be no ``out``.

    Raises:
        BadInput: a case, a mesh or a folder that cannot be used.
        NotSolved: physics that could not be solved.

    >>> import condyle
    >>> result = condyle.run({"march": {"updates": 2}, "accuracy": {"estimate": False}})
    >>> round(result.mass_loss_mg), result.wear["cycles"].tolist()
    (59, [2500000.0, 5000000.0])
    """
    if out is None and (resume or force):
        raise ValueError("resume and force are about the run in a folder: give out, too")
    if out is not None and wear_law is not None:
        raise ValueError("a run with a wear_law is kept in memory, since its folder would not name the law: leave out away")
    bar = Bar() if progress is True else None
    listener = bar or (progress if callable(progress) else None)
    checked = case_of(case)
    try:
        if out is None:
            return Result(_condyle.run_in_memory(checked.compiled, threads, fields, listener, wear_law))
        return Result(_run_into(Path(out), checked, resume, force, threads, listener), Path(out))
    finally:
        if bar:
            bar.close()


def open(folder: str | os.PathLike[str]) -> Result:
    """The run in a folder that ``condyle run --out`` or :func:`run` with ``out`` wrote, done or on its way.

    Raises:
        BadInput: a folder without a run, or with a damaged one.
    """
    return Result(_condyle.read_folder(folder), Path(folder))


def _run_into(
    out: Path,
    case: Case,
    resume: bool,
    force: bool,
    threads: int,
    listener: Callable[[Progress], Any] | None,
) -> RawRun:
    if case.has_arrays:
        out.mkdir(parents=True, exist_ok=True)
    case = case.written_in(out)
    return _condyle.run_into_folder(case.compiled, threads, out, resume, force, listener)
