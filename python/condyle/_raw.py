"""Types of the data that the compiled module returns, for the package itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class RawRun(TypedDict):
    """The data of a run, with the texts of its CSV files and the insert at every update."""

    case: str
    summary: str | None
    tables: dict[str, str]
    points_mm: NDArray[np.float64]
    hexes: NDArray[np.uint32]
    articulating: NDArray[np.bool_]
    fields: dict[str, NDArray[np.float64]]
    femur_points_mm: NDArray[np.float32]
    femur_triangles: NDArray[np.uint32]


class RawContact(TypedDict):
    """The contact at a pose."""

    force_n: NDArray[np.float64]
    moment_nmm: NDArray[np.float64]
    tangent: NDArray[np.float64]
    pressure_mpa: NDArray[np.float64]
    peak_pressure_mpa: float
    area_mm2: float


class RawCycle(TypedDict):
    """A cycle, increment by increment."""

    percent: NDArray[np.float64]
    pressure_mpa: NDArray[np.float64]
    slip_mm: NDArray[np.float64]
    rotation: NDArray[np.float64]
    translation_mm: NDArray[np.float64]
