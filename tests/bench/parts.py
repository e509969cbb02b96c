"""What is timed besides error against time: kernels, growth with the number of bodies, start, loading, output."""
import json
import os
import re
import subprocess
from types import SimpleNamespace

from problems import PROBLEMS, ROOT, WINDOWS, with_interval
from tables import table
from timing import Failed, alternate, growth, measured, median

CHAIN = os.path.join(ROOT, "mechanisms", "validation", "a02-chain.yaml")
CHAIN_IN_SPACE = os.path.join(ROOT, "tests", "bench", "chain-in-space.yaml")


def windows(n):
    return ["--set", "windows=%d" % n]


def kernels(bench):
    if not os.path.exists(bench.kernels):
        raise Failed("'%s' is not built: it needs Google Benchmark (libbenchmark-dev)" % bench.kernels)
    done = subprocess.run([bench.kernels, "--benchmark_format=json", "--benchmark_min_time=%g" % (0.01 if bench.quick else 0.1)],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise Failed("kernel_bench: " + done.stderr)
    found = json.loads(done.stdout)["benchmarks"]
    rows, numbers = [], []
    for one in found:
        if "error_message" in one:
            raise Failed("%s: %s" % (one["name"], one["error_message"]))
        name = re.sub("/(process_time|real_time|manual_time)", "", one["name"])
        nanoseconds = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}[one["time_unit"]]
        # A step is a part of a run of many.
        time = 1e9 * one["per_step"] if "per_step" in one else nanoseconds * one["cpu_time"]
        per = next(("%.4g ns %s" % (1e9 * one[key], key.replace("_", " ")) for key in ("per_body", "per_number") if key in one), "")
        numbers.append({"name": name, "ns": time, "all": one})
        rows.append([name, "%.5g" % time, per])
    bench.print(table(["kernel", "ns", ""], rows))
    return {"kernels": numbers}


def grow(bench):
    """N-four-bar in the plane and in space; there with joints that hold no more than needed, and with pins."""
    most = 40 if bench.quick else 1000
    bench.print("in the plane")
    found = growth_of(bench, CHAIN, 320 if bench.quick else max(WINDOWS))
    bench.print("\nin space")
    found["in_space"] = growth_of(bench, CHAIN_IN_SPACE, most)
    bench.print("\nin space, on pins: 3 N redundant constraints")
    found["on_pins"] = growth_of(bench, with_pins(bench), most)
    return found


def with_pins(bench):
    with open(CHAIN_IN_SPACE, encoding="utf-8") as file:
        text = file.read()
    path = os.path.join(bench.build, "models", "chain-on-pins.yaml")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(re.sub("type: (spherical|cylindrical)", "type: revolute", text))
    return path


