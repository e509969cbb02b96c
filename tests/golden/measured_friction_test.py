"""Laws of friction by tables, memory that outlives contacts, and a spring that yields: plugins from outside of the
program, with parameters that are lists and tables."""
import json
import math
import os
import shutil
import signal
import subprocess
import time
import unittest

from model_cases import ModelTest, rk4
from program import BUILD, PROGRAM

EXAMPLES = os.path.join(BUILD, "plugins", "example")

BLOCK = """plugins: [friction.so]
gravity: [0, -9.81]
bodies: {block: {mass: 2, inertia: 0.01}}
joints:
  G:
    type: prismatic
    between: [ground, block]
    clearance: {width: 0.2 mm, length: 100 mm, gap: 0.05 mm, initial: loaded, contact: {law: hertz, K: 1e9},
                friction: %s}
initial: {speeds: {G: 0.2 m/s}}
simulation: {end: %s, step: {size: 1 ms, adaptive: true, tolerance: 1e-9}, output: {interval: 0.1 ms}}
"""
SPEEDS, OVER_SPEED = (0.0, 0.05, 0.1, 0.15), (0.4, 0.25, 0.2, 0.3)
OVER_SPEED_LAW = ("{law: friction-over-speed, coefficient: [[0 m/s, 0.4], [5 cm/s, 0.25], [0.1, 0.2], [150 mm/s, 0.3]], "
                  "vs: 0.2 mm/s}")
WAYS, OVER_WAY = (0.0, 5e-3, 20e-3), (0.3, 0.1, 0.05)
OVER_WAY_LAW = ("{law: friction-over-distance, coefficient: [[0 mm, 0.3], [5 mm, 0.1], [20 mm, 0.05]], slid: %s, "
                "vs: 0.2 mm/s}")

# A shaft at rest on the lower side of its sleeve, which goes along and turns.
SHAFT = """plugins: [friction.so]
space: spatial
gravity: [0, -9.81, 0]
bodies: {shaft: {mass: 2, inertia: [1, 1, 1e-3], velocity: {linear: [0, 0, 0.15 m/s], angular: [0, 0, 20]}}}
joints:
  G:
    type: cylindrical
    between: [ground, shaft]
    clearance: {journal_radius: 10 mm, radial_clearance: 0.05 mm, length: 100 mm, initial: loaded,
                contact: {law: hertz, K: 1e9}, friction: %s}
simulation: {end: 20 ms, accuracy: 10 nm, output: {interval: 20 us}}
"""

SPRING = """plugins: [spring.so]
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  bar: {type: yielding-spring, between: [ground, disc], stiffness: 5 N*m, yield: 1 N*m, set: %s}
initial: {speeds: {pin: 6 rad/s}}
simulation: {end: %s, step: %s, output: {interval: 1 ms}}
"""


def between(xs, ys, x):
    if x <= xs[0]:
        return ys[0]
    for i in range(1, len(xs)):
        if x < xs[i]:
            return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1])
    return ys[-1]


class Outside(ModelTest):
    def setUp(self):
        super().setUp()
        for name, library in (("friction", "measured_friction"), ("spring", "yielding_spring")):
            shutil.copy(os.path.join(EXAMPLES, library + ".so"), self.path(name + ".so"))

    def run_block(self, law, end="50 ms"):
        return self.run_model(BLOCK % (law, end), "--allow-plugins")

    def is_resumed(self, text):
        """Ended by a signal and gone on with, a run of some seconds has the bytes of one that was not."""
        self.freeplay("run", self.model(text), "--out", "whole", "--quiet", "--allow-plugins")
        for attempt in range(5):
            name = "cut%d" % attempt
            run = subprocess.Popen([PROGRAM, "run", "m.yaml", "--out", name, "--quiet", "--allow-plugins",
                                    "--checkpoint", "20 ms"], cwd=self.folder, stderr=subprocess.DEVNULL)
            self.addCleanup(run.kill)
            while run.poll() is None and not os.path.exists(self.path(name, "checkpoint.bin")):
                time.sleep(0.005)
            time.sleep(0.1)
            run.send_signal(signal.SIGTERM)
            if run.wait(timeout=60) == 130:
                break
        self.freeplay("run", "--resume", name, "--quiet", "--allow-plugins")
        for file in ("results.csv", "events.csv"):
            self.assertEqual(self.read("whole", file), self.read(name, file))


