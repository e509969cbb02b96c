"""Tables: rows of analyses and of comparisons, column by column."""
from __future__ import annotations

import os
from importlib import import_module
from types import MappingProxyType
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from . import _html
from ._errors import Message, ResultError, UsageError, unknown_name, usage
from ._source import flag

Column = np.ndarray[Any, np.dtype[Any]]


def column_of(cells: Sequence[float | str] | Column) -> Column:
    """Words as texts where there is one; else numbers, NaN where empty."""
    if isinstance(cells, np.ndarray):
        return cells
    if any(isinstance(cell, str) for cell in cells):
        column: Column = np.array([cell if isinstance(cell, str) else "" for cell in cells], dtype=str)
    else:
        numbers = np.array(cells, dtype=float)
        column = np.where(np.isfinite(numbers), numbers, np.nan)
    column.setflags(write=False)
    return column


def is_replaceable(path: str | os.PathLike[str]) -> bool:
    """Whether there is no file, or one that begins as a table does: with names between commas."""
    if not os.path.isfile(path):
        return True
    with open(path, "rb") as file:
        first = file.readline(1 << 20)
    return not first or (b"," in first and not set(b"<>{}") & set(first) and first.isascii() and first.rstrip(b"\r\n").decode().isprintable())


class Table:
    """Rows of an analysis or a comparison. Nothing of it changes.

    kind: what it is of. columns, units: of its columns, in SI. summary: what the command says of the whole.
    warnings: sentences. axes: values of the grid by axis, where it is on a grid.
    """

    def __init__(self, kind: str, columns: Mapping[str, Sequence[float | str] | Column], units: Mapping[str, str], summary: dict[str, Any],
                 warnings: Sequence[str] = (), axes: Mapping[str, Column] | None = None, csv: str = "", force: bool = False,
                 draw: Callable[[], str] | None = None) -> None:
        self.kind = kind
        self.columns: tuple[str, ...] = tuple(columns)
        self.units: Mapping[str, str] = MappingProxyType(dict(units))
        self.summary = summary
        self.warnings = tuple(warnings)
        self.axes: dict[str, Column] = dict(axes or {})
        self._cells = {name: column_of(cells) for name, cells in columns.items()}
        self._csv = csv
        self._force = flag("force", force)
        self._draw = draw
        self._svg: str | None = None

    def __getitem__(self, column: str) -> Column:
        """The values of one column, (rows,). Raises UnknownName."""
        found = self._cells.get(column) if isinstance(column, str) else None
        if found is None:
            raise unknown_name("column", column, self.columns)
        return found

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "units": dict(self.units)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.units = MappingProxyType(state["units"])
        for column in self._cells.values():
            column.setflags(write=False)

    def __len__(self) -> int:
        return len(next(iter(self._cells.values()))) if self._cells else 0

    def __repr__(self) -> str:
        return f"<freeplay.Table of {self.kind}, {len(self)} rows of {len(self.columns)} columns>"

    def _repr_html_(self) -> str:
        try:
            return _html.page(f"{self.kind}, {len(self)} rows", _html.drawing(self.svg()))
        except UsageError:
            pass  # it is no map
        shown = min(len(self), _html.MOST_ROWS)
        head = [f"{name} [{self.units[name]}]" if self.units.get(name) not in (None, "", "1") else name for name in self.columns]
        cells = [[value.item() for value in self[name][:shown]] for name in self.columns]
        rest = f"<p>and {len(self) - shown} more rows</p>" if shown < len(self) else ""
        return _html.page(f"{self.kind}, {len(self)} rows", _html.table(head, list(zip(*cells))), rest)

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
        """Writes the table as CSV, the bytes of `--out` of the command, to `path`. Raises ResultError for a file that is no table."""
        if not self._force and not is_replaceable(path):
            text = f"cannot write '{os.fspath(path)}': it is there already, and no table; make the table with force=True, or choose another name"
            raise ResultError(text + " [cannot-write]", [Message(None, None, None, "error", "cannot-write", text, None)])
        try:
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(self._csv)
        except OSError as error:
            text = f"cannot write '{os.fspath(path)}': {error.strerror}"
            raise ResultError(text + " [cannot-write]", [Message(None, None, None, "error", "cannot-write", text, None)]) from error

    def svg(self) -> str:
        """The map of `analyze --svg`, which the analysis is made once more for. Raises UsageError for what is on no grid of x and y."""
        if self._draw is None:
            raise usage(f"svg(): a table of {self.kind} is no map")
        if self._svg is None:
            self._svg = self._draw()
        return self._svg
