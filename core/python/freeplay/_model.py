"""Models: a text that was read and checked."""
from __future__ import annotations

import os
import warnings
from typing import Any, Callable, Iterable, Mapping, NamedTuple, Sequence, TypeVar, Union

from . import _core, _html
from ._analyses import analyse
from ._errors import Error, Message, ModelWarning, message_of, usage
from ._result import Result, raise_failure, result_of
from ._source import Quantity, Source, build_options, count_of, filled, flag, kept_options, path_of, place_of, quantity, remark, renamed, shown_name
from ._simulation import Simulation
from ._table import Table

Progress = Union[bool, Callable[[float, float, int], None], None]
OF_LOAD = ("set", "ideal", "end", "step", "accuracy", "integrator", "plugins", "strict", "folder", "allow_plugins")
OF_RUN = ("interval", "channels", "format")
OF_RUN_ALONE = ("verify", "repeat", "seed", "twin", "report", "checkpoint", "inputs")
OF_CALL = ("out", "force", "yes", "profile", "progress", *OF_RUN_ALONE)


Answer = TypeVar("Answer")


class Channel(NamedTuple):
    """A column of results: its name and its SI unit."""

    name: str
    unit: str


class Model:
    """A model that was read and checked. Nothing of it changes: any thread may use it.

    name, file, text: of the model. space: planar or spatial. bodies, joints, drivers, inputs: names in the order of the file.
    parameters: values in SI, after `set`. channels: what a run records. warnings: messages of the file.
    """

    def __init__(self, place: Mapping[str, Any], options: Mapping[str, Any]) -> None:
        self._options = kept_options(options)
        self._place = {name: value for name, value in place.items() if name != "shown"}
        self._shown: str = place.get("shown") or shown_name(place["file"], self._options.get("folder"))
        self._home = present_folder()
        try:
            self._core = _core.open_model({**self._place, **build_options(self._options)})
        except Error as error:
            raise self._named(error) from None
        known = self._known = self._core.known()
        self.name: str = known["name"]
        self.file: str = self._shown if known["file"] == self._place["file"] else known["file"]
        self.text: str = known["text"].decode("utf-8", "replace")
        self.space: str = known["space"]
        self.bodies: tuple[str, ...] = known["bodies"]
        self.joints: tuple[str, ...] = known["joints"]
        self.drivers: tuple[str, ...] = known["drivers"]
        self.inputs: tuple[str, ...] = tuple(name for name, _ in known["inputs"])
        self.parameters: dict[str, float] = dict(known["parameters"])
        self.channels: tuple[Channel, ...] = tuple(Channel(*one) for one in known["channels"])
        messages = [message_of(fields) for fields in known["messages"]]
        self.warnings: tuple[Message, ...] = tuple(
            [one._replace(file=self.file) if one.file == self._place["file"] else one for one in messages] + [remark(text) for text in known["remarks"]])

    def __reduce__(self) -> tuple[Any, ...]:
        return Model, (self._same_text(), self._options)

    def _same_text(self) -> dict[str, Any]:
        """Where the model is from, whatever its file and the present folder have become."""
        place = {**self._place, "file": os.path.join(self._home, self._place["file"]), "shown": self._shown}
        return place if self.file.endswith((".urdf", ".sdf", ".xml")) else {**place, "text": self._known["text"]}

    def _here(self) -> Model:
        """The model for work that reads its tables again: where the present folder is another now, with a path from the root."""
        return self if os.path.isabs(self._place["file"]) or present_folder() == self._home else self.replace()

    def _named(self, error: Error) -> Error:
        return renamed(error, self._place["file"], self._shown)

    def __repr__(self) -> str:
        return f"<freeplay.Model '{self.name}', {self.space}, {len(self.bodies)} bodies>"

    def replace(self, **options_of_load: Any) -> Model:
        """The same text with these options of load() changed; None takes one back."""
        require_known(options_of_load, (*OF_LOAD, *OF_RUN))
        options = {**self._options, **options_of_load}
        for one, other in (("step", "accuracy"), ("accuracy", "step")):
            if options_of_load.get(one) is not None and other not in options_of_load:
                options[other] = None  # each takes the place of the other
        return Model(self._same_text(), options)

    def facts(self) -> dict[str, Any]:
        """Counts, rank and freedoms, as `facts` of `freeplay validate --json`. Raises ModelError where it cannot be assembled."""
        return self._told(self._core.facts)

    def start(self) -> dict[str, dict[str, float]]:
        """The assembled pose of every body [m, rad], as `start` of `freeplay validate --json`."""
        return self._told(self._core.start)

    def tree(self) -> dict[str, Any]:
        """The model after everything in it is expanded, in SI: `freeplay show --format json`."""
        return self._told(self._core.tree)

    def svg(self) -> str:
        """A drawing of the start: `freeplay show --format svg`."""
        return self._told(self._core.svg)

    def _told(self, question: Callable[[], Answer]) -> Answer:
        try:
            return question()
        except Error as error:
            raise self._named(error) from None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes `text` to `path`. Options such as `set` are not in it."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self.text)

    def run(self, **options_of_run: Any) -> Result:
        """Runs to the end: see freeplay.run() for the options and what it raises."""
        return run_model(self, options_of_run)

    def simulation(self, **options_of_run: Any) -> Simulation:
        """A run step by step, at its start: the options are those of freeplay.run() but verify, twin, repeat, seed, report and inputs.

        checkpoint: what Simulation.checkpoint() of the same model gave: it goes on from there. `out` does not go with it.
        """
        return Simulation(self, **options_of_run)

    def ik(self, *, frame: str | None = None, pose: Any = None, grid: Any = None, time: Any = None, input: Any = None, elbow: Any = None,
           branches: bool = False, force: bool = False) -> Table:
        """Drive coordinates for poses of the platform.

        frame: the platform. pose [m, rad], grid {axis: (from, to, count)}, time (from, to, count) [s] or input {joint: value}: where.
        elbow: working modes of the legs, 1 or -1. branches: all working modes of a pose.
        force: save() of the table replaces any file.
        """
        return self._analysed("ik", force, False, frame=frame, pose=pose, grid=grid, time=time, input=input, elbow=elbow, branches=branches)

    def workspace(self, *, frame: str | None = None, pose: Any = None, grid: Any = None, time: Any = None, elbow: Any = None,
                  colours: bool = False, force: bool = False) -> Table:
        """What is reachable, and how well conditioned.

        frame: the platform. pose [m, rad], grid {axis: (from, to, count)} or time (from, to, count) [s]: where. elbow: working modes.
        colours: of the map that svg() of the table draws, in place of greys. force: as in ik().
        """
        return self._analysed("workspace", force, colours, frame=frame, pose=pose, grid=grid, time=time, elbow=elbow)

    def singularity(self, *, frame: str | None = None, pose: Any = None, grid: Any = None, time: Any = None, input: Any = None,
                    elbow: Any = None, colours: bool = False, force: bool = False) -> Table:
        """How near poses are to singular ones. The arguments are those of ik() and workspace()."""
        return self._analysed("singularity", force, colours, frame=frame, pose=pose, grid=grid, time=time, input=input, elbow=elbow)

    def error(self, *, frame: str | None = None, pose: Any = None, grid: Any = None, time: Any = None, input: Any = None, elbow: Any = None,
              sensitivity: bool = False, samples: int | None = None, seed: int | None = None, distribution: str | None = None, colours: bool = False,
              force: bool = False) -> Table:
        """Largest position errors by clearance [m, rad]. Where: as in ik(); colours, force: as in workspace().

        sensitivity: a column for each joint. samples, seed, distribution: columns of random play.
        """
        return self._analysed("error", force, colours, frame=frame, pose=pose, grid=grid, time=time, input=input, elbow=elbow, sensitivity=sensitivity,
                              samples=samples, seed=seed, distribution=distribution)

    def inverse_dynamics(self, *, frame: str | None = None, pose: Any = None, grid: Any = None, time: Any = None, input: Any = None,
                         elbow: Any = None, preload: Quantity | None = None, force: bool = False) -> Table:
        """Efforts of the drivers [N, N m] and forces of the joints along the path. Where: as in ik(). preload: inner tension of redundant drivers."""
        return self._analysed("inverse-dynamics", force, False, frame=frame, pose=pose, grid=grid, time=time, input=input, elbow=elbow, preload=preload)

    def _analysed(self, kind: str, force: bool, colours: bool, **options: Any) -> Table:
        model = self._here()
        try:
            return analyse(model, kind, options, force, colours)
        except Error as error:
            raise model._named(error) from None

    def _repr_svg_(self) -> str:
        return self.svg()

    def _repr_html_(self) -> str:
        return _html.page(f"{self.name}: {self.space}", _html.drawing(self.svg()), _html.table((), _html.pairs(self.facts())))


