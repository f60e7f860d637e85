"""How far a run has come."""

from __future__ import annotations

import sys
from typing import NamedTuple

__all__ = ["Bar", "Progress"]


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


class Bar:
    """A bar on standard error; in a notebook it is a line of text."""

    WIDTH = 40

    def __call__(self, progress: Progress) -> None:
        """Draws it anew."""
        done = round(self.WIDTH * progress.part)
        said = "estimating the error" if progress.is_estimating else f"update {progress.updates}"
        bar = "#" * done + "-" * (self.WIDTH - done)
        sys.stderr.write(f"\r{bar} {100 * progress.part:3.0f} %  {said:<22}")
        sys.stderr.flush()

    def close(self) -> None:
        """Takes it away."""
        sys.stderr.write("\r" + " " * (self.WIDTH + 30) + "\r")
        sys.stderr.flush()
