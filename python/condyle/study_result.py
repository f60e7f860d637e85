"""The results of a study."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._condyle import unit_of
from ._extras import extra
from .answers import Answers
from .emulator import Emulator, read
from .errors import BadInput

if TYPE_CHECKING:
    import os

    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

__all__ = ["StudyResult", "open_study"]


class StudyResult:
    """The table and the answers in the folder of a study."""

    __slots__ = ("_answers", "_folder", "_table")

    def __init__(self, folder: Path, answers: dict[str, Any]) -> None:
        """Use :meth:`Study.run` or :func:`open_study`."""
        self._folder, self._answers = folder, Answers(answers)
        self._table: dict[str, NDArray[Any]] | None = None

    @property
    def folder(self) -> Path:
        """The folder with ``study.db``, ``table.csv``, ``answers.json``, ``study.html`` and the pictures."""
        return self._folder

    @property
    def answers(self) -> Answers:
        """The content of ``answers.json``: scatter, sensitivity, ranking, Pareto front, the best; ``answers.best.row`` and so on."""
        return self._answers

    @property
    def table(self) -> Mapping[str, NDArray[Any]]:
        """The columns: ``row``, ``status``, ``reason`` of failure or doubt, and every input and output, with one value per test.

        Numbers are float64, NaN where a test failed; ``row`` is int64, and words are objects.
        """
        if self._table is None:
            self._table = _read(self._folder)
            for column in self._table.values():
                column.flags.writeable = False
        return self._table

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        """A column of the table."""
        if column not in self.table:
            raise KeyError(f"there is no column {column!r}; there are {', '.join(self.table)}")
        return self.table[column]

    def emulator(self, output: str, design: str | None = None) -> Emulator:
        """The emulator of an output, such as ``mass_loss_mg``; in a study that compares designs, that of one ``design``.

        Raises:
            BadInput: an output without an emulator.
        """
        return read(self._folder, output, design)

    def to_pandas(self) -> pd.DataFrame:
        """The table as a data frame with the rows as its index; units are in ``.attrs["units"]``."""
        frame = extra("pandas", "pandas").DataFrame(dict(self.table)).set_index("row")
        frame.attrs["units"] = {name: unit_of(name) for name in frame.columns}
        return frame

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes the table as a Parquet file; needs pandas and pyarrow."""
        extra("pyarrow", "parquet")
        self.to_pandas().to_parquet(path)

    def _repr_html_(self) -> str:
        return self._answers._repr_html_()

    def __repr__(self) -> str:
        return f"<condyle.StudyResult of {self._answers['kept']} tests in {self._folder}>"


def open_study(folder: str | os.PathLike[str]) -> StudyResult:
    """Opens the study in a folder written by ``condyle study`` or :meth:`Study.run`.

    Raises:
        BadInput: a folder without a study, or with tests that are not evaluated: those of an unfinished study are evaluated by
            :meth:`Study.answered`.
    """
    path = Path(folder)
    try:
        answers = json.loads((path / "answers.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        is_begun = (path / "study.db").is_file()
        content = "an unfinished study; run the same study to resume it" if is_begun else "no study"
        raise BadInput(f"{path}: the folder holds {content}") from error
    result = StudyResult(path, answers)
    if (path / "study.db").is_file() and len(result["row"]) != answers["kept"]:
        raise BadInput(
            f"{path}: the folder holds {len(result['row'])} tests, and answers of {answers['kept']}; run the same study to resume "
            "it, or evaluate its tests with Study.answered"
        )
    return result


def _read(folder: Path) -> dict[str, NDArray[Any]]:
    import sqlite3

    import numpy as np

    with sqlite3.connect(folder / "study.db") as database:
        found = database.execute('SELECT * FROM tests ORDER BY "row"')
        names = [column[0] for column in found.description]
        rows = found.fetchall()
    database.close()
    columns = zip(*rows) if rows else ([] for _ in names)
    table = {name: _array(np, name, column) for name, column in zip(names, columns)}
    table.pop("checksum", None)
    return table


def _array(np: Any, name: str, column: Any) -> NDArray[Any]:
    if name == "row":
        return np.array(column, dtype=np.int64)
    if any(isinstance(value, str) for value in column):
        return np.array(column, dtype=object)
    return np.array(column, dtype=np.float64)
