"""Analyses of a mechanism, in the words of `freeplay analyze`."""
from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._errors import Error, Interrupted, usage
from ._source import count_of, flag, quantity, text
from ._table import Table

if TYPE_CHECKING:
    from ._model import Model

BY_WORD = {"time": "s", "x": "m", "y": "m", "z": "m", "angle": "rad", "roll": "rad", "pitch": "rad", "yaw": "rad", "dx": "m", "dy": "m",
           "dz": "m", "drx": "rad", "dry": "rad", "drz": "rad", "dangle": "rad", "position": "m", "fx": "N", "fy": "N", "fz": "N",
           "force": "N", "torque": "N*m", "tx": "N*m", "ty": "N*m", "tz": "N*m", "value": "1"}


def unit_of(column: str, channels: Mapping[str, str]) -> str:
    """The unit of a column: that of the channel of this name, or by its last word."""
    if column in channels:
        return channels[column]
    if column.endswith(".acceleration"):
        speed = channels.get(column[: -len("acceleration")] + "speed", "rad/s")
        return speed + "^2"
    word = column.rsplit(".", 1)[-1]
    for mark in ("ls_", "sample_rms_", "sample_max_"):
        word = word[len(mark):] if word.startswith(mark) else word
    return BY_WORD.get(word, "1")


def span(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    try:
        begin, end, count = value
    except (TypeError, ValueError):
        raise TypeError(f"{name}: (from, to, count) is needed") from None
    if isinstance(count, bool) or not isinstance(count, Integral):
        raise TypeError(f"{name}: the count of values is a whole number, not {type(count).__name__}")
    return f"{quantity(name, begin)}:{quantity(name, end)}:{int(count)}"


def pairs(name: str, value: Mapping[str, Any]) -> str:
    return ",".join(f"{key}={quantity(f'{name}: {key}', one)}" for key, one in value.items())


def pose_words(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    if isinstance(value, Mapping):
        return [pairs("pose", value)]
    if np.ndim(value) == 0 and not isinstance(value, Iterable):
        raise TypeError(f"pose: one pose, a list of poses or an array (N, 3) or (N, 6) is needed, not {type(value).__name__}")
    poses = list(value)
    if poses and not isinstance(poses[0], (Mapping, str)) and np.ndim(poses[0]) == 0:
        return [",".join(quantity("pose", number) for number in poses)]
    words = []
    for pose in poses:
        if not isinstance(pose, (Mapping, str)) and np.ndim(pose) != 1:
            raise TypeError("pose: one pose, a list of poses or an array (N, 3) or (N, 6) is needed")
        words += pose_words(pose)
    return words


def input_words(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    if isinstance(value, Mapping):
        return [pairs("input", value)]
    if not isinstance(value, (list, tuple)):
        raise TypeError(f"input: a mapping of joints to values, or a list of such, is needed, not {type(value).__name__}")
    return [word for one in value for word in input_words(one)]


def analysis_words(kind: str, options: Mapping[str, Any]) -> dict[str, Any]:
    words: dict[str, Any] = {"kind": kind}
    for name, value in options.items():
        if value is None or value is False:
            continue
        if name in ("sensitivity", "branches"):
            words[name] = flag(name, value)
        elif name == "grid" and not isinstance(value, Mapping):
            raise TypeError("grid: a mapping of axes to (from, to, count) is needed, not " + type(value).__name__)
        elif name == "grid":
            words[name] = [f"{axis}={span('grid: ' + axis, one)}" for axis, one in value.items()]
        elif name == "time":
            words[name] = span(name, value)
        elif name == "pose":
            words[name] = pose_words(value)
        elif name == "input":
            words[name] = input_words(value)
        elif name == "elbow":
            words[name] = ",".join(quantity(name, one) for one in value) if not isinstance(value, str) and isinstance(value, Iterable) else quantity(name, value)
        elif name == "preload":
            words[name] = quantity(name, value)
        elif name in ("samples", "seed"):
            words[name] = str(count_of(name, value, 0))
        else:
            words[name] = text(name, value)
        if name in ("grid", "pose", "input") and not words[name]:
            raise usage(f"{name}: at least one is needed")
    return words


def axes_of(table: Mapping[str, Any]) -> dict[str, Any]:
    """The axes of more than one value of a table whose rows stand on a grid; else none."""
    axes = {}
    for name in ("x", "y", "z", "angle", "roll", "pitch", "yaw"):
        values = list(dict.fromkeys(table["columns"][name].tolist())) if name in table["columns"] else []
        if len(values) > 1:
            axes[name] = np.array(values)
            axes[name].setflags(write=False)
    return axes if axes and int(np.prod([len(axis) for axis in axes.values()])) == table["rows"] else {}


def asked(model: Model, words: dict[str, Any]) -> dict[str, Any]:
    """What the core returns of an analysis."""
    table, raised = _core.analyse(model._core, words)
    if raised is not None:
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted() from None
        raise raised
    assert table is not None
    return table


def drawn(model: Model, words: dict[str, Any]) -> str:
    model = model._here()
    try:
        return str(asked(model, words)["map"])
    except Error as error:
        raise model._named(error) from None


def analyse(model: Model, kind: str, options: Mapping[str, Any], force: bool, colours: bool) -> Table:
    words = analysis_words(kind, options)
    table = asked(model, words)
    channels = {channel.name: channel.unit for channel in model.channels}
    columns = table["columns"]
    axes = axes_of(table) if options.get("pose") is None and options.get("time") is None and options.get("input") is None else {}
    return Table(kind, columns, {name: unit_of(name, channels) for name in columns}, table["summary"], table["warnings"], axes,
                 table["csv"], force, partial(drawn, model, {**words, "map": "colours" if colours else "grey"}))

