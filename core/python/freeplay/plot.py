"""Pictures of results: each draws into `ax`, or into a new figure, and returns the axes. Showing them is the caller's."""
from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from typing import Any

import numpy as np

from ._errors import unknown_name, usage
from ._result import Result
from ._table import Table

MICRO = 1e6


def axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    try:
        pyplot: Any = import_module("matplotlib.pyplot")
    except ImportError as error:
        raise ImportError("freeplay.plot needs matplotlib: Debian has it as python3-matplotlib") from error
    return pyplot.subplots()[1]


def labelled(ax: Any, x: str, y: str) -> Any:
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    return ax


def platform_error(result: Result, driver: str | None = None, *, ax: Any = None) -> Any:
    """Distance of the platform from its path [um] over time [s]. driver: the entry that has the path; needed where there are several."""
    found = [name[len("driver."):-len(".ex")] for name in result.names if name.startswith("driver.") and name.endswith(".ex")]
    if driver is None and len(found) != 1:
        raise usage("platform_error(): " + (f"which driver of {', '.join(found)}?" if found else "the model has no path by inverse kinematics"))
    name = found[0] if driver is None else driver
    if name not in found:
        raise unknown_name("driver with a path", name, found)
    ax = axes(ax)
    ax.plot(result.time, MICRO * np.hypot(result[f"driver.{name}.ex"], result[f"driver.{name}.ey"]))
    return labelled(ax, "time [s]", f"position error of {name} [um]")


def clearance_of(result: Result, joint: str) -> float:
    """Of its bearing [m]; NaN where it is not known."""
    if result.model is None:
        return float("nan")
    clearance = result.model.tree()["joints"].get(joint, {}).get("clearance") or {}
    return float(clearance.get("radial_clearance", float("nan")))


def orbit(result: Result, joint: str, *, ax: Any = None) -> Any:
    """The journal of a joint with play in its clearance circle [um]. joint: its name."""
    x, y = result[f"joint.{joint}.ex"], result[f"joint.{joint}.ey"]
    ax = axes(ax)
    ax.plot(MICRO * x, MICRO * y, linewidth=0.6)
    radius = MICRO * clearance_of(result, joint)
    if np.isfinite(radius):
        turn = np.linspace(0.0, 2.0 * np.pi, 181)
        ax.plot(radius * np.cos(turn), radius * np.sin(turn), color="0.6", linewidth=0.8)
    ax.set_aspect("equal")
    return labelled(ax, f"{joint}: x [um]", "y [um]")


def force_histogram(result: Result, joint: str, *, bins: int = 60, ax: Any = None) -> Any:
    """Share of time at each contact force [N] of a joint with play. joint: its name. bins: how many."""
    force = result[f"joint.{joint}.fn"]
    known = force[np.isfinite(force)]
    ax = axes(ax)
    ax.hist(known, bins=bins, weights=np.full(len(known), 1.0 / max(len(known), 1)))
    return labelled(ax, f"contact force of {joint} [N]", "share of time")


def channels(result: Result, names: str | Iterable[str], *, ax: Any = None) -> Any:
    """Channels over time [s]. names: of channels, or patterns with `*`."""
    ax = axes(ax)
    chosen = result.select(*([names] if isinstance(names, str) else names))
    for name, column in chosen.items():
        ax.plot(result.time, column, label=f"{name} [{result.units[name]}]")
    if len(chosen) > 1:
        ax.legend()
    units = {result.units[name] for name in chosen}
    return labelled(ax, "time [s]", f"{next(iter(chosen))} [{units.pop()}]" if len(chosen) == 1 else f"[{', '.join(sorted(units))}]")


def map(table: Table, column: str, *, ax: Any = None) -> Any:
    """A column of a table on a grid of two axes, as colours. column: its name."""
    if len(table.axes) != 2:
        raise usage(f"map(): two axes are needed, this table of {table.kind} has {len(table.axes)}")
    (x, across), (y, up) = table.axes.items()
    ax = axes(ax)
    drawn = ax.pcolormesh(across, up, table.grid(column).T, shading="nearest")
    ax.figure.colorbar(drawn, ax=ax, label=f"{column} [{table.units[column]}]")
    ax.set_aspect("equal" if table.units[x] == table.units[y] else "auto")
    return labelled(ax, f"{x} [{table.units[x]}]", f"{y} [{table.units[y]}]")