def present_folder() -> str:
    try:
        return os.getcwd()
    except OSError:
        return ""  # it is no more


def require_known(options: Mapping[str, Any], known: Iterable[str]) -> None:
    for name in options:
        if name not in known:
            raise TypeError(f"there is no option '{name}'")


def require_model(model: object) -> None:
    if not isinstance(model, Model):
        raise TypeError(f"a Model is needed, as load() gives it, not {type(model).__name__}")


def warn(texts: Iterable[str], level: int) -> None:
    for text in texts:
        warnings.warn(text, ModelWarning, stacklevel=level)


def load(source: Source, *, set: Mapping[str, Quantity] | None = None, ideal: str | Iterable[str] = (), end: Quantity | None = None,
         step: Quantity | None = None, accuracy: Quantity | None = None, integrator: str | None = None, plugins: Iterable[str] = (),
         strict: bool = False, folder: str | os.PathLike[str] | None = None, allow_plugins: bool = False) -> Model:
    """Reads and checks a model.

    source: a path (.yaml, .yml, .urdf, .sdf, .xml), a YAML text with a line feed, or the YAML tree as a mapping.
    set: values by parameter or path, numbers in SI or texts such as "0.2 mm". ideal: joints whose clearance is closed, a name, pattern or "all".
    end: end time [s]. step: step [s]. accuracy: of positions instead of a step [m per s]. integrator: its name.
    plugins: libraries to load besides. strict: warnings are errors. folder: where paths of a text or mapping count from (the present one).
    allow_plugins: run the code of libraries that the model names, wherever they lie.

    Raises ModelError with all messages of the file, UsageError, PluginError; gives warnings as ModelWarning.
    """
    model = Model(place_of(source, folder), {"set": set, "ideal": ideal, "end": end, "step": step, "accuracy": accuracy, "integrator": integrator,
                                             "plugins": plugins, "strict": strict, "folder": folder, "allow_plugins": allow_plugins})
    warn([one.message for one in model.warnings], 3)
    return model


