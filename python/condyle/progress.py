"""How far a run has come."""

from __future__ import annotations

import sys
import time
from typing import NamedTuple

__all__ = ["Bar", "Progress", "StudyProgress"]


class Progress(NamedTuple):
    """How far a run has come; what a callback is called with."""

    cycles: float
    """Gait cycles done, the part of the present interval that is solved included."""
    of_cycles: float
    """Gait cycles in all."""
    updates: int
    """Updates done."""
    is_estimating: bool
    """All cycles are done, and their error is being estimated."""

    @property
    def part(self) -> float:
        """Part of the cycles that is done, 0 to 1."""
        return min(self.cycles / self.of_cycles, 1.0) if self.of_cycles else 0.0


    @property
    def said(self) -> str:
        """The same in words."""
        return "estimating the error" if self.is_estimating else f"update {self.updates}"


class StudyProgress(NamedTuple):
    """How far a study has come; what a callback is called with."""

    kept: int
    """Tests that are kept, those of earlier runs included."""
    tests: int
    """Tests in all; of a search, at most."""

    @property
    def part(self) -> float:
        """Part of the tests that is kept, 0 to 1."""
        return self.kept / self.tests if self.tests else 1.0

    @property
    def said(self) -> str:
        """The same in words."""
        return f"{self.kept} of {self.tests} tests"


class Bar:
    """A bar on standard error, with the time left; in a notebook it is a line of text."""

    WIDTH = 40
    # Before, nobody waits, and what is left cannot be told.
    FIRST_TELLING_S = 2.0

    def __init__(self) -> None:
        """With nothing drawn yet."""
        self._began: tuple[float, float] | None = None

    def __call__(self, progress: Progress | StudyProgress) -> None:
        """Draws it anew."""
        done = round(self.WIDTH * progress.part)
        bar = "#" * done + "-" * (self.WIDTH - done)
        said = progress.said + self._time_left(progress.part)
        sys.stderr.write(f"\r{bar} {100 * progress.part:3.0f} %  {said:<40}")
        sys.stderr.flush()

    def _time_left(self, part: float) -> str:
        now_s = time.monotonic()
        start_s, start = self._began = self._began or (now_s, part)
        spent_s = now_s - start_s
        if spent_s < self.FIRST_TELLING_S or not start < part < 1.0:
            return ""
        return f", {spent_s * (1.0 - part) / (part - start):.0f} s left"

    def close(self) -> None:
        """Takes it away."""
        sys.stderr.write("\r" + " " * (self.WIDTH + 50) + "\r")
        sys.stderr.flush()
