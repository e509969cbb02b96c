"""Error against time: every integrator with every step and accuracy, and the hand-written programs in the same pass."""
import csv
import hashlib
import json
import os

from tables import table
from timing import Failed, alternate, largest_distance, median, ratio

FINALISTS = 6  # of either side that are measured again before one is chosen


def integrators(bench):
    return [entry["name"] for entry in json.loads(bench.ask("list", "integrators", "--json"))]


def own_reference(bench, problem):
    """The rows of the program itself at an accuracy beyond those that are tried; kept for this build and model."""
    options = problem.options("--accuracy", repr(problem.best))
    with open(problem.file(), "rb") as model, open(bench.program.path, "rb") as build:
        key = hashlib.sha256(model.read() + build.read() + repr((options, problem.points)).encode()).hexdigest()[:20]
    path = os.path.join(bench.build, "references", "%s-%s.json" % (problem.name, key))
    if not os.path.exists(path):
        rows = bench.program.run(problem.file(), options, "reference").columns(("time",) + problem.points)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(rows, file)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def stored_reference(bench, problem, times):
    """The points of the stored trajectory at these times, or None."""
    path = os.path.join(bench.trajectories, problem.trajectory)
    if not problem.trajectory or not os.path.isfile(path):
        return None
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(file)
        header = next(rows)
        places = [header.index(name) for name in ("t",) + problem.columns]
        known = {round(float(row[places[0]]) * 1e9): [float(row[place]) for place in places[1:]] for row in rows}
    keys = [round(time * 1e9) for time in times]
    return [known[key] for key in keys] if all(key in known for key in keys) else None


def reference(bench, problem):
    """Points, where they are from, and how far the program's own are from stored ones [m]."""
    own = own_reference(bench, problem)
    points = [row[1:] for row in own]
    stored = stored_reference(bench, problem, [row[0] for row in own])
    if stored is None:
        return points, "own run, accuracy %g m" % problem.best, None
    return stored, "stored trajectory", largest_distance(points, stored)


def measure(bench, problem):
    points, source, apart = reference(bench, problem)
    bench.print("%s: first %g s, error against %s%s" % (
        problem.name, problem.end, source, "" if apart is None else " (own run, accuracy %g m: %.2g m apart)" % (problem.best, apart)))
    records, timed = [], problem.timed_file(bench.build)
    for name, kind, value, options in problem.candidates(integrators(bench), bench.quick):
        record = {"integrator": name, "kind": kind, "value": value, "options": options}
        records.append(record)
        try:
            run = bench.program.run(problem.file(), options)
            record.update(error=largest_distance(run.columns(problem.points), points), steps=run.steps, rate=run.rate)
            if not problem.once:
                record["rate"] = problem.rate(bench, timed, options)
        except Failed as failure:
            record["failure"] = str(failure)
    bench.print(table(["integrator", "", "[s] or [m]", "error [m]", "wall s/s", "steps"], [
        [r["integrator"], r["kind"], "%g" % r["value"]] + (
            ["failed", "", ""] if "failure" in r else ["%.2e" % r["error"], "%.4g" % r["rate"], r["steps"]]) for r in records]))
    result = {"target": problem.target, "reference": source, "own_from_stored": apart, "runs": records}
    best = cheapest(records, problem.target, "integrator")
    if bench.hand and problem.hand:
        theirs = bench.hand.all(problem, bench.quick)
        result["hand_written"] = theirs
        hand_best = cheapest(theirs, problem.target, "method")
        bench.print(table(["hand-written", "[s] or [m]", "error [m]", "wall s/s"], [
            [r["method"], "%g" % r["value"], "%.2e" % r["error"], "%.4g" % r["rate"]] for r in hand_best.values()]))
        result["comparisons"] = compare(bench, problem, records, theirs)
    result["best"] = list(best.values())
    bench.print("cheapest runs with an error of at most %g m:" % problem.target)
    bench.print(table(["integrator", "", "[s] or [m]", "error [m]", "wall s/s"], [
        [r["integrator"], r["kind"], "%g" % r["value"], "%.2e" % r["error"], "%.4g" % r["rate"]]
        for r in sorted(best.values(), key=lambda r: r["rate"])]))
    return result


def cheapest(records, target, key):
    """By `key`, the record that reaches the target in the least time."""
    best = {}
    for record in records:
        if record.get("error", target + 1.0) <= target and record["rate"] < best.get(record[key], {"rate": 1e300})["rate"]:
            best[record[key]] = record
    return best


def choose(records, target, again):
    """The cheapest of those that reach the target; None without one."""
    good = sorted((r for r in records if r.get("error", target + 1.0) <= target), key=lambda r: r["rate"])
    return min(good[:FINALISTS], key=again, default=None)


def compare(bench, problem, records, theirs):
    """Our best against theirs, and Bathe against Bathe at the same step, pair by pair."""
    timed = problem.timed_file(bench.build)

    def our_rate(record):
        return problem.rate(bench, timed, record["options"])

    def their_rate(record):
        return bench.hand.again(problem, record)

    pairs = []
    ours, hand = choose(records, problem.target, our_rate), choose(theirs, problem.target, their_rate)
    if ours and hand:
        pairs.append(("best at %g m" % problem.target, ours, hand))
    mine = {r["value"]: r for r in records if r["integrator"] == "bathe" and r["kind"] == "step" and "error" in r}
    same = {r["value"]: r for r in theirs if r["method"] == "bathe predict" and r["value"] in mine}
    good = [h for h in same if max(same[h]["error"], mine[h]["error"]) <= problem.target]
    if same:
        step = max(good) if good else min(same)
        pairs.append(("bathe, step %g s" % step, mine[step], same[step]))
    rows, found = [], []
    for what, a, b in pairs:
        left, right = alternate(bench.passes, lambda: our_rate(a), lambda: their_rate(b))
        factor = ratio(left, right)
        found.append({"what": what, "ours": a, "theirs": b, "rate": median(left), "their_rate": median(right), "ratio": factor,
                      "rates": left, "their_rates": right})
        rows.append([what, "%s %s %g" % (a["integrator"], a["kind"], a["value"]), "%.2e" % a["error"], a["steps"],
                     "%.4g" % median(left), "%s %g" % (b["method"], b["value"]), "%.2e" % b["error"], b["steps"],
                     "%.4g" % median(right), "%.2f" % factor])
    bench.print("ratios, median of %d, taken in turn:" % bench.passes)
    bench.print(table(["", "ours", "error [m]", "steps", "wall s/s", "by hand", "error [m]", "steps", "wall s/s", "ratio"], rows))
    return found
