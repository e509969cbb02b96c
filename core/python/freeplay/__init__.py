"""Freeplay: rigid-body mechanisms whose joints have clearance, from Python.

A model is a text, a run is one call, a result is memory that is read only; the numbers are those of the command line.
"""
from __future__ import annotations

from . import _core
from ._catalogue import describe, info, schema, types
from ._errors import (Error, InternalError, Interrupted, Message, ModelError, ModelWarning, NumericalError, PluginError, ResultError,
                      UnknownName, UsageError)
from ._model import Channel, Model, check, load, run
from ._result import Result, open
from ._compare import compare
from ._map import Function, map
from ._resume import resume
from ._simulation import Simulation
from ._table import Table

__version__ = _core.version

__all__ = ["Channel", "Error", "Function", "InternalError", "Interrupted", "Message", "Model", "ModelError", "ModelWarning", "NumericalError",
           "PluginError", "Result", "ResultError", "Simulation", "Table", "UnknownName", "UsageError", "check", "compare",
           "describe", "info", "load", "map", "open", "resume", "run", "schema", "types"]
