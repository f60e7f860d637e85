"""The first and the last cycle, increment by increment, held against the tables and against geometry."""

import csv
import json
import os
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE, vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

CYCLES = ["cycle_first", "cycle_last"]


@pytest.fixture(scope="module", params=sorted(os.environ["CONDYLE_FRAMES_RESULTS"].split(":")))
def folder(request):
    return Path(request.param)


def table(path):
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def of_cycle(columns, cycle):
    """The rows of the first or of the last cycle."""
    wanted = columns["cycles"].min() if cycle == "cycle_first" else columns["cycles"].max()
    return {name: values[columns["cycles"] == wanted] for name, values in columns.items()}


def frames(folder, cycle):
    """Time, insert file and femur file of every increment, as the collection names them."""
    sets = ElementTree.parse(folder / f"{cycle}.pvd").getroot().findall("Collection/DataSet")
    for insert, femur in zip(sets[::2], sets[1::2]):
        assert insert.get("timestep") == femur.get("timestep")
        assert (insert.get("part"), femur.get("part")) == ("0", "1")
        yield float(insert.get("timestep")), folder / insert.get("file"), folder / femur.get("file")


def by_vtk(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def force_n(mesh):
    """Pressure times area over all quads, along the normals into the insert: two triangles a quad."""
    quads, points = mesh.cells_dict["quad"], mesh.points.astype(float)
    pressure = mesh.point_data["pressure_mpa"].astype(float)
    total = np.zeros(3)
    for corners in (quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]):
        a, b, c = (points[corners[:, i]] for i in range(3))
        total -= (np.cross(b - a, c - a) / 2 * pressure[corners].mean(axis=1)[:, None]).sum(axis=0)
    return total


def femur_surface(mesh):
    surface, points, triangles = vtkPolyData(), vtkPoints(), vtkCellArray()
    for point in mesh.points:
        points.InsertNextPoint(*point)
    for triangle in mesh.cells_dict["triangle"]:
        triangles.InsertNextCell(3, [int(corner) for corner in triangle])
    surface.SetPoints(points)
    surface.SetPolys(triangles)
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(surface)
    return distance


def poses(folder, cycle):
    rows = of_cycle(table(folder / "femur_pose.csv"), cycle)
    origin = np.stack([rows[f"origin_{axis}_mm"] for axis in "xyz"], axis=1)
    rotation = np.stack([rows[f"r_{i}{j}"] for i in "xyz" for j in "xyz"], axis=1)
    return origin, rotation.reshape(-1, 3, 3)


@pytest.mark.parametrize("cycle", CYCLES)
def test_every_frame_is_read_by_vtk_and_meshio_alike(folder, cycle):
    increments = json.loads((folder / "summary.json").read_text())["increments"]
    listed = list(frames(folder, cycle))
    assert [time for time, _, _ in listed] == [100 * (i + 1) / increments for i in range(increments)]
    for _, insert, femur in listed[:: max(1, increments // 10)]:
        grid, mesh = by_vtk(insert), meshio.read(insert)
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)
        pressure = vtk_to_numpy(grid.GetPointData().GetArray("pressure_mpa"))
        np.testing.assert_array_equal(pressure, mesh.point_data["pressure_mpa"])
        assert by_vtk(femur).GetCellType(0) == VTK_TRIANGLE
        assert len(meshio.read(femur).cells_dict["triangle"]) == by_vtk(femur).GetNumberOfCells()


@pytest.mark.parametrize("cycle", CYCLES)
def test_pressure_over_areas_is_the_axial_force(folder, cycle):
    kinematics = of_cycle(table(folder / "kinematics.csv"), cycle)
    for (time, insert, _), percent, force in zip(frames(folder, cycle), kinematics["percent"], kinematics["axial_force_n"]):
        assert time == percent
        # Friction bears some of it where the surface is inclined.
        assert -force_n(meshio.read(insert))[1] == pytest.approx(force, rel=0.01, abs=2)


@pytest.mark.parametrize("cycle", CYCLES)
def test_the_posed_femur_presses_where_there_is_pressure(folder, cycle):
    """`femur.vtu` moved from neutral by `femur_pose.csv`: overclosure over thickness is the pressure."""
    neutral = json.loads((folder / "summary.json").read_text())["neutral_pose"]
    material = tomllib.loads((folder / "case.toml").read_text())["material"]
    e, v = material["youngs_modulus_mpa"], material["poissons_ratio"]
    modulus = (1 - v) * e / ((1 + v) * (1 - 2 * v))
    femur = meshio.read(folder / "femur.vtu")
    in_femur = (femur.points - neutral["femoral_origin_mm"]) @ np.array(neutral["rotation"])
    unworn = meshio.read(folder / "insert_0000.vtu")
    thickness = unworn.point_data["thickness_mm"][unworn.point_data["articulating"] == 1]
    origins, rotations = poses(folder, cycle)
    listed = list(frames(folder, cycle))
    for increment in range(0, len(listed), max(1, len(listed) // 8)):
        mesh = meshio.read(listed[increment][1])
        femur.points = in_femur @ rotations[increment].T + origins[increment]
        distance = femur_surface(femur)
        gap = np.array([distance.EvaluateFunction(*map(float, point)) for point in mesh.points])
        pressure = mesh.point_data["pressure_mpa"]
        pressed = pressure > 0.4 * pressure.max()
        expected = pressure[pressed] * thickness[pressed] / modulus
        # Facets of the femur, and pressures that are means over shares: a hundredth of a millimetre or two.
        assert np.abs(-gap[pressed] - expected).max() < 0.02, increment
        far = gap > 0.3
        assert np.all(pressure[far] == 0)


def test_the_drawn_femur_is_the_posed_one(folder):
    """The frames' femur lies on `femur.vtu` moved by the pose, but for its coarser triangles."""
    neutral = json.loads((folder / "summary.json").read_text())["neutral_pose"]
    femur = meshio.read(folder / "femur.vtu")
    in_femur = (femur.points - neutral["femoral_origin_mm"]) @ np.array(neutral["rotation"])
    origins, rotations = poses(folder, "cycle_last")
    _, _, path = list(frames(folder, "cycle_last"))[-1]
    femur.points = in_femur @ rotations[-1].T + origins[-1]
    distance = femur_surface(femur)
    drawn = meshio.read(path).points
    away = [abs(distance.EvaluateFunction(*map(float, point))) for point in drawn[::7]]
    assert np.median(away) < 0.1
