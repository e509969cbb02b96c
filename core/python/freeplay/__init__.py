"""Freeplay: rigid-body mechanisms whose joints have clearance, from Python.

A model is a text, a run is one call, a result is memory that is read only; the numbers are those of the command line.
"""
from __future__ import annotations

import os
from typing import NoReturn

from . import _core
from ._catalogue import describe, info, schema, types
from ._errors import (Error, InternalError, Interrupted, Message, ModelError, ModelWarning, NumericalError, PluginError, ResultError,
                      UnknownName, UsageError, not_in_this_release)
from ._model import Channel, Model, check, load, run
from ._result import Result, open
from ._compare import compare
from ._map import Function, map
from ._simulation import Simulation
from ._source import Quantity, Source
from ._table import Table

__version__ = _core.version


def resume(path: str | os.PathLike[str], *, end: Quantity | None = None) -> NoReturn:
    """Goes on with the run of the result directory `path`, up to `end` [s]. Not in this release: `freeplay run --resume` does."""
    not_in_this_release("resume()")


__all__ = ["Channel", "Error", "Function", "InternalError", "Interrupted", "Message", "Model", "ModelError", "ModelWarning", "NumericalError",
           "PluginError", "Result", "ResultError", "Simulation", "Table", "UnknownName", "UsageError", "check", "compare",
           "describe", "info", "load", "map", "open", "resume", "run", "schema", "types"]
