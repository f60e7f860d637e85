"""Running a case, and opening a results folder."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import _condyle
from .case import CaseLike, case_of
from .laws import NodeCycle
from .progress import Progress, listening
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
    """Runs a case. The numbers equal those of ``condyle run``, to the last bit.

    The interpreter's lock is released meanwhile, so that threads can run cases in parallel. Ctrl-C stops a run within a
    fraction of a second; while a deformable insert is prepared, and in large ones, it takes seconds to minutes.

    Args:
        case: a :class:`Case`, the path of a case file, its text, or nested dictionaries.
        progress: ``True`` for a bar, or a function that is called with a :class:`Progress` after every update and about
            twenty times a second. The run stops with :class:`Interrupted` if it returns ``False``, or another
            false value than ``None``, or raises.
        out: a results folder as the command writes it: results for ParaView, a report, and a checkpoint.
        resume: resume the run in ``out``.
        force: overwrite the run in ``out``.
        fields: keep the insert and its results at every node for every update, about 100 bytes for each of its nodes.
        threads: threads for the preparation of a mesh; results do not depend on it.
        wear_law: a function that replaces the law of the case: called with the :class:`NodeCycle` of every sliding node,
            it returns the depth worn by one cycle, mm, of conventional polyethylene: cross-linking in the case reduces it. It
            is slow: each call takes ten microseconds longer than the function, and the default case has 690 per update. Case
            and hash do not include it, so it excludes ``out``.

    Raises:
        BadInput: a case, a mesh or a folder that cannot be used.
        NotSolved: physics that could not be solved.

    >>> import condyle
    >>> result = condyle.run({"march": {"updates": 2}, "accuracy": {"estimate": False}})
    >>> round(result.mass_loss_mg), result.wear["cycles"].tolist()
    (44, [2500000.0, 5000000.0])
    """
    if out is None and (resume or force):
        raise ValueError("resume and force refer to the run in a folder: give out, too")
    if out is not None and wear_law is not None:
        raise ValueError("a run with a wear_law is kept in memory, since a results folder could not name the law: omit out")
    checked = case_of(case)
    folder = None if out is None else Path(out)
    if folder is not None and checked.has_arrays:
        folder.mkdir(parents=True, exist_ok=True)
        checked = checked.written_in(folder)
    with listening(progress) as listener:
        raw = _condyle.run(
            checked.compiled,
            threads,
            keeps_fields=fields,
            out=folder,
            resume=resume,
            force=force,
            progress=listener,
            wear_law=wear_law,
        )
    return Result(raw, folder, checked)


def open(folder: str | os.PathLike[str]) -> Result:
    """Opens the run in a folder written by ``condyle run --out`` or by :func:`run` with ``out``, finished or not.

    Raises:
        BadInput: a folder without a run, or with a damaged one.
    """
    return Result(_condyle.read_folder(folder), Path(folder))