class FrictionByTable(Outside):
    def test_the_force_is_that_of_the_table(self):
        columns = self.run_block(OVER_SPEED_LAW)
        for normal, force, slip in zip(columns["joint.G.fn"], columns["joint.G.ft"], columns["joint.G.vt"]):
            mu = between(SPEEDS, OVER_SPEED, abs(slip))
            self.assertAlmostEqual(-mu * normal * slip / math.hypot(slip, 2e-4), force, delta=1e-5 * normal + 1e-9)

    def test_the_block_stops_as_its_equation_says(self):
        """v' = -mu(v) g v/sqrt(v^2 + vs^2): the load stays on the lower wall."""
        rate = lambda t, y: [-9.81 * between(SPEEDS, OVER_SPEED, abs(y[0])) * y[0] / math.hypot(y[0], 2e-4)]
        columns = self.run_block(OVER_SPEED_LAW)
        self.assertAlmostEqual(rk4(rate, [0.2], 0.05, 20000)[0], columns["body.block.vx"][-1], delta=2e-5)

    def test_a_distance_slid_goes_on_from_its_start(self):
        for start in (0.0, 2e-3):
            columns = self.run_block(OVER_WAY_LAW % ("%r m" % start), "40 ms")
            first = columns["body.block.x"][0]
            for normal, force, slip, x in zip(columns["joint.G.fn"], columns["joint.G.ft"], columns["joint.G.vt"],
                                              columns["body.block.x"]):
                mu = between(WAYS, OVER_WAY, start + x - first)
                self.assertAlmostEqual(-mu * normal * slip / math.hypot(slip, 2e-4), force, delta=1e-4 * normal)

    def test_a_block_in_space_slides_as_one_in_the_plane(self):
        plane = self.run_block(OVER_WAY_LAW % "2 mm", "40 ms")
        text = BLOCK % (OVER_WAY_LAW % "2 mm", "40 ms")
        for old, new in (("gravity: [0, -9.81]", "space: spatial\ngravity: [0, -9.81, 0]"),
                         ("inertia: 0.01", "inertia: [0.01, 0.01, 0.01]"),
                         ("width: 0.2 mm, length", "width: 0.2 mm, height: 0.2 mm, gap_height: 0.05 mm, length")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        space = self.run_model(text, "--allow-plugins")
        for x, y in zip(plane["body.block.x"], space["body.block.x"], strict=True):
            self.assertAlmostEqual(x, y, delta=2e-8)

    def test_a_shaft_slides_over_the_whole_of_its_way(self):
        """Along and around at once: the way is that of the speed of the surface."""
        columns = self.run_model(SHAFT % (OVER_WAY_LAW % "2 mm"), "--allow-plugins")
        time, slip, way = columns["time"], [abs(v) for v in columns["joint.G.vt"]], 2e-3
        for i in range(1, len(time)):
            way += 0.5 * (slip[i] + slip[i - 1]) * (time[i] - time[i - 1])
            expected = between(WAYS, OVER_WAY, way) * slip[i] / math.hypot(slip[i], 2e-4)
            self.assertAlmostEqual(expected, abs(columns["joint.G.ft"][i] / columns["joint.G.fn"][i]), delta=2e-3)
        self.assertGreater(way, 5e-3)

    def test_its_memory_is_part_of_a_checkpoint(self):
        # Short steps, so that a run of a second is met in the middle.
        text = BLOCK % (OVER_WAY_LAW % "2 mm", "30 ms")
        self.is_resumed(text.replace("{size: 1 ms, adaptive: true, tolerance: 1e-9}", "0.2 us"))

    def test_a_wrong_number_is_reported_at_its_place(self):
        for law, place, words in (
                ("{law: friction-over-speed, coefficient: [[-1 mm/s, 0.3], [1, 0.1]]}", ":10:", "never negative"),
                ("{law: friction-over-speed, coefficient: [[0, 0.3], [1 m, 0.1]]}", ":10:", "expected velocity"),
                ("{law: friction-over-speed, coefficient: [[0, 0.3], [1, -0.1]]}", ":10:", "coefficient[1][1]"),
                ("{law: friction-over-speed, coefficient: 0.3}", ":10:", "must be a list of points")):
            with self.subTest(law):
                _, err = self.freeplay("validate", self.model(BLOCK % (law, "1 ms")), "--allow-plugins", code=3)
                self.assertIn("m.yaml" + place, err)
                self.assertIn(words, err)

    def test_a_table_in_a_file_is_the_same_table(self):
        self.write("mu.csv", "# measured\nspeed,mu\n0,0.4\n5,0.25\n10,0.2\n15,0.3\n")
        law = "{law: friction-over-speed, coefficient: {file: mu.csv, x_unit: cm/s}, vs: 0.2 mm/s}"
        self.assertEqual(self.run_block(OVER_SPEED_LAW), self.run_block(law))
        self.freeplay("reproduce", "out", "--allow-plugins")  # from the files that the result keeps
        self.write("mu.csv", "speed,mu\n0,0.4\n-5,0.25\n10,-0.2\n")
        _, err = self.freeplay("validate", self.model(BLOCK % (law, "1 ms")), "--allow-plugins", code=3)
        self.assertIn("mu.csv:3:1: error: the first numbers of points must increase", err)

    def test_one_number_of_a_table_is_set_by_its_path(self):
        model = self.model(BLOCK % (OVER_SPEED_LAW, "1 ms"))
        path = "joints.G.clearance.friction.coefficient"
        shown = lambda *sets: json.loads(self.freeplay("show", model, "--allow-plugins", "--json", *sets)[0])
        points = lambda *sets: self.friction_of(shown(*sets))
        self.assertEqual([list(p) for p in zip(SPEEDS, OVER_SPEED)], points())
        self.assertEqual(0.35, points("--set", path + ".3.1=0.35")[3][1])
        self.assertEqual([[0.0, 0.5], [1.0, 0.1]], points("--set", path + "=[[0, 0.5], [1, 0.1]]"))

    def friction_of(self, shown):
        text = json.dumps(shown)
        begin = text.index('"coefficient": ') + len('"coefficient": ')
        return json.JSONDecoder().raw_decode(text[begin:])[0]


class DescribedTables(Outside):
    def test_the_program_says_what_is_expected(self):
        out, _ = self.freeplay("describe", "friction-over-speed", "--plugin", "./friction.so")
        self.assertRegex(out, r"coefficient\s.*1 to 1000 points over speed \[m/s\], each >= 0")
        out, _ = self.freeplay("describe", "yielding-spring", "--plugin", "./spring.so")
        self.assertRegex(out, r"set\s.*1 to 100 numbers")

    def test_the_schema_takes_lists_and_points(self):
        schema = json.loads(self.freeplay("schema", "--plugin", "./friction.so", "--plugin", "./spring.so")[0])
        table = schema["$defs"]["friction-law-friction-over-speed"]["properties"]["coefficient"]
        table, name, keys = table["anyOf"]
        self.assertEqual(("string", r"\.csv$"), (name["type"], name["pattern"]))
        self.assertEqual({"file", "x", "value", "x_unit", "unit"},
                         set(schema["$defs"][keys["$ref"].rsplit("/")[-1]]["properties"]))
        self.assertEqual(("array", 1, 1000), (table["type"], table["minItems"], table["maxItems"]))
        self.assertEqual((2, 2), (table["items"]["minItems"], table["items"]["maxItems"]))
        bent = schema["$defs"]["joint-yielding-spring"]["properties"]["set"]["anyOf"][0]
        self.assertEqual((100, "#/$defs/quantity"), (bent["maxItems"], bent["items"]["$ref"]))

    def test_both_libraries_keep_the_contract(self):
        for name in ("friction", "spring"):
            self.freeplay("check-plugin", "./%s.so" % name)


class YieldingSpring(Outside):
    def columns(self, bent="[0.1, 5 deg]", end="0.4 s", step="0.05 ms"):
        return self.run_model(SPRING % (bent, end, step), "--allow-plugins")

    def test_the_account_of_energy_counts_what_commit_reports(self):
        columns = self.columns()
        self.assertAlmostEqual(0.1 + math.radians(5), columns["joint.bar.permanent_set"][0], delta=1e-15)
        lost, start = columns["energy.dissipated"][-1], 0.05 * 36 / 2
        # Yield torque times the permanent set.
        moved = columns["joint.bar.permanent_set"][-1] - columns["joint.bar.permanent_set"][0]
        self.assertGreater(lost, 0.3 * start)
        self.assertAlmostEqual(1.0 * moved, lost, delta=0.01 * lost)
        # First order in the step, as the torque is beyond its limit by a step's way.
        coarse, fine = (max(abs(x) for x in self.columns(step=step)["energy.residual"]) for step in ("0.1 ms", "0.05 ms"))
        self.assertLess(fine, 0.002 * lost)
        self.assertAlmostEqual(2.0, coarse / fine, delta=0.2)

    def test_the_summary_has_what_joints_remember_at_the_end(self):
        columns = self.columns(end="0.1 s")
        memory = json.loads(self.read("out", "summary.json"))["memory"]
        self.assertEqual(["bar"], list(memory))
        self.assertEqual([], memory["bar"]["internal"])
        self.assertAlmostEqual(columns["joint.bar.permanent_set"][-1], memory["bar"]["history"][0], delta=1e-12)
        columns = self.run_block(OVER_WAY_LAW % "2 mm", "20 ms")
        upper, lower = slice(0, 2), slice(2, 4)
        slid = json.loads(self.read("out", "summary.json"))["memory"]["G"]["internal"]
        way = columns["body.block.x"][-1] - columns["body.block.x"][0]
        self.assertEqual([2e-3, 2e-3], slid[upper])
        for distance in slid[lower]:
            self.assertAlmostEqual(2e-3 + way, distance, delta=1e-6)

    def test_its_set_is_part_of_a_checkpoint(self):
        self.is_resumed(SPRING % ("[0.1]", "3 s", "2 us"))


if __name__ == "__main__":
    unittest.main()
