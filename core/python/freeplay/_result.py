"""Results: rows and events of a run as arrays that are read only."""
from __future__ import annotations

import json
import os
import pathlib
import re
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Iterable, Mapping

import numpy as np

from . import _core, _html
from ._errors import Error, Interrupted, NumericalError, Message, PluginError, ResultError, unknown_name, usage
from ._source import flag, names as names_of, path_of

if TYPE_CHECKING:
    from ._model import Model

DISAGREE = 7  # exit code of verify: a warning says so
Array = np.ndarray[Any, np.dtype[np.float64]]
Records = np.ndarray[Any, np.dtype[Any]]


def fits(pattern: str, name: str) -> bool:
    """Whether a name fits a pattern, in which `*` stands for any run of characters."""
    return re.fullmatch(".*".join(re.escape(part) for part in pattern.split("*")), name) is not None


def events_of(layout: Mapping[str, Any], numbers: Array) -> Records:
    """The fields of events.csv."""
    joints, kinds, fields = layout["joints"], layout["kinds"], layout["events"]

    def words(known: list[str], places: Array) -> Any:
        return np.array(known or [""], dtype=str)[places.astype(int)]

    columns = [words(joints, numbers[:, i]) if name == "joint" else words(kinds, numbers[:, i]) if name == "kind" else numbers[:, i]
               for i, name in enumerate(fields)]
    events = np.empty(len(numbers), dtype=[(name, column.dtype) for name, column in zip(fields, columns)])
    for name, column in zip(fields, columns):
        events[name] = column
    events.setflags(write=False)
    return events.view()  # which cannot be made one to write into


