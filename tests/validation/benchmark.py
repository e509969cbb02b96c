"""Runs the Open Clearance Benchmark and prints its table.

usage: benchmark.py PROGRAM FOLDER [--page PAGE] [CASE...]

FOLDER holds oracles.json: for each case its model and, by variant, what is known of its motion; and others.json: numbers of other
programs with their sources. Every variant is run at several accuracies. CASE: a number or a name. Exit 7 when the finest run of a
continuous case is off by more than its limit.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

ACCURACIES = "100 nm", "1 nm", "0.01 nm"
HEAD = "case", "variant", "accuracy", "t#1", "t#", "v#", "x [m]", "x/c", "F", "E", "s/s"
MEANING = {
    "t#1": "first begin of contact: error over the time before it",
    "t#": "all begins of contact, the largest: error over the time since the begin before it",
    "v#": "their approach speeds, the largest: relative error",
    "x [m]": "largest distance of the named point from the oracle", "x/c": "the same over the clearance",
    "F": "largest error of forces (case 12: of the angle) over the largest value",
    "E": "largest residual of energy over the largest kinetic energy",
    "s/s": "wall seconds of the run a simulated second, on one core",
}
LIMITS = {"t#1": 1e-7, "x [m]": 1e-6}  # of the finest run


def read_rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Run:
    """A variant of a case at an accuracy."""

    def __init__(self, program, model, variant, accuracy, folder):
        words = [program, "run", model, "--quiet", "--format", "csv", "--force", "--out", folder, "--accuracy", accuracy]
        for one in variant.get("set", []):
            words += ["--set", one]
        if "end" in variant:
            words += ["--end", "%r s" % variant["end"], "--interval", "%r s" % variant["interval"]]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise SystemExit("%s: freeplay run exits %d: %s" % (model, done.returncode, done.stderr.strip()))
        self.rows = read_rows(os.path.join(folder, "results.csv"))
        self.events = read_rows(os.path.join(folder, "events.csv"))
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.cost = json.load(file)["performance"]["wall_seconds"] / float(self.rows[-1]["time"])
        self.variant = variant

    def begins(self, name):
        """Times and approach speeds of the contacts of a joint or, `JOINT CONTACT`, of one of several."""
        joint, _, contact = name.partition(" ")
        kind = contact + "_contact_begin" if contact else "contact_begin"
        return [(float(event["time"]), float(event["speed"])) for event in self.events
                if event["joint"] == joint and (event["kind"] == kind if contact else event["kind"].endswith(kind))]

    def errors_of_begins(self):
        first, times, speeds = [], [], []
        for name, expected in self.variant.get("events", {}).items():
            found, before = self.begins(name), 0.0
            if len(found) < len(expected):
                return {"t#1": math.inf, "t#": math.inf, "v#": math.inf}
            for k, ((t, v), (ours, speed)) in enumerate(zip(expected, found)):
                (first if k == 0 else times).append(abs(ours - t) / (t - before))
                speeds.append(abs(speed - v) / v)
                before = t
        return {"t#1": max(first, default=None), "t#": max(first + times, default=None), "v#": max(speeds, default=None)}

    def row_at(self, t):
        nearest = min(self.rows, key=lambda row: abs(float(row["time"]) - t))
        if abs(float(nearest["time"]) - t) > 1e-9 * max(1.0, abs(t)):
            raise SystemExit("no row at %.12g s" % t)
        return nearest

    def differences(self, channels, samples):
        return [[float(row[channel]) - value for channel, value in zip(channels, values)]
                for (t, *values) in samples for row in [self.row_at(t)]]

    def measures(self):
        out = self.errors_of_begins()
        if "x" in self.variant:
            apart = self.differences(self.variant["x"]["point"], self.variant["x"]["samples"])
            each = self.variant.get("each", False)  # points of one number each
            out["x [m]"] = max(max(map(abs, d)) if each else math.hypot(*d) for d in apart)
            out["x/c"] = out["x [m]"] / self.variant["clearance"]
        if "F" in self.variant:
            forces = self.variant["F"]
            out["F"] = max(abs(e) for d in self.differences(forces["channels"], forces["samples"]) for e in d) / forces["largest"]
        kinetic = max(float(row["energy.kinetic"]) for row in self.rows)
        residual = max(abs(float(row["energy.residual"])) for row in self.rows)
        out["E"] = None if self.variant.get("rest", False) else residual / kinetic
        out["s/s"] = self.cost
        return out


def cell(name, value):
    if value is None:
        return "-"
    if value == math.inf:
        return "too few"
    return "%.2g" % value if name == "s/s" else "%.1e" % value


def table(program, folder, chosen):
    with open(os.path.join(folder, "oracles.json"), encoding="utf-8") as file:
        cases = [case for case in json.load(file) if not chosen or {case["case"], case["name"]} & set(chosen)]
    lines, off = [], []
    for case in cases:
        continuous = "nonsmooth" not in case["source"]
        for variant in case["variants"]:
            for accuracy in ACCURACIES:
                with tempfile.TemporaryDirectory() as scratch:
                    found = Run(program, os.path.join(folder, case["model"]), variant, accuracy,
                                os.path.join(scratch, "out")).measures()
                lines.append((case["case"] + " " + case["name"], variant["variant"] or "-", accuracy,
                              *(cell(name, found.get(name)) for name in HEAD[3:])))
                show(lines[-1])
            if continuous:
                off += ["%s %s: %s %.1e" % (case["name"], variant["variant"], name, found[name]) for name, limit in LIMITS.items()
                        if found.get(name) is not None and not found[name] <= limit]
    return cases, lines, off


WIDTHS = 17, 14, 8, 8, 8, 8, 8, 8, 8, 8, 6


def show(line):
    print("  ".join(text.ljust(width) for text, width in zip(line, WIDTHS)).rstrip(), flush=True)


def markdown(head, lines):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(line) + " |" for line in lines)]


def write_page(path, folder, cases, lines):
    with open(os.path.join(folder, "about.md"), encoding="utf-8") as file:
        page = file.read().rstrip() + "\n\n"
    page += "\n".join(markdown(("case", "model", "oracle", "window"), [
        (case["case"] + " " + case["name"], "[%s](../%s)" % (os.path.basename(case["model"]),
                                                              os.path.normpath(os.path.join("mechanisms/benchmark", case["model"]))),
         case["source"], case["window"]) for case in cases])) + "\n"
    page += "\n## Freeplay\n\n" + "\n".join("%s`%s`: %s." % ("- ", name, text) for name, text in MEANING.items() if name in HEAD[:-1])
    page += "\n\nA dash: the oracle says nothing of it. Too few: fewer contacts than the oracle has. `./dev benchmark` prints the time, too.\n\n"
    page += "\n".join(markdown(HEAD[:-1], [line[:-1] for line in lines])) + "\n"  # time depends on the machine
    page += "\n## Other programs\n\n" + "\n".join(markdown(*others(folder))) + "\n"
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)


def others(folder):
    with open(os.path.join(folder, "others.json"), encoding="utf-8") as file:
        known = json.load(file)
    return ("case", "program", "problem", "numbers", "against the oracle", "source"), [
        tuple(one[key] for key in ("case", "program", "problem", "numbers", "error", "source")) for one in known]


def main():
    parser = argparse.ArgumentParser(prog="./dev benchmark", description="Runs the Open Clearance Benchmark and prints its table.")
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--page", help="writes the table into this page as well")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="number or name; all without one")
    options = parser.parse_args()
    show(HEAD)
    cases, lines, off = table(os.path.abspath(options.program), options.folder, options.cases)
    if not cases:
        parser.error("no case is called %s" % " or ".join(options.cases))
    head, known = others(options.folder)
    print()
    for one in known:
        if not options.cases or {case["case"] for case in cases} & set(one[0].split("-")):
            print("%s  %s (%s): %s; against the oracle %s [%s]" % one)
    if options.page:
        write_page(options.page, options.folder, cases, lines)
    for one in off:
        print("OFF  " + one)
    return 7 if off else 0


if __name__ == "__main__":
    sys.exit(main())
