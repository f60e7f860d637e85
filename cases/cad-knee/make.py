"""Makes the implant of this folder: a cruciate-retaining femoral component and a dished insert, as CAD exports them.

    pip install 'cadquery-ocp-novtk>=8' gmsh numpy
    python cases/cad-knee/make.py

Lengths are in mm; x points right, y anterior and z superior, and it is a right knee. A B-spline surface through points splits
a blank; bone cuts, the notch and pegs follow, and rims are rounded. Each body is written as STEP (the solid) and as STL
(triangles with edges of at most EDGE_MM). The femur's origin lies on the axis of its posterior arcs, that of the insert
between the lowest points of its dishes. Another version of OpenCASCADE or Gmsh may place triangles differently.
"""

import re
from pathlib import Path

import gmsh
import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse, BRepAlgoAPI_Splitter
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.collections import Array2_gp_Pnt, List_TopoDS_Shape
from OCP.GeomAbs import GeomAbs_BSplineSurface, GeomAbs_Line
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_IN, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

# The longest edge of a triangle: 0.01 mm from the arc of the smallest radius that articulates.
EDGE_MM = 1.6

# The condyles of both bodies.
SPACING_MM = 46.0

# Femoral component, from the side: arcs of these radii meet in a common tangent at these angles from straight below,
# positive towards posterior.
POSTERIOR_RADIUS_MM, DISTAL_RADIUS_MM, TROCHLEAR_RADIUS_MM = 22.0, 36.0, 30.0
POSTERIOR_TO_DISTAL_DEG, DISTAL_TO_TROCHLEAR_DEG = 20.0, -25.0
FEMORAL_CORONAL_RADIUS_MM = 25.0
FEMORAL_HALF_WIDTH_MM = 34.0
GROOVE_DEPTH_MM = 4.5
LATERAL_RIDGE_MM = 2.5
NOTCH_RADIUS_MM = 9.0
# Where the posterior condyles end.
TIP_MM = 12.5
# Corners of the bone, (anterior, superior).
BONE = [(-13, 60), (-13, -4), (-4, -14), (16, -14), (28, -3), (33, 60)]

# Insert.
DISH_SAGITTAL_RADIUS_MM, DISH_CORONAL_RADIUS_MM = 41.0, 30.0
THICKNESS_MM = 9.0
EMINENCE_MM = 5.5


def smooth_step(x, low, high):
    """0 up to `low`, 1 from `high` on, with two continuous derivatives between."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t**2)


def smooth_min(a, b, width):
    """The smaller of both, rounded with two continuous derivatives where they differ by less than `width`."""
    overlap = np.maximum(width - np.abs(a - b), 0.0) / width
    return np.minimum(a, b) - overlap**3 * width / 6.0


def drop(x, radius):
    """Distance at x between an arc through the lowest point of each condyle and its tangent there."""
    return radius - np.sqrt(radius**2 - (np.abs(x) - SPACING_MM / 2) ** 2)


def normal(deg):
    """The direction (anterior, superior) at an angle from straight below, positive towards posterior."""
    return np.stack([-np.sin(np.radians(deg)), -np.cos(np.radians(deg))], axis=-1)


def j_curve():
    """Angles, points and normals of the femur's outline from the side, from posterior to the top of the flange."""
    distal_centre = (POSTERIOR_RADIUS_MM - DISTAL_RADIUS_MM) * normal(POSTERIOR_TO_DISTAL_DEG)
    trochlear_centre = distal_centre + (DISTAL_RADIUS_MM - TROCHLEAR_RADIUS_MM) * normal(DISTAL_TO_TROCHLEAR_DEG)
    arcs = [
        (np.zeros(2), POSTERIOR_RADIUS_MM, 150.0, POSTERIOR_TO_DISTAL_DEG),
        (distal_centre, DISTAL_RADIUS_MM, POSTERIOR_TO_DISTAL_DEG, DISTAL_TO_TROCHLEAR_DEG),
        (trochlear_centre, TROCHLEAR_RADIUS_MM, DISTAL_TO_TROCHLEAR_DEG, -90.0),
    ]
    angles, points = [], []
    for centre, radius, first, last in arcs:
        deg = np.linspace(first, last, round(abs(first - last) / 5.0), endpoint=False)
        angles.append(deg)
        points.append(centre + radius * normal(deg))
    rise = np.linspace(0.0, 34.0 - trochlear_centre[1], 6)
    angles.append(np.full(len(rise), -90.0))
    points.append(trochlear_centre + np.stack([np.full(len(rise), TROCHLEAR_RADIUS_MM), rise], axis=-1))
    angles = np.concatenate(angles)
    return angles, np.concatenate(points), normal(angles)


