"""Many runs of one model, and numbers of runs as a function of parameters."""
from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from . import _core
from ._errors import Error, Interrupted, Message, refused, usage
from ._model import OF_LOAD, OF_RUN, Model, require_known
from ._result import Result
from ._source import OF_TEXT, Quantity, Source, build_options, count_of, place_of, plain, quantity
from ._table import Column, Table

if TYPE_CHECKING:
    from concurrent.futures import Executor

Reducer = Union["tuple[Any, ...]", Mapping[str, Any]]
Reduce = Union[Mapping[str, Reducer], Callable[[Result], Mapping[str, float]], None]
Points = Union[Mapping[str, Any], Iterable[Mapping[str, Quantity]], None]
Progress = Union[Callable[[int, int], Any], None]
SHORT = ("channel", "reduce", "from")
BEFORE_ALL = -1e300  # [s]
OWN_COLUMNS = ("index", "exit_code", "error")
ALONE = "value"  # the name of a reducer that has none


class Row(NamedTuple):
    """A point that has come to its end."""

    number: int
    cells: list[str]
    exit_code: int
    error: str
    message: str
    values: list[float]


class Done(NamedTuple):
    """Points with what the columns are; what ended them before the last one."""

    keys: list[tuple[str, str, bool]]
    columns: list[tuple[str, str]]
    rows: list[Row]
    raised: BaseException | None


def reducer(name: str, entry: Any) -> dict[str, Any]:
    """An entry of `study.reducers`, of which (channel, how, from [s]) is short; (channel, how) is of the whole run."""
    if isinstance(entry, Mapping):
        return dict(plain(entry, f"reduce.{name}"))
    if isinstance(entry, (tuple, list)) and 2 <= len(entry) <= len(SHORT):
        return dict(plain({"from": BEFORE_ALL, **dict(zip(SHORT, entry))}, f"reduce.{name}"))
    raise TypeError(f"reduce: {name}: (channel, how), (channel, how, from) or a mapping is needed, not {entry!r}")


def reducers_text(reduce: Mapping[str, Any]) -> str:
    if not isinstance(reduce, Mapping):
        raise TypeError(f"reduce: reducers by name, or a function of a Result, are needed, not {type(reduce).__name__}")
    if not reduce:
        raise usage("reduce: at least one reducer is needed")
    for name in reduce:
        if not isinstance(name, str):
            raise TypeError(f"reduce: names are texts, not {type(name).__name__}")
    return json.dumps({name: reducer(name, entry) for name, entry in reduce.items()}, indent=2, ensure_ascii=False) + "\n"


def value_text(name: str, value: Any) -> str:
    return quantity(name, value.item() if isinstance(value, np.generic) else value)


def listed(points: Mapping[str, Any] | Iterable[Mapping[str, Quantity]]) -> tuple[list[str], list[list[str]]]:
    """Targets, and a text for each at every point; "" where a point sets none."""
    if isinstance(points, Mapping):
        columns = {name: list(values) if not isinstance(values, str) and np.ndim(values) == 1 else None for name, values in points.items()}
        for name, column in columns.items():
            if not isinstance(name, str):
                raise TypeError(f"points: names are texts, not {type(name).__name__}")
            if column is None:
                raise TypeError(f"points: {name}: a list of values is needed")
        lengths = {len(column or []) for column in columns.values()}
        if len(lengths) > 1:
            raise usage("points: lists must be equally long: " + ", ".join(f"{name} has {len(column or [])}" for name, column in columns.items()))
        return list(columns), [[value_text(f"points: {name}", (column or [])[i]) for name, column in columns.items()]
                               for i in range(lengths.pop() if lengths else 0)]
    each = list(points)
    for point in each:
        if not isinstance(point, Mapping):
            raise TypeError(f"points: a mapping is needed for each, not {type(point).__name__}")
    targets = list(dict.fromkeys(name for point in each for name in point))
    return targets, [[value_text(f"points: {name}", point[name]) if name in point else "" for name in targets] for point in each]


def done_of(answer: tuple[dict[str, Any], BaseException | None], shift: int = 0) -> Done:
    report, raised = answer
    rows = [Row(number + shift, cells, exit_code, error, message, values) for number, cells, exit_code, error, message, values in report["rows"]]
    return Done(report["keys"], report["columns"], rows, raised)


def part_done(model: Model, reducers: str, targets: list[str], values: list[list[str]], shift: int) -> Done:
    """Some points in a worker of an executor."""
    return done_of(_core.map_points(model._core, reducers, targets, values, 1, None), shift)


