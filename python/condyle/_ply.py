"""Triangles as a PLY file in double precision."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .errors import BadInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def ply_bytes(vertices: ArrayLike, triangles: ArrayLike, what: str) -> bytes:
    """The bytes of a PLY file; messages call the body ``what``."""
    import numpy as np

    if np.ma.is_masked(vertices) or np.ma.is_masked(triangles):
        raise BadInput(f"arrays of the {what} have masked entries; give those of the body alone")
    positions = np.asarray(vertices, dtype="<f8")
    corners = np.asarray(triangles)
    if positions.ndim != 2 or positions.shape[1] != 3 or len(positions) == 0:
        raise BadInput(f"vertices of the {what} have shape {positions.shape}; give n rows of x, y, z")
    if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) == 0:
        raise BadInput(f"triangles of the {what} have shape {corners.shape}; give m rows of three vertex numbers")
    if corners.dtype.kind not in "iu":
        raise BadInput(f"triangles of the {what} are of type {corners.dtype}; give whole numbers")
    if corners.min() < 0 or corners.max() >= len(positions):
        raise BadInput(
            f"triangles of the {what} name vertices {corners.min()} to {corners.max()}; "
            f"there are vertices 0 to {len(positions) - 1}"
        )
    if not np.isfinite(positions).all():
        raise BadInput(f"vertices of the {what} have a coordinate that is not a finite number")
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(corners), dtype=[("count", "u1"), ("vertices", "<i4", 3)])
    faces["count"], faces["vertices"] = 3, corners
    return header.encode() + positions.tobytes() + faces.tobytes()
