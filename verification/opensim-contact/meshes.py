"""Triangle meshes as arrays: read from binary STL, rounded between their vertices, written as OBJ."""

import numpy as np

# Edges whose ends' normals part by more than this stay straight: rims, not bearing surface.
MIN_COSINE_OF_A_ROUND_EDGE = 0.9


def read_stl(path):
    """Vertices (n, 3), each once, and triangles (m, 3) of a binary STL file, in the file's unit."""
    record = np.dtype([("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
    with open(path, "rb") as file:
        file.seek(80)
        count = int(np.frombuffer(file.read(4), "<u4")[0])
        records = np.frombuffer(file.read(count * record.itemsize), record)
    corners = records["corners"].reshape(-1, 3).astype(float)
    vertices, numbers = np.unique(corners, axis=0, return_inverse=True)
    return vertices, numbers.reshape(-1, 3)


def vertex_normals(vertices, triangles):
    """Normals at vertices, exact where these lie on a sphere (Max 1999, J Graph Tools 4:2)."""
    normals = np.zeros_like(vertices)
    for corner in range(3):
        here, after, before = (vertices[triangles[:, (corner + k) % 3]] for k in range(3))
        after, before = after - here, before - here
        weight = (after**2).sum(1) * (before**2).sum(1)
        np.add.at(normals, triangles[:, corner], np.cross(after, before) / weight[:, None])
    return normals / np.linalg.norm(normals, axis=1)[:, None]


def rounded(vertices, triangles):
    """The mesh with every triangle in four, new vertices on curved edges.

    An edge is the cubic that meets the normals of both ends (Vlachos et al. 2001, PN triangles):
    its middle lies ((e . n2) n2 - (e . n1) n1)/8 off the middle of the chord e, the sagitta of a
    circle in equal parts from both ends.
    """
    normals = vertex_normals(vertices, triangles)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges, of_triangle = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = of_triangle.reshape(3, -1) + len(vertices)
    start, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    normal_at_start, normal_at_end = normals[edges[:, 0]], normals[edges[:, 1]]

    def along(normal):
        return ((end - start) * normal).sum(1)[:, None] * normal

    bulge = (along(normal_at_end) - along(normal_at_start)) / 8.0
    is_round = (normal_at_start * normal_at_end).sum(1) > MIN_COSINE_OF_A_ROUND_EDGE
    middles = (start + end) / 2.0 + np.where(is_round[:, None], bulge, 0.0)
    a, b, c = triangles.T
    quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([vertices, middles]), np.concatenate([np.stack(q, 1) for q in quarters])


def write_obj(path, vertices, triangles):
    """Writes an OBJ file."""
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in vertices)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in triangles + 1)
