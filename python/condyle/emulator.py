"""Emulators of the outputs of a study."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from .errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Emulator"]


class Emulator:
    """A Gaussian process that predicts an output of tests that a study did not run.

    Its mean is unknown; its correlation is the product of Matern 5/2 correlations with a length for each input, and a nugget.
    """

    __slots__ = ("_model",)

    def __init__(self, model: dict[str, Any]) -> None:
        """Use :meth:`StudyResult.emulator`."""
        self._model = model

    @property
    def output(self) -> str:
        """The key of the output."""
        return self._model["output"]

    @property
    def design(self) -> str | None:
        """The name of the design, if the study compares designs."""
        return self._model["design"]

    @property
    def q2(self) -> float:
        """The part of the variance that predictions of each test from all others explain; condyle uses emulators from 0.9 on."""
        return self._model["q2"]

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The smallest and the largest value of each input in the tests."""
        return {one["key"]: (one["low"], one["high"]) for one in self._model["inputs"]}

    def predict(self, inputs: Mapping[str, ArrayLike]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Predicts the output of tests, in its unit, and the standard deviation of each prediction, with that of the nugget.

        Args:
            inputs: a value, or an array of values of one shape, for every input of the study.

        Raises:
            BadInput: an input that is missing, unknown, or outside of its range in the tests: emulators do not extrapolate.
        """
        import numpy as np

        model = self._model
        places = np.broadcast_arrays(*self._places(inputs))
        shape = places[0].shape
        points = np.stack([place.ravel() for place in places], axis=1)
        tests = np.array(model["points"])
        lengths, weights = np.array(model["lengths"]), np.array(model["weights"])
        factor = np.linalg.cholesky(_correlation(tests, tests, lengths) + model["nugget"] * np.eye(len(tests)))
        both = _correlation(tests, points, lengths)
        solved = np.linalg.solve(factor, np.column_stack([np.ones(len(tests)), both]))
        of_ones, of_both = solved[:, 0], solved[:, 1:]
        of_mean = 1.0 - of_ones @ of_both
        variance = 1.0 + model["nugget"] - (of_both**2).sum(axis=0) + of_mean**2 / (of_ones @ of_ones)
        mean = model["mean"] + weights @ both
        deviation = model["standard_deviation"] * np.sqrt(np.maximum(variance, 0.0))
        return mean.reshape(shape), deviation.reshape(shape)

    def _places(self, inputs: Mapping[str, ArrayLike]) -> list[NDArray[np.float64]]:
        import numpy as np

        ranges = self.ranges
        for key in [*ranges, *inputs]:
            if key not in inputs or key not in ranges:
                problem = "needs a value" if key in ranges else "is no input of the study"
                raise BadInput(f"{key!r} {problem}; the inputs are {', '.join(ranges)}")
        places = []
        for key, (low, high) in ranges.items():
            values = np.asarray(inputs[key], dtype=np.float64)
            outside = values[~((values >= low) & (values <= high))]
            if outside.size:
                raise BadInput(
                    f"{key} = {outside.flat[0]:g} is outside of the tests, {low:g} to {high:g}; emulators do not extrapolate"
                )
            places.append((values - low) / ((high - low) or 1.0))
        return places

    def __repr__(self) -> str:
        return f"<condyle.Emulator of {_name(self.output, self.design)}, Q2 {self.q2:.4f}>"


def _correlation(one: NDArray[np.float64], other: NDArray[np.float64], lengths: NDArray[np.float64]) -> NDArray[np.float64]:
    import numpy as np

    a = np.sqrt(5.0) * np.abs(one[:, None, :] - other[None, :, :]) / lengths
    return np.prod((1.0 + a + a * a / 3.0) * np.exp(-a), axis=2)


def read(folder: Path, output: str, design: str | None) -> Emulator:
    """Reads an emulator from the folder of a study."""
    path = folder / "emulators.json"
    models = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else []
    for model in models:
        if model["output"] == output and model["design"] == design:
            return Emulator(model)
    names = ", ".join(_name(model["output"], model["design"]) for model in models)
    reason = "none: it is a search, its inputs are no numbers, or there are too few tests"
    raise BadInput(f"the study has no emulator of {_name(output, design)}; it has {names or reason}")


def _name(output: str, design: str | None) -> str:
    return repr(output) if design is None else f"{output!r} of the design {design!r}"
