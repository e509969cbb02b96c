"""How far two results agree."""
from __future__ import annotations

import math
import os
from typing import Iterable, Union

from . import _core
from ._errors import usage
from ._result import Result
from ._simulation import number
from ._source import Quantity, names as names_of
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

    with tempfile.TemporaryDirectory() as folder:
        paths = [path_of(one, os.path.join(folder, name)) for one, name in ((a, "a"), (b, "b"))]
        found = _core.compare(paths[0], paths[1], part("tolerance", tolerance), part("absolute", absolute), names_of(channels),
                              -math.inf if start is None else number("start", start, "s"),
                              math.inf if until is None else number("until", until, "s"))
    rows = found["rows"]
    columns = {name: [row[i] for row in rows] for i, name in enumerate(COLUMNS)}
    units = {name: "s" if name == "at_time" else "1" for name in COLUMNS}
    return Table("compare", columns, units, {"agree": found["agree"], "rows": found["compared"]}, found["notes"])


def part(name: str, value: float) -> float:
    """What may differ."""
    found = number(name, value, "1")
    if found < 0:
        raise usage(f"bad value '{value}' of {name}: it must not be negative", message_id="bad-value")
    return found


def path_of(result: Compared, folder: str) -> str:
    """Where the files of a result stand; one that was kept alone is written into `folder`."""
    if not isinstance(result, Result):
        return os.fspath(result)
    if result._directory is not None:
        return result._directory
    return os.fspath(result.save(folder, format="hdf5"))