def called(model: Model, reduce: Callable[[Result], Mapping[str, float]], targets: list[str], texts: list[str]) -> tuple[int, str, str, dict[str, float]]:
    """One point whose numbers a function takes, in a worker."""
    try:
        result = run_point(model, targets, texts)
    except Error as error:
        return failure_of(error)
    return 0, "", "", numbers_of(reduce, result)


def failure_of(error: Error) -> tuple[int, str, str, dict[str, float]]:
    first = next((message for message in error.messages if message.severity == "error"), None)
    exit_code = 3 if error.exit_code == 2 else error.exit_code  # what a call would refuse is a mistake of the point here
    return exit_code, first.id if first else "", first.message if first else str(error), {}


def numbers_of(reduce: Callable[[Result], Mapping[str, float]], result: Result) -> dict[str, float]:
    """What a function of the caller takes of a run."""
    found = reduce(result)
    if not isinstance(found, Mapping):
        raise TypeError(f"reduce: the function is to return a mapping of names to numbers, not {type(found).__name__}")
    for name, value in found.items():
        if not isinstance(name, str) or not name or not name.isprintable() or set(name) & set(',"'):
            raise TypeError(f"reduce: {name!r} cannot be the name of a column")
        if isinstance(value, str) or np.ndim(value) != 0:
            raise TypeError(f"reduce: {name}: the function is to return a number, not {type(value).__name__}")
    return {name: float(value) for name, value in found.items()}


def run_point(model: Model, targets: Sequence[str], texts: Sequence[str], progress: Callable[..., None] | None = None) -> Result:
    from ._model import quiet_run

    own = {name: text for name, text in zip(targets, texts) if text}
    return quiet_run(model.replace(set={**(model._options.get("set") or {}), **own}), progress)


def in_order(pool: Executor, model: Model, targets: list[str], values: list[list[str]]) -> Iterator[Any]:
    """Results of runs, or what was raised instead, in the order of the points; no more runs begin than are taken soon."""
    from collections import deque
    from threading import Event

    waiting: Any = deque()
    over = Event()

    def go_on(*_: Any) -> None:
        if over.is_set():
            raise KeyboardInterrupt  # the caller was; runs in threads hear no signal
    ahead = 2 * (getattr(pool, "_max_workers", None) or 1)
    try:
        for texts in values:
            waiting.append(pool.submit(run_point, model, targets, texts, go_on))
            if len(waiting) >= ahead:
                yield waiting.popleft()
        while waiting:
            yield waiting.popleft()
    finally:
        over.set()
        for future in waiting:
            future.cancel()


def by_function(model: Model, reduce: Callable[[Result], Mapping[str, float]], targets: list[str], values: list[list[str]], workers: int,
                executor: Executor | None, progress: Progress) -> Done:
    taken: list[tuple[int, str, str, dict[str, float]]] = []
    raised: BaseException | None = None

    def take(one: tuple[int, str, str, dict[str, float]]) -> None:
        taken.append(one)
        if progress is not None:
            progress(len(taken), len(values))
    try:
        if executor is not None:
            count = len(values)
            for one in executor.map(called, [model] * count, [reduce] * count, [targets] * count, values):
                take(one)
        else:
            from concurrent.futures import ThreadPoolExecutor

            with ThreadPoolExecutor(workers) as pool:
                for future in in_order(pool, model, targets, values):
                    try:
                        result = future.result()
                    except Error as error:
                        take(failure_of(error))
                    else:
                        take((0, "", "", numbers_of(reduce, result)))
    except KeyboardInterrupt as error:
        raised = error
    names = list(dict.fromkeys(name for one in taken for name in one[3]))
    for name in names:
        if name in (*targets, *OWN_COLUMNS):
            raise usage(f"reduce: '{name}' is a column already", message_id="duplicate-name")
    shown = _core.cells(values)
    rows = [Row(i, shown[i], *one[:3], [one[3].get(name, float("nan")) for name in names]) for i, one in enumerate(taken)]
    return Done([(name, _core.unit_of(model._core, name), False) for name in targets], [(name, "") for name in names], rows, raised)