def femoral_surface():
    """Points of the femur's articulating surface, [along the J-curve, from left to right]."""
    angles, points, normals = j_curve()
    x = np.linspace(-36.0, 36.0, 37)
    profile = smooth_min(drop(x, FEMORAL_CORONAL_RADIUS_MM), GROOVE_DEPTH_MM, 4.0)
    in_front = smooth_step(-angles, 40.0, 80.0)[:, None]
    depth = profile - LATERAL_RIDGE_MM * in_front * smooth_step(x, 4.0, 22.0)
    sagittal = points[:, None, :] - depth[..., None] * normals[:, None, :]
    return np.concatenate([np.broadcast_to(x[:, None], (*depth.shape, 1)), sagittal], axis=-1)


def insert_surface():
    """Points of the insert's articulating surface, [from posterior to anterior, from left to right]."""
    y = np.linspace(-26.0, 30.0, 25)[:, None]
    x = np.linspace(-40.0, 40.0, 41)
    # A torus for each dish: the coronal arc turned about an axis above it.
    to_axis = DISH_SAGITTAL_RADIUS_MM - drop(x, DISH_CORONAL_RADIUS_MM)
    dishes = DISH_SAGITTAL_RADIUS_MM - np.sqrt(to_axis**2 - y**2)
    # The eminence falls off in front, where the trochlea comes down in extension.
    eminence = EMINENCE_MM - 3.0 * smooth_step(y, 2.0, 14.0)
    cap = eminence + (9.5 - eminence) * smooth_step(np.abs(x), 8.0, 18.0)
    height = smooth_min(dishes, cap, 2.5)
    return np.stack([*np.broadcast_arrays(x, y, height)], axis=-1)


def point(place):
    return gp_Pnt(*map(float, place))


def spline(points):
    """The B-spline surface through a grid of points."""
    grid = Array2_gp_Pnt(1, points.shape[0], 1, points.shape[1])
    for i, j in np.ndindex(points.shape[:2]):
        grid.SetValue(i + 1, j + 1, point(points[i, j]))
    surface = GeomAPI_PointsToBSplineSurface()
    surface.Interpolate(grid)
    return surface.Surface()


def parts(shape, kind, cast):
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield cast(explorer.Current())
        explorer.Next()


def polygon(corners):
    made = BRepBuilderAPI_MakePolygon()
    for corner in corners:
        made.Add(point(corner))
    made.Close()
    return BRepBuilderAPI_MakeFace(made.Wire(), True).Face()


def prism(corners, along):
    """The polygon `corners` extruded by the vector `along`."""
    return BRepPrimAPI_MakePrism(polygon(corners), gp_Vec(*map(float, along))).Shape()


def split(blank, points, inside):
    """The part of a solid that contains the place `inside`, split by the B-spline surface through `points`."""
    splitter = BRepAlgoAPI_Splitter()
    face = BRepBuilderAPI_MakeFace(spline(points), 1e-6).Face()
    for add, shape in ((splitter.SetArguments, blank), (splitter.SetTools, face)):
        shapes = List_TopoDS_Shape()
        shapes.Append(shape)
        add(shapes)
    splitter.Build()
    for piece in parts(splitter.Shape(), TopAbs_SOLID, TopoDS.Solid):
        if BRepClass3d_SolidClassifier(piece, point(inside), 1e-6).State() == TopAbs_IN:
            return piece
    raise ValueError("the place lies in no part")


def cut(body, tool):
    return BRepAlgoAPI_Cut(body, tool).Shape()


def fuse(body, tool):
    return BRepAlgoAPI_Fuse(body, tool).Shape()


def box(low, high):
    return BRepPrimAPI_MakeBox(point(low), point(high)).Shape()


def cylinder(bottom, radius, height):
    return BRepPrimAPI_MakeCylinder(gp_Ax2(point(bottom), gp_Dir(0, 0, 1)), radius, height).Shape()


def is_on_spline(face, edge):
    return BRepAdaptor_Surface(face).GetType() == GeomAbs_BSplineSurface


def is_upright(face, edge):
    curve = BRepAdaptor_Curve(edge)
    return curve.GetType() == GeomAbs_Line and abs(curve.Line().Direction().Z()) > 0.999


