"""The parts of a run: the bodies of a case, their contact at a pose, and one cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from . import _condyle
from .case import CaseLike, case_of
from .errors import BadInput

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Contact", "Cycle", "Knee"]


class Contact(NamedTuple):
    """The contact of the femur with the insert."""

    force_n: NDArray[np.float64]
    """Force on the insert, in its frame, N: shape (3,)."""
    moment_nmm: NDArray[np.float64]
    """Moment on the insert about its origin, N mm: shape (3,)."""
    tangent: NDArray[np.float64]
    """Derivative of moment and force, in this order, with respect to a small motion of the femur in the insert frame: three
    rotations about its axes (rad), then three translations (mm): shape (6, 6)."""
    pressure_mpa: NDArray[np.float64]
    """Mean pressure on the share of each node of the articulating surface, MPa: shape (nodes,)."""
    peak_pressure_mpa: float
    """Highest pressure anywhere, including between nodes, MPa."""
    area_mm2: float
    """Area in contact, mm2."""


class Cycle(NamedTuple):
    """One gait cycle with its contact, increment by increment."""

    percent: NDArray[np.float64]
    """Completed part of the cycle, %: shape (increments,)."""
    pressure_mpa: NDArray[np.float64]
    """Pressure at every node of the articulating surface, MPa: shape (increments, nodes)."""
    slip_mm: NDArray[np.float64]
    """Slip of the femur past each node, along the surface's anterior and lateral directions, mm: shape (increments,
    nodes, 2)."""
    rotation: NDArray[np.float64]
    """R of the femur's pose: shape (increments, 3, 3)."""
    translation_mm: NDArray[np.float64]
    """t of the femur's pose, mm: shape (increments, 3)."""


class Knee:
    """The bodies of a case with the femur settled on the unworn insert.

    Everything is in the units and frames of the solver: a right knee, mm, N, rad; a left one is mirrored. A point p of the
    femoral frame is at R p + t in the insert frame.

    >>> import numpy as np
    >>> knee = Knee({"insert": {"edge_mm": 2.0}})
    >>> rotation, translation = knee.neutral_pose
    >>> lowered = knee.contact(rotation, translation - [0.0, 0.01, 0.0])
    >>> bool(lowered.force_n[1] < knee.contact(rotation, translation).force_n[1] < 0.0)
    True
    """

    def __init__(self, case: CaseLike, *, threads: int = 1) -> None:
        """Builds the bodies and settles the femur.

        Raises:
            BadInput: an unusable case or unusable bodies.
            NotSolved: a femur that does not settle.
        """
        self._raw = _condyle.RawKnee(case_of(case).compiled, threads)

    def gap(self, points_mm: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Gap and outward normal of the femur at points of the femoral frame near its surface: of a mesh femur, within 3.5 mm.

        Args:
            points_mm: shape (n, 3).

        Returns:
            Gaps, > 0 apart, mm: shape (n,); unit normals: shape (n, 3). For a mesh femur they are those of its smooth
            field, which has no meaning farther from the surface.
        """
        import numpy as np

        points = np.ascontiguousarray(points_mm, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise BadInput(f"points have shape {points.shape}; give n rows of x, y, z")
        return self._raw.gap(points)

    @property
    def neutral_pose(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """R and t of the settled femur: shapes (3, 3) and (3,)."""
        return self._raw.neutral_pose()

    @property
    def surface_points_mm(self) -> NDArray[np.float64]:
        """Nodes of the articulating surface, mm: shape (nodes, 3)."""
        return self._raw.surface_points()

    def contact(self, rotation: ArrayLike, translation_mm: ArrayLike) -> Contact:
        """The contact of the femur at rest at a pose, on the unworn insert.

        A plastic insert yields, and a resting insert settles on its tray, under this load alone. The tangent holds for the
        resulting plastic strain and state of the backside. The contact of a mesh femur that is pressed in by more than about
        1.5 mm is wrong, without an error.

        Args:
            rotation: R, shape (3, 3).
            translation_mm: t, mm, shape (3,).

        Raises:
            BadInput: an R that is not a rotation.
            NotSolved: a load that the insert cannot bear.
        """
        import numpy as np

        r, t = np.asarray(rotation, dtype=np.float64), np.asarray(translation_mm, dtype=np.float64)
        if r.shape != (3, 3) or t.shape != (3,) or not np.isfinite(t).all():
            raise BadInput(f"a pose has shapes {r.shape} and {t.shape}; give (3, 3) and (3,)")
        if not np.allclose(r @ r.T, np.eye(3), atol=1e-9) or np.linalg.det(r) < 0.0:
            raise BadInput("this is no rotation: its rows are not perpendicular, of length 1 and right-handed")
        return Contact(**self._raw.contact(r.tolist(), t.tolist()))

    def first_cycle(self) -> Cycle:
        """The first periodic cycle of the first activity, on the unworn insert.

        Raises:
            NotSolved: a cycle that cannot be solved.
        """
        return Cycle(**self._raw.first_cycle())
