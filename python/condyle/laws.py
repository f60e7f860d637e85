"""The input of wear laws written in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["NodeCycle"]


class NodeCycle(NamedTuple):
    """The history of one node of the articulating surface in the mean cycle of all activities.

    A wear law returns the depth worn by one such cycle, mm. Archard's, with Kw in mm3/(N m):

    >>> import condyle
    >>> def archard(cycle: condyle.NodeCycle) -> float:
    ...     return 2.64e-7 * cycle.pressure_slip_mpa_mm / 1000.0
    >>> case = condyle.Case.from_dict({"march": {"updates": 1}, "accuracy": {"estimate": False}})
    >>> own = condyle.run(case, wear_law=archard)
    >>> own.wear_laws[0]["law"]
    'python'
    """

    pressure_mpa: NDArray[np.float64]
    """Mean pressure on the loaded part of the node's share of the surface at every instant of contact, MPa: shape (instants,)."""
    slip_mm: NDArray[np.float64]
    """Slip of the femur past the insert in each instant, along the surface's anterior and lateral directions, mm: shape
    (instants, 2)."""
    share: NDArray[np.float64]
    """Share of all cycles of the instant's activity times the loaded part of the node's share of the surface: shape (instants,)."""
    peak_pressure_mpa: float
    """The highest mean pressure on the node's whole share of the surface, MPa."""
    sliding_distance_mm: float
    """Sum of share times slip, mm: the mean sliding distance under pressure over the node's share of the surface."""
    pressure_slip_mpa_mm: float
    """Sum of share times pressure times slip, MPa mm."""
    cross_shear: float
    """The part of pressure times slip across the principal direction, 0 to 0.5."""
