"""A result as meshes of PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ._extras import extra
from .result import check_fields

if TYPE_CHECKING:
    import pyvista as pv

    from .result import Result

__all__ = ["scene"]

_HEXAHEDRON = 12


def scene(result: Result, update: int, increment: int | None, cycle: Literal["first", "last"]) -> pv.MultiBlock:
    """The insert with its fields at an update, and the femur at an increment or at neutral."""
    pyvista = extra("pyvista", "pyvista")
    check_fields(result)
    insert = pyvista.UnstructuredGrid({_HEXAHEDRON: result.hexes.astype(int)}, result.points_mm[update])
    for name, values in result.fields.items():
        insert.point_data[name] = values[update]
    insert.point_data["articulating"] = result.articulating.astype("uint8")
    insert.set_active_scalars("wear_depth_mm")
    points = result.femur_points_mm if increment is None else result.femur_points_at(increment, cycle)
    femur = pyvista.PolyData.from_regular_faces(points, result.femur_triangles.astype(int))
    return pyvista.MultiBlock({"insert": insert, "femur": femur})
