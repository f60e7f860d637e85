"""A results folder read by programs that know nothing of condyle."""

import csv
import json
import os
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

FIELDS = [
    "wear_depth_mm",
    "depth_per_cycle_mm",
    "peak_pressure_mpa",
    "sliding_distance_mm",
    "cross_shear",
    "thickness_mm",
]


@pytest.fixture(scope="module")
def folder():
    return Path(os.environ["CONDYLE_RESULTS"])


@pytest.fixture(scope="module")
def summary(folder):
    return json.loads((folder / "summary.json").read_text())


@pytest.fixture(scope="module")
def meshes(folder):
    return sorted(folder.glob("insert_*.vtu"))


@pytest.fixture(scope="module")
def coarse_meshes():
    """Meshes whose numbers of points leave 0, 1 and 2 when divided by 3."""
    return sorted(Path(os.environ["CONDYLE_COARSE_RESULTS"]).glob("*/insert_0001.vtu"))


def table(path):
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def by_vtk(path):
    """Points, cell types and point data of a file, as VTK reads them."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    types = {grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())}
    return vtk_to_numpy(grid.GetPoints().GetData()), grid.GetNumberOfCells(), types, arrays


def test_summary_has_every_key_of_the_contract(summary):
    keys = [
        "cycles",
        "mass_loss_mg",
        "volume_loss_mm3",
        "volume_loss_mesh_mm3",
        "max_depth_mm",
        "peak_pressure_mpa",
        "peak_contact_area_mm2",
        "ap_range_mm",
        "ie_range_deg",
        "medial_load_share",
        "updates",
        "increments",
        "newton_iterations",
        "contact_evaluations",
        "wall_s",
        "version",
    ]
    assert [key for key in keys if key not in summary] == []


def test_both_volumes_agree_within_a_hundredth(summary):
    assert summary["volume_loss_mesh_mm3"] == pytest.approx(summary["volume_loss_mm3"], rel=0.01)


def test_wear_table_ends_with_the_summary(folder, summary):
    wear = table(folder / "wear.csv")
    for name in ["cycles", "mass_loss_mg", "volume_loss_mm3", "max_depth_mm"]:
        assert wear[name][-1] == pytest.approx(summary[name], rel=1e-6)
    assert np.all(np.diff(wear["mass_loss_mg"]) > 0)


def test_kinematics_hold_the_first_and_the_last_cycle(folder, summary):
    kinematics = table(folder / "kinematics.csv")
    columns = [
        "cycles",
        "percent",
        "flexion_deg",
        "axial_force_n",
        "ap_mm",
        "ie_deg",
        "ml_mm",
        "vv_deg",
        "is_mm",
        "contact_area_mm2",
        "peak_pressure_mpa",
        "medial_force_n",
        "lateral_force_n",
    ]
    assert list(kinematics) == columns
    assert len(kinematics["percent"]) == 2 * summary["increments"]
    sides = kinematics["medial_force_n"] + kinematics["lateral_force_n"]
    np.testing.assert_allclose(sides, kinematics["axial_force_n"], atol=0.01)


def test_one_mesh_an_update_and_one_unworn(meshes, summary):
    assert len(meshes) == summary["updates"] + 1


def test_collection_names_the_meshes_by_their_cycles(folder, meshes, summary):
    sets = ElementTree.parse(folder / "insert.pvd").getroot().findall("Collection/DataSet")
    assert [entry.get("file") for entry in sets] == [mesh.name for mesh in meshes]
    assert float(sets[0].get("timestep")) == 0
    assert float(sets[-1].get("timestep")) == summary["cycles"]


def assert_vtk_and_meshio_read_the_same(path):
    points, cells, types, arrays = by_vtk(path)
    mesh = meshio.read(path)
    assert types == {VTK_HEXAHEDRON}
    assert len(mesh.cells_dict["hexahedron"]) == cells
    np.testing.assert_array_equal(points, mesh.points)
    for name in [*FIELDS, "articulating", "principal_direction"]:
        np.testing.assert_array_equal(arrays[name], mesh.point_data[name])
    return len(points)


def test_vtk_and_meshio_read_the_same(meshes):
    for path in (meshes[0], meshes[-1]):
        assert_vtk_and_meshio_read_the_same(path)


def test_vtk_and_meshio_read_the_same_whatever_the_number_of_points(coarse_meshes):
    # meshio finds an array's block by its offset in base64, where three bytes are four letters.
    counts = [assert_vtk_and_meshio_read_the_same(path) for path in coarse_meshes]
    assert {count % 3 for count in counts} == {0, 1, 2}


def test_fields_are_those_of_the_summary(meshes, summary):
    fields = meshio.read(meshes[-1]).point_data
    assert fields["wear_depth_mm"].max() == pytest.approx(summary["max_depth_mm"], rel=1e-6)
    on_surface = fields["articulating"] == 1
    assert np.all(fields["thickness_mm"][on_surface] > 0)
    for name in FIELDS:
        assert fields[name].dtype == np.float64
        assert np.all(fields[name][~on_surface] == 0)


def test_cross_shear_has_a_direction_along_the_surface(meshes):
    fields = meshio.read(meshes[-1]).point_data
    shear, direction = fields["cross_shear"], fields["principal_direction"]
    assert direction.shape == (len(shear), 3)
    assert np.all((shear >= 0) & (shear <= 0.5)) and shear.max() > 0.01
    length = np.linalg.norm(direction, axis=1)
    has_one = length > 0
    np.testing.assert_allclose(length[has_one], 1, rtol=1e-12)
    assert np.all(direction[:, 0] >= 0)
    assert np.all(shear[~has_one] % 0.5 < 1e-6)
    # A knee slides mostly forwards and backwards.
    pressed = fields["sliding_distance_mm"] > 1
    assert np.median(direction[pressed, 0]) > 0.9


def test_every_law_says_what_it_would_have_worn(summary):
    laws = summary["wear_laws"]
    assert len({law["law"] for law in laws}) == len(laws) >= 5
    assert [law["moved_the_surface"] for law in laws] == [True] + [False] * (len(laws) - 1)
    assert laws[0]["mass_loss_mg"] == pytest.approx(summary["mass_loss_mg"], rel=1e-12)
    assert laws[0]["max_depth_mm"] == summary["max_depth_mm"]
    for law in laws:
        assert law["mass_loss_mg"] > 0 and law["max_depth_mm"] > 0
        per_million = law["mass_loss_mg"] / summary["cycles"] * 1e6
        assert law["mass_loss_mg_per_million_cycles"] == pytest.approx(per_million)
        outside = law["outside_of_fit_percent"]
        assert outside is None or 0 <= outside <= 100


def test_case_as_run_writes_every_section_out(folder):
    text = (folder / "case.toml").read_text()
    sections = set(re.findall(r"^\[(\w+)", text, re.MULTILINE))
    assert {"femur", "insert", "material", "contact", "machine", "wear", "march", "time"} <= sections
