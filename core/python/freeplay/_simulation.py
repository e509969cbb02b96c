"""A run that a script takes step by step."""
from __future__ import annotations

import math
import warnings
import weakref
from numbers import Real
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ._errors import Error, unknown_name, usage
from ._result import Array, Result, raise_failure, result_of
from ._source import Quantity, count_of
from . import _core

if TYPE_CHECKING:
    from ._model import Model

ALL = 2**63 - 1


def number(name: str, value: Quantity, unit: str) -> float:
    """A finite number of this unit, in SI."""
    if isinstance(value, str):
        return _core.quantity(name, value, unit)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name}: a number in SI or a text such as '2 ms' is needed, not {type(value).__name__}")
    found = float(value)
    if not math.isfinite(found):
        raise usage(f"bad value '{found}' of {name}: it must be finite", message_id="bad-value")
    return found


def seal(core: _core.SteppedRun, directory: str) -> None:
    """What close() does to the files of a simulation that nothing refers to any more, also at the end of the program."""
    try:
        if core.ended() is None:
            core.close()
            warnings.warn(f"the simulation in '{directory}' was not closed: it ends where it stopped", ResourceWarning, stacklevel=2)
    except Error as error:
        warnings.warn(f"the simulation in '{directory}' was not closed, and its files cannot be: {error}", ResourceWarning, stacklevel=2)
    except RuntimeError:
        pass  # a thread that the program did not wait for is in a step


class Simulation:
    """A run step by step, assembled at its start; `with` closes it. One thread at a time uses it, any may interrupt() it.

    model: what runs. names: of the channels that are kept, time [s] first. end: of the run [s].
    """

    def __init__(self, model: Model, **options_of_run: Any) -> None:
        from ._model import begin, require_model

        require_model(model)
        self._result: Result | None = None
        self._told = self._cut = False  # what ended it was raised; it was before its end
        self.model, self._core, self._directory, self._profiled = begin(model, options_of_run)
        self.names: tuple[str, ...] = tuple(self._core.layout()["names"])
        self.end: float = float(self.model._known["end"])
        self._places = {name: place for place, name in enumerate(self.names)}
        self._units: dict[str, str] = dict(self.model._known["inputs"])
        self._inputs = {name: place for place, name in enumerate(self._units)}
        if self._directory is not None:
            weakref.finalize(self, seal, self._core, self._directory)
        if self._core.ended() is not None:
            self._over()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        try:
            self.close()
        except Error:
            if kind is None:
                raise

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a simulation cannot be copied: checkpoint() gives what another one goes on from")

    def __repr__(self) -> str:
        return f"<freeplay.Simulation of '{self.model.name}', {self.status} at {self.time:g} s of {self.end:g} s>"

    @property
    def time(self) -> float:
        """Reached so far [s]."""
        return self._core.time()

    @property
    def steps(self) -> int:
        """Accepted so far."""
        return self._core.steps()

    @property
    def done(self) -> bool:
        """Whether the run is over: at its end, stopped, failed, interrupted or closed."""
        return self._core.ended() is not None

    @property
    def status(self) -> str:
        """completed, stopped, failed or interrupted; unfinished before the run is over."""
        ended = self._core.ended()
        return "unfinished" if ended is None else ended.status

    @property
    def inputs(self) -> dict[str, float]:
        """Efforts of the inputs from now on [N, N m]."""
        return dict(zip(self._inputs, self._core.efforts()))

    @property
    def row(self) -> Array:
        """All channels now, (len(names),): a view that every call renews."""
        return self._core.row()

    def __getitem__(self, name: str) -> float:
        """The value of one channel now. Raises UnknownName."""
        place = self._places.get(name) if isinstance(name, str) else None
        if place is None:
            raise unknown_name("channel", name, self.names)
        return self._core.value(place)

    def advance(self, until: Quantity | None = None, *, rows: int | None = None) -> float:
        """Goes on, and returns the time that is reached [s].

        until: exactly to this time [s]; beyond the end, to the end. rows: past so many output instants instead. Without either: to the end.
        At the end it stays there. Raises what run() raises, Interrupted after interrupt(), UsageError once it was ended before.
        """
        if until is None:
            time = self._core.advance(math.inf, ALL if rows is None else min(count_of("rows", rows), ALL), ALL)
        else:
            if rows is not None:
                raise usage("advance(): until and rows exclude each other")
            time = self._core.advance(self._later(until), ALL, ALL)
        return time if time == time else self._over()

    def _later(self, until: Quantity) -> float:
        found = number("until", until, "s")
        if found < self._core.time():
            raise usage(f"bad value '{until}' of until: the simulation is at {self.time} s already", message_id="bad-value")
        return found

    def step(self, count: int = 1) -> float:
        """Goes on by `count` accepted steps, no farther than the end, and returns the time that is reached [s]."""
        time = self._core.advance(math.inf, ALL, 1 if count == 1 and type(count) is int else min(count_of("count", count), ALL))
        return time if time == time else self._over()

    def set(self, name: str, value: Quantity) -> None:
        """The effort of an input from now on.

        name: of a driver with `input`. value: its effort [N, N m]. What holds already changes nothing.
        """
        place = self._inputs.get(name) if isinstance(name, str) else None
        if place is None:
            raise unknown_name("input", name, list(self._inputs))
        self._core.set(place, number(name, value, self._units[name]))

    def result(self) -> Result:
        """The rows up to now; before the run is over without a summary."""
        if self._result is not None:
            return self._result
        ended = self._core.ended()
        if ended is None:
            record = self._core.record()
            return Result(record, record["data"], record["event_numbers"], {}, self.model)
        self._result = result_of(ended, self.model, self._profiled, self._directory)
        return self._result

    def _over(self) -> float:
        from ._model import warn

        result, ended = self.result(), self._core.ended()
        if self._told:
            if self._cut:
                raise usage(f"the simulation is over ({self.status})")
            return self.time
        self._told, self._cut = True, self._cut or self.status in ("failed", "interrupted")
        warn(result.warnings, 4)
        if ended is not None:
            raise_failure(ended, result, self._core.raised())
        return self.time

    def interrupt(self) -> None:
        """From any thread: the step in hand is the last, and the call that makes it raises Interrupted."""
        self._core.interrupt()

    def close(self) -> None:
        """Ends the run where it is and seals its directory; before the end `status` is then "stopped". Again it does nothing."""
        if self._core.ended() is None:
            self._core.close()
            self._cut = True
            self._over()

    def checkpoint(self) -> bytes:
        """Where the simulation is, with all rows up to now: `model.simulation(checkpoint=...)` goes on from there, in this or another process.

        Raises UsageError once it is over.
        """
        return self._core.checkpoint()
