"""The search of condyle as a sampler of Optuna, whose storage, pruning and dashboard then serve a wear test.

Needs Optuna: ``pip install optuna``.
"""

import tempfile
from typing import Any

import optuna
from optuna.distributions import BaseDistribution, FloatDistribution
from optuna.study import Study as OptunaStudy
from optuna.trial import FrozenTrial, TrialState

import condyle

STUDY: dict[str, Any] = {
    "design": {"kind": "optimise", "size": 20},
    "vary": [
        {"key": "insert.sagittal_radius_mm", "low": 40.0, "high": 80.0},
        {"key": "insert.coronal_radius_mm", "low": 26.0, "high": 40.0},
    ],
    "limit": [{"output": "peak_pressure_mpa", "most": 36.0}],
}


class CondyleSampler(optuna.samplers.BaseSampler):
    """Samples the designs that a ``condyle.Search`` asks for, and tells it the outputs that a trial leaves in ``outputs``."""

    def __init__(self, search: condyle.Search, ranges: dict[str, FloatDistribution]) -> None:
        self.search, self.ranges = search, ranges
        self.random = optuna.samplers.RandomSampler(seed=1)

    def infer_relative_search_space(self, study: OptunaStudy, trial: FrozenTrial) -> dict[str, BaseDistribution]:
        return dict(self.ranges)

    def sample_relative(
        self, study: OptunaStudy, trial: FrozenTrial, search_space: dict[str, BaseDistribution]
    ) -> dict[str, float]:
        designs = self.search.ask()
        if not designs:
            study.stop()
        return designs[0] if designs else {}

    def sample_independent(
        self, study: OptunaStudy, trial: FrozenTrial, param_name: str, param_distribution: BaseDistribution
    ) -> Any:
        return self.random.sample_independent(study, trial, param_name, param_distribution)

    def after_trial(self, study: OptunaStudy, trial: FrozenTrial, state: TrialState, values: Any) -> None:
        if trial.params in self.search.pending:
            self.search.tell([trial.params], [trial.user_attrs.get("outputs", "the trial failed")])


def main() -> None:
    case = condyle.Case.from_dict(
        {"insert": {"edge_mm": 3.0}, "march": {"updates": 2}, "time": {"increments": 60}, "accuracy": {"estimate": False}}
    )
    study = condyle.Study.from_dict(STUDY, case=case)
    ranges = {one["key"]: FloatDistribution(one["low"], one["high"]) for one in STUDY["vary"]}

    with tempfile.TemporaryDirectory() as out, study.search(out) as search:

        def mass_loss_mg(trial: optuna.Trial) -> float:
            design = {key: trial.suggest_float(key, one.low, one.high) for key, one in ranges.items()}
            result = condyle.run(search.case(design), fields=False)
            keys = ("mass_loss_mg", "peak_pressure_mpa")
            trial.set_user_attr("outputs", {key: result.summary[key] for key in keys})
            return result.mass_loss_mg

        optuna.logging.set_verbosity(optuna.logging.WARNING)
        trials = optuna.create_study(sampler=CondyleSampler(search, ranges))
        trials.optimize(mass_loss_mg, n_trials=study.tests)
        best = search.answered().answers.best
        assert best is not None
        values = ", ".join(f"{one.name} = {one.value:.4g}" for one in best.inputs)
        print(f"{search.tested} trials; the best within the limit: {best.outputs[0].value:.2f} mg with {values}")


if __name__ == "__main__":
    main()
