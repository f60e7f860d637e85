"""Pictures show what the numbers say."""

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest

import condyle

from conftest import ROOT

matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_maps_show_the_articulating_surface(result: condyle.Result) -> None:
    for draw, field in [(result.plot.wear_map, "wear_depth_mm"), (result.plot.pressure, "peak_pressure_mpa")]:
        axes = draw()
        (drawn,) = axes.collections
        assert drawn.get_array().max() == result.fields[field][-1].max()
        assert "medial" in axes.get_xlabel().split("<")[0], "a right knee has medial at the left, seen from above"
        axes.figure.canvas.draw()


def test_the_unworn_insert_has_no_cycle(result: condyle.Result) -> None:
    for update in (0, -4):
        with pytest.raises(ValueError, match="has no cycle"):
            result.plot.pressure(update)
    assert result.plot.pressure(1).get_title() == "cycle at 0 million cycles"


def test_maps_take_axes_and_an_update(result: condyle.Result) -> None:
    _, axes = plt.subplots()
    assert result.plot.wear_map(update=1, ax=axes) is axes
    assert axes.get_title() == "after 1.66667 million cycles"


def test_other_joints_have_their_own_labels() -> None:
    changes = {"march.updates": 1, "insert.edge_mm": 2.5, "time.increments": 50, "accuracy.estimate": False}
    hip = condyle.run(condyle.Case.read(ROOT / "cases" / "hip-iso.toml").replace(changes))
    # A right hip stands upside down in its machine: z points to the left.
    assert hip.plot.wear_map().get_xlabel() == "lateral  <  z, mm  >  medial"
    titles = [axes.get_title() for axes in hip.plot.kinematics().axes]
    assert "abduction +, deg" in titles and "peak pressure, MPa" in titles and len(titles) == 8
    # A vertex of the femoral frame is at R p + t, and at N p + n in the neutral pose.
    settled = (hip.femur_points_mm - hip.neutral_pose["femoral_origin_mm"]) @ np.array(hip.neutral_pose["rotation"])
    rows = [[hip.femur_pose[f"r_{i}{j}"][20] for j in "xyz"] for i in "xyz"]
    origin = [hip.femur_pose[f"origin_{axis}_mm"][20] for axis in "xyz"]
    assert np.allclose(hip.femur_points_at(20), settled @ np.transpose(rows) + origin)
    # The machine has hardly moved by the end of the first increment: the ball is near its neutral pose.
    assert np.abs(hip.femur_points_at(0) - hip.femur_points_mm).max() < 2
    assert "flexion_deg" not in hip.neutral_pose


def test_the_curve_ends_at_the_mass(result: condyle.Result) -> None:
    axes = result.plot.wear_curve()
    assert axes.lines[0].get_ydata()[-1] == result.mass_loss_mg


def test_kinematics_show_both_cycles(result: condyle.Result) -> None:
    figure = result.plot.kinematics()
    assert len(figure.axes) == 6 and all(len(axes.lines) == 2 for axes in figure.axes)
    force = figure.axes[1].lines[0].get_ydata()
    assert np.array_equal(force, result.kinematics["axial_force_n"][:60])
