"""A result as a data set of xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._condyle import unit_of
from ._extras import extra
from .femur import rows_of_cycle
from .result import check_fields

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

    from .result import Result
    from .table import Table

__all__ = ["data_set"]

# Names of motions and loads that the wear table or the nodes have too.
_OF_INSERT_TOO = ("peak_pressure_mpa", "x_mm", "y_mm", "z_mm")


def data_set(result: Result) -> xr.Dataset:
    """Tables and fields of a run as one data set."""
    import numpy as np

    xarray = extra("xarray", "xarray")
    check_fields(result)
    variables = {**_at_nodes(result), **_by_update(result.wear)}
    for name, table in result.tables.items():
        if name != "wear":
            _, _, activity = name.partition("kinematics_")
            variables |= _by_increment(table, f"{activity}_" if activity else "")
    places = result.points_mm[0]
    kinematics = result.kinematics
    first = rows_of_cycle(kinematics["cycles"], "first")
    coordinates = {
        "cycles": ("update", result.update_cycles, {"long_name": "gait cycles done"}),
        "component": ["x", "y", "z"],
        "cycle": ["first", "last"][: len(np.unique(kinematics["cycles"]))],
        "percent": ("increment", kinematics["percent"][first], {"units": "%", "long_name": "part of the cycle"}),
        "articulating": ("node", result.articulating),
        **{f"{axis}_mm": ("node", places[:, number], {"units": "mm"}) for number, axis in enumerate("xyz")},
    }
    inputs = result.summary.get("inputs_blake3") or result.case.inputs_blake3
    return xarray.Dataset(variables, coordinates, {"condyle": result.summary.get("version", ""), "inputs_blake3": inputs})


def _described(dimensions: tuple[str, ...], values: NDArray[np.float64], name: str) -> tuple[Any, ...]:
    return dimensions, values, {"units": unit_of(name) or "1", "long_name": name.replace("_", " ")}


def _at_nodes(result: Result) -> dict[str, Any]:
    def described(name: str, values: NDArray[np.float64]) -> tuple[Any, ...]:
        dimensions = ("update", "node", "component")[: values.ndim]
        return _described(dimensions, values, name)

    fields = {name: described(name, values) for name, values in result.fields.items()}
    return {"points_mm": described("points_mm", result.points_mm), **_apart(fields, "node_")}


def _apart(fields: dict[str, Any], prefix: str) -> dict[str, Any]:
    """Adds a prefix to fields whose name a table has too."""
    return {prefix + name if name == "peak_pressure_mpa" else name: values for name, values in fields.items()}


def _by_update(table: Table) -> dict[str, Any]:
    """The table with a first row of NaN for the unworn insert, update 0, which the file does not have."""
    import numpy as np

    def from_unworn(name: str) -> NDArray[np.float64]:
        return np.concatenate([[np.nan], table[name]])

    return {name: _described(("update",), from_unworn(name), name) for name in table if name != "cycles"}


def _by_increment(table: Table, prefix: str) -> dict[str, Any]:
    import numpy as np

    cycles = np.unique(table["cycles"])

    def by_cycle(name: str) -> NDArray[np.float64]:
        return table[name].reshape(len(cycles), -1)

    names = [name for name in table if name not in ("cycles", "percent")]
    own = {name: f"cycle_{name}" if name in _OF_INSERT_TOO else name for name in names}
    return {prefix + own[name]: _described(("cycle", "increment"), by_cycle(name), name) for name in names}
