"""Searches whose tests run anywhere."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from .errors import BadInput
from .result import Result

if TYPE_CHECKING:
    from .case import Case
    from .study import Study
    from .study_result import StudyResult

__all__ = ["Search"]

Design = Mapping[str, float]
"""The value of every input of a search."""


class Search:
    """A search that proposes designs and takes the results of their tests, which may run anywhere and end in any order.

    It holds the folder of its study until it is closed; use it in a ``with`` statement. Each result is stored at once,
    so that another search, :meth:`Study.run` or the command continues from them.

    >>> import tempfile
    >>> from condyle import Case, Study
    >>> study = Study.from_dict({
    ...     "design": {"kind": "optimise", "size": 20},
    ...     "vary": [{"key": "contact.friction", "low": 0.03, "high": 0.1}],
    ... }, case=Case.from_text(""))
    >>> with tempfile.TemporaryDirectory() as out, study.search(out) as search:
    ...     designs = search.ask(2)
    ...     search.tell(designs, [{"mass_loss_mg": 30.0}, {"mass_loss_mg": 20.0}])
    ...     search.tested, designs[0]
    (2, {'contact.friction': 0.07})
    """

    __slots__ = ("_held", "_out", "_pending", "_study")

    def __init__(self, study: Study, out: str | os.PathLike[str]) -> None:
        """Use :meth:`Study.search`."""
        self._study, self._out = study, os.fspath(out)
        self._held = study._raw.hold(out)
        self._pending: list[dict[str, float]] = []

    @property
    def tested(self) -> int:
        """The number of tests with a stored result."""
        return self._held.count()

    @property
    def pending(self) -> list[dict[str, float]]:
        """The proposed designs without a result."""
        return list(self._pending)

    def ask(self, count: int = 1) -> list[dict[str, float]]:
        """Proposes up to ``count`` designs: the value of every input, those of disturbances among them.

        Designs that are :attr:`pending` are taken into account as if they had the results that the emulators predict. The list is
        empty at the end of the search: when it has converged, or no more tests are allowed; while designs are pending, their results
        may change that.

        Raises:
            BadInput: a study that is not a search.
        """
        pending = [self._values(design) for design in self._pending]
        asked = self._held.ask(self._study._raw, pending, count)
        designs = [dict(zip(self._study.inputs, values)) for values in asked]
        self._pending += designs
        return designs

    def case(self, design: Design) -> Case:
        """The case of a design, for :func:`condyle.run` here or on another machine."""
        return self._study._changed(self._study._raw.changes_with(self._values(design)))

    def tell(self, designs: Sequence[Design], results: Sequence[Result | Mapping[str, float] | str | Exception]) -> None:
        """Stores the results of tests.

        Args:
            designs: those that were asked for, in any order, or others within the ranges.
            results: for each design the :class:`Result` of its case, or the outputs by their keys, of which those that are
                minimised or limited are necessary; for a test that failed, the exception or its reason as text.

        Raises:
            BadInput: values outside the study, results that lack an output, and a :class:`Result` of another case than that of its
                design or of a ``wear_law`` of its own; nothing is stored then.
        """
        if len(designs) != len(results):
            raise ValueError(f"there are {len(designs)} designs and {len(results)} results; tell one result for each design")
        found = [(self._values(design), self._found(design, result)) for design, result in zip(designs, results)]
        self._held.tell(self._study._raw, found)
        told = [dict(design) for design in designs]
        self._pending = [design for design in self._pending if design not in told]

    def answered(self) -> StudyResult:
        """Evaluates the stored tests; rewrites table, answers and page."""
        return self._study.answered(self._out)

    def close(self) -> None:
        """Releases the folder."""
        self._held.close()

    def __enter__(self) -> Search:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _values(self, design: Design) -> list[float]:
        keys = self._study.inputs
        if set(design) != set(keys):
            raise BadInput(f"a design has the inputs {', '.join(keys)}, and this one has {', '.join(design) or 'none'}")
        return [float(design[key]) for key in keys]

    def _found(self, design: Design, result: Result | Mapping[str, float] | str | Exception) -> tuple[list[float], str] | str:
        if isinstance(result, (str, Exception)):
            return str(result).partition("\n")[0].strip() or type(result).__name__
        raw, doubts = self._study._raw, ""
        known = raw.results
        if isinstance(result, Result):
            case = self.case(design)
            if result.inputs_blake3 != case.inputs_blake3:
                raise BadInput(f"the result is not that of the case of its design, {dict(design)}")
            if result.wear_laws[0]["law"] != case["wear.law"]:
                raise BadInput(
                    "the result has a wear_law of its own, which the study does not have; give its outputs by their keys"
                )
            doubts = " ".join(doubt["check"] for doubt in result.plausibility)
            result = {key: result.summary[key] for key in known if result.summary.get(key) is not None}
        for key in result:
            if key not in known:
                raise BadInput(f"a test has no output {key!r}; it has {', '.join(raw.outputs)}")
        return raw.output_values({key: float(value) for key, value in result.items()}), doubts

    def __repr__(self) -> str:
        return f"<condyle.Search: {self.tested} of at most {self._study.tests} tests done, {len(self._pending)} pending>"
