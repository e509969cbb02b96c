"""The mechanisms that are timed: model, window of time, what is compared, steps and accuracies that are tried."""
import dataclasses
import os
import re

from timing import Failed

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FIXED = ("bathe", "newmark", "hht", "generalized-alpha")  # take steps of one size, or steps that the error chooses
ADAPTIVE = ("dopri5", "verner6", "verner7", "arkode")     # always choose them


@dataclasses.dataclass(frozen=True)
class Problem:
    name: str
    model: str             # below mechanisms/
    end: float             # [s]
    points: tuple          # channels whose distance from the reference is the error [m]
    target: float          # error at which times are compared [m]
    steps: tuple           # [s]
    accuracies: tuple      # [m]
    set: tuple = ()
    best: float = 1e-12    # accuracy of the program's own reference [m]
    trajectory: str = ""   # file of stored trajectories, where a folder with them is given
    columns: tuple = ()    # of it, for `points`
    hand: str = ""         # name at the hand-written programs
    hand_options: tuple = ()
    between: tuple = ()    # further accuracies of those that always choose their steps: close to the target
    once: bool = False     # each integrator once, with its own kind of step, and the run that tells the error is timed
    timed_interval: str = ""  # of rows of runs that are timed, where the model asks for more that only the error needs
    timed_end: float = 0.0    # of runs that are timed, where the programs by hand are timed over more than the window of the error [s]

    def file(self):
        return os.path.join(ROOT, "mechanisms", self.model + ".yaml")

    def timed_file(self, folder):
        return with_interval(folder, self.model, self.timed_interval) if self.timed_interval else self.file()

    def rate(self, bench, timed, options):
        """Seconds for each second of the motion, over the time for which programs by hand tell theirs."""
        place, end = options.index("--end") + 1, self.timed_end or self.end
        return bench.repeated.seconds(timed, [*options[:place], repr(end), *options[place + 1:]]) / end

    def options(self, *more):
        words = ["--end", repr(self.end)]
        for value in self.set:
            words += ["--set", value]
        return words + list(more)

    def candidates(self, integrators, quick):
        """(integrator, kind, value, options) of every run of the comparison."""
        for name in integrators:
            if name not in ADAPTIVE:
                for step in self.steps[:2] if quick else self.steps:
                    yield name, "step", step, self.options("--integrator", name, "--step", repr(step))
            if self.once and name not in ADAPTIVE:
                continue
            # What is of second order does not go as far.
            accuracies = sorted(self.accuracies + self.between, reverse=True) if name in ADAPTIVE else self.accuracies[:5]
            for accuracy in accuracies[:2] if quick else accuracies:
                yield name, "accuracy", accuracy, self.options("--integrator", name, "--accuracy", repr(accuracy))


def with_interval(folder, model, interval):
    """A copy of a model with another interval of rows."""
    with open(os.path.join(ROOT, "mechanisms", model + ".yaml"), encoding="utf-8") as file:
        text, count = re.subn(r"interval: [^,}]+", "interval: " + interval, file.read())
    if count != 1:
        raise Failed("mechanisms/%s.yaml does not hold an 'interval: ' once" % model)
    path = os.path.join(folder, "models", "%s-%s.yaml" % (os.path.basename(model), interval.replace(" ", "")))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


PLATFORM = ("body.platform.x", "body.platform.y")
CONTACT = ("platform_x", "platform_y")


def four_bar(n):
    return Problem("four-bar-%d" % n, "validation/a02-chain", 1.0, ("frame.column1.link/top.x", "frame.column1.link/top.y"),
                   1e-4, (2e-2, 1e-2, 5e-3, 2e-3, 1e-3), (1e-2, 1e-3, 1e-4), ("windows=%d" % n,), best=1e-9,
                   between=(1e-1, 5e-2, 4e-2, 3e-2, 2e-2, 5e-3, 1.5e-3),
                   trajectory="p2_fourbar_n%d.csv" % n, columns=("B0_x", "B0_y"), hand="p2", hand_options=("--n", str(n)), timed_end=10.0)


def long_four_bar(n):
    return dataclasses.replace(four_bar(n), steps=(2e-3 if n < 10000 else 1e-2,), accuracies=(1e-1,), between=(), best=1e-6, once=True, hand="", timed_end=0.0)


PROBLEMS = {
    "slider-crank": Problem(
        "slider-crank", "slider-crank", 8e-3, ("body.slider.x", "body.slider.y"), 1e-6,
        (2e-6, 1e-6, 5e-7, 2e-7, 1e-7, 5e-8), (1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8),
        between=(5e-4, 4.5e-4, 4e-4, 3.5e-4, 3e-4, 2.5e-4, 2e-4, 1.5e-4, 7e-5, 5e-5, 3e-5, 2e-5, 5e-6), best=1e-13, timed_interval="1 ms",
        trajectory="p1_slider_crank_c500_mu000.csv", columns=("slider_x", "slider_y"), hand="p1",
        hand_options=("--window", "0.008", "--horizon", "0.008", "--sample", "2e-5")),
    "3-rrr": Problem(
        "3-rrr", "3-rrr", 20e-3, PLATFORM, 1e-6, (1e-5, 5e-6, 4e-6, 2e-6, 1e-6),
        (5e-4, 2e-4, 1e-4, 1e-5, 1e-6, 1e-7),
        between=(2e-3, 1e-3, 3e-4, 5e-5, 2e-5), timed_interval="1 ms", trajectory="p3_3rrr_c100_mu100.csv", columns=CONTACT, hand="p3",
        hand_options=("--window", "0.02", "--horizon", "0.02", "--sample", "1e-4")),
    "4-rrr": Problem(
        "4-rrr", "4-rrr", 20e-3, PLATFORM, 1e-6, (1e-5, 5e-6, 4e-6, 2e-6, 1e-6),
        (2e-4, 1e-4, 5e-5, 1e-5, 1e-6, 1e-7), between=(1e-3, 5e-4, 3e-4, 7e-5), timed_interval="1 ms", hand="p4",
        hand_options=("--window", "0.02", "--horizon", "0.02", "--sample", "1e-4")),
    "squeezer": Problem(
        "squeezer", "validation/squeezer", 0.03, ("body.K3.x", "body.K3.y"), 1e-6, (1e-4, 5e-5, 2e-5, 1e-5, 5e-6),
        (1e-3, 1e-4, 1e-5, 1e-6, 1e-7), best=1e-13),
    **{"four-bar-%d" % n: four_bar(n) for n in (5, 40, 320)},
    **{"four-bar-%d" % n: long_four_bar(n) for n in (1000, 10000)},
}
WINDOWS = (5, 10, 40, 100, 320, 1000, 3200, 10000)
