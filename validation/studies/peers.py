"""Searches twelve standard problems by condyle, Optuna and pymoo, each with as many tests and several seeds."""

from __future__ import annotations

import argparse
import math
import statistics
import tempfile
import warnings
from collections.abc import Callable
from importlib.metadata import version

import numpy as np
import optuna
from problems import PROBLEMS, Found, Point, Problem
from pymoo.algorithms.soo.nonconvex.de import DE
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.algorithms.soo.nonconvex.isres import ISRES
from pymoo.algorithms.soo.nonconvex.pso import PSO
from pymoo.core.problem import ElementwiseProblem
from pymoo.optimize import minimize

from condyle import Case, Study

# The inputs and the outputs of a study that stand for those of a problem.
INPUTS = [
    ("contact.friction", 0.03, 0.1),
    ("insert.sagittal_radius_mm", 40.0, 80.0),
    ("insert.coronal_radius_mm", 26.0, 40.0),
    ("femur.distal_radius_mm", 30.0, 38.0),
    ("insert.thickness_mm", 8.0, 12.0),
    ("material.youngs_modulus_mpa", 400.0, 500.0),
    ("material.poissons_ratio", 0.4, 0.47),
    ("machine.springs.posterior_n_per_mm", 20.0, 40.0),
    ("machine.springs.anterior_n_per_mm", 5.0, 10.0),
    ("machine.springs.free_play_mm", 1.0, 3.0),
    ("machine.vv_axis_medial_mm", 0.0, 10.0),
    ("machine.vv_axis_below_mm", 10.0, 30.0),
    ("machine.flexion_offset_deg", -9.0, -3.0),
]
OUTPUTS = [
    "peak_pressure_mpa",
    "ap_range_mm",
    "ie_range_deg",
    "max_depth_mm",
    "volume_loss_mm3",
    "peak_contact_area_mm2",
    "medial_load_share",
    "first_cycle_peak_pressure_mpa",
    "last_cycle_peak_pressure_mpa",
]
# Weight of the sum of excesses in the output of a search that knows no limits, relative to the optimum.
PENALTY = 100.0


class Tested:
    """A problem that keeps the best of its first tests within the limits."""

    def __init__(self, problem: Problem) -> None:
        self.problem, self.count, self.best = problem, 0, math.inf

    def __call__(self, point: Point) -> Found:
        output, limits = self.problem.of(np.clip(point, 0.0, 1.0))
        self.count += 1
        if self.count <= self.problem.tests and all(limit <= 0.0 for limit in limits):
            self.best = min(self.best, float(output))
        return float(output), [float(limit) for limit in limits]


def by_condyle(tested: Tested, seed: int) -> None:
    problem = tested.problem
    keys, outputs = INPUTS[: problem.inputs], OUTPUTS[: problem.limits]
    study = Study.from_dict(
        {
            "design": {"kind": "optimise", "size": problem.tests, "seed": seed, "minimise": "mass_loss_mg"},
            "vary": [{"key": key, "low": low, "high": high} for key, low, high in keys],
            "limit": [{"output": output, "most": 0.0} for output in outputs],
        },
        case=Case.from_text(""),
    )

    def result(design: dict[str, float]) -> dict[str, float]:
        output, limits = tested([(design[key] - low) / (high - low) for key, low, high in keys])
        return {"mass_loss_mg": output, **dict(zip(outputs, limits))}

    with tempfile.TemporaryDirectory() as out, study.search(out) as search:
        while designs := search.ask(2):
            search.tell(designs, [result(design) for design in designs])


def by_optuna(sampler: Callable[[Tested, int], optuna.samplers.BaseSampler]) -> Callable[[Tested, int], None]:
    def search(tested: Tested, seed: int) -> None:
        problem, chosen = tested.problem, sampler(tested, seed)
        knows_limits = isinstance(chosen, optuna.samplers.TPESampler)

        def output(trial: optuna.Trial) -> float:
            found, limits = tested([trial.suggest_float(f"x{axis}", 0.0, 1.0) for axis in range(problem.inputs)])
            trial.set_user_attr("limits", limits)
            excess = 0.0 if knows_limits else sum(max(0.0, limit) for limit in limits)
            return found + PENALTY * (1.0 + abs(problem.optimum)) * excess

        optuna.create_study(sampler=chosen).optimize(output, n_trials=problem.tests)

    return search


def tpe(tested: Tested, seed: int) -> optuna.samplers.BaseSampler:
    limits = (lambda trial: trial.user_attrs["limits"]) if tested.problem.limits else None
    return optuna.samplers.TPESampler(seed=seed, multivariate=True, constraints_func=limits)


def cma_es(_: Tested, seed: int) -> optuna.samplers.BaseSampler:
    return optuna.samplers.CmaEsSampler(seed=seed)


def by_pymoo(algorithm: Callable[[], object]) -> Callable[[Tested, int], None]:
    def search(tested: Tested, seed: int) -> None:
        problem = tested.problem

        class OfPymoo(ElementwiseProblem):
            def __init__(self) -> None:
                super().__init__(n_var=problem.inputs, n_obj=1, n_ieq_constr=problem.limits, xl=0.0, xu=1.0)

            def _evaluate(self, x: np.ndarray, out: dict[str, object], *_: object, **__: object) -> None:
                out["F"], limits = tested(x)
                if limits:
                    out["G"] = limits

        minimize(OfPymoo(), algorithm(), ("n_eval", problem.tests), seed=seed)

    return search


SEARCHES: dict[str, Callable[[Tested, int], None]] = {
    "condyle": by_condyle,
    "TPE": by_optuna(tpe),
    "CMA-ES": by_optuna(cma_es),
    "DE": by_pymoo(lambda: DE(pop_size=10)),
    "GA": by_pymoo(lambda: GA(pop_size=10)),
    "ISRES": by_pymoo(lambda: ISRES(n_offsprings=20, rule=1.0 / 7.0)),
    "PSO": by_pymoo(lambda: PSO(pop_size=10)),
}


def medians(problem: Problem, seeds: int, names: list[str]) -> dict[str, float]:
    found = {}
    for name in names:
        tests = [Tested(problem) for _ in range(seeds)]
        for seed, tested in enumerate(tests, 1):
            SEARCHES[name](tested, seed)
        found[name] = statistics.median(tested.best for tested in tests)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--problems", nargs="*", default=list(PROBLEMS))
    parser.add_argument("--searches", nargs="*", default=list(SEARCHES))
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    print(
        f"Optuna {version('optuna')} (TPE, CMA-ES) and pymoo {version('pymoo')} (DE, GA, ISRES, PSO); median of {given.seeds} seeds.\n"
    )
    print("| problem | inputs, limits | tests | optimum | " + " | ".join(given.searches) + " |")
    print("| --- | --- | ---: | ---: |" + " ---: |" * len(given.searches))
    for name in given.problems:
        problem = PROBLEMS[name]
        found = medians(problem, given.seeds, given.searches)
        best = min(found.values())
        shown = ["-" if math.isinf(one) else f"**{one:.6g}**" if one == best else f"{one:.6g}" for one in found.values()]
        numbers = f"{problem.inputs}, {problem.limits} | {problem.tests} | {problem.optimum:.6g}"
        print(f"| {name} | {numbers} | " + " | ".join(shown) + " |", flush=True)


if __name__ == "__main__":
    main()
