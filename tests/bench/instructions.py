"""Machine instructions of runs, counted by valgrind: the same again on any machine of this kind, however busy."""
import os
import re
import subprocess

from problems import PROBLEMS, ROOT
from tables import table
from timing import Failed, Run
from versus import build

# From the assembled start to the last accepted step: what reads the model and what writes files beside the run is left out.
# Older revisions go on in the first of these functions, newer ones in the second.
COUNTED = ("freeplay::Simulation::run*", "freeplay::Simulation::advance*")


def of_problem(name, integrator, kind, value, end):
    return "%s, %g ms" % (name, 1e3 * end), PROBLEMS[name], ["--end", repr(end), "--integrator", integrator, "--" + kind, repr(value)]


def of_model(name, accuracy, end):
    label = "%s, %g ms" % (os.path.basename(name), 1e3 * end)
    return label, os.path.join(ROOT, "mechanisms", name + ".yaml"), ["--end", repr(end), "--accuracy", repr(accuracy)]


# Those of the tables by mechanism, then accuracy runs with the rows and the integrator of their files.
RUNS = (
    of_problem("slider-crank", "bathe", "step", 1e-7, 2e-3),
    of_problem("3-rrr", "bathe", "step", 5e-6, 20e-3),
    of_problem("4-rrr", "bathe", "step", 1e-5, 20e-3),
    of_problem("slider-crank", "verner7", "accuracy", 4e-4, 8e-3),
    of_problem("3-rrr", "dopri5", "accuracy", 5e-4, 20e-3),
    of_problem("4-rrr", "dopri5", "accuracy", 3e-4, 20e-3),
    of_model("pendulum", 1e-6, 0.5),
    of_model("four-bar", 1e-6, 0.5),
    of_model("slider-crank", 1e-6, 3e-3),
    of_model("3-rrr", 1e-6, 10e-3),
    of_model("validation/squeezer", 1e-6, 0.03),
)
QUICK = (of_problem("slider-crank", "verner7", "accuracy", 4e-4, 2e-4),)


def count(program, model, options, folder):
    """(instructions, summary) of a run."""
    log = os.path.join(folder, "callgrind.out")
    os.makedirs(folder, exist_ok=True)
    words = ["valgrind", "--tool=callgrind", *("--toggle-collect=" + name for name in COUNTED), "--callgrind-out-file=" + log,
             program, "run", model, *options, "--quiet", "--force", "--out", os.path.join(folder, "run")]
    try:
        done = subprocess.run(words, capture_output=True, text=True)
    except FileNotFoundError as missing:
        raise Failed("valgrind is not installed") from missing
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not found or int(found[1]) == 0:
        raise Failed("%s: %s" % (" ".join(words), done.stderr.strip()[-2000:]))
    return int(found[1]), Run(os.path.join(folder, "run"), 0.0, 0.0, 0).summary


def measure(bench, other=None):
    """Of this program and, where there is one, of another one beside."""
    rows, found = [], []
    for label, what, options in QUICK if bench.quick else RUNS:
        model = what if isinstance(what, str) else what.timed_file(bench.build)
        folder = os.path.join(bench.build, "runs", "counted")
        ours, summary = count(bench.program.path, model, options, folder)
        counts = summary["counts"]
        record = {"name": label, "options": options, "instructions": ours, "steps": counts["steps"]}
        words = dict(zip(options[::2], options[1::2]))
        row = [label, " ".join([words.get("--integrator", "as the file"), *options[-2:]]).replace("--", ""), counts["steps"],
               "%.2f" % (1e-6 * ours), "%.0f" % (ours / counts["steps"])]
        if other:
            record["other"], summary = count(other, model, options, os.path.join(bench.build, "runs", "counted-other"))
            counts = summary["counts"]
            record["other_steps"] = counts["steps"]
            row += [counts["steps"], "%.2f" % (1e-6 * record["other"]), "%+.1f %%" % (100.0 * (ours / record["other"] - 1.0))]
        rows.append(row)
        found.append(record)
    heading = ["run", "by", "steps", "millions", "a step"]
    bench.print(table(heading + (["other: steps", "millions", "more"] if other else []), rows))
    return {"heading": heading, "rows": [row[:5] for row in rows], "runs": found}


def compare(bench, revision):
    return measure(bench, build(revision, bench.build))
