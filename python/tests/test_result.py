"""Results: their numbers, arrays and what they become."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import condyle
from condyle._summary import Summary

from conftest import ROOT


def test_every_entry_of_the_summary_is_a_typed_attribute(result: condyle.Result) -> None:
    assert set(result.summary) <= set(Summary.__annotations__)
    assert all(getattr(result, name) == value for name, value in result.summary.items())
    assert type(result.updates) is int and type(result.mass_loss_mg) is float
    with pytest.raises(AttributeError, match=r"a result has no mass_los_mg$"):
        _ = result.mass_los_mg  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no backside_lift_mm; this run does not have it"):
        _ = result.backside_lift_mm


def test_a_column_is_a_view(result: condyle.Result) -> None:
    mass = result.wear["mass_loss_mg"]
    assert np.shares_memory(mass, result.wear.array)
    assert mass[-1] == result.mass_loss_mg and result.wear.units["mass_loss_mg"] == "mg"
    with pytest.raises(KeyError, match="there are cycles, mass_loss_mg"):
        result.wear["mass"]


def test_a_table_may_have_line_ends_of_windows() -> None:
    assert condyle.Table.from_csv("a,b\r\n1,2\r\n", "wear.csv")["b"].tolist() == [2.0]


@pytest.mark.parametrize("text", ["a,b\n1\n", "a,b\n1,x\n", "a\n1,2\n"])
def test_a_table_that_no_run_wrote_is_refused(text: str) -> None:
    with pytest.raises(condyle.BadInput, match=r"wear\.csv: this is not a table that a run wrote"):
        condyle.Table.from_csv(text, "wear.csv")


def test_fields_agree_with_the_table(result: condyle.Result) -> None:
    assert np.array_equal(result.fields["wear_depth_mm"].max(axis=1)[1:], result.wear["max_depth_mm"])
    assert result.update_cycles.tolist() == [0.0, *result.wear["cycles"]]
    assert not result.fields["wear_depth_mm"][:, ~result.articulating].any()
    sunk_mm = np.linalg.norm(result.points_mm[-1] - result.points_mm[0], axis=1)[result.articulating]
    depth_mm = result.fields["wear_depth_mm"][-1][result.articulating]
    assert np.allclose(sunk_mm, depth_mm, atol=2e-3), "nodes move along their normals by the depth"


def test_volume_lost_is_that_between_the_meshes(result: condyle.Result) -> None:
    def volume_mm3(points: np.ndarray) -> float:
        corners = points[result.hexes]
        tetrahedra = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
        parts = [np.linalg.det(corners[:, [b, c, d]] - corners[:, [a]]) for a, b, c, d in tetrahedra]
        return float(sum(parts).sum() / 6.0)  # type: ignore[union-attr]

    lost = volume_mm3(result.points_mm[0]) - volume_mm3(result.points_mm[-1])
    assert lost == pytest.approx(result.volume_loss_mesh_mm3, rel=0.01)


def test_a_result_without_fields_is_small(small: condyle.Case, result: condyle.Result) -> None:
    lean = condyle.run(small, fields=False)
    assert lean.mass_loss_mg == result.mass_loss_mg and not lean.fields
    with pytest.raises(condyle.CondyleError, match="fields=True"):
        lean.to_xarray()
    assert len(pickle.dumps(lean)) < 200_000 + result.femur_points_mm.nbytes + result.femur_triangles.nbytes


def test_a_result_is_pickled(result: condyle.Result) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again.summary == result.summary and np.array_equal(again.wear.array, result.wear.array)


def test_a_pickled_result_has_its_case_with_arrays(small: condyle.Case, result: condyle.Result) -> None:
    case = small.with_femur(result.femur_points_mm, result.femur_triangles).replace({"march.updates": 1})
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(condyle.run(case, fields=False)))))
    assert again.case == case


@pytest.mark.parametrize("is_in_folder", [False, True])
def test_a_pickled_result_has_its_case_as_run(
    small: condyle.Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_in_folder: bool
) -> None:
    file = tmp_path / "load.csv"
    load = "percent,axial_force_n\n" + "".join(f"{percent},{500 + percent * (100 - percent)}\n" for percent in range(0, 101, 5))
    file.write_text(load)
    tables = {**small.to_dict(), "machine": {"axial_force": {"file": "load.csv", "scale": 0.5}}}
    monkeypatch.chdir(tmp_path)
    result = condyle.run(condyle.Case.from_dict(tables), out="out" if is_in_folder else None, fields=False)
    before, pickled = result.case, pickle.dumps(result)
    monkeypatch.chdir("/")
    for change in (lambda: file.write_text(load.replace("500", "900")), file.unlink):
        change()
        again = pickle.loads(pickle.dumps(pickle.loads(pickled)))
        assert again.case == before and again.case["machine.axial_force"] == before["machine.axial_force"]
        assert again.case.inputs_blake3 == again.inputs_blake3 == result.inputs_blake3


def test_a_result_is_copied(result: condyle.Result) -> None:
    for again in (copy.copy(result), copy.deepcopy(result), copy.copy(copy.deepcopy(result))):
        assert again.summary == result.summary and again.case == result.case
        for name, values in result.fields.items():
            assert np.array_equal(again.fields[name], values, equal_nan=True) and not again.fields[name].flags.writeable


def test_the_unworn_insert_has_no_fields_of_a_cycle(small: condyle.Case, result: condyle.Result, tmp_path: Path) -> None:
    for one in (result, pickle.loads(pickle.dumps(result)), condyle.run(small, out=tmp_path / "out")):
        unworn = {name for name, values in one.fields.items() if np.isnan(values[0]).all()}
        of_a_cycle = {"cross_shear", "depth_per_cycle_mm", "peak_pressure_mpa", "principal_direction", "sliding_distance_mm"}
        assert unworn == of_a_cycle and not any(np.isnan(values[1:]).any() for values in one.fields.values())
    pytest.importorskip("xarray")
    assert bool(result.to_xarray()["node_peak_pressure_mpa"][0].isnull().all())


def test_pandas(result: condyle.Result) -> None:
    frame = result.to_pandas()
    assert frame["mass_loss_mg"].iloc[-1] == result.mass_loss_mg
    assert frame.attrs["units"]["max_depth_mm"] == "mm"
    assert len(result.kinematics.to_pandas()) == 120


def test_xarray(result: condyle.Result) -> None:
    data = result.to_xarray()
    assert {"update": 4, "cycle": 2, "increment": 60, "component": 3}.items() <= dict(data.sizes).items()
    assert data["wear_depth_mm"].attrs["units"] == "mm" and data["ap_mm"].dims == ("cycle", "increment")
    assert float(data["wear_depth_mm"].max()) == result.max_depth_mm
    assert float(data["mass_loss_mg"][-1]) == result.mass_loss_mg and bool(data["mass_loss_mg"][0].isnull())
    pressed = data["node_peak_pressure_mpa"].isel(node=data["articulating"].values)
    assert pressed.sizes["node"] == result.articulating_nodes
    range_mm = float(data["ap_mm"].sel(cycle="first").max() - data["ap_mm"].sel(cycle="first").min())
    assert range_mm == pytest.approx(result.ap_range_mm)


@pytest.mark.parametrize("name", ["pin-on-disc", "gait-and-stairs"])
def test_xarray_of_other_cases(name: str) -> None:
    pytest.importorskip("xarray")
    changes = {"march.updates": 1, "time.increments": 50, "accuracy.estimate": False}
    result = condyle.run(condyle.Case.read(ROOT / "cases" / f"{name}.toml").replace(changes))
    data = result.to_xarray()
    column, key = ("x_mm", "cycle_x_mm") if name == "pin-on-disc" else ("ap_mm", "stairs_ap_mm")
    table = result.kinematics if name == "pin-on-disc" else result.tables["kinematics_stairs"]
    assert np.array_equal(data[key].values.ravel(), table[column]) and data[key].attrs["units"] == "mm"
    assert np.array_equal(data["r_xz"].values.ravel(), result.femur_pose["r_xz"])


def test_pyvista(result: condyle.Result) -> None:
    scene = result.to_pyvista()
    assert scene["insert"].n_cells == result.hexahedra
    assert scene["insert"].volume == pytest.approx(
        result.to_pyvista(0)["insert"].volume - result.volume_loss_mesh_mm3, rel=1e-4
    )
    assert np.array_equal(scene["femur"].points, result.femur_points_mm)


def test_the_femur_rests_on_the_insert_through_the_cycle(result: condyle.Result) -> None:
    for increment in (0, 20, 59):
        scene = result.to_pyvista(0, increment, "first")
        near = scene["femur"].compute_implicit_distance(scene["insert"].extract_surface(algorithm="dataset_surface"))
        deepest_mm = -near["implicit_distance"].min()
        assert 0.0 < deepest_mm < 1.0, "it presses, and by less than a millimetre"


def test_a_left_knee_is_the_mirror_image(small: condyle.Case, result: condyle.Result) -> None:
    left = condyle.run({**small.to_dict(), "side": "left"})
    assert left.mass_loss_mg == result.mass_loss_mg
    assert np.array_equal(left.points_mm * [1.0, 1.0, -1.0], result.points_mm)


def test_a_result_is_read_only(result: condyle.Result) -> None:
    for name in ("mass_loss_mg", "mass_los_mg", "summary", "tables"):
        with pytest.raises(AttributeError, match=f"a result is read-only: {name} cannot be assigned"):
            setattr(result, name, 1.0)
    arrays = [result.points_mm, result.hexes, result.articulating, result.femur_points_mm, result.wear["cycles"]]
    for again in (result, pickle.loads(pickle.dumps(result))):
        assert not again.fields["wear_depth_mm"].flags.writeable
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_a_table_leaves_the_array_that_it_is_made_of_writable() -> None:
    array = np.zeros((2, 1))
    assert not condyle.Table(["a"], array)["a"].flags.writeable and array.flags.writeable


def test_notebooks_show_tables(result: condyle.Result, small: condyle.Case) -> None:
    shown = result._repr_html_()
    assert f"<td>mass_loss_mg</td><td>{result.mass_loss_mg:.5g}</td><td>mg</td>" in shown
    long = condyle.Table(["a<b"], np.arange(30.0).reshape(-1, 1))._repr_html_()
    assert "<th>a&lt;b</th>" in long and long.count("<tr>") == 12 and "<td>25</td>" in long
    assert "increments = 60" in small._repr_html_()
