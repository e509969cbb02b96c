"""The largest values of tables and summaries: no row exceeds them, and they say from when to when they are taken."""
import csv
import glob
import itertools
import json
import math
import os
import re
import unittest

from program import ROOT, ProgramTest, mechanism

PART = 1e-6  # of a peak, by which a row may exceed it

# Short enough to be quick, long enough to meet impacts.
SHIPPED = sorted(glob.glob(os.path.join(ROOT, "mechanisms", "*.yaml")) +
                 glob.glob(os.path.join(ROOT, "mechanisms", "spatial", "*.yaml")) +
                 glob.glob(os.path.join(ROOT, "mechanisms", "validation", "*.yaml")))
PENDULUM = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 1/12, com: [0.5 m, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
simulation: {end: 2 s, output: {interval: 2 s}}
"""
# The rod is longer than the crank by so much: as far from a singular position each half turn comes, and the force of a
# joint rises from 10 N to 600 kN and falls again within 3 ms.
NEARLY_SINGULAR = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 1e-3, frames: {p: [50 mm, 0]}}
  rod: {mass: 1, inertia: 2e-3, com: [75 mm, 0], frames: {p: [%s mm, 0]}, pose: {position: [50 mm, 0]}}
  slide: {mass: 2, inertia: 1e-3}
joints:
  O: {type: revolute, between: [ground, crank]}
  P: {type: revolute, between: [crank/p, rod]}
  S: {type: revolute, between: [rod/p, slide]}
  G: {type: prismatic, between: [ground, slide]}
drivers: {m: {joint: O, kind: velocity, value: 10}}
simulation: {end: 1}
"""
# A wheel that turns at 10 rad/s whatever the load; the torque of its driver is that of the load. The rms by the integral of
# its square.
LOADED_WHEEL = """freeplay: 1
bodies: {w: {mass: 1, inertia: 0.01, frames: {rim: [0.1, 0]}}%s}
joints: {g: {type: revolute, between: [ground, w]}%s}
drivers: {m: {joint: g, kind: velocity, value: 10}}
forces: {f: {type: torque, on: w, value: "%s"}}
simulation: {end: 1 s, accuracy: %s, integrator: %s, output: {interval: 1 ms}}
"""
# What moves freely beside the wheel does not show what the torque does to its motor either.
BESIDE_WHEEL = {"nothing": ("", ""),
                "a pendulum": (", p: {mass: 1, inertia: 0.02, frames: {a: [-0.3, 0]}}", ", h: {type: revolute, between: [ground, p/a]}"),
                "a rider": (", p: {mass: 0.001, inertia: 1e-5, frames: {a: [-0.1, 0]}}", ", h: {type: revolute, between: [w/rim, p/a]}")}
GAUSS = 7.0 * math.sqrt(1e-3 * math.sqrt(math.pi / 2.0))
RIPPLE = [3.0 * math.sin(400.0 * i / 200000) + 4.0 * math.cos(200.0 * i / 200000)**3 for i in range(200001)]
LOADS = (("7*exp(-((t - 0.5455405549459713)/0.001)^2)", 7.0, GAUSS), ("7*exp(-((t - 0.51234)/0.001)^2)", 7.0, GAUSS),
         ("7*exp(-((joint.g.angle - 5.1234 rad)/(0.01 rad))^2)", 7.0, GAUSS),
         ("7*(1 - tanh((t - 0.4321)/0.002)^2)", 7.0, 7.0 * math.sqrt(0.002 * 4.0 / 3.0)),
         ("7/(1 + ((t - 0.61)/0.004)^2)", 7.0, 7.0 * math.sqrt(0.004 * math.pi / 2.0)),
         ("7*sin(50*t)", 7.0, 7.0 * math.sqrt(0.5 - math.sin(100.0) / 200.0)),
         ("3*sin(400*t) + 4*cos(200*t)^3", max(map(abs, RIPPLE)), math.sqrt(sum(value * value for value in RIPPLE) / len(RIPPLE))))
ENDS = {"slider-crank": 2e-3, "3-rrr": 0.01, "4-rrr": 0.01, "slider-crank-clearance": 4e-3, "cradle-3": 0.02, "cradle-5": 0.02,
        "bathe-noh": 2.0, "bathe-noh-trapezoidal": 2.0}


def length(row, prefix, names):
    return math.hypot(*(float(row[prefix + name]) for name in names))


def moment(row, prefix):
    return abs(float(row[prefix + "torque"])) if prefix + "torque" in row else length(row, prefix + "t", "xyz")


def peaks_of_rows(rows, model):
    """Largest values of the rows under the names of summary.json."""
    last = {}

    def note(*name, value):
        last[name] = max(last.get(name, -math.inf), value)

    space = "xyz" if model["model"]["space"] == "spatial" else "xy"
    for row in rows:
        for name in model["bodies"]:
            note("bodies", name, "max_speed", value=length(row, "body.%s.v" % name, space))
        for name, joint in model["joints"].items():
            prefix = "joint.%s." % name
            note("joints", name, "max_force", value=length(row, prefix + "f", space))
            note("joints", name, "max_torque", value=moment(row, prefix))
            if joint["max_fn"] is not None:
                note("joints", name, "max_fn", value=float(row[prefix + "fn"]))
                note("joints", name, "max_delta", value=float(row[prefix + "delta"]))
                axes = [axis for axis in space if prefix + "e" + axis in row]
                if axes:  # a slide has none
                    note("joints", name, "max_eccentricity", value=length(row, prefix + "e", axes))
        for name in model["forces"]:
            note("forces", name, "max_force", value=length(row, "force.%s.f" % name, space))
            note("forces", name, "max_torque", value=moment(row, "force.%s." % name))
        for name in model["drivers"]:
            prefix = "driver.%s." % name
            effort = row.get(prefix + "torque", row.get(prefix + "force"))
            note("drivers", name, "max_abs", value=abs(float(effort)))
        for name in model["paths"]:
            note("paths", name, "max_position", value=length(row, "driver.%s.e" % name, "xy"))
            note("paths", name, "max_angle", value=abs(float(row["driver.%s.eangle" % name])))
    return last


class PeaksTest(ProgramTest):
    def run_model(self, model, *options):
        out, err = self.freeplay("run", model, "--out", "r", "--force", *options)
        rows = list(csv.DictReader(self.read("r", "results.csv").splitlines()))
        return rows, json.loads(self.read("r", "summary.json")), out, err

    def assert_no_row_exceeds(self, rows, summary):
        rows = [row for row in rows if float(row["time"]) >= summary["statistics"]["from"]]
        for (kind, name, key), value in peaks_of_rows(rows, summary).items():
            peak = summary[kind][name][key]
            self.assertLessEqual(value, peak + PART * abs(peak) + 1e-15, (kind, name, key))

    def finely_written(self, path, end):
        """A copy of a model whose rows are fine, and whose statistics leave nothing out."""
        with open(path, encoding="utf-8") as file:
            text = file.read()
        text = re.sub(r"interval: [^,}\n]+", "interval: %g" % (end / 400), text)
        text = re.sub(r"(, )?discard: [^,}\n]+", "", text)
        return self.write(os.path.basename(path), text)

    def test_no_row_exceeds_a_peak_in_any_shipped_model(self):
        for path in SHIPPED:
            end = ENDS.get(os.path.basename(path)[:-5], 0.05)
            for options in (("--accuracy", "1um"), ("--step", "%g" % (end / 2000))):
                with self.subTest(os.path.relpath(path, ROOT), options=options):
                    model = self.finely_written(path, end)
                    rows, summary, _, _ = self.run_model(model, "--end", "%g" % end, *options)
                    self.assertGreater(len(rows), 390)
                    self.assert_no_row_exceeds(rows, summary)

    def test_a_peak_does_not_depend_on_how_fine_the_rows_are(self):
        # A pendulum that is let go: largest speed and force at the bottom, which coarse steps pass by.
        self.write("m.yaml", PENDULUM)
        for accuracy in ("1mm", "10um", "0.1um"):
            _, summary, _, _ = self.run_model("m.yaml", "--accuracy", accuracy)
            self.assertAlmostEqual(1.0, summary["joints"]["pivot"]["max_force"] / (2.5 * 9.81), delta=2e-4)
            self.assertAlmostEqual(1.0, summary["bodies"]["rod"]["max_speed"] / (0.5 * math.sqrt(3 * 9.81)), delta=2e-4)

    def test_no_row_of_another_run_exceeds_a_peak_by_much(self):
        # The same steps with rows as fine as steps are long at most: what these see the table of the coarse run has, too.
        models = {"near 1 um": (NEARLY_SINGULAR % "50.001", 1.0), "near 1 mm": (NEARLY_SINGULAR % "51", 1.0),
                  "pendulum": (PENDULUM, 2.0)}
        for name, (text, end) in models.items():
            self.write("m.yaml", text)
            for options in (("--accuracy", "10um"), ("--accuracy", "1um"), ("--accuracy", "0.1um", "--integrator", "verner7"),
                            ("--accuracy", "1um", "--integrator", "verner6"), ("--accuracy", "1um", "--integrator", "bathe"),
                            ("--accuracy", "1um", "--integrator", "newmark")):
                with self.subTest(name, options=options):
                    _, coarse, _, _ = self.run_model("m.yaml", *options, "--interval", "%g" % end)
                    for rows in (300, 7919):
                        rows, fine, _, _ = self.run_model("m.yaml", *options, "--interval", "%.9g" % (end / rows))
                        self.assert_no_row_exceeds(rows, fine)
                    for (kind, element, key), value in peaks_of_rows(rows, fine).items():
                        self.assertLessEqual(value, coarse[kind][element][key] * 1.003 + 1e-12, (kind, element, key))

    def test_smooth_loads_on_what_only_drivers_move_have_their_peaks_and_means(self):
        methods = (("100 um", "verner7"), ("1 um", "dopri5"), ("1 um", "bathe"), ("10 nm", "verner7"))
        for (load, largest, rms), (accuracy, integrator), beside in itertools.product(LOADS, methods, BESIDE_WHEEL):
            if beside == "nothing" or integrator == "dopri5":
                with self.subTest(load=load, accuracy=accuracy, integrator=integrator, beside=beside):
                    bodies, joints = BESIDE_WHEEL[beside]
                    self.write("m.yaml", LOADED_WHEEL % (bodies, joints, load, accuracy, integrator))
                    _, summary, _, _ = self.run_model("m.yaml")
                    motor = summary["drivers"]["m"]
                    self.assertAlmostEqual(1.0, motor["max_abs"] / largest, delta=2e-3)
                    self.assertAlmostEqual(1.0, motor["rms"] / rms, delta=5e-3)

    def test_the_window_is_printed_with_what_it_leaves_out(self):
        self.write("m.yaml", PENDULUM.replace("interval: 2 s", "interval: 10 ms, discard: 0.6 s"))
        for options in (("--accuracy", "1um"), ("--step", "1 ms")):
            rows, summary, out, err = self.run_model("m.yaml", "--end", "0.8 s", *options)
            self.assertEqual("", err)
            reached = max(length(row, "joint.pivot.f", "xy") for row in rows if float(row["time"]) < 0.6)
            self.assertRegex(out, r"\n  statistics from 0\.6 s to 0\.8 s; before that pivot reached 24\.\d+ N\n")
            before = summary["statistics"]["before"]["joints"]["pivot"]["max_force"]
            self.assertLessEqual(reached, before)
            self.assertLess(summary["joints"]["pivot"]["max_force"], before)
            self.assertEqual((0.6, 0.8), (summary["statistics"]["from"], summary["statistics"]["to"]))

    def test_what_is_left_out_has_the_events_and_peaks_of_a_run_that_leaves_out_nothing(self):
        for name, end in (("slider-crank", 4e-3), ("3-rrr", 12e-3), ("slider-in-guide", 40e-3)):
            with open(mechanism(name), encoding="utf-8") as file:
                text = re.sub(r"(, )?discard: [^,}\n]+", "", file.read())
            whole, part = (self.write(file, re.sub(r"output: \{", "output: {discard: %g s, " % discard, text))
                           for file, discard in (("whole.yaml", 0.0), ("part.yaml", 0.98 * end)))
            with self.subTest(name):
                options = ("--end", "%g" % end, "--step", "%g" % (end / 2000))
                rows, all_counts, _, _ = self.run_model(whole, *options)
                events = self.read("r", "events.csv")
                others, left_out, _, _ = self.run_model(part, *options)
                self.assertEqual(rows, others)
                self.assertEqual(events, self.read("r", "events.csv"))
                self.assertGreater(events.count("contact_end"), 3)
                for kind, key in (("joints", "max_force"), ("drivers", "max_abs")):
                    for element, before in left_out["statistics"]["before"][kind].items():
                        most = max(before[key], left_out[kind][element][key])
                        self.assertEqual(all_counts[kind][element][key], most, element)
                penetrations = [[reason for reason in summary["trust"]["reasons"] if reason["id"] == "penetration"]
                                for summary in (all_counts, left_out)]
                self.assertEqual(*penetrations)

    def test_without_a_window_there_are_no_figures_and_a_word(self):
        for discard in ("2 s", "3 s"):
            self.write("m.yaml", PENDULUM.replace("interval: 2 s", "interval: 10 ms, discard: " + discard))
            _, summary, out, err = self.run_model("m.yaml", "--step", "1 ms")
            self.assertRegex(err, r"statistics begin at %s, but the run ends at 2 s.*\[no-statistics\]" % discard)
            self.assertIn("no statistics: they begin at %s, and the run ended at 2 s; before that pivot reached" % discard, out)
            self.assertRegex(out, r"pivot +-  ")
            self.assertIsNone(summary["joints"]["pivot"]["max_force"])
            self.assertIsNone(summary["statistics"]["to"])

    def test_rows_that_miss_a_peak_are_reported(self):
        _, _, out, _ = self.run_model(mechanism("slider-crank"), "--end", "16 ms", "--accuracy", "1um")
        self.assertRegex(out, r"rows 2e-05 s apart miss peaks between them: they show \S+ N of the .* in wrist\n")


if __name__ == "__main__":
    unittest.main()
