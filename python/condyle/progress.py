"""Progress of runs and studies, and a bar that shows it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, TypeVar

__all__ = ["Bar", "Progress", "StudyProgress"]

_Step = TypeVar("_Step", bound="Progress | StudyProgress")


class Progress(NamedTuple):
    """Progress of a run; the argument of its callback."""

    cycles: float
    """Gait cycles done, including the solved part of the present interval."""
    of_cycles: float
    """Gait cycles in all."""
    updates: int
    """Updates done."""
    is_estimating: bool
    """All cycles are done, and the error is being estimated."""

    @property
    def part(self) -> float:
        """Completed part of the cycles, 0 to 1."""
        return min(self.cycles / self.of_cycles, 1.0) if self.of_cycles else 0.0

    @property
    def text(self) -> str:
        """The progress in words."""
        return "estimating the error" if self.is_estimating else f"update {self.updates}"


class StudyProgress(NamedTuple):
    """Progress of a study; the argument of its callback."""

    kept: int
    """Tests in the folder, including those of earlier runs."""
    tests: int
    """Number of tests; for a search the maximum."""

    @property
    def part(self) -> float:
        """Completed part of the tests, 0 to 1."""
        return self.kept / self.tests if self.tests else 1.0

    @property
    def text(self) -> str:
        """The progress in words."""
        return f"{self.kept} of {self.tests} tests"


class Bar:
    """A progress bar on standard error with the remaining time; in a notebook, a line of text."""

    WIDTH = 40
    # Earlier, the remaining time cannot be estimated.
    MIN_ELAPSED_S = 2.0

    def __init__(self) -> None:
        """Creates a bar that is drawn at the first call."""
        self._began: tuple[float, float] | None = None

    def __call__(self, progress: Progress | StudyProgress) -> None:
        """Draws the bar."""
        done = round(self.WIDTH * progress.part)
        bar = "#" * done + "-" * (self.WIDTH - done)
        text = progress.text + self._time_left(progress.part)
        sys.stderr.write(f"\r{bar} {100 * progress.part:3.0f} %  {text:<40}")
        sys.stderr.flush()

    def _time_left(self, part: float) -> str:
        now_s = time.monotonic()
        start_s, start = self._began = self._began or (now_s, part)
        spent_s = now_s - start_s
        if spent_s < self.MIN_ELAPSED_S or not start < part < 1.0:
            return ""
        return f", {spent_s * (1.0 - part) / (part - start):.0f} s left"

    def close(self) -> None:
        """Clears the line."""
        sys.stderr.write("\r" + " " * (self.WIDTH + 50) + "\r")
        sys.stderr.flush()


@contextmanager
def listening(progress: bool | Callable[[_Step], Any] | None) -> Iterator[Callable[[_Step], Any] | None]:
    """The function to call with progress: a bar, which is cleared in the end, for ``True``; otherwise ``progress`` itself."""
    if progress is not True:
        yield progress or None
        return
    bar = Bar()
    try:
        yield bar
    finally:
        bar.close()
