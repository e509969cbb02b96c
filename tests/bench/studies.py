"""What the engine of studies costs: beside its points, on two cores, in memory, and per row of the table."""
import csv
import json
import os
import re
import shutil
import statistics
import subprocess
import time

from tables import table
from timing import Failed, measured

CRANK = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "mechanisms", "slider-crank.yaml")
SHORT = """freeplay: 1
study:
  models: {slider-crank: %s}
  set: {simulation.end: 8 ms, simulation.accuracy: 1 um}
  axes: {c: {linspace: [0.1 mm, 0.5 mm, %d]}}
  reducers: {f: {channel: joint.wrist.fn, reduce: max}}
"""
BALL = """freeplay: 1
name: ball
parameters: {g: 9.81 m/s^2}
gravity: [0, -$g]
bodies: {ball: {mass: 1 kg, inertia: 0.1}}
simulation: {end: 0.1 s, step: 10 ms, output: {interval: 10 ms}}
study:
  axes: {g: {linspace: [1, 2, %d]}}
  reducers: {y: {channel: body.ball.y, reduce: final}}
"""


class Study:
    """A study of a text, in a folder of its own."""

    def __init__(self, bench, name, text):
        self.program, self.folder = bench.program.path, os.path.join(bench.build, "studies", name)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        self.file, self.out = os.path.join(self.folder, "study.yaml"), os.path.join(self.folder, "out")
        with open(self.file, "w", encoding="utf-8") as file:
            file.write(text)

    def run(self, jobs, look=lambda pid, workers: None):
        """The report of the run; meanwhile `look` is called with the processes."""
        shutil.rmtree(self.out, ignore_errors=True)
        words = [self.program, "study", "run", self.file, "--out", self.out, "--jobs", str(jobs), "--json"]
        cpus = sorted(os.sched_getaffinity(0))[:jobs]
        run = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: os.sched_setaffinity(0, cpus))
        while run.poll() is None:
            try:
                with open("/proc/%d/task/%d/children" % (run.pid, run.pid), encoding="ascii") as file:
                    look(run.pid, [int(word) for word in file.read().split()])
            except OSError:
                pass
            time.sleep(0.004)
        out, err = run.communicate()
        if run.returncode != 0:
            raise Failed("study run: exit code %d: %s" % (run.returncode, err[-400:]))
        return json.loads(out)

    def stepping(self):
        with open(os.path.join(self.out, "timing.csv"), encoding="utf-8", newline="") as file:
            return sum(float(row["run_seconds"]) for row in csv.DictReader(file))


def state(pid):
    try:
        with open("/proc/%d/stat" % pid, encoding="ascii", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0]
    except OSError:
        return ""


def kilobytes(pid, what):
    try:
        with open("/proc/%d/status" % pid, encoding="ascii", errors="replace") as file:
            return int(re.search(what + r":\s+(\d+)", file.read())[1])
    except (OSError, TypeError):
        return 0


def engine(bench):
    """Overhead a point on one core, and what two cores are used for: processor time with one worker over that with two, times the
    share of both workers that ran or could have run, so that other programs on the machine neither help nor harm."""
    points, passes = (60, 1) if bench.quick else (1000, 3)
    study, best = Study(bench, "crank", SHORT % (CRANK, points)), {"overhead": 1.0, "efficiency": 0.0}
    two = min(2, len(os.sched_getaffinity(0)))
    for _ in range(passes):
        one = study.run(1)["cpu_seconds"]
        best["overhead"] = min(best["overhead"], (one - study.stepping()) / points)
        shares = []
        both = study.run(two, lambda pid, workers: shares.append(
            sum(state(worker) == "R" for worker in workers) / two) if workers else None)["cpu_seconds"]
        best["efficiency"] = max(best["efficiency"], min(1.0, one / both) * statistics.fmean(shares or [0.0]))
    return {"points": points, "cores": two, **best}


def large(bench, points):
    """Memory of a study of many short points, and the time of a merge."""
    study, sizes, parent = Study(bench, "ball-%d" % points, BALL % points), {}, [0]

    def look(pid, workers):
        parent[0] = max(parent[0], kilobytes(pid, "VmHWM"))
        for worker in workers:
            size = kilobytes(worker, "VmRSS")
            if size > 0:
                sizes.setdefault(worker, []).append(size)
    rate = points / study.run(min(2, len(os.sched_getaffinity(0))), look)["wall_seconds"]
    _, processor, peak = measured([study.program, "study", "merge", study.out])
    growth = max((max(seen) - max(seen[:len(seen) // 10 + 1]) for seen in sizes.values()), default=0)
    return {"points": points, "per_second": rate, "parent_bytes": 1024 * parent[0], "worker_growth_bytes": 1024 * growth,
            "merge_seconds": processor, "merge_bytes": peak}


def studies(bench):
    found = {"engine": engine(bench), "large": [large(bench, points) for points in ((200, 2000) if bench.quick else (10000, 100000))]}
    bench.print(table(*rows_of_engine(found)))
    bench.print("")
    bench.print(table(*rows_of_large(found)))
    return found


def rows_of_engine(found):
    own = found["engine"]
    return ("slider-crank, 8 ms", "points", "wanted", "found"), [
        ["all but stepping [ms a point]", own["points"], "at most 1", "%.2f" % (1e3 * own["overhead"])],
        ["use of %d cores" % own["cores"], own["points"], "at least 0.95", "%.3f" % own["efficiency"]]]


def rows_of_large(found):
    head = ["points of 10 steps", "points/s", "memory of the parent [MB]", "a worker grows by [MB]", "merge [s]", "merge [us a row]",
            "memory of the merge [MB]"]
    return head, [[own["points"], "%.0f" % own["per_second"], "%.0f" % (own["parent_bytes"] / 1e6),
                   "%.1f" % (own["worker_growth_bytes"] / 1e6), "%.2f" % own["merge_seconds"],
                   "%.1f" % (1e6 * own["merge_seconds"] / own["points"]), "%.0f" % (own["merge_bytes"] / 1e6)]
                  for own in found["large"]]