def check(source: Source, *, set: Mapping[str, Quantity] | None = None, ideal: str | Iterable[str] = (), end: Quantity | None = None,
          step: Quantity | None = None, accuracy: Quantity | None = None, integrator: str | None = None, plugins: Iterable[str] = (),
          strict: bool = False, folder: str | os.PathLike[str] | None = None, allow_plugins: bool = False) -> list[Message]:
    """All messages of a model, an empty list for a good one. The arguments are those of load(); raises UsageError alone."""
    options = {"set": set, "ideal": ideal, "end": end, "step": step, "accuracy": accuracy, "integrator": integrator, "plugins": plugins,
               "strict": strict, "allow_plugins": allow_plugins}
    place = place_of(source, folder)
    messages = [message_of(fields) for fields in _core.check_model({**place, **build_options(options)})]
    return [one._replace(file=shown_name(one.file, folder)) if one.file == place["file"] else one for one in messages]


def run(source: Source | Model, *, out: str | os.PathLike[str] | None = None, force: bool = False, format: str | None = None,
        verify: bool = False, profile: bool = False, channels: str | Iterable[str] | None = None, progress: Progress = None,
        interval: Quantity | None = None, checkpoint: Quantity | None = None, twin: bool = False, report: bool = False,
        repeat: int | None = None, seed: int | None = None, yes: bool = False, inputs: str | os.PathLike[str] | None = None, set: Mapping[str, Quantity] | None = None,
        ideal: str | Iterable[str] | None = None, end: Quantity | None = None, step: Quantity | None = None, accuracy: Quantity | None = None,
        integrator: str | None = None, plugins: Iterable[str] | None = None, strict: bool | None = None,
        folder: str | os.PathLike[str] | None = None, allow_plugins: bool | None = None) -> Result:
    """Simulates a model; the numbers are those of `freeplay run`, bit for bit.

    source: as in load(), or a Model. out: result directory; without it nothing is written. force: write beside other files.
    format: of the files, csv, hdf5 or both. profile: count where the time goes. channels: patterns of what is kept and written.
    verify: run again by a method of another kind; the summary and warnings say how far both agree. twin: run the model with every
    clearance closed, too, into the folder twin of `out`; summary["twin"] says how far both are apart. repeat: how many runs, from starts
    moved in the play, that `seed` chooses (1); summary["repeat"] has their peaks. report: write report.html into `out`.
    checkpoint: wall time between checkpoints of `out`, from which resume() goes on [s] (10); 0: when it is interrupted.
    progress: True prints how far it is; a function gets time [s], end [s] and steps, and what it raises ends the run.
    interval: between rows [s]. inputs: a table of efforts over time, inputs.csv of another run. yes: no question is put in any case.
    set, ideal, end [s], step [s], accuracy [m per s], integrator, plugins, strict, folder, allow_plugins: as in load().

    Raises what load() raises; NumericalError and Interrupted with .result, all rows up to the last accepted step; ResultError.
    """
    given: dict[str, Any] = {"set": set, "ideal": ideal, "end": end, "step": step, "accuracy": accuracy, "integrator": integrator,
                             "plugins": plugins, "strict": strict, "folder": folder, "allow_plugins": allow_plugins, "interval": interval,
                             "channels": channels, "format": format}
    called: dict[str, Any] = {"out": out, "force": force, "profile": profile, "progress": progress, "verify": verify, "twin": twin,
                              "report": report, "repeat": repeat, "seed": seed, "checkpoint": checkpoint, "inputs": inputs}
    options = {name: value for name, value in {**given, **called}.items() if value is not None}
    if isinstance(source, Model):
        return run_model(source, options)
    load_options = {name: value for name, value in options.items() if name in (*OF_LOAD, *OF_RUN)}
    model = Model(place_of(source, folder), load_options)
    return run_model(model, {name: value for name, value in options.items() if name in OF_CALL})


