"""Two revisions in one run: the other one is built beside, and both are timed in turn."""
import filecmp
import os
import shutil
import subprocess

from problems import PROBLEMS, ROOT
from tables import table
from timing import Failed, Program, alternate, median, ratio

FILES = ("results.csv", "events.csv")


def told(*words, cwd=ROOT):
    done = subprocess.run(words, cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise Failed("%s: %s" % (" ".join(words), (done.stderr or done.stdout).strip()[-2000:]))
    return done.stdout.strip()


def build(revision, folder):
    """The program of a revision, built in a folder of its own that is kept for the next time."""
    try:
        commit = told("git", "rev-parse", "--verify", "--quiet", revision + "^{commit}")
    except Failed as failure:
        raise Failed("there is no revision '%s' here; git log --oneline lists some" % revision) from failure
    tree = os.path.join(folder, "revisions", commit[:12])
    program = os.path.join(tree, "build", "release", "freeplay")
    if not os.path.exists(program):
        print("building %s (%s)" % (revision, commit[:12]), flush=True)
        shutil.rmtree(tree, ignore_errors=True)
        os.makedirs(tree)
        archive = os.path.join(tree, "tree.tar")
        told("git", "archive", "--output", archive, commit)
        told("tar", "-xf", archive, cwd=tree)
        os.remove(archive)
        told("cmake", "--preset", "release", cwd=tree)
        told("cmake", "--build", "--preset", "release", "--target", "freeplay", cwd=tree)
    return program


def cases(names):
    """(label, model, options) of what is timed for each mechanism: a run of fixed steps and one by accuracy of each kind."""
    for name in names:
        problem = PROBLEMS[name]
        step, accuracy = problem.steps[len(problem.steps) // 2], problem.accuracies[len(problem.accuracies) // 2]
        for integrator in ("bathe", "generalized-alpha"):
            yield name, problem.file(), problem.options("--integrator", integrator, "--step", repr(step))
        for integrator in ("dopri5", "bathe"):
            yield name, problem.file(), problem.options("--integrator", integrator, "--accuracy", repr(accuracy))


def compare(bench, revision, names):
    other = Program(build(revision, bench.build), os.path.join(bench.build, "runs"))
    bench.print("this tree against %s: wall seconds, ratio below 1: this tree is faster; median of %d pairs" % (revision, bench.passes))
    rows, found = [], []
    for name, model, options in cases(names):
        label = " ".join(options[options.index("--integrator") + 1:])
        try:
            ours, theirs = alternate(bench.passes, lambda: bench.program.run(model, options, "this"),
                                     lambda: other.run(model, options, "other"))
        except Failed as failure:
            rows.append([name, label, "failed", "", "", str(failure)])
            found.append({"name": name, "options": options, "failure": str(failure)})
            continue
        same = all(filecmp.cmp(os.path.join(ours[0].folder, file), os.path.join(theirs[0].folder, file), shallow=False)
                   for file in FILES)
        a, b = [run.wall for run in ours], [run.wall for run in theirs]
        found.append({"name": name, "options": options, "wall": a, "other_wall": b, "ratio": ratio(a, b), "same_bytes": same})
        rows.append([name, label, "%.4g" % median(a), "%.4g" % median(b), "%.3f" % ratio(a, b), "same" if same else "differ"])
    bench.print(table(["mechanism", "run", "this [s]", "other [s]", "ratio", "bytes"], rows))
    return {"revision": revision, "runs": found}