class Result:
    """What a run came to. Nothing of it changes; arrays are views of one block of memory that they keep alive.

    names, units: of the columns, the first is time [s]. data: (rows, columns). events: the fields of events.csv.
    status: completed, stopped, failed or interrupted, and reason why. summary: that of summary.json.
    profile: {phase: (seconds [s], count)} of a run with profile=True. model: what ran, or None.
    """

    def __init__(self, layout: Mapping[str, Any], data: Array, numbers: Array, summary: dict[str, Any], model: Model | None,
                 kept: _core.KeptRun | _core.StoredResult | None = None, directory: str | None = None) -> None:
        self.names: tuple[str, ...] = tuple(layout["names"])
        self.units: Mapping[str, str] = MappingProxyType(dict(zip(self.names, layout["units"])))
        self.data: Array = data
        self._places = {name: i for i, name in enumerate(self.names)}
        self.time: Array = data[:, 0]
        self.events: Records = events_of(layout, numbers)
        self.summary: dict[str, Any] = summary
        self.status: str = summary.get("status", "unfinished")
        self.reason: str | None = summary.get("stop_reason") or None
        self.profile: dict[str, tuple[float, int]] | None = None
        self.warnings: tuple[str, ...] = tuple(summary.get("warnings") or ())
        self.model: Model | None = model
        self._kept = kept
        self._directory = directory

    def __getitem__(self, name: str) -> Array:
        """The numbers of one column, (rows,): a view. Raises UnknownName."""
        place = self._places.get(name) if isinstance(name, str) else None
        if place is None:
            raise unknown_name("channel", name, self.names)
        return self.data[:, place]

    def __copy__(self) -> Result:
        return self

    def __deepcopy__(self, memo: Any) -> Result:
        return self

    def __getstate__(self) -> dict[str, Any]:
        """For another process: what was read and no more, as of a result that was opened."""
        state = {**self.__dict__, "units": dict(self.units), "data": np.asfortranarray(self.data), "events": np.array(self.events), "_kept": None}
        del state["time"]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.units = MappingProxyType(state["units"])
        for array in (state["data"], state["events"]):
            array.setflags(write=False)
        self.data, self.events = state["data"].view(), state["events"].view()
        self.time = self.data[:, 0]

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        return f"<freeplay.Result {self.status}, {len(self.time)} rows of {len(self.names)} channels>"

    def _repr_html_(self) -> str:
        parts = [] if self.model is None else [_html.drawing(self.model.svg())]
        counts = {"rows": len(self.time), "until [s]": float(self.time[-1]) if len(self.time) else 0.0, **(self.summary.get("counts") or {})}
        parts += [_html.table((), _html.pairs(counts)), _html.joints(self.summary)]
        title = f"{self.model.name if self.model else 'result'}: {self.status}"
        return _html.page(title, *parts, _html.frame(self._page(), _html.MOST_TEXT - sum(map(len, parts)) - 1000))

    def _page(self) -> str:
        """The page of report(); empty where there is none, as of a simulation that goes on."""
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            try:
                return self.report(os.path.join(folder, "report.html")).read_text(encoding="utf-8")
            except Error:
                return ""

    def _chosen(self, patterns: Iterable[str]) -> list[str]:
        chosen: dict[str, None] = {}
        for pattern in patterns:
            found = [name for name in self.names if fits(pattern, name)]
            if not found:
                raise unknown_name("channel", pattern, self.names)
            chosen.update(dict.fromkeys(found))
        return list(chosen)

    def select(self, *patterns: str) -> dict[str, Array]:
        """Columns by name that fit one of the patterns, in which `*` stands for any run of characters: views."""
        return {name: self[name] for name in self._chosen(names_of(patterns))}

    def to_pandas(self, channels: str | Iterable[str] = "*") -> Any:
        """A pandas DataFrame of the channels that fit, index `time` [s]; attrs["units"] has their units."""
        try:
            pandas: Any = import_module("pandas")
        except ImportError as error:
            raise ImportError("to_pandas needs pandas: Debian has it as python3-pandas") from error
        chosen = [name for name in self._chosen(names_of(channels)) if name != "time"]
        frame = pandas.DataFrame({name: self[name] for name in chosen}, index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = {name: self.units[name] for name in ["time", *chosen]}
        return frame

    def to_xarray(self, channels: str | Iterable[str] = "*") -> Any:
        """An xarray Dataset of the channels that fit over `time` [s]: variables have attrs["units"], the set the summary."""
        try:
            xarray: Any = import_module("xarray")
        except ImportError as error:
            raise ImportError("to_xarray needs xarray: Debian has it as python3-xarray") from error
        chosen = [name for name in self._chosen(names_of(channels)) if name != "time"]
        variables = {name: ("time", self[name], {"units": self.units[name]}) for name in chosen}
        time = ("time", self.time, {"units": self.units["time"]})
        return xarray.Dataset(variables, coords={"time": time}, attrs={"summary": json.dumps(self.summary)})

    def save(self, out: str | os.PathLike[str], *, force: bool = False, format: str | None = None) -> pathlib.Path:
        """Writes a result directory with the bytes that the command line writes, and returns its path.

        out: the directory. force: write beside other files. format: csv, hdf5 or both (what the model says). A result that was opened
        is copied, every file as it stands; of its rows csv can be made where they are in hdf5.
        """
        if self.status == "unfinished" and self._directory is None:
            raise usage("save(): the simulation is not over: close() it before")
        if self._kept is None:
            raise usage("save(): a result that came from another process has its numbers alone: save it there")
        path = path_of("out", out)
        _core.save(self._kept, path, flag("force", force), format)
        return pathlib.Path(path)

    def report(self, path: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Writes the page of `freeplay report` and returns where it is.

        path: of the page, which may replace another page; without it report.html in the directory of the result.
        """
        if self._directory is not None:
            return pathlib.Path(_core.report(self._directory, "" if path is None else path_of("path", path)))
        if path is None:
            raise usage("report(): a result that was not written has no directory: say where the page is to be")
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            name = self.model.name if self.model is not None else "result"
            written = self.save(os.path.join(folder, name), format="hdf5")
            return pathlib.Path(_core.report(str(written), path_of("path", path)))


def result_of(kept: _core.KeptRun, model: Model, profiled: bool, directory: str | None) -> Result:
    result = Result(kept.layout(), kept.data(), kept.event_numbers(), kept.summary(), model, kept, directory)
    if profiled:
        result.profile = kept.profile()
    return result


def raise_failure(kept: _core.KeptRun, result: Result, raised: BaseException | None) -> None:
    """What ended the run before its end, as an exception with the rows up to there."""
    if raised is not None:
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(f"interrupted at {result.time[-1] if len(result.time) else 0.0:g} s", result) from None
        raise raised
    if kept.exit_code in (0, DISAGREE):
        return
    if kept.exit_code == Interrupted.exit_code:
        raise Interrupted(kept.reason, result)
    kinds: dict[int, tuple[type[NumericalError] | type[PluginError] | type[ResultError], str]] = {
        4: (NumericalError, "run-failed"), 5: (PluginError, "plugin-failed"), 6: (ResultError, "cannot-write")}
    kind, message_id = kinds.get(kept.exit_code, (NumericalError, "run-failed"))
    text = kept.reason + (" [cannot-write]" if kept.exit_code == 6 else "")
    error = kind(text, [Message(None, None, None, "error", message_id, kept.reason, None)], kept.exit_code)
    error.result = result
    raise error


def open(path: str | os.PathLike[str], *, channels: str | Iterable[str] = "*") -> Result:
    """The result of any run: its directory, CSV or HDF5 file, also one that goes on or was killed.

    path: of the result. channels: patterns of what is read; `time` [s] always is. Raises ResultError.
    """
    from ._model import model_of_result

    place = path_of("path", path)
    stored = _core.read(place, names_of(channels))
    summary = stored["summary"] if isinstance(stored["summary"], dict) else {}
    directory = stored["directory"] or None
    model = model_of_result(directory, summary) if directory else None
    return Result(stored, stored["data"], stored["event_numbers"], summary, model, stored["stored"],
                  os.path.abspath(directory or place))
