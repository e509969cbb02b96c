"""Compares the 3-RRR with the 4-RRR: study.py PROGRAM DOCS [PLAN RESULTS].

The page and its figures go to the folder DOCS. What is varied stands in PLAN (study.yaml beside this file); results of
runs are kept in RESULTS (results/studies/NAME). One that is there already and was made by the same program, model and
options is used again.
"""
import concurrent.futures
import csv
import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import sys

import yaml

import figures
import page

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
NAME = os.path.basename(HERE)
SETTLE = 0.2  # turns: the models' `discard`


class Study:
    def __init__(self, program, plan, results):
        self.program, self.plan, self.results = program, plan, results
        self.mechanisms = plan["mechanisms"]
        with open(program, "rb") as file:
            self.build = hashlib.sha256(file.read()).hexdigest()

    def model(self, mechanism):
        return os.path.join(ROOT, "mechanisms", mechanism + ".yaml")

    def call(self, *words):
        done = subprocess.run([self.program, *words], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit("freeplay %s exits %d: %s" % (" ".join(words), done.returncode, done.stderr.strip()))
        return done.stdout

    def run(self, mechanism, ideal=False, **changed):
        """The folder of a run with some parameters changed."""
        values = {**self.plan["base"], **changed}
        words = ["run", self.model(mechanism), "--accuracy", repr(self.plan["accuracy"]),
                 "--end", repr(self.plan["turns"] * values["T"])]
        for name in sorted(values):
            words += ["--set", "%s=%r" % (name, values[name])]
        words += ["--ideal", "all"] if ideal else []
        with open(self.model(mechanism), "rb") as file:
            key = hashlib.sha256(repr((self.build, words[2:])).encode() + file.read()).hexdigest()[:16]
        folder = os.path.join(self.results, "%s-%s" % (mechanism, key))
        if not os.path.exists(os.path.join(folder, "done")):
            shutil.rmtree(folder, ignore_errors=True)
            self.call(*words, "--quiet", "--out", folder)
            open(os.path.join(folder, "done"), "w").close()
        return folder

    def runs(self):
        """{(mechanism, parameter, value): Run} of every point of every series; parameter "ideal": the ideal twin at the
        period `value`."""
        points = [(m, name, value) for m in self.mechanisms for name, values in self.plan["series"].items()
                  for value in values]
        points += [(m, "ideal", period) for m in self.mechanisms for period in self.plan["series"]["T"]]

        def key(point):
            mechanism, name, value = point
            changed = {"T": value} if name == "ideal" else {name: value}
            return mechanism, name == "ideal", tuple(sorted({**self.plan["base"], **changed}.items()))

        def run(mechanism, ideal, values):
            return Run(self.run(mechanism, ideal, **dict(values)), dict(values)["T"])

        # The point about which the series vary is in all of them.
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            started = {one: pool.submit(run, *one) for one in dict.fromkeys(map(key, points))}
            return {point: started[key(point)].result() for point in points}

    def analysis(self, mechanism, *words):
        rows = self.call("analyze", "error", self.model(mechanism), *words).splitlines()
        return [{name: float(text) if text else math.nan for name, text in row.items()} for row in csv.DictReader(rows)]

    def bounds(self, mechanism):
        """Worst static errors at poses of the circle; the last is the first again."""
        count, period = self.plan["path"], self.plan["base"]["T"]
        return self.analysis(mechanism, "--time", "0:%r:%d" % (period, count + 1))

    def centre(self, mechanism):
        return self.analysis(mechanism, "--pose", "0,0,0")[0]

    def map_grid(self):
        ends = self.plan["map"]
        span = "%r:%r:%d" % (ends["from"], ends["to"], ends["count"])
        return ["--grid", "x=" + span, "--grid", "y=" + span]

    def map(self, mechanism):
        return self.analysis(mechanism, *self.map_grid())

    def draw(self, runs, folder):
        """Pictures of single runs and maps, by the program."""
        base, turns = self.plan["base"], self.plan["turns"]
        window = ["--from", "%r s" % ((turns - 1) * base["T"]), "--until", "%r s" % (turns * base["T"])]
        one = {m: runs[m, "c", base["c"]].folder for m in self.mechanisms}
        first, second = self.mechanisms
        self.picture(folder, "errors", "plot", one[first], "driver.circle.ex", "driver.circle.ey", *window, "--against", one[second])
        for m in self.mechanisms:
            self.picture(folder, "map-" + m, "analyze", "error", self.model(m), *self.map_grid())
            self.picture(folder, "loads-" + m, "plot", one[m], "driver.leg1.A.torque", "joint.leg1.B.fx", *window,
                         "--against", runs[m, "ideal", base["T"]].folder)
            self.picture(folder, "orbit-" + m, "plot", one[m], "--orbit", "leg1.B", *window, "--width", "480")

    def picture(self, folder, name, command, *words):
        """Without the record of provenance, which holds the paths of this machine; names of results are those of mechanisms."""
        path = os.path.join(folder, name + ".svg")
        where = ["--svg", path, "--out", os.devnull] if command == "analyze" else ["--out", path]
        self.call(command, *words, *where)
        with open(path, encoding="utf-8") as file:
            text = re.sub(r"\n<metadata>.*?</metadata>", "", file.read(), flags=re.S)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


class Run:
    """Summary and time series of one run; the series are read when they are asked for."""

    def __init__(self, folder, period):
        self.folder, self.period = folder, period
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        self.known = {}

    def columns(self, *names):
        """Lists of numbers, from the end of the settling on."""
        missing = [name for name in ("time", *names) if name not in self.known]
        if missing:
            with open(os.path.join(self.folder, "results.csv"), encoding="utf-8") as file:
                head = file.readline().strip().split(",")
                places = [head.index(name) for name in missing]
                read = [[] for _ in missing]
                for line in file:
                    cells = line.split(",")
                    for place, column in zip(places, read):
                        column.append(float(cells[place]))
            self.known.update(zip(missing, read))
        first = next(i for i, t in enumerate(self.known["time"]) if t >= SETTLE * self.period - 1e-12)
        return [self.known[name][first:] for name in names]

    def clearance_joints(self):
        return {name: joint for name, joint in self.summary["joints"].items() if joint["max_delta"] is not None}

    def over_joints(self, quantity, how=max):
        return how([joint[quantity] for joint in self.clearance_joints().values()])

    def torque_rms(self):
        """Of the vector of all torques [N m]."""
        return math.sqrt(sum(driver["rms"] ** 2 for driver in self.summary["drivers"].values()))

    def torque_max(self):
        return max(driver["max_abs"] for driver in self.summary["drivers"].values())

    def path(self):
        return next(iter(self.summary["paths"].values()))

    def excess(self, bounds, factor):
        """How far the position error leaves `factor` times the static bound at its place on the circle [m]; the bound
        between two poses is the larger one."""
        count = len(bounds) - 1
        times, ex, ey = self.columns("time", "driver.circle.ex", "driver.circle.ey")
        worst = -math.inf
        for t, x, y in zip(times, ex, ey):
            k = int(t / self.period * count) % count
            bound = factor * max(bounds[k]["position"], bounds[k + 1]["position"])
            worst = max(worst, math.hypot(x, y) - bound)
        return worst


def main():
    if len(sys.argv) not in (3, 5):
        raise SystemExit(__doc__)
    program, docs = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    given, results = sys.argv[3:] or (os.path.join(HERE, "study.yaml"), os.path.join(ROOT, "results", "studies", NAME))
    with open(given, encoding="utf-8") as file:
        plan = yaml.safe_load(file)
    os.makedirs(results, exist_ok=True)
    study = Study(program, plan, results)
    static = {m: {"bounds": study.bounds(m), "centre": study.centre(m), "map": study.map(m)} for m in study.mechanisms}
    runs = study.runs()
    pictures = os.path.join(docs, "images", NAME)
    os.makedirs(pictures, exist_ok=True)
    for old in os.listdir(pictures):
        os.remove(os.path.join(pictures, old))
    figures.draw(plan, static, runs, pictures)
    study.draw(runs, pictures)
    text = page.text(plan, static, runs, "images/" + NAME)
    with open(os.path.join(docs, NAME + ".md"), "w", encoding="utf-8") as file:
        file.write(text)
    print("wrote %s" % os.path.relpath(os.path.join(docs, NAME + ".md"), os.getcwd()))


if __name__ == "__main__":
    main()
