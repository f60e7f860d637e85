from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

from ._raw import RawContact, RawCycle, RawRun
from .laws import NodeCycle
from .progress import Progress, StudyProgress

__all__ = [
    "VERSION",
    "RawCase",
    "RawHeldStudy",
    "RawKnee",
    "RawStudy",
    "read_folder",
    "run_in_memory",
    "run_into_folder",
    "with_table",
]

VERSION: Final[str]

@final
class RawCase:
    def __new__(
        cls,
        path: str | PathLike[str],
        text: str,
        base: str | PathLike[str],
        files: Mapping[str, bytes],
        changes: Sequence[str],
    ) -> RawCase: ...
    @staticmethod
    def read_text(path: str | PathLike[str]) -> str: ...
    def toml(self) -> str: ...
    def toml_in(self, folder: str | PathLike[str]) -> str: ...
    def json(self) -> str: ...
    def inputs_blake3(self) -> str: ...
    def preview(self, threads: int) -> tuple[str, str]: ...

@final
class RawKnee:
    def __new__(cls, case: RawCase, threads: int) -> RawKnee: ...
    def gap(self, points_mm: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def neutral_pose(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def surface_points(self) -> NDArray[np.float64]: ...
    def contact(self, rotation: Sequence[Sequence[float]], translation: Sequence[float]) -> RawContact: ...
    def first_cycle(self) -> RawCycle: ...

@final
class RawStudy:
    def __new__(
        cls,
        path: str | PathLike[str],
        text: str,
        base: str | PathLike[str],
        files: Mapping[str, bytes],
    ) -> RawStudy: ...
    @property
    def tests(self) -> int: ...
    @property
    def design(self) -> str: ...
    @property
    def inputs(self) -> list[str]: ...
    @property
    def case_path(self) -> Path: ...
    @property
    def inputs_blake3(self) -> str: ...
    def run(
        self,
        out: str | PathLike[str],
        threads: int,
        progress: Callable[[StudyProgress], Any] | None = None,
    ) -> None: ...
    def run_rows(self, rows: Sequence[int]) -> list[tuple[int, list[float] | str]]: ...
    def hold(self, out: str | PathLike[str]) -> RawHeldStudy: ...
    def merge(self, shards: Sequence[str], out: str | PathLike[str]) -> int: ...
    def answers(self, out: str | PathLike[str]) -> str: ...
    def changes(self, row: int, out: str | PathLike[str] | None) -> list[str]: ...

@final
class RawHeldStudy:
    def missing(self, study: RawStudy) -> list[int]: ...
    def keep(self, study: RawStudy, found: Sequence[tuple[int, list[float] | str]]) -> None: ...
    def close(self) -> None: ...

def with_table(text: str, table: str, keys: str) -> str: ...
def read_folder(path: str | PathLike[str]) -> RawRun: ...
def run_in_memory(
    case: RawCase,
    threads: int,
    keeps_fields: bool,
    progress: Callable[[Progress], Any] | None = None,
    wear_law: Callable[[NodeCycle], float] | None = None,
) -> RawRun: ...
def run_into_folder(
    case: RawCase,
    threads: int,
    out: str | PathLike[str],
    resume: bool,
    force: bool,
    progress: Callable[[Progress], Any] | None = None,
) -> RawRun: ...
