"""What a run found."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ._raw import RawRun
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


class Result:
    """What a run found: the same whether it was run from Python or read from a folder of the command.

    The numbers of ``summary.json`` are attributes with their unit in the name; those of a run that is not done are not
    there. Places are in the insert frame of the case's own knee: x anterior, y superior, z to the right, mm.

    >>> import condyle
    >>> result = condyle.run("[march]\\nupdates = 1\\n[accuracy]\\nestimate = false")
    >>> result.points_mm.shape == (2, *result.articulating.shape, 3)
    True
    >>> float(result.fields["wear_depth_mm"][-1].max()) == result.max_depth_mm
    True
    """

    cycles: float
    """Gait cycles."""
    mass_loss_mg: float
    """Mass worn, mg."""
    volume_loss_mm3: float
    """Volume worn, from depth times area, mm3."""
    volume_loss_mesh_mm3: float
    """Volume worn, from the change of the mesh less the volume of creep, mm3."""
    max_depth_mm: float
    """Deepest wear, mm."""
    peak_pressure_mpa: float
    """Highest pressure anywhere, between nodes too, in any cycle, MPa."""
    peak_pressure_cycle: float
    """Cycles done before the cycle that has it."""
    first_cycle_peak_pressure_mpa: float
    """Highest pressure of the first cycle, MPa."""
    last_cycle_peak_pressure_mpa: float
    """Highest pressure of the last cycle solved, MPa."""
    peak_contact_area_mm2: float
    """Largest contact area in any cycle, mm2."""
    peak_contact_area_cycle: float
    """Cycles done before the cycle that has it."""
    first_cycle_contact_area_mm2: float
    """Largest contact area of the first cycle, mm2."""
    last_cycle_contact_area_mm2: float
    """Largest contact area of the last cycle solved, mm2."""
    last_cycle: float
    """Cycles done before the last cycle solved."""
    ap_range_mm: float
    """Range of AP in the first cycle, mm."""
    ie_range_deg: float
    """Range of IE in the first cycle, degrees."""
    medial_load_share: float
    """Medial part of the axial force, averaged over the first cycle, weighted by force."""
    updates: int
    """Updates of the geometry."""
    increments: int
    """Increments a cycle."""
    cycles_solved: float
    """Cycles solved in all."""
    cycles_not_repeating: int
    """Updates whose cycle did not repeat itself within the tolerance."""
    newton_iterations: int
    """Newton iterations in all."""
    contact_evaluations: int
    """Contact evaluations in all."""
    newton_iterations_per_cycle: float
    """Newton iterations of a cycle solved, on average."""
    contact_evaluations_per_cycle: float
    """Contact evaluations of a cycle solved, on average."""
    step_halvings: int
    """Steps that were halved."""
    hexahedra: int
    """Hexahedra of the insert."""
    articulating_nodes: int
    """Nodes of its articulating surface."""
    worst_quality: float
    """Smallest scaled Jacobian of any update's mesh."""
    wall_s: float
    """Seconds spent on the solver."""
    version: str
    """Version of condyle."""
    inputs_blake3: str
    """Hash of case and meshes."""
    warnings: list[str]
    """What was put right or looks doubtful in the input."""
    plausibility: list[dict[str, Any]]
    """What makes the numbers doubtful, the worst first, each with ``message`` and ``advice``."""
    error: dict[str, Any] | None
    """Estimated discretisation errors, in % of each quantity, with their parts; none if the case asks for none."""
    wear_laws: list[dict[str, Any]]
    """What every law of wear says of the same histories, that of the run first."""
    neutral_pose: dict[str, Any]
    """Where the femur settled, in the insert frame: there AP, ML and IS read zero."""

    def __init__(self, run: RawRun, folder: Path | None = None) -> None:
        """Use :func:`condyle.run` or :func:`condyle.open`."""
        self._run, self._folder = run, folder
        summary = run["summary"]
        self.summary: dict[str, Any] = json.loads(summary) if summary else {}
        """All of ``summary.json``."""
        self.tables: dict[str, Table] = {name: Table(*table) for name, table in run["tables"].items()}
        """All tables of the run, by the names of their files without the ending."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self.summary[name]
        except KeyError:
            why = "" if self.summary else "; the run is not done, so that it has no summary yet"
            raise AttributeError(f"a result has no {name}{why}") from None

    @property
    def is_done(self) -> bool:
        """Whether the run came to its end."""
        return bool(self.summary)

    @property
    def folder(self) -> Path | None:
        """Where the results lie, if in a folder."""
        return self._folder

    @property
    def case(self) -> Case:
        """The case as run."""
        return Case.from_text(self._run["case"], folder=self._folder or ".", name="case of the run")

    @property
    def wear(self) -> Table:
        """A row an update: ``cycles``, ``mass_loss_mg``, ``volume_loss_mm3``, ``max_depth_mm`` and more."""
        return self.tables["wear"]

    @property
    def kinematics(self) -> Table:
        """Motions and loads of the first activity: a row an increment of the first and of the last cycle.

        ``cycles`` says how many were done before: 0 for the first one. Other activities are in :attr:`tables`, as
        ``kinematics_NAME``.
        """
        return self.tables["kinematics"]

    @property
    def femur_pose(self) -> Table:
        """Where the femur is at the rows of :attr:`kinematics`: its origin, and its rotation row by row."""
        return self.tables["femur_pose"]

    @property
    def update_cycles(self) -> NDArray[np.float64]:
        """Cycles done at every update of :attr:`fields`, that of the unworn insert first: shape (updates + 1,)."""
        import numpy as np

        cycles = np.concatenate([[0.0], self.wear["cycles"]])
        return cycles[: len(self.points_mm)]

    @property
    def points_mm(self) -> NDArray[np.float64]:
        """Places of the insert's nodes at every update, the unworn first, mm: shape (updates + 1, nodes, 3)."""
        return self._run["points_mm"]

    @property
    def hexes(self) -> NDArray[np.uint32]:
        """Node numbers of the hexahedra, in VTK's order: shape (hexahedra, 8)."""
        return self._run["hexes"]

    @property
    def articulating(self) -> NDArray[np.bool_]:
        """Which nodes are on the articulating surface: shape (nodes,)."""
        return self._run["articulating"]

    @property
    def fields(self) -> dict[str, NDArray[np.float64]]:
        """Results at the nodes at every update, the unworn first: shape (updates + 1, nodes), directions with 3 more.

        ``wear_depth_mm``, ``depth_per_cycle_mm``, ``peak_pressure_mpa``, ``sliding_distance_mm``, ``cross_shear``,
        ``thickness_mm``, ``principal_direction``; 0 at nodes that are not on the articulating surface.
        """
        return self._run["fields"]

    @property
    def femur_points_mm(self) -> NDArray[np.float32]:
        """Vertices of the femur as it stands at neutral, mm: shape (vertices, 3)."""
        return self._run["femur_points_mm"]

    @property
    def femur_triangles(self) -> NDArray[np.uint32]:
        """Vertex numbers of its triangles: shape (triangles, 3)."""
        return self._run["femur_triangles"]

    def femur_points_at(self, increment: int, cycle: Literal["first", "last"] = "first") -> NDArray[np.float64]:
        """Vertices of the femur at the end of an increment, from 0, of one of the two cycles, mm: shape (vertices, 3)."""
        from .femur import femur_points_at

        return femur_points_at(self, increment, cycle)

    @property
    def plot(self) -> Plots:
        """Pictures with Matplotlib, such as ``result.plot.wear_map()``."""
        from .plot import Plots

        return Plots(self)

    def to_pandas(self) -> pd.DataFrame:
        """:attr:`wear` as a data frame; the other tables have a ``to_pandas`` of their own."""
        return self.wear.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """Everything as a data set.

        Dimensions are ``update`` (the unworn insert is 0), ``node``, ``component``, ``cycle`` (first and last) and
        ``increment``; units are attributes.
        """
        from .data_set import data_set

        return data_set(self)

    def to_pyvista(
        self, update: int = -1, increment: int | None = None, cycle: Literal["first", "last"] = "last"
    ) -> pv.MultiBlock:
        """The insert with its fields at an update, and the femur beside it.

        Args:
            update: which update, 0 for the unworn insert, -1 for the last.
            increment: where the femur stands, from 0; at neutral if not given.
            cycle: of which cycle that increment is.
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

    def __getstate__(self) -> dict[str, Any]:
        return {"_run": self._run, "_folder": self._folder}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["_run"], state["_folder"])


def check_fields(result: Result) -> None:
    """Refuses a result without fields, of a run that was asked to keep none."""
    if not result.fields:
        raise CondyleError("this result has no fields at the nodes: run the case with fields=True")
