"""Pictures of a result with Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from ._extras import extra
from .femur import rows_of_cycle
from .result import check_fields

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from .result import Result

__all__ = ["Plots"]

_MOTIONS = {
    "flexion_deg": "flexion, deg",
    "axial_force_n": "axial force, N",
    "ap_mm": "AP, anterior +, mm",
    "ie_deg": "IE, internal +, deg",
    "vv_deg": "varus +, deg",
    "peak_pressure_mpa": "peak pressure, MPa",
}


def _of_joint(result: Result) -> dict[str, str]:
    """The labels of the motions and loads of a joint other than the knee."""
    labels = {}
    for motion in result.motions:
        unit = motion["column"].rpartition("_")[2]
        labels[motion["column"]] = f"{motion['positive'] or motion['title']} +, {unit}"
    return labels | {name: _MOTIONS[name] for name in ("axial_force_n", "peak_pressure_mpa")}


class Plots:
    """Pictures of a result. Each is drawn into the given or into new axes, which are returned."""

    def __init__(self, result: Result) -> None:
        """Use ``result.plot``."""
        self._result = result

    def wear_map(self, update: int = -1, ax: Axes | None = None) -> Axes:
        """Wear depth on the articulating surface, from above with anterior up, mm."""
        return self._map("wear_depth_mm", "wear depth, mm", update, ax)

    def pressure(self, update: int = -1, ax: Axes | None = None) -> Axes:
        """Highest pressure in the cycle repeated up to an update, from 1, or in the final cycle, from above, MPa."""
        check_fields(self._result)
        cycles = self._result.update_cycles
        place = range(len(cycles))[update]
        if place == 0:
            raise ValueError("the unworn insert, update 0, has no cycle; the first cycle is that of update 1")
        axes = self._map("peak_pressure_mpa", "peak pressure, MPa", update, ax)
        is_final = self._result.is_done and place == len(cycles) - 1
        axes.set_title(f"cycle at {cycles[place if is_final else place - 1] / 1e6:g} million cycles", fontsize="medium")
        return axes

    def wear_curve(self, ax: Axes | None = None) -> Axes:
        """Mass loss over the cycles, mg, with its discretisation error if that was estimated."""
        axes, wear = _axes(ax), self._result.wear
        millions, mass_mg = [0.0, *(wear["cycles"] / 1e6)], [0.0, *wear["mass_loss_mg"]]
        (line,) = axes.plot(millions, mass_mg, marker="o", markersize=4)
        error = self._result.summary.get("error")
        if error:
            part = error["mass_loss_percent"]["total"] / 100
            low, high = ([mass * (1 + sign * part) for mass in mass_mg] for sign in (-1, 1))
            axes.fill_between(millions, low, high, color=line.get_color(), alpha=0.2, label="discretisation error")
            axes.legend(loc="upper left", frameon=False)
        axes.set(xlabel="million cycles", ylabel="mass loss, mg", xlim=(0, None), ylim=(0, None))
        return axes

    def kinematics(self) -> Figure:
        """Motions and loads in the first and the last cycle."""
        pyplot = extra("matplotlib.pyplot", "plot")
        result = self._result
        table = result.kinematics
        is_knee = result.summary.get("joint", "knee") == "knee"
        labels = _MOTIONS if is_knee else _of_joint(result)
        shown = {name: label for name, label in labels.items() if name in table}
        lines = -(-len(shown) // 3)
        figure, grid = pyplot.subplots(lines, 3, figsize=(11, 2.75 * lines), sharex=True, squeeze=False, layout="constrained")
        for axes, (name, label) in zip(grid.flat, shown.items()):
            for cycle, style in _cycles(table["cycles"]):
                rows = rows_of_cycle(table["cycles"], cycle)
                axes.plot(table["percent"][rows], table[name][rows], style, label=f"{cycle} cycle")
            axes.set_title(label, fontsize="medium")
        for axes in list(grid.flat)[len(shown) :]:
            axes.remove()
        for axes in list(grid.flat)[: len(shown)][-3:]:
            axes.set_xlabel("% of the cycle")
            axes.tick_params(labelbottom=True)
        grid.flat[0].legend(frameon=False)
        return figure

    def _map(self, field: str, label: str, update: int, ax: Axes | None) -> Axes:
        result = self._result
        check_fields(result)
        triangulation = extra("matplotlib.tri", "plot").Triangulation
        triangles = _surface_triangles(result.hexes, result.articulating)
        positions = result.points_mm[update]
        axes = _axes(ax)
        from_above = triangulation(positions[:, 2], positions[:, 0], triangles)
        colours = axes.tripcolor(from_above, result.fields[field][update], shading="gouraud", cmap="magma_r", vmin=0.0)
        axes.get_figure().colorbar(colours, ax=axes, label=label, shrink=0.7)
        label_x, label_z = "x, mm", "z, mm"
        joint = result.summary.get("joint")
        if joint in ("knee", "hip", "ankle"):
            # Hips and ankles stand upside down in their machines: a left one has lateral at +z.
            lateral_at = "right" if joint == "knee" else "left"
            left, right = ("medial", "lateral") if result.case["side"] == lateral_at else ("lateral", "medial")
            label_x, label_z = "x, anterior up, mm", f"{left}  <  z, mm  >  {right}"
        axes.set(xlabel=label_z, ylabel=label_x, aspect="equal")
        axes.set_title(f"after {result.update_cycles[update] / 1e6:g} million cycles", fontsize="medium")
        return axes


def _axes(ax: Axes | None) -> Any:
    return ax if ax is not None else extra("matplotlib.pyplot", "plot").subplots(layout="constrained")[1]


def _cycles(cycles: NDArray[np.float64]) -> list[tuple[Literal["first", "last"], str]]:
    """The recorded cycles with a line style; a run of one update has one cycle."""
    both = cycles.min() != cycles.max()
    return [("first", "-"), ("last", "--")] if both else [("first", "-")]


def _surface_triangles(hexes: NDArray[np.uint32], articulating: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Two triangles for every outer face with four nodes on the articulating surface."""
    import numpy as np

    corners = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    faces = hexes[:, corners].reshape(-1, 4).astype(np.int64)
    faces = faces[articulating[faces].all(axis=1)]
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[first[count == 1]]
    return np.concatenate([outer[:, [0, 1, 2]], outer[:, [0, 2, 3]]])
