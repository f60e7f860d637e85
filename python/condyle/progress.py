"""Progress of runs and studies, and a bar that shows it."""

from __future__ import annotations

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
    """A progress bar with the remaining time, by tqdm: on standard error, or a widget in a notebook."""

    def __init__(self) -> None:
        """Creates a bar that is drawn at the first call."""
        self._bar: Any = None

    def __call__(self, progress: Progress | StudyProgress) -> None:
        """Draws the bar."""
        from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]

        if self._bar is None:
            layout = "{percentage:3.0f} % {bar} {desc}, {remaining} left"
            # The time left counts from what was done before.
            self._bar = tqdm(total=1.0, initial=progress.part, leave=False, bar_format=layout)
        self._bar.set_description_str(progress.text, refresh=False)
        self._bar.n = progress.part
        self._bar.refresh()

    def close(self) -> None:
        """Removes the bar."""
        if self._bar is not None:
            self._bar.close()


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