def by_executor(model: Model, reducers: str, targets: list[str], values: list[list[str]], executor: Executor, progress: Progress) -> Done:
    workers = getattr(executor, "_max_workers", None) or 1
    size = max(1, len(values) // (4 * workers))
    starts = range(0, len(values), size)
    count = len(starts)
    whole = done_of(_core.map_points(model._core, reducers, targets, [], 1, None))
    raised: BaseException | None = None
    try:
        for part in executor.map(part_done, [model] * count, [reducers] * count, [targets] * count,
                                 [values[start:start + size] for start in starts], list(starts)):
            whole.rows.extend(part.rows)
            if progress is not None:
                progress(len(whole.rows), len(values))
    except KeyboardInterrupt as error:
        raised = error
    return whole._replace(raised=raised)


def cell(words: bool, text: str) -> float | str:
    if words:
        return text
    return float(text) if text else float("nan")


def is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return not text
    return True


def table_of(done: Done) -> Table:
    """The table of study.csv, with its bytes."""
    columns: dict[str, list[float | str]] = {"index": [float(row.number) for row in done.rows]}
    units = {"index": "1"}
    for place, (name, unit, words) in enumerate(done.keys):
        texts = [row.cells[place] for row in done.rows]
        words = words or not all(is_number(text) for text in texts)
        columns[name] = [cell(words, text) for text in texts]
        units[name] = "" if words else unit
    for place, (name, unit) in enumerate(done.columns):
        columns[name] = [row.values[place] for row in done.rows]
        units[name] = unit
    columns["exit_code"] = [float(row.exit_code) for row in done.rows]
    columns["error"] = [row.error for row in done.rows]
    units.update({"exit_code": "1", "error": ""})
    lines = [",".join(columns)]
    for row in done.rows:
        lines.append(",".join([str(row.number), *row.cells, *(_core.number_text(value) for value in row.values), str(row.exit_code), row.error]))
    failed = sum(row.exit_code != 0 for row in done.rows)
    return Table("study", columns, units, {"points": len(done.rows), "failed": failed}, csv="\n".join(lines) + "\n")


def raise_first(done: Done, model: Model | None, targets: list[str], values: list[list[str]]) -> None:
    """What the first point that failed would raise by itself."""
    for row in done.rows:
        if row.exit_code == 0:
            continue
        if model is not None and row.exit_code != 4:
            run_point(model, targets, values[row.number])
        raise refused(row.exit_code, [Message(None, None, None, "error", row.error, row.message, None)._asdict()],
                      f"point {row.number}: {row.message} [{row.error}]")


def model_of(source: Source | Model, options: Mapping[str, Any]) -> Model:
    require_known(options, (*OF_LOAD, *OF_RUN))
    given = {name: value for name, value in options.items() if value is not None}
    if isinstance(source, Model):
        return source.replace(**given) if given else source._here()
    return Model(place_of(source, options.get("folder")), given)


def counted(progress: Progress) -> Progress:
    """The core counts in floats."""
    if progress is None:
        return None
    called_with = progress
    return lambda done, points: called_with(int(done), points)


def study_of(source: Source | Model, reduce: Mapping[str, Any] | None, workers: int, progress: Progress, options: Mapping[str, Any]) -> Done:
    """The points of the section `study` of a file."""
    if isinstance(source, Model):
        place, given = source._here()._place, {**source._options, **{name: value for name, value in options.items() if value is not None}}
    else:
        place, given = place_of(source, options.get("folder")), dict(options)
    if os.path.basename(place["file"]) == OF_TEXT:
        raise usage("map() without points: the section `study` is read from a file; save() the model before")
    reducers = "" if reduce is None else reducers_text(reduce)
    return done_of(_core.map_study({"file": place["file"], **build_options(given)}, reducers, workers, counted(progress)))


def computed(source: Source | Model, points: Points, reduce: Reduce, workers: int | None, executor: Executor | None, progress: Progress,
             errors: str, options: Mapping[str, Any]) -> Done:
    if errors not in ("keep", "raise"):
        raise usage(f"bad value '{errors}' of errors: it must be keep or raise", message_id="bad-value")
    threads = _core.processor_count() if workers is None else count_of("workers", workers)
    if executor is not None and (isinstance(executor, type) or not callable(getattr(executor, "map", None))):
        raise TypeError(f"executor: an Executor as in concurrent.futures is needed, not {executor if isinstance(executor, type) else type(executor).__name__}")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: a function of the points done and of all is needed, not {type(progress).__name__}")
    if points is None:
        if executor is not None or callable(reduce):
            raise usage("map() without points: an executor, or a function that takes the numbers, needs points")
        done = study_of(source, reduce, threads, progress, options)
        if errors == "raise":
            raise_first(done, None, [], [])
        return done
    if reduce is None:
        raise usage("map() with points: reduce says what is kept of each")
    model = model_of(source, options)
    targets, values = listed(points)
    try:
        if callable(reduce):
            done = by_function(model, reduce, targets, values, threads, executor, progress)
        elif executor is not None:
            done = by_executor(model, reducers_text(reduce), targets, values, executor, progress)
        else:
            done = done_of(_core.map_points(model._core, reducers_text(reduce), targets, values, threads, counted(progress)))
    except Error as error:
        raise model._named(error) from None
    if done.raised is None and errors == "raise":
        raise_first(done, model, targets, values)
    return done


def raise_interrupted(done: Done) -> None:
    if done.raised is None:
        return
    if not isinstance(done.raised, KeyboardInterrupt):
        raise done.raised
    raise Interrupted(f"interrupted after {len(done.rows)} points", table=table_of(done)) from None


def map(source: Source | Model, points: Points = None, *, reduce: Reduce = None, workers: int | None = None, executor: Executor | None = None,
        progress: Progress = None, errors: str = "keep", set: Mapping[str, Quantity] | None = None, ideal: str | Iterable[str] | None = None,
        end: Quantity | None = None, step: Quantity | None = None, accuracy: Quantity | None = None, integrator: str | None = None,
        plugins: Iterable[str] | None = None, strict: bool | None = None, folder: str | os.PathLike[str] | None = None,
        allow_plugins: bool | None = None) -> Table:
    """Runs a model at many points; the table has the columns and the bytes of study.csv, whatever the workers.

    source: as in load(), or a Model. points: equally long lists of values by target, or a mapping for each point; a target is a parameter or a
    path, a value a number in SI or a text. None: the section `study` of the file.
    reduce: what is kept of each, by name: (channel, how) of the whole run, (channel, how, from [s]) or an entry of `study.reducers`; or a function of each
    Result, called in order. None: that of the file. workers: threads. executor: where the points run instead.
    progress: a function of the points done and of all. errors: "keep" has NaN, exit code and id of points that fail, "raise" raises the first.
    set, ideal, end [s], step [s], accuracy [m per s], integrator, plugins, strict, folder, allow_plugins: as in load().

    Raises what load() raises; Interrupted with .table, what was done.
    """
    done = computed(source, points, reduce, workers, executor, progress, errors,
                    {"set": set, "ideal": ideal, "end": end, "step": step, "accuracy": accuracy, "integrator": integrator, "plugins": plugins,
                     "strict": strict, "folder": folder, "allow_plugins": allow_plugins})
    raise_interrupted(done)
    return table_of(done)


class Function:
    """Numbers of runs as a function of parameters: `f(x)` of one point, `f.sample(x)` of many.

    source: as in load(), or a Model. inputs: targets, a parameter or path for each number of x, in SI. outputs: one reducer, (channel, how), for
    a float, or reducers by name for an array. workers: threads of sample(). errors: "raise", or "nan" where a run fails.
    Other keywords are those of load(): set, ideal, end [s], step [s], accuracy [m per s], integrator, plugins, strict, folder.
    """

    def __init__(self, source: Source | Model, inputs: Sequence[str], outputs: Reducer | Mapping[str, Reducer], *, workers: int | None = None,
                 errors: str = "raise", **options_of_load: Any) -> None:
        if errors not in ("raise", "nan"):
            raise usage(f"bad value '{errors}' of errors: it must be raise or nan", message_id="bad-value")
        if isinstance(inputs, str) or not all(isinstance(name, str) for name in inputs):
            raise TypeError("inputs: a list of names is needed")
        self.inputs: tuple[str, ...] = tuple(inputs)
        if not self.inputs:
            raise usage("inputs: at least one name is needed")
        if len(set(self.inputs)) < len(self.inputs):
            raise usage("inputs: a name stands there twice", message_id="duplicate-name")
        self.alone: bool = not isinstance(outputs, Mapping) or any(not isinstance(entry, (Mapping, tuple, list)) for entry in outputs.values())
        self.outputs: dict[str, Any] = {ALONE: outputs} if self.alone else dict(outputs)
        self._model = model_of(source, options_of_load)
        self._workers, self._errors = workers, errors
        self._values([])  # for the mistakes in names

    def __call__(self, x: Any) -> Any:
        """The number at one point, a float; an array of them, (m,), where outputs have names. x: (n,), in SI."""
        point = np.asarray(x, dtype=float)
        if point.shape != (len(self.inputs),):
            raise usage(f"x has the shape {point.shape}, ({len(self.inputs)},) is needed", message_id="bad-value")
        values = self._values(point[None, :])[0]
        return float(values[0]) if self.alone else values

    def sample(self, x: Any) -> Column:
        """The numbers at many points on all workers, (N, m). x: (N, n), in SI."""
        points = np.asarray(x, dtype=float)
        if points.ndim != 2 or points.shape[1] != len(self.inputs):
            raise usage(f"x has the shape {points.shape}, (N, {len(self.inputs)}) is needed", message_id="bad-value")
        return self._values(points)

    def _values(self, points: Any) -> Column:
        listed_points = {name: [float(point[i]) for point in points] for i, name in enumerate(self.inputs)}
        done = computed(self._model, listed_points, self.outputs, self._workers, None, None, "raise" if self._errors == "raise" else "keep", {})
        raise_interrupted(done)
        values = np.full((len(points), len(done.columns)), np.nan)
        for row in done.rows:
            values[row.number] = row.values
        return values
