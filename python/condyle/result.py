"""The results of a run."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from . import _html
from ._condyle import unit_of
from ._raw import RawRun
from ._summary import Summary
from .case import Case
from .errors import CondyleError
from .table import Table

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    import pyvista as pv
    import xarray as xr
    from numpy.typing import NDArray

    from .plot import Plots

__all__ = ["Result"]

# Fields of the cycle before an update, which the unworn insert does not have.
_OF_A_CYCLE = {"cross_shear", "depth_per_cycle_mm", "peak_pressure_mpa", "principal_direction", "sliding_distance_mm"}


class Result(Summary):
    """The results of a run, whether it was run from Python or read from a folder of the command.

    The numbers of ``summary.json`` are attributes with their unit in the name; an unfinished run has none of them.
    Attributes cannot be assigned, and arrays are read-only.
    Positions are in the insert frame of the knee of the case: x anterior, y superior, z to the right, mm.

    >>> import condyle
    >>> result = condyle.run("[march]\\nupdates = 1\\n[accuracy]\\nestimate = false")
    >>> result.points_mm.shape == (2, *result.articulating.shape, 3)
    True
    >>> float(result.fields["wear_depth_mm"][-1].max()) == result.max_depth_mm
    True
    """

    def __init__(self, run: RawRun, folder: Path | None = None, case: Case | partial[Case] | None = None) -> None:
        """Use :func:`condyle.run` or :func:`condyle.open`."""
        self._run, self._folder, self._case = run, folder, case or _as_run(run, folder)
        summary = run["summary"]
        self.summary: dict[str, Any] = json.loads(summary) if summary else {}
        """The content of ``summary.json``."""
        self.tables: dict[str, Table] = {}
        """Wear, femur pose and the kinematics of every activity, by the names of their files without the ending."""
        for name, text in run["tables"].items():
            self.tables[name] = Table.from_csv(text, f"{folder or 'the run'}: {name}.csv")
        for name in _OF_A_CYCLE & run["fields"].keys():
            if run["fields"][name].flags.writeable:  # Otherwise those of a result that was copied.
                run["fields"][name][:1] = float("nan")
        arrays: list[NDArray[Any]] = [run["points_mm"], run["hexes"], run["articulating"]]
        for array in [*arrays, run["femur_points_mm"], run["femur_triangles"], *run["fields"].values()]:
            array.flags.writeable = False

    if not TYPE_CHECKING:  # A type checker knows the attributes by their annotations, and no others.

        def __getattr__(self, name: str) -> Any:
            if name in self.__dict__.get("summary", {}):
                return self.summary[name]
            is_known = name in Summary.__annotations__
            reason = f"; {'this run' if self.summary else 'a run that is not done'} does not have it" if is_known else ""
            raise AttributeError(f"a result has no {name}{reason}")

        def __setattr__(self, name: str, value: object) -> None:
            if name in self.__dict__ or name not in ("_run", "_folder", "_case", "summary", "tables"):
                raise AttributeError(f"a result is read-only: {name} cannot be assigned")
            object.__setattr__(self, name, value)

        def __dir__(self) -> list[str]:
            return [*super().__dir__(), *self.summary]

    @property
    def is_done(self) -> bool:
        """True if the run is finished."""
        return bool(self.summary)

    @property
    def folder(self) -> Path | None:
        """The results folder, if there is one."""
        return self._folder

    @property
    def case(self) -> Case:
        """The case as run."""
        return self._case if isinstance(self._case, Case) else self._case()

    @property
    def wear(self) -> Table:
        """One row per update: ``cycles``, ``mass_loss_mg``, ``volume_loss_mm3``, ``max_depth_mm`` and more."""
        return self.tables["wear"]

    @property
    def kinematics(self) -> Table:
        """Motions and loads of the first activity: one row per increment of the first and of the last cycle.

        ``cycles`` is the number of cycles before, 0 for the first one. Other activities are in :attr:`tables`, as
        ``kinematics_NAME``.
        """
        return self.tables["kinematics"]

    @property
    def femur_pose(self) -> Table:
        """Pose of the femur at the rows of :attr:`kinematics`: its origin, and its rotation row by row."""
        return self.tables["femur_pose"]

    @property
    def update_cycles(self) -> NDArray[np.float64]:
        """Number of cycles at every update of :attr:`fields`, 0 for the unworn insert: shape (updates + 1,)."""
        import numpy as np

        cycles = np.concatenate([[0.0], self.wear["cycles"]])
        return cycles[: len(self.points_mm)]

    @property
    def points_mm(self) -> NDArray[np.float64]:
        """Positions of the insert's nodes at every update, unworn first, mm: shape (updates + 1, nodes, 3)."""
        return self._run["points_mm"]

    @property
    def hexes(self) -> NDArray[np.uint32]:
        """Node numbers of the hexahedra, in VTK's order: shape (hexahedra, 8)."""
        return self._run["hexes"]

    @property
    def articulating(self) -> NDArray[np.bool_]:
        """Marks the nodes of the articulating surface: shape (nodes,)."""
        return self._run["articulating"]

    @property
    def fields(self) -> dict[str, NDArray[np.float64]]:
        """Results at the nodes at every update, unworn first: shape (updates + 1, nodes), for directions (updates + 1, nodes, 3).

        ``wear_depth_mm``, ``depth_per_cycle_mm``, ``peak_pressure_mpa``, ``sliding_distance_mm``, ``cross_shear``,
        ``thickness_mm``, ``principal_direction``; 0 at nodes outside of the articulating surface. NaN at updates without the field:
        the unworn insert has thickness and depth only. Depth, thickness and positions are those after the update. Fields of a
        cycle, such as pressure, are those of the cycle that was repeated up to the update (of several activities, the highest pressure,
        and the mean of the others by their shares): update ``k`` has the cycle at
        ``update_cycles[k - 1]``, and the last update of a finished run the final cycle.
        """
        return self._run["fields"]

    @property
    def femur_points_mm(self) -> NDArray[np.float32]:
        """Vertices of the femur at neutral, mm: shape (vertices, 3)."""
        return self._run["femur_points_mm"]

    @property
    def femur_triangles(self) -> NDArray[np.uint32]:
        """Vertex numbers of its triangles: shape (triangles, 3)."""
        return self._run["femur_triangles"]

    def femur_points_at(self, increment: int, cycle: Literal["first", "last"] = "first") -> NDArray[np.float64]:
        """Vertices of the femur at the end of an increment, from 0, of the first or last cycle, mm: shape (vertices, 3)."""
        from .femur import femur_points_at

        return femur_points_at(self, increment, cycle)

    @property
    def plot(self) -> Plots:
        """Pictures with Matplotlib, such as ``result.plot.wear_map()``."""
        from .plot import Plots

        return Plots(self)

    def to_pandas(self) -> pd.DataFrame:
        """The table :attr:`wear` as a data frame; other tables have a ``to_pandas`` too."""
        return self.wear.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """All tables and fields as one data set.

        Dimensions are ``update`` (the unworn insert is 0), ``node``, ``component``, ``cycle`` (first and last) and
        ``increment``; units are attributes. Motions and loads of a further activity have its name as a prefix, and those with the
        name of a result of the insert, such as ``peak_pressure_mpa``, the prefix ``cycle_``.
        """
        from .data_set import data_set

        return data_set(self)

    def to_pyvista(
        self, update: int = -1, increment: int | None = None, cycle: Literal["first", "last"] = "last"
    ) -> pv.MultiBlock:
        """The insert with its fields at an update, and the femur.

        Args:
            update: the update, 0 for the unworn insert, -1 for the last.
            increment: the increment at whose end the femur is shown, from 0; by default at neutral.
            cycle: the cycle of that increment.
        """
        from .scene import scene

        return scene(self, update, increment, cycle)

    def __repr__(self) -> str:
        if not self.is_done:
            done = self.wear["cycles"][-1] if len(self.wear.array) else 0.0
            return f"<condyle.Result, not done: {done:.0f} cycles so far>"
        return (
            f"<condyle.Result: {self.mass_loss_mg:.2f} mg worn in {self.cycles:.0f} cycles, {self.max_depth_mm:.4f} mm deep, "
            f"{self.peak_pressure_mpa:.1f} MPa>"
        )

    def _repr_html_(self) -> str:
        names = [
            "cycles",
            "mass_loss_mg",
            "volume_loss_mm3",
            "max_depth_mm",
            "peak_pressure_mpa",
            "ap_range_mm",
            "ie_range_deg",
        ]
        rows = [(name, self.summary[name], unit_of(name)) for name in names if name in self.summary]
        return _html.table(repr(self), ("", "value", "unit"), rows)

    def __getstate__(self) -> dict[str, Any]:
        # As run, since its files may be other ones by then; read when it is used, since meshes may be missing on the other machine.
        case = _as_run(self._run, self._folder, self._case.arrays) if isinstance(self._case, Case) else self._case
        return {"_run": self._run, "_folder": self._folder, "_case": case}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["_run"], state["_folder"], state["_case"])


def _as_run(run: RawRun, folder: Path | None, arrays: Mapping[str, bytes] | None = None) -> partial[Case]:
    """The case as written for the run, read when it is called."""
    return partial(Case, "case of the run", run["case"], os.path.abspath(folder or "."), arrays)


def check_fields(result: Result) -> None:
    """Raises an error for a result of a run with ``fields=False``."""
    if not result.fields:
        raise CondyleError("this result has no fields at the nodes: run the case with fields=True")
