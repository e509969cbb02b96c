"""Runs that go on."""
from __future__ import annotations

import os
from typing import Any

from . import _core
from ._model import Progress, progress_of, warn
from ._result import Result, open, raise_failure
from ._source import Quantity, filled, flag, path_of, quantity


def resume(path: str | os.PathLike[str], *, end: Quantity | None = None, checkpoint: Quantity | None = None, report: bool = False,
           profile: bool = False, allow_plugins: bool = False, progress: Progress = None) -> Result:
    """Goes on with the run of a result directory that was killed, interrupted or could not write, to the same bytes; a run that came
    to its end stays as it is. Model and settings are those of the run.

    path: of the directory. end: a later end [s]. checkpoint, report, profile, progress, allow_plugins: as in run().

    Raises what run() raises; ModelError where the model, an input, a plugin or the program is another now; ResultError without a
    checkpoint, as simulation() leaves none.
    """
    ends: list[float] = []
    words: dict[str, Any] = {"call": "freeplay.resume()", "profile": flag("profile", profile), "report": flag("report", report)}
    given = {name: filled(name, quantity(name, value)) for name, value in (("end", end), ("checkpoint", checkpoint)) if value is not None}
    if "checkpoint" in given:
        words["checkpoint"] = given["checkpoint"]
    on_progress = progress_of(progress, ends)
    kept, raised = _core.resume(path_of("path", path), given.get("end", ""), flag("allow_plugins", allow_plugins), words, ends.append, on_progress)
    result = open(path)
    if kept is None:
        return result
    if profile:
        result.profile = kept.profile()
    warn(result.warnings, 3)
    raise_failure(kept, result, raised)
    return result
