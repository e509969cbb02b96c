"""How fast the program is: `./dev bench`.

Without NAME everything is measured, in twenty minutes on two cores; the tables are printed, and everything goes as
JSON to the build folder. What is compared in one line is measured in turn, so that a busy machine disturbs both alike.
"""
import argparse
import datetime
import difflib
import json
import os
import platform
import subprocess
import sys

import formulas
import instructions
import loose_slider
import page
import pareto
import parts
import series
import studies
import versus
from hand_written import HandWritten, source_folder, trajectories
from problems import PROBLEMS, ROOT
from timing import Failed, Program, RepeatedRun

PARTS = {
    "kernels": ("evaluations, factors, steps, laws, rows and loading, each by itself", parts.kernels),
    **{name: ("error against time of every integrator; beside hand-written programs, where there are any",
              lambda bench, problem=problem: pareto.measure(bench, problem)) for name, problem in PROBLEMS.items()},
    "growth": ("time per step and peak memory of N-four-bar", parts.grow),
    "startup": ("the whole process with one step", parts.start),
    "load": ("reading and checking models", parts.load),
    "output": ("what rows at 1 kHz of all channels cost", parts.output),
    "instructions": ("machine instructions of runs by fixed steps and by accuracy, which repeat on a busy machine", instructions.measure),
    "formulas": ("instructions of formulas of the motion, up to 10 000 of them, and beside the same load in C++", formulas.measure),
    "loose-slider": ("instructions of a slider-crank with play in its guide beside one with play in its wrist", loose_slider.measure),
    "studies": ("what the engine of studies costs a point, and memory and time of 10^5 points", studies.studies),
}

COMPARED = (*PROBLEMS, "instructions")  # by --vs


class Bench:
    """What the parts share: the program, folders, and where tables go."""

    def __init__(self, options):
        self.build, self.quick, self.kernels = os.path.abspath(options.build), options.quick, options.kernels
        self.passes = 1 if options.quick else 5
        self.repeated = RepeatedRun(options.repeated)
        self.program = Program(options.program, os.path.join(self.build, "runs"))
        source = source_folder()
        self.trajectories = trajectories(source)
        self.hand = HandWritten(source, self.build) if source and not options.vs else None

    def ask(self, *words):
        return subprocess.run([self.program.path, *words], capture_output=True, text=True, check=True).stdout

    @staticmethod
    def print(text):
        print(text, flush=True)


def help_of_parts():
    width = max(map(len, PARTS))
    return "parts:\n" + "\n".join("  %-*s  %s" % (width, name, words) for name, (words, _) in PARTS.items())


def usual_parts(quick):
    return [name for name in PARTS if not (quick and name in PROBLEMS and PROBLEMS[name].once)]


def parser():
    words = argparse.ArgumentParser(prog="./dev bench", description=__doc__, epilog=help_of_parts(), allow_abbrev=False,
                                    formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("names", nargs="*", metavar="NAME", help="parts to measure (default: all)")
    words.add_argument("--quick", action="store_true", help="fewer runs, nothing large: to see that all of it works")
    words.add_argument("--plain", action="store_true", help="the program as `./dev build` makes it; without, as `./dev tune` does")
    words.add_argument("--page", action="store_true", help="write the tables into docs/performance.md, too")
    words.add_argument("--vs", metavar="REV", help="time this tree and the revision REV of git in turn")
    words.add_argument("--series", action="store_true", help="print tests/bench/series.csv and draw it; measures nothing")
    words.add_argument("--release", metavar="NAME", help="with --series: first add the ratios of docs/performance.md as NAME")
    words.add_argument("--only-words", action="store_true", help=argparse.SUPPRESS)  # are looked at, before anything is built
    words.add_argument("--program", default=os.path.join(ROOT, "build", "release", "freeplay"), help=argparse.SUPPRESS)
    words.add_argument("--kernels", default=os.path.join(ROOT, "build", "release", "tests", "kernel_bench"), help=argparse.SUPPRESS)
    words.add_argument("--repeated", default=os.path.join(ROOT, "build", "release", "tests", "repeated_run"), help=argparse.SUPPRESS)
    words.add_argument("--build", default=os.path.join(ROOT, "build", "bench"), help=argparse.SUPPRESS)
    return words


def meant(word, words):
    near = difflib.get_close_matches(word.lower(), words, 1)
    return "; did you mean '%s'?" % near[0] if near else ""


def parse(arguments):
    reader = parser()
    options, unknown = reader.parse_known_args(arguments)
    for word in unknown:
        reader.exit(2, "bench: unknown option '%s'%s\n" % (word, meant(word, ["--quick", "--plain", "--page", "--vs", "--series", "--release", "--help"])))
    if options.page and (options.quick or options.plain or options.vs):
        reader.exit(2, "bench: --page takes none of --quick, --plain and --vs: the page tells what was measured in full\n")
    if options.series and (options.names or options.quick or options.plain or options.page or options.vs):
        reader.exit(2, "bench: --series takes no part and no other option but --release\n")
    if options.release and not options.series:
        reader.exit(2, "bench: --release goes with --series\n")
    for name in options.names:
        if name not in PARTS:
            reader.exit(2, "bench: there is no part '%s'%s\n%s\n" % (name, meant(name, PARTS) or ";", help_of_parts()))
        if options.vs and name not in COMPARED:
            reader.exit(2, "bench: --vs compares %s, not '%s'\n" % (", ".join(COMPARED), name))
    return options


def facts(bench, options):
    return {"program": bench.ask("--version").strip(), "date": datetime.date.today().isoformat(), "quick": bench.quick,
            "tuned": not (options.plain or options.quick or options.vs),
            "machine": {"cores": os.cpu_count(), "processor": platform.machine(), "system": platform.system()},
            "hand_written": bench.hand is not None}


def show_series(options):
    if options.release:
        series.append(options.release)
    rows = series.read()
    os.makedirs(options.build, exist_ok=True)
    path = os.path.join(options.build, "series.svg")
    series.draw(rows, path)
    print(series.text(rows) + "\ndrawn in " + os.path.relpath(path))


def main(arguments):
    options = parse(arguments)
    if options.only_words:
        return 0
    try:
        if options.series:
            show_series(options)
            return 0
        bench = Bench(options)
        results = facts(bench, options)
        if options.vs:
            names = options.names or list(PROBLEMS)
            if timed := [name for name in names if name in PROBLEMS]:
                results["vs"] = versus.compare(bench, options.vs, timed)
            if "instructions" in names:
                results["instructions"] = instructions.compare(bench, options.vs)
        else:
            for name in options.names or usual_parts(options.quick):
                bench.print("\n== %s: %s ==" % (name, PARTS[name][0]))
                results[name] = PARTS[name][1](bench)
    except Failed as failure:
        sys.stderr.write("bench: %s\n" % failure)
        return 1
    path = os.path.join(bench.build, "versus.json" if options.vs else "results.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)
        file.write("\n")
    if options.page:
        page.rewrite(results)
    bench.print("\nall numbers are in " + os.path.relpath(path))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
