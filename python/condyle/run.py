"""Running a case, and opening a folder of results."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import _condyle
from .case import Case, CaseLike, case_of
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

    Raises:
        BadInput: a case, a mesh or a folder that cannot be used.
        NotSolved: physics that could not be solved.

    >>> import condyle
    >>> result = condyle.run({"march": {"updates": 2}, "accuracy": {"estimate": False}})
    >>> round(result.mass_loss_mg), result.wear["cycles"].tolist()
    (80, [2500000.0, 5000000.0])
    """
    bar = Bar() if progress is True else None
    listener = bar or (progress if callable(progress) else None)
    checked = case_of(case)
    try:
        if out is None:
            return Result(_run_in_memory(checked, resume, force, fields, threads, listener))
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


def _run_in_memory(
    case: Case,
    resume: bool,
    force: bool,
    fields: bool,
    threads: int,
    listener: Callable[[Progress], Any] | None,
) -> _condyle.RawRun:
    if resume or force:
        raise ValueError("resume and force are about the run in a folder: give out, too")
    return _condyle.run_in_memory(case.compiled, threads, fields, listener)


def _run_into(
    out: Path,
    case: Case,
    resume: bool,
    force: bool,
    threads: int,
    listener: Callable[[Progress], Any] | None,
) -> _condyle.RawRun:
    if case.has_arrays:
        out.mkdir(parents=True, exist_ok=True)
    case = case.written_in(out)
    return _condyle.run_into_folder(case.compiled, threads, out, resume, force, listener)