def height(edge):
    """The height of the middle of an edge."""
    curve = BRepAdaptor_Curve(edge)
    return curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter())).Z()


def rounded(body, radius, wanted):
    """The body with the edges rounded for which `wanted(face, edge)` is true."""
    rounding = BRepFilletAPI_MakeFillet(body)
    for face in parts(body, TopAbs_FACE, TopoDS.Face):
        for edge in parts(face, TopAbs_EDGE, TopoDS.Edge):
            if wanted(face, edge):
                rounding.Add(radius, edge)
    return rounding.Shape()


def femur():
    blank = box((-FEMORAL_HALF_WIDTH_MM, -40, -40), (FEMORAL_HALF_WIDTH_MM, 50, 33))
    blank = cut(blank, prism([(-40, *corner) for corner in BONE], (80, 0, 0)))
    body = split(blank, femoral_surface(), (SPACING_MM / 2, 0, -17))
    # The tips of the posterior condyles, and the top of the flange, which rises to the lateral side.
    body = cut(body, prism([(-40, -30, TIP_MM), (40, -30, TIP_MM), (40, 0, TIP_MM), (-40, 0, TIP_MM)], (0, 0, 40)))
    body = cut(body, prism([(-40, 20, 25), (40, 20, 31), (40, 20, 60), (-40, 20, 60)], (0, 40, 0)))
    # The flange becomes narrower to the top.
    for side in (-1, 1):
        body = cut(body, prism([(side * 34.5, 20, -2), (side * 25, 20, 36), (side * 40, 20, 36)], (0, 40, 0)))
    notch = box((-NOTCH_RADIUS_MM, -40, -40), (NOTCH_RADIUS_MM, 8, 40))
    body = cut(body, fuse(notch, cylinder((0, 8, -40), NOTCH_RADIUS_MM, 80)))
    # The edges at the tips are too sharp to be rounded.
    body = rounded(body, 1.0, lambda face, edge: is_on_spline(face, edge) and abs(height(edge) - TIP_MM) > 0.1)
    for side in (-1, 1):
        foot = (side * SPACING_MM / 2, 4.0, -14.5)
        tip = gp_Ax2(point((foot[0], foot[1], -3.0)), gp_Dir(0, 0, 1))
        body = fuse(body, cylinder(foot, 3.0, 11.5))
        body = fuse(body, BRepPrimAPI_MakeCone(tip, 3.0, 2.0, 2.0).Shape())
    return body


def insert():
    blank = rounded(box((-36, -20, -THICKNESS_MM), (36, 27, 20)), 14.0, is_upright)
    # The notch of the posterior cruciate ligament.
    blank = cut(blank, fuse(box((-8, -40, -20), (8, -14, 20)), cylinder((0, -14, -20), 8, 40)))
    body = split(blank, insert_surface(), (0, 0, -3))
    return rounded(body, 1.0, is_on_spline)


def write_step(shape, file):
    if not BRepCheck_Analyzer(shape).IsValid():
        raise ValueError(f"{file}: the solid is not valid")
    step = STEPControl_Writer()
    # Curves in the parameters of a surface follow from those in space, and are half of a file.
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 0)
    step.Transfer(shape, STEPControl_AsIs)
    step.Write(str(file))
    text = file.read_text(encoding="utf-8")
    text = re.sub(r"'\d{4}-\d\d-\d\dT[\d:]+'", "'2026-11-24T00:00:00'", text)
    # A nanometre is enough.
    text = re.sub(r"-?\d+\.\d{7,}(?!\d*E)", lambda number: f"{float(number[0]):.6f}".rstrip("0"), text)
    file.write_text(text, encoding="utf-8")


def write_stl(step, file):
    """Writes triangles of the solid in a STEP file, as short on flat faces as on curved ones."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", EDGE_MM)
    gmsh.option.setNumber("Mesh.MeshSizeMin", EDGE_MM / 3)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 8)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.open(str(step))
    gmsh.model.mesh.generate(2)
    gmsh.write(str(file))
    gmsh.finalize()
    print(f"{file.name}: {(file.stat().st_size - 84) // 50} triangles")


def main():
    folder = Path(__file__).resolve().parent
    for name, shape in (("femur", femur()), ("insert", insert())):
        write_step(shape, folder / f"{name}.step")
        write_stl(folder / f"{name}.step", folder / f"{name}.stl")


if __name__ == "__main__":
    main()
