"""Tables of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from io import StringIO
from typing import TYPE_CHECKING

from . import _html
from ._condyle import unit_of
from ._extras import extra
from .errors import BadInput

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

__all__ = ["Table"]


class Table(Mapping[str, "NDArray[np.float64]"]):
    """Columns of numbers by name, as in the CSV files of a run; each name ends with its unit.

    A column is a view of :attr:`array`, which is read-only.
    """

    # Rows of a long table that a notebook shows at either end.
    _SHOWN = 5

    __slots__ = ("_array", "_columns")

    def __init__(self, columns: list[str], array: NDArray[np.float64]) -> None:
        """``array`` has one row per row of the file and one column per name."""
        self._columns, self._array = tuple(columns), array.view()
        self._array.flags.writeable = False

    @classmethod
    def from_csv(cls, text: str, name: str) -> Table:
        """Reads the text of a CSV file that a run wrote; messages call it ``name``.

        >>> Table.from_csv("percent,ap_mm\\n0,1.5\\n100,1.5\\n", "kinematics.csv")["ap_mm"].tolist()
        [1.5, 1.5]

        Raises:
            BadInput: a row that does not fit the header, or a cell that is not a number.
        """
        import numpy as np

        header, _, rows = text.partition("\n")
        columns = header.rstrip("\r").split(",")
        array = np.empty((0, len(columns)))
        try:
            if rows:
                array = np.loadtxt(StringIO(rows), delimiter=",", ndmin=2)
            if array.shape[1] != len(columns):
                raise ValueError(f"{array.shape[1]} columns under {len(columns)} names")
        except ValueError as error:
            raise BadInput(f"{name}: this is not a table that a run wrote ({error}); run the case again") from error
        return cls(columns, array)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return self._columns

    @property
    def array(self) -> NDArray[np.float64]:
        """All numbers, shape (rows, columns)."""
        return self._array

    @property
    def units(self) -> dict[str, str]:
        """The unit of every column; empty for a pure number."""
        return {name: unit_of(name) for name in self._columns}

    def to_pandas(self) -> pd.DataFrame:
        """The table as a data frame; units are in ``.attrs["units"]``."""
        frame = extra("pandas", "pandas").DataFrame(self._array, columns=list(self._columns))
        frame.attrs["units"] = self.units
        return frame

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self._columns:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(self._columns)}")
        return self._array[:, self._columns.index(name)]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<condyle.Table of {len(self._array)} rows: {', '.join(self._columns)}>"

    def _repr_html_(self) -> str:
        rows = self._array.tolist()
        if len(rows) > 2 * self._SHOWN:
            rows[self._SHOWN : -self._SHOWN] = [["..."] * len(self)]
        return _html.table(f"{len(self._array)} rows", self._columns, rows)

    def __reduce__(self) -> tuple[object, ...]:
        return Table, (list(self._columns), self._array)
