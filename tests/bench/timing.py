"""Runs the program under a clock."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile


# The kernel counts the memory of who starts a program as the program's own, so a small process starts it.
STARTER = """
import os, sys, time
begin = time.perf_counter()
_, status, usage = os.wait4(os.posix_spawn(sys.argv[2], sys.argv[2:], os.environ), 0)
seconds = time.perf_counter() - begin
os.write(int(sys.argv[1]), b'%.9f %.9f %d' % (seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024))
sys.exit(os.waitstatus_to_exitcode(status) % 256)
"""


class Failed(Exception):
    """The program could not do what was asked of it."""


class Run:
    """What a run left: its summary, its folder, and what the kernel says of the process."""

    def __init__(self, folder, seconds, processor, peak_bytes):
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        self.folder, self.seconds, self.processor, self.peak_bytes = folder, seconds, processor, peak_bytes
        self.wall = self.summary["performance"]["wall_seconds"]
        self.steps = self.summary["counts"]["steps"]
        self.rate = self.wall / (self.summary["time"]["reached"] - self.summary["settings"]["start"])

    def columns(self, names):
        """Rows of results.csv as lists of the named channels."""
        with open(os.path.join(self.folder, "results.csv"), encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            header = next(rows)
            places = [header.index(name) for name in names]
            return [[float(row[place]) for place in places] for row in rows]


def measured(words, told=subprocess.DEVNULL):
    """Wall seconds, processor seconds and peak memory [bytes] of a command that must succeed."""
    with tempfile.TemporaryFile() as errors, tempfile.TemporaryFile() as numbers:
        starter = [sys.executable, "-I", "-S", "-c", STARTER, str(numbers.fileno())]
        done = subprocess.run(starter + words, stdout=told, stderr=errors, pass_fds=(numbers.fileno(),))
        if done.returncode != 0:
            errors.seek(0)
            raise Failed("%s: exit code %d: %s" % (" ".join(words), done.returncode,
                                                   errors.read().decode(errors="replace").strip()[-400:]))
        numbers.seek(0)
        seconds, processor, peak = numbers.read().split()
        return float(seconds), float(processor), int(peak)


class RepeatedRun:
    """A program that runs a model again and again in one process, as those written by hand do: the first run of a process brings
    pages of the program into memory."""

    def __init__(self, path):
        self.path = os.path.abspath(path)

    def seconds(self, model, options):
        done = subprocess.run([self.path, model, *options], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failed(done.stderr.strip())
        return float(done.stdout)


class Program:
    """One build of freeplay."""

    def __init__(self, path, results):
        self.path, self.results = os.path.abspath(path), results

    def run(self, model, options, name="run"):
        folder = os.path.join(self.results, name)
        return Run(folder, *measured([self.path, "run", model, *options, "--quiet", "--force", "--out", folder]))

    def profiled(self, model, options, name="run"):
        """The run, and its seconds without those of the start: orders of unknowns and dependent rows are found there."""
        folder = os.path.join(self.results, name)
        words = [self.path, "run", model, *options, "--quiet", "--profile", "--force", "--out", folder]
        run, lines = self.printed(words, folder)
        seconds = {line.split()[0]: float(line.split()[1]) for line in lines if line.split()[0] in ("start", "all")}
        return run, seconds["all"] - seconds["start"]

    def started(self, model, options, name="run"):
        """The run, and the processor seconds of the program until its first step had ended."""
        folder = os.path.join(self.results, name)
        words = [self.path, "run", model, *options, "--quiet", "--profile", "--force", "--out", folder]
        run, lines = self.printed(words, folder)
        return run, next(float(line.split()[5]) for line in lines if line.startswith("  the first step ended after "))

    @staticmethod
    def printed(words, folder):
        with tempfile.TemporaryFile("w+") as output:
            run = Run(folder, *measured(words, output))
            output.seek(0)
            return run, output.readlines()


def median(values):
    values = sorted(values)
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else 0.5 * (values[middle - 1] + values[middle])


def alternate(times, *measure):
    """Calls the functions in turn, `times` times: a list of results for each."""
    results = [[] for _ in measure]
    for _ in range(times):
        for result, call in zip(results, measure):
            result.append(call())
    return results


def ratio(ours, theirs):
    """Median of the ratios of measurements that were taken pair by pair."""
    return median([a / b for a, b in zip(ours, theirs, strict=True)])


def largest_distance(rows, reference):
    """Largest distance of two lists of points, of the same instants."""
    if len(rows) != len(reference):
        raise Failed("%d rows, and the reference has %d" % (len(rows), len(reference)))
    return max(math.dist(a, b) for a, b in zip(rows, reference))


def growth(points):
    """Exponent p of y = c x^p: from the first point to the last, by least squares in logarithms, and the largest
    between neighbours."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mx, my = (sum(column) / len(logs) for column in zip(*logs))
    slope = sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)
    steep = lambda a, b: (b[1] - a[1]) / (b[0] - a[0])
    return steep(logs[0], logs[-1]), slope, max(map(steep, logs, logs[1:]))
