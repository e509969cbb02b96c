"""Programs written by hand for one mechanism each, to run beside, where a folder with them is given: FREEPLAY_LOWER_BOUND
or ../shared/reference/lower-bound. They are compiled into the build folder and used from there; so are the references
that they compute for themselves."""
import os
import re
import shlex
import subprocess

from problems import ROOT
from timing import Failed

RK4_STEPS = "1.6e-5,1.2e-5,1e-5,8e-6,6e-6,4e-6,3e-6,2e-6,1.5e-6,1e-6,7e-7,5e-7"
BATHE_STEPS = "1e-5,8e-6,6e-6,5e-6,4e-6,2e-6,1e-6,5e-7,2e-7,1e-7,5e-8"
CONTACT_METHODS = (  # method, options, steps or tolerances
    ("rk4", ("--contact", "split"), RK4_STEPS),
    ("rk4", ("--contact", "predict"), RK4_STEPS),
    ("bathe", ("--contact", "split", "--newton-tol", "1e-9"), BATHE_STEPS),
    ("bathe", ("--contact", "predict", "--newton-tol", "1e-9"), BATHE_STEPS),
    ("dopri", (), "1e-7,5e-8,2e-8,1e-8,5e-9,2e-9,1e-9,5e-10,2e-10,1e-10"),
    ("extrap", (), "1e-6,1e-7,1e-8,1e-9"),
    ("adams", (), "1e-7,1e-8,3e-9,1e-9,1e-10"))
CHAIN_METHODS = (("natural", (), "2e-2,1.66667e-2,1.42857e-2,1.25e-2,1e-2,5e-3,2e-3"),)  # parts of 0.1 s
CHAIN_LINE = re.compile(r"^p2 .* h= *\S+ +B0 error to 1 s (\S+) m, to 10 s \S+ m +wall s/s (\S+)")


def source_folder():
    """The folder, or None where there is none."""
    given = os.environ.get("FREEPLAY_LOWER_BOUND")
    folder = given or os.path.join(os.path.dirname(ROOT), "shared", "reference", "lower-bound")
    if os.path.exists(os.path.join(folder, "Makefile")):
        return os.path.abspath(folder)
    if given:
        raise Failed("FREEPLAY_LOWER_BOUND: no Makefile in '%s'" % given)
    return None


def trajectories(source):
    return os.path.join(os.path.dirname(source), "trajectories") if source else ""


class HandWritten:
    def __init__(self, source, build):
        folder = os.path.join(build, "hand-written", "programs")
        os.makedirs(folder, exist_ok=True)
        self.program = os.path.join(folder, "lower_bound")
        # It looks for stored trajectories beside its own folder.
        link = os.path.join(folder, os.pardir, "trajectories")
        if os.path.isdir(trajectories(source)) and not os.path.islink(link):
            os.symlink(trajectories(source), link)
        newest = max(os.path.getmtime(os.path.join(source, name)) for name in os.listdir(source))
        if not os.path.exists(self.program) or os.path.getmtime(self.program) < newest:
            self.compile(source)

    def compile(self, source):
        """With the command of their own Makefile, but for the place of the result."""
        told = subprocess.run(["make", "-nB", "--no-print-directory", "lower_bound"], cwd=source, capture_output=True, text=True)
        words = next((shlex.split(line) for line in told.stdout.splitlines() if " -o lower_bound" in line), None)
        if not words:
            raise Failed("the Makefile in '%s' does not say how lower_bound is compiled\n%s" % (source, told.stderr))
        words[words.index("-o") + 1] = self.program
        done = subprocess.run(words, cwd=source, capture_output=True, text=True)
        if done.returncode != 0:
            raise Failed("the hand-written programs do not compile:\n" + done.stderr[-2000:])

    def measure(self, problem, method, options, values):
        """One record for each step or tolerance: error at the end of the window, wall seconds per simulated second."""
        words = [self.program, "--problem", problem.hand, "--method", method, "--h", values, *problem.hand_options, *options]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode != 0:
            raise Failed("%s: %s" % (" ".join(words), done.stderr.strip()))
        records = []
        for value, line in zip(values.split(","), done.stdout.splitlines(), strict=True):
            chain = CHAIN_LINE.match(line)
            cells = line.split()
            error, rate = (chain[1], chain[2]) if chain else (cells[5], cells[6])
            records.append({"method": " ".join([method, *options[1:2]]), "call": [method, list(options)],
                            "value": float(value), "error": float(error), "rate": float(rate),
                            "steps": round(1.0 / float(value)) if chain else int(cells[9])})
        return records

    def all(self, problem, quick):
        """Every method with every step and tolerance."""
        records = []
        for method, options, values in CHAIN_METHODS if problem.hand == "p2" else CONTACT_METHODS:
            if quick and method not in ("dopri", "bathe", "natural"):
                continue
            records += self.measure(problem, method, options, values)
        return records

    def again(self, problem, record):
        """Wall seconds per simulated second of an earlier record, measured anew."""
        method, options = record["call"]
        return self.measure(problem, method, options, repr(record["value"]))[0]["rate"]
