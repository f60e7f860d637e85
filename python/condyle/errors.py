"""Exceptions with the messages of the command, and their fields."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from typing import NamedTuple, TypeAlias

__all__ = ["BadInput", "CondyleError", "Interrupted", "NotSolved", "Problem", "StudyInterrupted"]


class Problem(NamedTuple):
    """One problem of the input, with its place."""

    reason: str
    """The cause."""
    advice: str | None
    """The remedy, if it is known."""
    key: str | None
    """Dotted path of the key, such as ``contact.friction``."""
    file: str | None
    """Name of the file."""
    line: int | None
    """Line in it, from 1."""
    column: int | None
    """Column in it, from 1."""


# Cause; remedy, key and file; line and column: as the compiled module passes a problem.
_Fields: TypeAlias = "tuple[str, tuple[str | None, str | None, str | None], tuple[int, int] | None]"


def _problem(reason: str, texts: tuple[str | None, str | None, str | None], place: tuple[int, int] | None) -> Problem:
    line, column = place or (None, None)
    return Problem(reason, *texts, line, column)


def _visible(character: str) -> str:
    # Characters of a file name or a text that steer a terminal, or change the direction of text.
    is_harmless = character in "\n\t" or unicodedata.category(character) not in ("Cc", "Cf")
    return character if is_harmless else f"\\u{{{ord(character):x}}}"


class CondyleError(Exception):
    """The base class of all errors of condyle; the message is that of the command."""


class _WithProblems(CondyleError):
    problems: tuple[Problem, ...]

    def __init__(self, message: str, problems: Iterable[_Fields] = ()) -> None:
        super().__init__(message, problems)
        self.problems = tuple(_problem(*fields) for fields in problems)

    def __str__(self) -> str:
        return "".join(map(_visible, self.args[0]))


class BadInput(_WithProblems, ValueError):
    """A case, a mesh, a waveform or a folder that cannot be used: exit code 2 of the command.

    >>> import condyle
    >>> try:
    ...     condyle.Case.from_text("[contact]\\nfrictoin = 0.04")
    ... except condyle.BadInput as error:
    ...     problem = error.problems[0]
    >>> problem.key, problem.line
    ('contact.frictoin', 2)
    """

    problems: tuple[Problem, ...]
    """All problems with their places; empty if the cause is not in a file."""


class NotSolved(_WithProblems, ArithmeticError):
    """The physics could not be solved: exit code 3 of the command.

    The message states the instant, the pose and the residual.
    """

    problems: tuple[Problem, ...]
    """The place in the case that is the likely cause, if there is one."""


class Interrupted(CondyleError):
    """A run whose progress callback returned ``False``.

    Ctrl-C raises ``KeyboardInterrupt``, as everywhere in Python. After either, ``condyle.run(case, out=out, resume=True)``
    resumes a run with ``out``.
    """

    updates: int
    """Updates done."""
    cycles: float
    """Gait cycles done."""
    of_cycles: float
    """Gait cycles in all."""

    def __init__(self, updates: int, cycles: float, of_cycles: float) -> None:
        super().__init__(updates, cycles, of_cycles)
        self.updates, self.cycles, self.of_cycles = updates, cycles, of_cycles

    def __str__(self) -> str:
        return f"interrupted: {self.updates} updates are done, {self.cycles:.0f} of {self.of_cycles:.0f} cycles"


class StudyInterrupted(CondyleError):
    """A study whose progress callback returned ``False``, or whose cluster was lost; the same call resumes it."""

    kept: int
    """Tests in the folder."""
    tests: int
    """Number of tests."""

    cause: str
    """The reason for the end of the study."""
    resume: str
    """The command or call that resumes it."""

    def __init__(self, kept: int, tests: int, cause: str = "interrupted", resume: str = "the same call resumes") -> None:
        super().__init__(kept, tests, cause, resume)
        self.kept, self.tests, self.cause, self.resume = kept, tests, cause, resume

    def __str__(self) -> str:
        return f"{self.cause}: {self.kept} of {self.tests} tests are done; {self.resume}"
