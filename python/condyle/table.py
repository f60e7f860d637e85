"""Tables of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ._extras import extra
from .units import unit_of

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

__all__ = ["Table"]


class Table(Mapping[str, "NDArray[np.float64]"]):
    """Columns of numbers under the names of a run's CSV files, each with its unit in the name.

    A column is a view of :attr:`array`: nothing is copied.
    """

    __slots__ = ("_array", "_columns")

    def __init__(self, columns: list[str], array: NDArray[np.float64]) -> None:
        """``array`` has a row a row of the file, and a column a name."""
        self._columns, self._array = tuple(columns), array

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return self._columns

    @property
    def array(self) -> NDArray[np.float64]:
        """All numbers, shape (rows, columns)."""
        return self._array

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column; empty for a pure number."""
        return {name: unit_of(name) for name in self._columns}

    def to_pandas(self) -> pd.DataFrame:
        """As a data frame; units are in ``.attrs["units"]``."""
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

    def __reduce__(self) -> tuple[object, ...]:
        return Table, (list(self._columns), self._array)
