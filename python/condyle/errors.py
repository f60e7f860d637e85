"""What goes wrong, as exceptions with the command's text and their fields."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["BadInput", "CondyleError", "Interrupted", "NotSolved", "Problem", "StudyInterrupted"]


class Problem(NamedTuple):
    """One thing that is wrong, at its place."""

    reason: str
    """What is wrong."""
    advice: str | None
    """What to do, where there is more to say."""
    key: str | None
    """Dotted path of the key, such as ``contact.friction``."""
    file: str | None
    """Name of the file."""
    line: int | None
    """Line in it, from 1."""
    column: int | None
    """Column in it, from 1."""


class CondyleError(Exception):
    """Whatever condyle refuses or cannot do; its text is that of the command."""


class _WithProblems(CondyleError):
    problems: tuple[Problem, ...]

    def __init__(self, message: str, problems: tuple[Problem, ...] = ()) -> None:
        super().__init__(message, problems)
        self.problems = problems

    def __str__(self) -> str:
        return self.args[0]


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
    """Everything that is wrong, each thing with its place; empty where there is no file to point into."""


class NotSolved(_WithProblems, ArithmeticError):
    """The physics could not be solved: exit code 3 of the command.

    The text has the instant, the pose and what is out of balance.
    """

    problems: tuple[Problem, ...]
    """The place in the case that is likely behind it, if there is one."""


class Interrupted(CondyleError):
    """A run that its progress callback stopped by answering ``False``.

    Ctrl-C is a ``KeyboardInterrupt``, as everywhere in Python. After either, a run with ``out`` can be gone on
    with: ``condyle.run(case, out=out, resume=True)``.
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
    """A study that its progress callback stopped by answering ``False``; the same call goes on with it."""

    kept: int
    """Tests that are kept."""
    tests: int
    """Tests in all."""

    def __init__(self, kept: int, tests: int) -> None:
        super().__init__(kept, tests)
        self.kept, self.tests = kept, tests

    def __str__(self) -> str:
        return f"interrupted: {self.kept} of {self.tests} tests are kept; the same call goes on"
