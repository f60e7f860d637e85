from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Final, TypedDict, final

import numpy as np
from numpy.typing import NDArray

from .progress import Progress

VERSION: Final[str]

class RawInsert(TypedDict):
    points_mm: NDArray[np.float64]
    hexes: NDArray[np.uint32]
    articulating: NDArray[np.bool_]
    fields: dict[str, NDArray[np.float64]]

class RawRun(TypedDict):
    case: str
    summary: str | None
    tables: dict[str, tuple[list[str], NDArray[np.float64]]]
    insert: RawInsert
    femur_points_mm: NDArray[np.float64]
    femur_triangles: NDArray[np.uint32]

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

def with_table(text: str, table: str, keys: str) -> str: ...
def read_folder(path: str | PathLike[str]) -> RawRun: ...
def run_in_memory(
    case: RawCase, threads: int, keeps_fields: bool, progress: Callable[[Progress], Any] | None = None
) -> RawRun: ...
def run_into_folder(
    case: RawCase,
    threads: int,
    out: str | PathLike[str],
    resume: bool,
    force: bool,
    progress: Callable[[Progress], Any] | None = None,
) -> RawRun: ...