class Call(NamedTuple):
    """What runs, and what the core needs to know of how."""

    model: Model
    directory: str | None
    profiled: bool
    words: tuple[Any, ...]


def call_of(model: Model, options: Mapping[str, Any], name: str) -> Call:
    require_known(options, (*OF_LOAD, *OF_RUN, *OF_CALL))
    changes = {name: value for name, value in options.items() if name in (*OF_LOAD, *OF_RUN) and value is not None}
    if changes:
        model = model.replace(**changes)
    profiled = flag("profile", options.get("profile"))
    words: dict[str, Any] = {"call": name, "profile": profiled, "force": flag("force", options.get("force"))}
    words.update((name, flag(name, options.get(name))) for name in ("verify", "twin", "report"))
    words.update((count, str(count_of(count, options[count], least))) for count, least in (("repeat", 2), ("seed", 0))
                 if options.get(count) is not None)
    if options.get("checkpoint") is not None:
        words["checkpoint"] = filled("checkpoint", quantity("checkpoint", options["checkpoint"]))
    words.update((path, filled(path, path_of(path, options[path]))) for path in ("out", "inputs") if options.get(path) is not None)
    if words["report"] and "out" not in words:
        raise usage("--report needs --out, the directory in which the page is to be")
    progress = progress_of(options.get("progress"), (float(model._known["end"]),))
    return Call(model, os.path.abspath(words["out"]) if "out" in words else None, profiled, (model._core, words, progress))


def run_model(model: Model, options: Mapping[str, Any]) -> Result:
    call = call_of(model, options, "freeplay.run()")
    try:
        kept, raised = _core.run(*call.words)
    except Error as error:
        raise call.model._named(error) from None
    result = result_of(kept, call.model, call.profiled, call.directory)
    warn(result.warnings, 4)
    raise_failure(kept, result, raised)
    return result


def quiet_run(model: Model, progress: Callable[..., None] | None = None) -> Result:
    """A run without warnings of Python, which a worker has no one to give to."""
    call = call_of(model, {"progress": progress}, "freeplay.map()")
    kept, raised = _core.run(*call.words)
    result = result_of(kept, call.model, False, None)
    raise_failure(kept, result, raised)
    return result


def begin(model: Model, options: Mapping[str, Any]) -> tuple[Model, _core.SteppedRun, str | None, bool]:
    state = options.get("checkpoint")
    if state is not None and not isinstance(state, (bytes, bytearray, memoryview)):
        raise TypeError(f"checkpoint: bytes of Simulation.checkpoint() are needed, not {type(state).__name__}")
    options = {name: value for name, value in options.items() if name != "checkpoint"}
    if state is not None and options.get("out") is not None:
        raise usage("simulation(): out and checkpoint exclude each other: result().save() writes all rows at its end")
    for name in OF_RUN_ALONE:
        if options.get(name) not in (None, False):
            raise usage("simulation(): inputs are set by set(); run() takes a table of them" if name == "inputs" else
                        f"simulation(): --{name} is of a whole run: run() takes it")
    call = call_of(model, options, "freeplay.Simulation()")
    if state is not None:
        call.words[1]["state"] = bytes(state)
    if call.directory is not None:
        call.words[1]["out"] = call.directory  # the present folder may be another at the end
    try:
        return call.model, _core.begin(*call.words), call.directory, call.profiled
    except Error as error:
        raise call.model._named(error) from None


def progress_of(progress: Progress, end: Sequence[float]) -> Callable[[float, int], None] | None:
    """What the core calls. `end` has the end of the run [s] by then."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return lambda time, steps: print(f"{time:g} s of {end[0]:g} s, {steps} steps", flush=True)
    if not callable(progress):
        raise TypeError(f"progress: True or a function of time [s], end [s] and steps is needed, not {type(progress).__name__}")
    called = progress

    def tick(time: float, steps: int) -> None:
        called(time, end[0], steps)
    return tick


def model_of_result(directory: str, summary: Mapping[str, Any]) -> Model | None:
    """The model that stands in a result, as it ran; None where it has none that can be read."""
    settings = summary.get("settings") or {}
    for name in ("model.yaml", "model.urdf", "model.sdf", "model.xml"):
        path = os.path.join(directory, name)
        if not os.path.exists(path):
            continue
        try:
            return Model({"file": path}, {"set": dict(settings.get("set") or {}), "ideal": list(settings.get("ideal") or ())})
        except Error:
            return None
    return None
