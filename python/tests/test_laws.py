"""A wear law that is a function of Python."""

import numpy as np
import pytest

import condyle

KW_MM3_PER_NM = 2.64e-7


def archard(cycle: condyle.NodeCycle) -> float:
    slip_mm = np.linalg.norm(cycle.slip_mm, axis=1)
    return KW_MM3_PER_NM * float(np.sum(cycle.share * cycle.pressure_mpa * slip_mm)) / 1000.0


def test_archard_in_python_wears_as_the_law_does(small: condyle.Case) -> None:
    case = small.replace({"wear.law": "archard", "wear.wear_factor_mm3_per_nm": KW_MM3_PER_NM})
    own, built_in = condyle.run(case, wear_law=archard), condyle.run(case)
    assert own.mass_loss_mg == pytest.approx(built_in.mass_loss_mg, rel=1e-9)
    assert own.max_depth_mm == pytest.approx(built_in.max_depth_mm, rel=1e-9)
    assert own.wear_laws[0]["law"] == "python" and built_in.wear_laws[0]["law"] == "archard"


def test_the_sums_are_those_of_the_instants(small: condyle.Case) -> None:
    def law(cycle: condyle.NodeCycle) -> float:
        slip_mm = np.linalg.norm(cycle.slip_mm, axis=1)
        mean_mpa = cycle.share * cycle.pressure_mpa
        assert cycle.peak_pressure_mpa == pytest.approx(mean_mpa.max())
        assert cycle.sliding_distance_mm == pytest.approx((cycle.share * slip_mm).sum())
        assert cycle.pressure_slip_mpa_mm == pytest.approx((mean_mpa * slip_mm).sum())
        assert 0.0 <= cycle.cross_shear <= 0.5
        return 0.0

    assert condyle.run(small.replace({"march.updates": 1}), wear_law=law).mass_loss_mg == 0.0


@pytest.mark.parametrize(
    ("law", "kind", "message"),
    [
        (lambda cycle: -1.0, ValueError, "gave -1"),
        (lambda cycle: float("nan"), ValueError, "gave NaN"),
        (lambda cycle: None, TypeError, "float|real number"),
        (lambda cycle: 1 / 0, ZeroDivisionError, "division"),
    ],
)
def test_a_law_that_fails_stops_the_run(small: condyle.Case, law: object, kind: type, message: str) -> None:
    with pytest.raises(kind, match=message):
        condyle.run(small, wear_law=law)  # type: ignore[arg-type]


def test_a_law_of_python_is_not_written_into_a_folder(small: condyle.Case, tmp_path) -> None:
    with pytest.raises(ValueError, match="in memory"):
        condyle.run(small, out=tmp_path, wear_law=archard)
