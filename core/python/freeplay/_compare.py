"""How far two results agree."""
from __future__ import annotations

import math
import os
from typing import Iterable, Union

from . import _core
from ._errors import usage
from ._result import Result
from ._simulation import number
from ._source import Quantity, names as names_of, path_of
from ._table import Table

COLUMNS = ("channel", "max_abs", "max_rel", "rms", "at_time", "ok")
Compared = Union[Result, str, "os.PathLike[str]"]


def compare(a: Compared, b: Compared, *, tolerance: float = 1e-6, absolute: float = 1e-12, channels: str | Iterable[str] = "*",
            start: Quantity | None = None, until: Quantity | None = None) -> Table:
    """The rows of `freeplay compare`, worst first; `summary["agree"]` says whether both agree.

    a, b: results or paths of some. tolerance: part of the largest |a| that may differ. absolute: what may differ besides.
    channels: patterns of what is compared. start, until: first and last time [s].
    """
    import tempfile

    begin, end = (-math.inf if start is None else number("start", start, "s")), (math.inf if until is None else number("until", until, "s"))
    if begin > end:
        raise usage(f"--from {start} is after --until {until}", message_id="bad-value")
    with tempfile.TemporaryDirectory() as folder:
        paths = [files_of(one, os.path.join(folder, name)) for one, name in ((a, "a"), (b, "b"))]
        found = _core.compare(paths[0], paths[1], part("tolerance", tolerance), part("absolute", absolute), names_of(channels),
                              begin, end)
    rows = found["rows"]
    columns = {name: [row[i] for row in rows] for i, name in enumerate(COLUMNS)}
    units = {name: "s" if name == "at_time" else "1" for name in COLUMNS}
    lines = [COLUMNS, *([row[0], *map(_core.number_text, row[1:])] for row in rows)]
    return Table("compare", columns, units, {"agree": found["agree"], "rows": found["compared"]}, found["notes"],
                 csv="".join(",".join(line) + "\n" for line in lines))


def part(name: str, value: float) -> float:
    """What may differ."""
    found = number(name, value, "1")
    if found < 0:
        raise usage(f"bad value '{value}' of {name}: it must not be negative", message_id="bad-value")
    return found


def files_of(result: Compared, folder: str) -> str:
    """Where the files of a result stand; one that was kept alone is written into `folder`."""
    if not isinstance(result, Result):
        return path_of("compare()", result)
    if result._directory is not None:
        return result._directory
    return os.fspath(result.save(folder, format="hdf5"))
