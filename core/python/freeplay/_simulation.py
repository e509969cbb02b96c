"""Runs step by step."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import not_in_this_release
from ._source import Quantity

if TYPE_CHECKING:
    from ._model import Model


class Simulation:
    """A run step by step. Not in this release: making one raises UsageError."""

    def __init__(self, model: Model, **options: Any) -> None:
        not_in_this_release("simulation()")

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def __getitem__(self, name: str) -> float:
        """The value of a channel now. Not in this release."""
        not_in_this_release("simulation()")

    @property
    def time(self) -> float:
        """Reached so far [s]. Not in this release."""
        not_in_this_release("simulation()")

    @property
    def done(self) -> bool:
        """Whether the end is reached. Not in this release."""
        not_in_this_release("simulation()")

    def set(self, name: str, value: Quantity) -> None:
        """An effort [N, N m] from now on. Not in this release."""
        not_in_this_release("set()")

    def advance(self, until: Quantity | None = None, *, rows: int | None = None) -> float:
        """Goes on to `until` [s], past `rows` output instants or to the end. Not in this release."""
        not_in_this_release("advance()")
