"""Bodies from CAD files.

``python -m condyle.cad FILE.step FILE.ply`` converts a STEP file to triangles, as ``condyle new --femur FILE.step`` does.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._extras import extra
from ._ply import ply_bytes
from .errors import BadInput

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["read_step"]


# OpenCASCADE samples the deflection along edges and at some points of a face, and exceeds the requested value up to 2.1
# times on a sphere; the request is divided by this factor.
_EXCEEDED = 2.5


def read_step(
    path: str | os.PathLike[str], *, deflection_mm: float = 0.01, angle_deg: float = 10.0
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The surface of all bodies in a STEP file as triangles, for ``Case.with_femur`` and ``with_insert``.

    OpenCASCADE reads the file (``pip install condyle[cad]``) and converts its unit to mm.

    Args:
        path: a STEP file.
        deflection_mm: the largest distance of a triangle from its surface, mm.
        angle_deg: the largest angle between the normals of neighbouring triangles on a curved face, degrees.

    Returns:
        Vertices in mm without repetition, shape (n, 3); vertex numbers from 0, shape (m, 3), anticlockwise seen from outside.

    Raises:
        BadInput: an unreadable file, or one without a surface.
    """
    import numpy as np

    if not (deflection_mm > 0.0 and angle_deg > 0.0):
        raise BadInput(f"deflection_mm = {deflection_mm} and angle_deg = {angle_deg}: give both above 0")
    shape = _shape(os.fspath(path))
    mesh = extra("OCP.BRepMesh", "cad").BRepMesh_IncrementalMesh
    mesh(shape, deflection_mm / _EXCEEDED, False, np.radians(angle_deg), False)
    parts = [part for part in map(_triangles_of, _faces(shape)) if part is not None]
    if not parts:
        raise BadInput(f"{os.fspath(path)}: there is no surface in the file")
    return _joined(parts)


def _shape(path: str) -> Any:
    control = extra("OCP.STEPControl", "cad")
    reader = control.STEPControl_Reader()
    if reader.ReadFile(path) != extra("OCP.IFSelect", "cad").IFSelect_RetDone:
        raise BadInput(f"{path}: this is not a STEP file that can be read; check that it exists and was exported as STEP")
    reader.TransferRoots()
    shape = reader.OneShape()
    if shape is None or shape.IsNull():
        raise BadInput(f"{path}: there is no body in the file")
    return shape


def _faces(shape: Any) -> list[Any]:
    kinds, explorer = extra("OCP.TopAbs", "cad"), extra("OCP.TopExp", "cad").TopExp_Explorer
    casts = extra("OCP.TopoDS", "cad").TopoDS
    cast = getattr(casts, "Face_s", None) or casts.Face
    found, faces = explorer(shape, kinds.TopAbs_FACE), []
    while found.More():
        faces.append(cast(found.Current()))
        found.Next()
    return faces


def _triangles_of(face: Any) -> NDArray[np.float64] | None:
    """The corners of a face's triangles, mm: shape (m, 3, 3)."""
    import numpy as np

    place = extra("OCP.TopLoc", "cad").TopLoc_Location()
    tool = extra("OCP.BRep", "cad").BRep_Tool
    triangulation = (getattr(tool, "Triangulation_s", None) or tool.Triangulation)(face, place)
    if triangulation is None:
        return None
    moved = place.Transformation()
    nodes = [triangulation.Node(number + 1).Transformed(moved) for number in range(triangulation.NbNodes())]
    positions = np.array([(node.X(), node.Y(), node.Z()) for node in nodes])
    corners = np.array([triangulation.Triangle(number + 1).Get() for number in range(triangulation.NbTriangles())]) - 1
    reversed_face = face.Orientation() == extra("OCP.TopAbs", "cad").TopAbs_REVERSED
    return positions[corners[:, ::-1] if reversed_face else corners]


def _joined(parts: list[NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The triangles of all faces, with the vertices of adjacent faces merged; degenerate triangles and folded flaps are removed."""
    import numpy as np

    corners = np.concatenate(parts).reshape(-1, 3)
    _, first, number = np.unique(corners.round(6), axis=0, return_index=True, return_inverse=True)
    triangles = number.reshape(-1, 3)
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    # Where two edges of a thin face nearly coincide, its triangles lie on those of its neighbour and face the other way: no
    # surface is between them, and their edges would have more than two triangles.
    _, same, count = np.unique(np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True)
    return corners[first], triangles[count[same.ravel()] == 1]


def _main() -> None:
    parser = argparse.ArgumentParser(prog="python -m condyle.cad", description="Convert a STEP file to triangles in mm.")
    parser.add_argument("step", help="the STEP file")
    parser.add_argument("ply", help="the PLY file to write; an existing one is replaced")
    parser.add_argument("--deflection-mm", type=float, default=0.01, help="the largest distance of a triangle from its surface")
    given = parser.parse_args()
    try:
        vertices, triangles = read_step(given.step, deflection_mm=given.deflection_mm)
    except (BadInput, ImportError) as error:
        sys.exit(str(error))
    Path(given.ply).write_bytes(ply_bytes(vertices, triangles, "body"))
    size = " x ".join(f"{edge:.1f}" for edge in vertices.max(axis=0) - vertices.min(axis=0))
    print(
        f"{given.ply}: {len(triangles)} triangles, {size} mm, at most {given.deflection_mm:g} mm from the surface of {given.step}"
    )


if __name__ == "__main__":
    _main()
