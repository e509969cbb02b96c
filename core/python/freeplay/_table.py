"""Tables: rows of analyses and of comparisons, column by column."""
from __future__ import annotations

import os
from importlib import import_module
from types import MappingProxyType
from typing import Any, Mapping, Sequence

import numpy as np

from ._errors import not_in_this_release, unknown_name, usage

Column = np.ndarray[Any, np.dtype[Any]]


def column_of(cells: Sequence[float | str]) -> Column:
    """Words as texts where there is one; else numbers, NaN where empty."""
    if any(isinstance(cell, str) for cell in cells):
        column: Column = np.array([cell if isinstance(cell, str) else "" for cell in cells], dtype=str)
    else:
        numbers = np.array(cells, dtype=float)
        column = np.where(np.isfinite(numbers), numbers, np.nan)
    column.setflags(write=False)
    return column


class Table:
    """Rows of an analysis or a comparison. Nothing of it changes.

    kind: what it is of. columns, units: of its columns, in SI. summary: what the command says of the whole.
    warnings: sentences. axes: values of the grid by axis, where it is on a grid.
    """

    def __init__(self, kind: str, columns: Mapping[str, Sequence[float | str]], units: Mapping[str, str], summary: dict[str, Any],
                 warnings: Sequence[str] = (), axes: Mapping[str, Column] | None = None, csv: str = "") -> None:
        self.kind = kind
        self.columns: tuple[str, ...] = tuple(columns)
        self.units: Mapping[str, str] = MappingProxyType(dict(units))
        self.summary = summary
        self.warnings = tuple(warnings)
        self.axes: dict[str, Column] = dict(axes or {})
        self._cells = {name: column_of(cells) for name, cells in columns.items()}
        self._csv = csv

    def __getitem__(self, column: str) -> Column:
        """The values of one column, (rows,). Raises UnknownName."""
        found = self._cells.get(column)
        if found is None:
            raise unknown_name("column", column, self.columns)
        return found

    def __len__(self) -> int:
        return len(next(iter(self._cells.values()))) if self._cells else 0

    def __repr__(self) -> str:
        return f"<freeplay.Table of {self.kind}, {len(self)} rows of {len(self.columns)} columns>"

    def grid(self, column: str) -> Column:
        """The values of a column in the shape of `axes`, x first. Raises UsageError for a table that is on no grid."""
        shape = [len(axis) for axis in self.axes.values()]
        if not shape or int(np.prod(shape)) != len(self):
            raise usage(f"grid(): the rows of this table of {self.kind} stand on no grid")
        order = [np.asarray(self[name]) for name in self.axes]
        places = [np.searchsorted(axis, values) if axis[0] <= axis[-1] else len(axis) - 1 - np.searchsorted(axis[::-1], values)
                  for axis, values in zip(self.axes.values(), order)]
        shaped = np.empty(shape, dtype=self[column].dtype)
        shaped[tuple(places)] = self[column]
        shaped.setflags(write=False)
        return shaped

    def to_pandas(self) -> Any:
        """A pandas DataFrame of all columns; attrs["units"] has their units."""
        try:
            pandas: Any = import_module("pandas")
        except ImportError as error:
            raise ImportError("to_pandas needs pandas: Debian has it as python3-pandas") from error
        frame = pandas.DataFrame({name: self[name] for name in self.columns})
        frame.attrs["units"] = dict(self.units)
        return frame

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the table as CSV, the bytes of `--out` of the command, to `path`."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self._csv)

    def svg(self) -> str:
        """The map of `--svg`. Not in this release: the command draws it."""
        not_in_this_release("svg() of a table")
