"""How much of the accuracy that is asked for each integrator uses up on smooth motion.

usage: kept_accuracy.py PROGRAM [--page PAGE] [--quick] [--models NAME,...] [--integrators NAME,...] [--accuracies L,...]

Runs the models below by every integrator and accuracy and compares with a run of `verner7` whose own error is far less.
The number that is printed is the largest error over the accuracy times the simulated time: of every row, positions as
they are and angles times the size of the model. Rows lie inside the steps. Writes the table into PAGE, between the marks
`<!-- kept accuracy -->` and `<!-- end -->`. `--quick` stops at 1e-6 m. Exit 7 when a number is above 2.
"""
import argparse
import csv
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
MECHANISMS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "mechanisms")
LIMIT = 2.0
INTEGRATORS = ("dopri5", "verner6", "verner7", "bathe", "generalized-alpha", "hht", "newmark")
ACCURACIES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)

# Name: file, size [m] by which an angle counts, simulated time [s], change of the text.
MODELS = {
    "pendulum": ("pendulum.yaml", 1.0, 2.0, None),
    "double pendulum": ("validation/double-pendulum.yaml", 2.0, 2.0, None),
    "four-bar let go": ("four-bar.yaml", 0.4, 1.0, lambda text: re.sub(
        r"drivers:.*?\n.*?\n", "gravity: [0, -9.81]\n", text, count=1, flags=re.S).replace(
            "initial: {joints: {A: 60 deg}}", "initial: {joints: {A: 60 deg}, speeds: {A: 6.0}}")),
    "heavy top": ("spatial/heavy-top.yaml", 0.04, 0.5, None),
    "nutating top": ("spatial/heavy-top.yaml", 0.04, 0.5, lambda text: text.replace(
        "$own*cos($tilt) + $W]", "$own*cos($tilt)]")),
    "Andrews' mechanism": ("validation/squeezer.yaml", 0.1, 0.03, None),
}


def motion(row):
    """Positions and turns of all bodies in a row: name, number, whether it is an angle [rad] or half of one."""
    for name, text in row.items():
        part = name.rsplit(".", 1)[-1]
        if not name.startswith("body."):
            continue
        if part in ("x", "y", "z"):
            yield name, float(text), 0
        elif part == "angle":
            yield name, float(text), 1
        elif part in ("qw", "qx", "qy", "qz"):
            yield name, float(text), 2


def largest_difference(rows, reference, size):
    largest = 0.0
    for ours, theirs in zip(rows[1:], reference[1:]):
        assert abs(float(ours["time"]) - float(theirs["time"])) < 1e-12
        for (_, number, turns), (_, other, _) in zip(motion(ours), motion(theirs)):
            largest = max(largest, abs(number - other) * (size * turns if turns else 1.0))
    return largest


class Runs:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def model(self, name, end):
        path, _, _, change = MODELS[name]
        with open(os.path.join(MECHANISMS, path), encoding="utf-8") as file:
            text = file.read()
        if change is not None:
            changed = change(text)
            assert changed != text, name
            text = changed
        # 47 intervals, which no step has.
        text = re.sub("simulation: {.*}", "simulation: {end: %r s, accuracy: 1 um, output: {interval: %r s}}"
                      % (end, end / 47.0), text)
        own = os.path.join(self.folder, "model.yaml")
        with open(own, "w", encoding="utf-8") as file:
            file.write(text)
        return own

    def rows(self, name, integrator, accuracy, end):
        """Rows and the number of steps of a run."""
        out = os.path.join(self.folder, "out")
        done = subprocess.run([self.program, "run", self.model(name, end), "--integrator", integrator, "--accuracy",
                               repr(accuracy), "--quiet", "--out", out], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit("%s by %s at %g m: exit %d: %s" % (name, integrator, accuracy, done.returncode,
                                                               done.stderr.strip()))
        with open(os.path.join(out, "results.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            return rows, json.load(file)["counts"]["steps"]


def ratio(runs, name, integrator, accuracy, references):
    _, size, end, _ = MODELS[name]
    if name not in references:
        references[name] = runs.rows(name, "verner7", 1e-13 if size < 1.0 else 3e-13, end)[0]
    rows, steps = runs.rows(name, integrator, accuracy, end)
    return largest_difference(rows, references[name], size) / (accuracy * end), steps


def lines_of(runs, models, integrators, accuracies):
    references, worst = {}, 0.0
    yield "| model | integrator | " + " | ".join("%g m" % a for a in accuracies) + " |"
    yield "|---|---|" + "---|" * len(accuracies)
    for name in models:
        for integrator in integrators:
            cells = []
            for accuracy in accuracies:
                number, steps = ratio(runs, name, integrator, accuracy, references)
                worst = max(worst, number)
                cells.append("%.2g (%d)" % (number, steps))
            yield "| %s | `%s` | %s |" % (name, integrator, " | ".join(cells))
    yield worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--page")
    parser.add_argument("--quick", action="store_true")
    split = lambda text: text.split(",")
    parser.add_argument("--models", type=split, default=list(MODELS))
    parser.add_argument("--integrators", type=split, default=list(INTEGRATORS))
    parser.add_argument("--accuracies", type=lambda text: [float(part) for part in text.split(",")])
    options = parser.parse_args()
    accuracies = options.accuracies or [a for a in ACCURACIES if a >= 1e-6 or not options.quick]
    table = []
    with tempfile.TemporaryDirectory() as folder:
        for line in lines_of(Runs(options.program, folder), options.models, options.integrators, accuracies):
            if isinstance(line, float):
                worst = line
                continue
            print(line, flush=True)
            table.append(line)
    if options.page:
        with open(options.page, encoding="utf-8") as file:
            text = file.read()
        begin, end = "<!-- kept accuracy -->\n", "<!-- end -->"
        head, rest = text.split(begin)
        with open(options.page, "w", encoding="utf-8") as file:
            file.write(head + begin + "\n".join(table) + "\n" + end + rest.split(end, 1)[1])
    print("largest: %.2g, at most %g is promised" % (worst, LIMIT))
    return 0 if worst <= LIMIT else 7


if __name__ == "__main__":
    sys.exit(main())
