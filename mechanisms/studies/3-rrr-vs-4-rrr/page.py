"""The page of the study: page.py PROGRAM DOCS RESULTS writes page.md.in with tables of what was found, and of each claim whether
it holds, and pictures, to the folder DOCS. RESULTS has the directories `series` and `ideal` that `freeplay study run --keep all` made of
series.yaml and ideal.yaml; `./dev study 3-rrr-vs-4-rrr` does it all.
"""
import csv
import json
import math
import os
import subprocess
import sys

import h5py

import figures

HERE = os.path.dirname(os.path.abspath(__file__))
NAME = os.path.basename(HERE)
MECHANISMS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "{}.yaml")
BASE = {"c": 1e-4, "T": 0.5, "mu": 0.1}  # of both models, where an axis does not set it
POSES = 120  # on the circle
COUPLER = 0.24  # m, l2 of both models
NAMES = {"c": "clearance", "T": "turn", "mu": "friction"}
WORDS = {"c": "{:.2f} mm", "T": "{:g} s", "mu": "{:g}"}
SCALES = {"c": 1e3, "T": 1.0, "mu": 1.0}


class Run:
    """A row of the table and the results that were kept of it."""

    def __init__(self, study, row):
        self.row = row
        self.folder = os.path.join(study, "kept", "%04d" % (int(row["index"]) // 1000), row["index"])
        self.period = float(row["T"] or BASE["T"])

    def value(self, column):
        return float(self.row[column])

    def over_joints(self, quantity, how=max):
        cells = [cell for name, cell in self.row.items() if name.startswith("loose.") and name.endswith("." + quantity)]
        return how(float(cell) for cell in cells if cell)

    def summary(self):
        with open(os.path.join(self.folder, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    def end(self):
        return self.summary()["time"]["reached"]

    def excess(self, bounds, factor):
        """How far the position error leaves `factor` times the static bound at its place on the circle [m]; the bound
        between two poses is the larger one."""
        with h5py.File(os.path.join(self.folder, "results.h5"), "r") as file:
            times, ex, ey = (file[name][:] for name in ("time", "driver.circle.ex", "driver.circle.ey"))
        first, worst = self.summary()["settings"]["discard"] - 1e-12, -math.inf
        for t, x, y in zip(times, ex, ey):
            if t < first:
                continue
            k = int(t / self.period * POSES) % POSES
            bound = factor * max(bounds[k]["position"], bounds[k + 1]["position"])
            worst = max(worst, math.hypot(x, y) - bound)
        return worst


def table_of(study):
    with open(os.path.join(study, "study.csv"), encoding="utf-8") as file:
        return [Run(study, row) for row in csv.DictReader(file)]


def read(results):
    """The values of each series, and {(mechanism, parameter, value): Run}; parameter "ideal": without play at the period `value`. The
    point about which the series vary is in all of them."""
    series, runs = {name: set() for name in BASE}, {}
    for run in table_of(os.path.join(results, "series")):
        varied = [name for name in BASE if run.row[name]]
        for name in varied or BASE:
            value = float(run.row[name] or BASE[name])
            series[name].add(value)
            runs[run.row["model"], name, value] = run
    for run in table_of(os.path.join(results, "ideal")):
        runs[run.row["model"], "ideal", run.period] = run
    return {name: sorted(values, reverse=name == "T") for name, values in series.items()}, runs


def analysis(program, mechanism, *words):
    done = subprocess.run([program, "analyze", "error", MECHANISMS.format(mechanism), *words], capture_output=True, text=True,
                          check=True)
    return [{name: float(text) if text else math.nan for name, text in row.items()}
            for row in csv.DictReader(done.stdout.splitlines())]


def at_rest(program, mechanism):
    """Worst static errors at poses of the circle, the last of which is the first again, at the centre, and over the model's grid."""
    return {"bounds": analysis(program, mechanism, "--time", "0:%r:%d" % (BASE["T"], POSES + 1)),
            "centre": analysis(program, mechanism, "--pose", "0,0,0")[0], "map": analysis(program, mechanism)}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def um(value):
    return "%.1f" % (1e6 * value)


def mrad(value):
    return "%.3f" % (1e3 * value)


def static_table(static):
    rows = []
    for mechanism, own in static.items():
        path, centre = own["bounds"], own["centre"]
        worst = max(path, key=lambda row: row["position"])
        rows.append([mechanism, um(centre["position"]), um(centre["ls_position"]), mrad(centre["dangle"]),
                     um(worst["position"]), um(max(row["ls_position"] for row in path)),
                     um(min(row["position"] for row in path)), mrad(max(row["dangle"] for row in path))])
    return table(["", "centre, exact [um]", "centre, least squares [um]", "centre, angle [mrad]",
                  "circle, largest exact [um]", "circle, largest least squares [um]", "circle, smallest exact [um]",
                  "circle, largest angle [mrad]"], rows)


def run_rows(series, static, runs, name):
    rows = []
    for value in series[name]:
        for mechanism in static:
            run = runs[mechanism, name, value]
            ideal = runs[mechanism, "ideal", run.period]
            rows.append([WORDS[name].format(SCALES[name] * value), mechanism, um(run.value("position_error")),
                         um(run.value("usual_error")), mrad(run.value("angle_error")),
                         "%.1f" % run.over_joints("rms_force"), "%.0f" % run.over_joints("max_force"),
                         "%.2f" % (1e6 * run.over_joints("max_delta")),
                         "%.1f" % (100 * run.over_joints("contact_fraction", min)),
                         "%.2f" % run.value("torque"), "%.2f" % ideal.value("torque"), "%.1f" % run.value("peak_torque")])
    return table([NAMES[name], "", "largest error [um]", "rms error [um]", "largest angle [mrad]",
                  "rms force, worst joint [N]", "largest force [N]", "largest penetration [um]",
                  "in contact, worst joint [%]", "rms torque, worst driver [N m]", "the same, ideal [N m]", "largest torque [N m]"],
                 rows)


def envelope_rows(series, static, runs):
    """Excess over the static bound, and over that of a clearance wider by the largest penetration."""
    rows, worst = [], -math.inf
    for mechanism, name in [(mechanism, name) for mechanism in static for name in series]:
        for value in series[name]:
            run = runs[mechanism, name, value]
            clearance = value if name == "c" else BASE["c"]
            bounds = static[mechanism]["bounds"]
            rigid, elastic = (run.excess(bounds, (clearance + more) / BASE["c"])
                              for more in (0.0, run.over_joints("max_delta")))
            worst = max(worst, elastic)
            rows.append([mechanism, "%s %s" % (NAMES[name], WORDS[name].format(SCALES[name] * value)),
                         "%.2f" % (1e6 * rigid), "%.2f" % (1e6 * elastic)])
    return table(["", "run", "over the bound [um]", "over the bound with penetration [um]"], rows), worst


def pairs(series, static, runs, name, quantity):
    """Points of a series at which the 4-RRR has the smaller value, of how many."""
    three, four = static
    values = series[name]
    better = sum(quantity(runs[four, name, value]) < quantity(runs[three, name, value]) for value in values)
    return better, len(values)


def verdict(better, count):
    return "holds" if better == count else "does not hold" if better == 0 else "holds in part"


def static_claims(static):
    three, four = static.values()
    both = [(a, b) for a, b in zip(three["map"], four["map"]) if a["position"] == a["position"] and
            b["position"] == b["position"]]
    claims = []
    for name, words in (("position", "smaller worst position error (exact)"),
                        ("ls_position", "smaller worst position error (least squares)"),
                        ("dangle", "smaller worst orientation error")):
        path = [b[name] < a[name] for a, b in zip(three["bounds"][1:], four["bounds"][1:])]
        cells = [b[name] < a[name] for a, b in both]
        claims.append(["at rest: %s on the circle" % words, verdict(sum(path), len(path)),
                       "%d of %d poses; largest there %s" % (sum(path), len(path), " against ".join(
                           (mrad if name == "dangle" else um)(max(row[name] for row in own["bounds"]))
                           for own in (four, three)))])
        claims.append(["at rest: %s where both reach" % words, verdict(sum(cells), len(cells)),
                       "%.0f %% of %d cells of the map" % (100.0 * sum(cells) / max(1, len(cells)), len(cells))])
    at = [own["centre"]["ls_position"] for own in (four, three)]
    claims.append(["at rest: smaller worst position error at the centre (least squares)",
                   verdict(int(at[0] < at[1]), 1), "%s um against %s um" % tuple(um(value) for value in at)])
    return claims


def dynamic_claims(series, static, runs):
    claims = []
    for words, quantity in (("largest platform error", lambda run: run.value("position_error")),
                            ("rms platform error", lambda run: run.value("usual_error")),
                            ("largest platform angle error", lambda run: run.value("angle_error")),
                            ("rms joint force of the worst joint", lambda run: run.over_joints("rms_force")),
                            ("largest joint force", lambda run: run.over_joints("max_force")),
                            ("time out of contact of the worst joint", lambda run: -run.over_joints("contact_fraction", min)),
                            ("largest driver torque", lambda run: run.value("peak_torque"))):
        counts = [pairs(series, static, runs, name, quantity) for name in series]
        claims.append(["in motion: smaller %s" % words, verdict(sum(b for b, _ in counts), sum(n for _, n in counts)),
                       "; ".join("%s %d of %d" % (NAMES[name], *count) for name, count in zip(series, counts))])
    return claims


def text(series, static, runs, images):
    envelope, worst = envelope_rows(series, static, runs)
    claims = static_claims(static) + dynamic_claims(series, static, runs)
    usual = next(iter(runs.values())).summary()["settings"]
    with open(os.path.join(HERE, "page.md.in"), encoding="utf-8") as file:
        words = file.read()
    return words.format(
        c=1e3 * BASE["c"], T=BASE["T"], mu=BASE["mu"], turns=usual["end"] / BASE["T"], accuracy=1e6 * usual["step"]["accuracy"],
        images=images, claims=table(["The 4-RRR has the", "", "found"], claims), static=static_table(static),
        table_c=run_rows(series, static, runs, "c"), table_T=run_rows(series, static, runs, "T"),
        table_mu=run_rows(series, static, runs, "mu"), envelope=envelope, worst=1e6 * worst,
        second=1e6 * (2 * max(series["c"])) ** 2 / (2 * COUPLER))


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    program, docs, results = map(os.path.abspath, sys.argv[1:])
    series, runs = read(results)
    static = {m: at_rest(program, m) for m in dict.fromkeys(mechanism for mechanism, _, _ in runs)}
    folder = os.path.join(docs, "images", NAME)
    os.makedirs(folder, exist_ok=True)
    for old in os.listdir(folder):
        os.remove(os.path.join(folder, old))
    figures.bounds(static, folder)
    pictures = figures.Pictures(program, folder)
    pictures.of_runs(runs, BASE)
    for m in static:
        pictures.draw("map-" + m, "analyze", "error", MECHANISMS.format(m))
    for plot in ("error-clearance", "error-time", "force-clearance", "force-friction", "what-matters"):
        pictures.draw(plot, "study", "plot", os.path.join(results, "series"), plot)
    with open(os.path.join(docs, NAME + ".md"), "w", encoding="utf-8") as file:
        file.write(text(series, static, runs, "images/" + NAME))


if __name__ == "__main__":
    main()
