"""The position of the femur through a cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from .errors import CondyleError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .result import Result

__all__ = ["femur_points_at", "rows_of_cycle"]


def rows_of_cycle(cycles: NDArray[np.float64], cycle: Literal["first", "last"]) -> NDArray[np.bool_]:
    """Marks the rows of a column ``cycles`` that belong to a cycle."""
    if cycle not in ("first", "last"):
        raise ValueError(f"a cycle is 'first' or 'last', and this one is {cycle!r}")
    return cycles == (cycles.min() if cycle == "first" else cycles.max())


def femur_points_at(result: Result, increment: int, cycle: Literal["first", "last"] = "first") -> NDArray[np.float64]:
    """Vertices of the femur at the end of an increment, from 0, of one of the two cycles, mm: shape (vertices, 3).

    The vertices of the result, in the neutral pose, are converted to the femoral frame and then moved to R p + t.

    Raises:
        ValueError: another word for the cycle.
        CondyleError: a result of an earlier version and a joint other than the knee, which has no neutral pose.
    """
    import numpy as np

    neutral = result.neutral_pose
    if neutral is None:
        raise CondyleError("this result of an earlier version has no neutral pose; run its case again")
    origin, rotation = np.array(neutral["femoral_origin_mm"]), np.array(neutral["rotation"])
    in_femoral_frame = (result.femur_points_mm - origin) @ rotation
    table = result.femur_pose
    row = table.array[rows_of_cycle(table["cycles"], cycle)][increment]
    first = table.columns.index("origin_x_mm")
    there, turned = row[first : first + 3], row[first + 3 : first + 12].reshape(3, 3)
    return in_femoral_frame @ turned.T + there
