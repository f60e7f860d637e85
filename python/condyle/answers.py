"""The answers of a study, as values with attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _html

__all__ = ["Answer", "Answers"]


class Answer(Mapping[str, Any]):
    """A part of the answers: its entries are attributes, and items as in ``answers.json``; all are read-only.

    >>> part = Answer({"optimum": {"row": 7}, "limits": ["peak pressure at most 33 MPa"]})
    >>> part.optimum.row, part["limits"], "optimum" in dir(part)
    (7, ('peak pressure at most 33 MPa',), True)
    """

    __slots__ = ("_entries",)

    _entries: Mapping[str, Any]

    def __init__(self, entries: Mapping[str, Any]) -> None:
        """Use :attr:`StudyResult.answers`."""
        object.__setattr__(self, "_entries", {name: _value(value) for name, value in entries.items()})

    def __getitem__(self, name: str) -> Any:
        return self._entries[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._entries:
            known = "" if name.startswith("_") else f"; it has {', '.join(self._entries)}"
            raise AttributeError(f"the answer has no {name!r}{known}")
        return self._entries[name]

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"an answer is read-only: {name} cannot be assigned")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"an answer is read-only: {name} cannot be deleted")

    def __eq__(self, other: object) -> bool:
        # Equal to the same content as it is read from JSON, with lists.
        return isinstance(other, Mapping) and dict(self) == {name: _value(value) for name, value in other.items()}

    __hash__ = None  # type: ignore[assignment]

    def __dir__(self) -> list[str]:
        return [*self._entries, *super().__dir__()]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (dict(self._entries),)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._entries.items())})"

    def _repr_html_(self) -> str:
        return _html.table("", ("", "value"), [(name, _shown(value)) for name, value in self._entries.items()])


class Answers(Answer):
    """All answers of a study, the content of ``answers.json``."""

    __slots__ = ()

    if TYPE_CHECKING:
        title: str
        """The title of the study."""
        design: str
        """The design of the tests."""
        tests: int
        """The number of tests; for a search and an adaptive study the maximum."""
        kept: int
        """The number of stored tests, done or failed."""
        failed: tuple[Answer, ...]
        """``reason`` and number of ``tests`` of the failures, the most frequent first."""
        doubtful: tuple[Answer, ...]
        """The same of tests that do not pass a plausibility check."""
        spreads: tuple[Answer, ...]
        """For each output and alternative: ``least``, ``percentiles``, ``most``, ``mean``, ``beyond`` its limits, and more."""
        effects: tuple[Answer, ...]
        """For each input, output and alternative: ``means``, their ``span``, ``span_by_chance``, and ``is_emulated``."""
        elementary: tuple[Answer, ...]
        """Elementary effects of a Morris design: ``mu``, ``mu_star``, ``sigma``."""
        indices: tuple[Answer, ...]
        """Sobol indices, ``first`` and ``total`` with their intervals."""
        emulated: tuple[Answer, ...]
        """For each output with an emulator: ``q2``, the ``distribution`` of its predictions, and probabilities ``beyond`` its limits."""
        ranking: Answer | None
        """The ``designs`` of a study with alternatives, the best first."""
        front: Answer | None
        """The ``tests`` on the Pareto front of two outputs, its ``knee`` and ``hypervolume``."""
        best: Answer | None
        """The best test of a search: ``row``, ``inputs``, ``outputs``, ``margins`` and ``standing``."""
        robust: Answer | None
        """The ``optimum`` of a robust search beside the ``first`` design."""
        doubtful_optima: tuple[Answer, ...]
        """``row`` and failed ``checks`` of the optimum, or of each test of a searched front, that is doubtful."""
        aim: Answer | None
        """Of an adaptive study: ``output``, ``limit``, ``part``, ``error``, ``probability``, ``tests``, and whether it ``is_known``."""

    def _repr_html_(self) -> str:
        # The tests of an adaptive study are no sample; its emulators state the distributions.
        emulated = [one for one in self.emulated if self.aim and one.distribution]

        # 5 %, median and 95 % among the percentiles.
        def row(of: Answer) -> list[object]:
            name = " ".join(filter(None, [of.title, of.get("design")]))
            percentiles = of.get("distribution", of).percentiles
            return [name, of.unit, *(percentiles[place] for place in (1, 3, 5)), of.tests]

        caption = f"{self.kept} of {self.tests} tests, {self.design}"
        head = ("output", "unit", "5 %", "median", "95 %", "tests")
        spreads = _html.table(caption, head, map(row, emulated or self.spreads))
        if self.best is None or self.best.row is None:
            return spreads
        values = [(one.name, one.value, one.first) for one in (*self.best.inputs, *self.best.outputs)]
        return spreads + _html.table(f"Best test, row {self.best.row}", ("", "value", "first design"), values)


def _value(value: Any) -> Any:
    if isinstance(value, Mapping):
        return value if isinstance(value, Answer) else Answer(value)
    if isinstance(value, (list, tuple)):
        return tuple(map(_value, value))
    return value


def _shown(value: Any) -> object:
    """A nested value by its size; it has its own table."""
    if isinstance(value, Answer):
        return ", ".join(value)
    if isinstance(value, tuple) and any(isinstance(one, Answer) for one in value):
        return f"{len(value)} entries"
    return value