def growth_of(bench, model, most):
    """Time per step, without the start and the first two steps, in which matrices find their patterns."""
    rows, points, found, step = [], [], [], 5e-3
    for n in [n for n in WINDOWS if n <= most]:
        few, many = 2, 2 + min(100, max(10, 10000 // n))
        best, seconds = {}, {}
        for steps in (few, many):
            options = ["--integrator", "bathe", "--step", repr(step), "--end", repr(steps * step), *windows(n)]
            tries = [bench.program.profiled(model, options) for _ in range(3 if n <= 320 else 1)]
            best[steps], seconds[steps] = min(tries, key=lambda one: one[1])
            if best[steps].steps != steps:
                raise Failed("N = %d took %d steps for %d" % (n, best[steps].steps, steps))
        per_step = (seconds[many] - seconds[few]) / (many - few)
        if not per_step > 0.0:
            raise Failed("N = %d: %d steps took no longer than %d" % (n, many, few))
        record = {"windows": n, "seconds_per_step": per_step, "seconds_of_start": best[few].wall - seconds[few],
                  "process_seconds": best[few].seconds, "peak_bytes": max(run.peak_bytes for run in best.values())}
        found.append(record)
        points.append((n, per_step))
        rows.append([n, "%.4g" % per_step, "%.3g" % (1e6 * per_step / n), "%.3g" % record["seconds_of_start"],
                     "%.3g" % best[few].seconds, "%.0f" % (record["peak_bytes"] / 1e6)])
    whole, slope, steepest = growth(points)
    bench.print(table(["N", "s per step", "us per step, N", "start [s]", "process [s]", "peak [MB]"], rows))
    bench.print("time per step grows as N^%.2f from first to last (fitted N^%.2f, between neighbours at most N^%.2f)" %
                (whole, slope, steepest))
    return {"from_first_to_last": whole, "exponent": slope, "steepest": steepest, "runs": found}


def start(bench):
    """The whole process, with one step, its files written. Rows as text take little more than what comes before that step."""
    rows, found = [], {}
    for name in ("slider-crank", "3-rrr", "4-rrr"):
        model = PROBLEMS[name].file()
        end = {"slider-crank": "1e-6"}.get(name, "2e-6")
        for form, words in (("csv", "rows as CSV"), ("both", "as CSV and HDF5")):
            runs = [bench.program.started(model, ["--end", end, "--format", form])
                    for _ in range(3 if bench.quick else 21)]
            one = {"seconds": [run.seconds for run, _ in runs], "processor": [run.processor for run, _ in runs],
                   "first_step": [first for _, first in runs]}
            one["median"] = median(one["seconds"])
            found["%s, %s" % (name, words)] = one
            rows.append(["%s, %s" % (name, words), *("%.2f" % (1e3 * number) for number in (
                one["median"], min(one["seconds"]), median(one["processor"]), median(one["first_step"])))])
    bench.print(table(["process with one step", "median [ms]", "least [ms]", "processor [ms]",
                       "to the end of the step [ms]"], rows))
    return found


def load(bench):
    rows, found = [], {}
    cases = [("3-rrr", PROBLEMS["3-rrr"].file(), [])]
    cases += [("four-bar-%d" % n, CHAIN, windows(n)) for n in ((40, 320) if bench.quick else (40, 320, 3200, 10000))]
    for name, model, options in cases:
        words = [bench.program.path, "validate", "--no-assemble", "--quiet", model, *options]
        times = [measured(words)[0] for _ in range(3)]
        found[name] = min(times)
        rows.append([name, "%.4g" % min(times)])
    bench.print(table(["read and checked", "s"], rows))
    return found


OUTPUTS = (  # name, model, options
    ("3-rrr, bathe", "3-rrr", ["--end", "0.2 s", "--step", "2us", "--integrator", "bathe"]),
    ("3-rrr, accuracy 1 um", "3-rrr", ["--end", "1 s", "--accuracy", "1um"]),
    ("four-bar-320, bathe", "validation/a02-chain", ["--end", "1 s", "--step", "1ms", "--integrator", "bathe", *windows(320)]),
    ("four-bar-320, accuracy 1 um", "validation/a02-chain", ["--end", "1 s", "--accuracy", "1um", *windows(320)]))


def quickest(bench, model, options, name):
    """The least of each time over several runs, and the last summary."""
    runs = [bench.program.run(model, options, name) for _ in range(1 if bench.quick else 3)]
    return SimpleNamespace(summary=runs[-1].summary, **{
        what: min(getattr(run, what) for run in runs) for what in ("wall", "seconds", "processor")})


def output(bench):
    """All channels 1000 times a second against first and last row alone, in turn."""
    rows, found = [], {}
    for name, model, options in OUTPUTS:
        if bench.quick:
            options = ["--end", "20 ms"] + options[2:]
        full, none = (with_interval(bench.build, model, interval) for interval in ("1 ms", "10 s"))
        a, b = alternate(bench.passes, lambda: quickest(bench, full, options, "full"),
                         lambda: quickest(bench, none, options, "none"))
        numbers = {}
        for what in ("wall", "seconds", "processor"):
            numbers[what] = median([getattr(x, what) / getattr(y, what) for x, y in zip(a, b)]) - 1.0
        found[name] = {**numbers, "rows": a[0].summary["counts"]["rows"], "wall_without": median([y.wall for y in b])}
        rows.append([name, found[name]["rows"], "%.4g" % found[name]["wall_without"],
                     *("%+.1f %%" % (100.0 * numbers[what]) for what in ("wall", "seconds", "processor"))])
    bench.print(table(["all channels at 1 kHz", "rows", "wall without [s]", "wall", "process", "processor"], rows))
    return found
