"""A wear test as a problem of pymoo: the front of mass loss and peak pressure by NSGA-II, beside that of condyle.

Needs pymoo: ``pip install pymoo``.
"""

import tempfile
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.indicators.hv import HV
from pymoo.optimize import minimize

import condyle

TESTS = 40
RANGES = {"insert.sagittal_radius_mm": (40.0, 80.0), "insert.coronal_radius_mm": (26.0, 40.0)}
OUTPUTS = ["mass_loss_mg", "peak_pressure_mpa"]
LEAST_AP_RANGE_MM = 4.0


class WearTest(Problem):
    """Two outputs of a case, with a limit to its AP range; the designs of a generation run at the same time."""

    def __init__(self, case: condyle.Case) -> None:
        low, high = zip(*RANGES.values())
        super().__init__(n_var=len(RANGES), n_obj=len(OUTPUTS), n_ieq_constr=1, xl=low, xu=high)
        self.case = case

    def _evaluate(self, x: np.ndarray, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
        with ThreadPoolExecutor() as pool:
            results = list(pool.map(self.run, x))
        out["F"] = [[result.summary[key] for key in OUTPUTS] for result in results]
        out["G"] = [[LEAST_AP_RANGE_MM - result.ap_range_mm] for result in results]

    def run(self, values: np.ndarray) -> condyle.Result:
        return condyle.run(self.case.replace(dict(zip(RANGES, map(float, values)))), fields=False)


def searched(case: condyle.Case) -> np.ndarray:
    """The front that condyle finds in as many tests."""
    tables = {
        "design": {"kind": "optimise", "minimise": "pareto", "size": TESTS},
        "vary": [{"key": key, "low": low, "high": high} for key, (low, high) in RANGES.items()],
        "limit": [{"output": "ap_range_mm", "least": LEAST_AP_RANGE_MM}],
        "answers": {"outputs": OUTPUTS},
    }
    with tempfile.TemporaryDirectory() as out:
        result = condyle.Study.from_dict(tables, case=case).run(out)
        within = result["ap_range_mm"] >= LEAST_AP_RANGE_MM
        return np.column_stack([result[key][within] for key in OUTPUTS])


def main() -> None:
    case = condyle.Case.from_dict(
        {"insert": {"edge_mm": 3.0}, "march": {"updates": 2}, "time": {"increments": 60}, "accuracy": {"estimate": False}}
    )
    evolved = minimize(WearTest(case), NSGA2(pop_size=10), ("n_eval", TESTS), seed=1)
    fronts = {"NSGA-II": evolved.F, "condyle": searched(case)}
    worst = np.vstack(list(fronts.values())).max(axis=0)
    for name, front in fronts.items():
        print(f"{name}: hypervolume {HV(ref_point=worst)(front):.1f} mg MPa after {TESTS} tests")


if __name__ == "__main__":
    main()
