"""Sliders with play: four corners between two walls do what an integration of Lagrange's equations does."""
import csv
import json
import os
import re
import unittest

from model_cases import EXACT, ModelTest
from program import mechanism

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "slider_in_guide.json")
CORNERS = "front_upper", "rear_upper", "front_lower", "rear_lower"
EXACT_IMPACTS = "step: {size: 1 us, adaptive: true, tolerance: 1e-12}, integrator: verner7"

BLOCK = """
gravity: [%s]
bodies: {block: {mass: 2, inertia: 0.01}}
joints: {G: {type: prismatic, between: [%s, block], clearance: {width: 40 mm, length: 100 mm, gap: %s,
         contact: {law: hertz, K: 1e9}%s}}}
simulation: {end: 20 ms, %s, output: {interval: 0.1 ms}}
"""


def block(gravity="0, -9.81", frame="ground", gap="0.2 mm", rest="", simulation=EXACT):
    return BLOCK % (gravity, frame, gap, rest, simulation)


def reference():
    with open(DATA, encoding="utf-8") as file:
        return json.load(file)


class SliderInGuide(ModelTest):
    def crank(self, case, end, **changes):
        """Columns and events of the slider-crank with the laws of a case of the reference."""
        with open(mechanism("slider-in-guide"), encoding="utf-8") as file:
            text = file.read()
        contact, friction = case["contact"], case["friction"]
        text = text[:text.index("simulation:")] + "simulation: {end: %s, %s, output: {interval: %s}}\n" % (
            end, changes.get("simulation", EXACT_IMPACTS), changes.get("interval", "0.5 us"))
        if case["start_speeds"][2] != 0.0:
            text = text.replace("inertia: 2.7e-6}", "inertia: 2.7e-6, velocity: {linear: [0, 0], angular: %r}}" %
                                case["start_speeds"][2])
        sets = ["joints.guide.clearance.contact.law=%s" % contact["law"],
                "joints.guide.clearance.contact.K=%r" % contact["K"],
                "joints.guide.clearance.contact.restitution=%r" % contact["restitution"], "mu=%r" % friction["mu"]]
        options = [word for one in sets for word in ("--set", one)]
        columns = self.run_model(text, *options, head="")
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return columns, list(csv.DictReader(file))

    def run_model(self, text, *options, head="freeplay: 1\n"):
        self.freeplay("run", self.model(text, head), "--out", "out", "--quiet", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {name: [float(x) if x else float("nan") for x in values] for name, *values in zip(*rows)}

    def assert_samples(self, case, columns):
        rows = {round(t * 2e6): i for i, t in enumerate(columns["time"])}
        for sample in case["samples"]:
            at = lambda name: columns[name][rows[round(sample["t"] * 2e6)]]
            for name, key in (("x", "x"), ("y", "y"), ("angle", "slider_angle")):
                self.assertLess(abs(at("body.slider." + name) - sample[key]), 1e-8, (case["name"], sample["t"], name))
            self.assertLess(abs(at("joint.main.angle") - sample["crank"]), 1e-8)
            for corner, force in zip(CORNERS, sample["fn"]):
                self.assertLess(abs(at("joint.guide.%s_fn" % corner) - force), 1e-6 * max(1.0, force), sample["t"])

    def assert_events(self, case, events):
        by_kind = {}
        for event in events:
            by_kind.setdefault(event["kind"], []).append(event)
        seen = dict.fromkeys(by_kind, 0)
        for expected in case["events"]:
            kind = "%s_contact_%s" % (CORNERS[expected["corner"]], expected["event"])
            event = by_kind[kind][seen[kind]]
            seen[kind] += 1
            self.assertLess(abs(float(event["time"]) - expected["t"]), 1e-9, (case["name"], kind))
            self.assertLess(abs(float(event["speed"]) - expected["speed"]), 1e-5, (case["name"], kind))
            self.assertLess(abs(float(event["tangential_speed"]) - expected["slip"]), 1e-5, (case["name"], kind))

    def test_free_flight_is_that_of_lagranges_equations(self):
        case, flight = reference()["penalty"][0], reference()["free_flight"]
        columns, events = self.crank(case, "2 ms")
        self.assertEqual([], events)
        self.assertLess(abs(columns["joint.main.angle"][-1] - flight["crank"]), 1e-9)
        self.assertLess(abs(columns["body.slider.y"][-1] - flight["y"]), 1e-9)
        self.assertLess(abs(columns["joint.guide.shift"][-1] - flight["y"]), 1e-9)

    def test_impacts_of_corners_are_those_of_the_reference(self):
        for case, end in zip(reference()["penalty"], ("3 ms", "3 ms", "9 ms", "5 ms"), strict=True):
            columns, events = self.crank(case, end)
            self.assert_samples(case, columns)
            self.assert_events(case, events)
            summary = json.loads(self.read("out", "summary.json"))
            energy = columns["energy.kinetic"][0] + columns["energy.potential"][0]
            self.assertLess(summary["residuals"]["energy_max"], 1e-8 * energy)
            self.assertEqual(len(case["events"]) // 2, summary["joints"]["guide"]["contacts"])

    def test_stiffer_corners_near_the_impact_without_compliance(self):
        """The duration of an impact, by which the next one is late, goes with K^-0.4."""
        data, late = reference(), []
        for stiffness in (1e11, 1e12, 1e13):
            _, events = self.crank({**data["penalty"][2], "contact": {**data["penalty"][2]["contact"], "K": stiffness}},
                                   "5.7 ms", interval="100 us")
            begins = [float(event["time"]) for event in events if event["kind"] == "front_upper_contact_begin"]
            late.append(begins[1] - data["second_impact_without_compliance"])
        for softer, stiffer in zip(late, late[1:]):
            self.assertAlmostEqual(10 ** 0.4, softer / stiffer, delta=0.02)

    def test_steps_resolve_the_impact_of_the_corner_not_of_the_block(self):
        """With friction the block rocks during the impact: its corner feels 1.07e-3 kg, its centre 0.094 kg."""
        case = reference()["penalty"][0]
        stiff = {**case, "contact": {**case["contact"], "K": 1e12}}
        simulation = "step: {size: 20 us, adaptive: true, tolerance: 1e-7}, integrator: dopri5"
        _, events = self.crank(stiff, "2.72 ms", simulation=simulation, interval="100 us")
        ends = {event["kind"]: event for event in events if event["kind"].endswith("end")}
        # Quadruple precision, theory of the translational joint: speed out over speed in, front and rear corner.
        for corner, ratio in (("front", 0.39571), ("rear", 0.39958)):
            self.assertAlmostEqual(ratio, float(ends[corner + "_upper_contact_end"]["speed"]) / case["events"][0]["speed"], delta=1e-4)

    def test_fixed_steps_foresee_the_speed_of_approach(self):
        case = reference()["penalty"][0]
        _, events = self.crank(case, "2.9 ms", simulation="step: 5 us", interval="100 us")
        begins = [event for event in events if event["kind"].endswith("begin")]
        self.assertEqual(2, len(begins))
        for event in begins:
            self.assertLess(abs(float(event["speed"]) - case["events"][0]["speed"]), 1e-5)
            self.assertLess(abs(float(event["time"]) - case["events"][0]["t"]), 1e-8)

    def test_without_friction_an_aligned_slider_stays_aligned(self):
        columns, _ = self.crank(reference()["penalty"][2], "9 ms")
        self.assertLess(max(map(abs, columns["body.slider.angle"])), 1e-12)


class Error(ModelTest):
    """A crank that is driven to angle 0, where the slider's place is that of its pin: 1 mm of gap, 100 mm of length."""

    def largest(self, ends, frame):
        with open(mechanism("slider-in-guide"), encoding="utf-8") as file:
            text = file.read()
        text = text.replace("between: [ground, slider]", "between: [%s]" % ends).replace(
            "inertia: 2.7e-6}", "inertia: 2.7e-6, frames: {nose: [100 mm, 0]}}").replace(
            "initial: {joints: {main: 0 deg}, speeds: {main: 150 rad/s}}",
            "drivers: {motor: {joint: main, kind: angle, value: 0 rad}}")
        self.model(text, head="")
        out, _ = self.freeplay("analyze", "error", "m.yaml", "--frame", frame, "--input", "main=0")
        row, = csv.DictReader(out.splitlines())
        return {name: float(row[name]) for name in ("dx", "dy", "dangle")}

    def test_both_ends_of_a_slider_err_by_the_gap(self):
        for frame, dy in (("slider", 1e-3), ("slider/nose", 2e-3)):
            error = self.largest("ground, slider", frame)
            self.assertAlmostEqual(dy, error["dy"], places=9)
            self.assertAlmostEqual(2e-3 / 0.1, error["dangle"], places=9)
            self.assertAlmostEqual(0.0, error["dx"], places=9)

    def test_a_guide_that_moves_over_its_block_turns_about_the_block(self):
        error = self.largest("slider, ground", "slider/nose")
        self.assertAlmostEqual(1e-3 * 2 * (0.153 + 0.306 + 0.1) / 0.1, error["dy"], places=9)


class Block(ModelTest):
    def test_facts_with_and_without_play(self):
        self.facts(block(), clearance_joints=1, constraints=0, dof=3)
        self.facts(block(), "--ideal", "G", clearance_joints=0, constraints=2, dof=1)

    def test_its_ideal_twin_has_the_bytes_of_the_joint_without_the_block(self):
        text = block(gravity="1, -9.81")
        begin, end = text.index(", clearance:"), text.index("}}}}") + 2
        for model, options in ((text, ("--ideal", "all")), (text[:begin] + text[end:], ())):
            self.freeplay("run", self.model(model), "--out", "ideal" + str(len(options)), "--quiet", *options)
        self.assertEqual(self.read("ideal2", "results.csv"), self.read("ideal0", "results.csv"))

    def test_it_rests_where_statics_puts_it(self):
        columns = self.run_model(block(rest=", initial: loaded"))
        depth = (9.81 / 1e9) ** (2 / 3)  # two corners carry the weight
        self.assert_column(columns, "joint.G.shift", lambda t: -(2e-4 + depth), 1e-12)
        self.assert_column(columns, "joint.G.delta", lambda t: depth, 1e-12)
        self.assert_column(columns, "joint.G.fn", lambda t: 2 * 9.81, 1e-6)
        self.assert_column(columns, "joint.G.rear_lower_fn", lambda t: 9.81, 1e-6)

    def test_it_rests_on_a_sloping_guide_too(self):
        text = block(rest=", initial: loaded", frame="ground/wall").replace(
            "bodies:", "frames: {ground/wall: {angle: 180 deg}}\nbodies:")
        columns = self.run_model(text)
        depth = (9.81 / 1e9) ** (2 / 3)
        self.assert_column(columns, "joint.G.shift", lambda t: 2e-4 + depth, 1e-12)
        self.assert_column(columns, "body.block.y", lambda t: -(2e-4 + depth), 1e-12)

    def test_it_starts_where_its_block_says_and_falls(self):
        rest = ', initial: {eccentricity: [0, "0.15 mm"], velocity: [0, 2 mm/s]}'
        columns = self.run_model(block(rest=rest, gap="1 mm", simulation="integrator: dopri5, step: {size: 0.1 ms, adaptive: true, tolerance: 1e-7}"))
        first = {name: values[:100] for name, values in columns.items()}
        self.assert_column(first, "joint.G.shift", lambda t: 1.5e-4 + 2e-3 * t - 9.81 / 2 * t * t, 1e-12)

    def test_every_impact_of_a_corner_gets_its_steps(self):
        """The error would allow a few: 1/m = 1/2 kg + (l/2)^2/J of a corner that may turn its block away."""
        loose = "integrator: dopri5, step: {size: 0.1 ms, adaptive: true, tolerance: 1e-2}"
        text = block(gravity="0, 0", rest=", initial: {angle: 1 mrad, velocity: [0, -0.1 m/s]}", simulation=loose).replace(
            "K: 1e9", "K: 1e12").replace("inertia: 0.01", "inertia: 1e-4").replace("end: 20 ms", "end: 2 ms")
        self.run_model(text)
        ends = [event for event in csv.DictReader(self.read("out", "events.csv").splitlines()) if event["kind"].endswith("contact_end")]
        self.assertGreater(len(ends), 2)
        mass = 1 / (1 / 2 + 0.05 ** 2 / 1e-4)
        for event in ends:
            self.assertGreaterEqual(int(event["steps"]), 20)
            alone = 3.21806545972 * (mass ** 2 / (1e24 * float(event["approach_speed"]))) ** 0.2
            self.assertLess(abs(float(event["duration"]) / alone - 1), 0.01)

    def test_it_rests_under_a_moment_as_well(self):
        """The guide holds it 30 mm and 80 mm from its centre of mass: on two corners of one side, or on opposite ones."""
        weight = 2 * 9.81
        for lever in (0.03, 0.08):
            text = block(rest=", initial: loaded").replace("inertia: 0.01", "inertia: 0.01, com: [%r, 0]" % lever)
            columns = self.run_model(text)
            front, rear = weight * (0.5 + lever / 0.1), weight * (0.5 - lever / 0.1)
            side = "lower" if rear > 0.0 else "upper"
            self.assert_column(columns, "joint.G.front_lower_fn", lambda t: front, 0.02)
            self.assert_column(columns, "joint.G.rear_%s_fn" % side, lambda t: abs(rear), 0.02)
            self.assertLess(max(map(abs, columns["body.block.omega"])), 1e-6)

    def test_the_corners_of_a_loose_block_rest_where_its_tilt_puts_them(self):
        """Gap and width as large as this tilt the block by 0.14: corners turn away from their walls by 0.4 mm."""
        text = block(rest=", initial: loaded", gap="7 mm").replace("width: 40 mm", "width: 80 mm").replace(
            "simulation:", "forces: {twist: {type: torque, on: block, value: -1.5}}\nsimulation:")
        columns = self.run_model(text)
        self.assertGreater(abs(columns["joint.G.tilt"][0]), 0.13)
        self.assertLess(max(map(abs, columns["body.block.omega"])), 1e-6)

    def test_it_starts_with_angle_and_angular_velocity(self):
        rest = ", initial: {angle: 1 mrad, speed: 20 mrad/s}"
        text = block(rest=rest, gravity="0, 0", gap="1 mm")
        for model in (text, text.replace("between: [ground, block]", "between: [ground/wall, block]").replace(
                "bodies:", "frames: {ground/wall: {angle: 120 deg}}\nbodies:")):
            columns = self.run_model(model)
            self.assert_column(columns, "joint.G.tilt", lambda t: 1e-3 + 2e-2 * t, 1e-12)
            self.assert_column(columns, "joint.G.shift", lambda t: 0.0, 1e-12)

    def test_a_picture_has_its_walls_level(self):
        text = block(gap="1 mm", frame="ground/wall").replace("bodies:", "frames: {ground/wall: {angle: 90 deg}}\nbodies:")
        self.run_model(text.replace("gravity: [0, -9.81]", "gravity: [2, -9.81]"))
        picture, _ = self.freeplay("show", "out", "--format", "svg", "--magnify", "G=20")
        self.assertIn("G, 20 times across", picture)
        self.assertNotIn('<circle class="clearance"', picture)
        walls, = re.findall(r'class="clearance"[^>]*d="M\S+ (\S+)h\S+M\S+ (\S+)h', picture)
        way, = re.findall(r'class="orbit" d="([^"]*)"', picture)
        y = [float(pair.split(" ")[1]) for pair in re.findall(r"[ML]([-\d.]+ [-\d.]+)", way)]
        # It falls along its guide, and 2 m/s^2 press it to one wall.
        self.assertAlmostEqual(0.5 * sum(map(float, walls)), y[0], delta=0.2)
        self.assertGreater(max(y) - min(y), 1.0)
        self.assertTrue(float(walls[0]) - 0.5 < min(y) and max(y) < float(walls[1]) + 0.5)

    def test_the_summary_calls_its_play_a_gap(self):
        self.run_model(block(rest=", initial: loaded"))
        joint = json.loads(self.read("out", "summary.json"))["joints"]["G"]
        self.assertEqual({"gap": 2e-4, "length": 0.1}, joint["clearance"])

    def test_the_gap_closes_to_the_ideal_slider(self):
        errors = []
        for gap in (4e-4, 2e-4, 1e-4):
            columns = self.run_model(block(rest=", initial: loaded", gap="%r m" % gap, simulation="step: 0.1 ms"))
            errors.append(abs(columns["body.block.y"][-1]) - (9.81 / 1e9) ** (2 / 3))
        for wide, narrow in zip(errors, errors[1:]):
            self.assertAlmostEqual(2.0, wide / narrow, places=6)

    def test_mistakes_have_place_and_remedy(self):
        laws = "contact: {law: hertz, K: 1e9}"
        head, tail = block().split("clearance: {")[0], "}}}\nsimulation: {end: 1 ms}\n"
        for keys, expected in (
                ("width: 40 mm, length: 100 mm, gap: 40 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("width: 40 mm, length: 4 mm, gap: 2 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("width: 40 mm, length: 0 mm, gap: 1 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("width: 40 mm, gap: 1 mm, " + laws, {"id": "missing-key", "line": 5}),
                ("width: 40 mm, length: 100 mm, " + laws, {"id": "missing-key", "line": 5}),
                ("width: 40 mm, length: 100 mm, gapp: 1 mm, gap: 1 mm, " + laws, {"id": "unknown-key", "suggestion": "gap"}),
                ("width: 40 mm, guide_width: 42 mm, gap: 2 mm, length: 100 mm, " + laws, {"id": "conflicting-keys"}),
                ("width: 40 mm, guide_width: 40 mm, length: 100 mm, " + laws, {"id": "out-of-range"}),
                ("gap: 1 mm, length: 100 mm, friction: {law: coulomb-tanh, mu: 0.1}, " + laws, {"id": "missing-key"}),
                ("gap: 1 mm, length: 100 mm, contact: hertz", {"id": "missing-key"}),
                ("gap: 1 mm, length: 100 mm, initial: {eccentricity: [0, 1.1 mm]}, " + laws, {"id": "out-of-range"}),
                ("gap: 1 mm, length: 100 mm, initial: {eccentricity: [1 mm, 0]}, " + laws, {"id": "out-of-range"}),
                ("gap: 1 mm, length: 100 mm, initial: {angle: 21 mrad}, " + laws, {"id": "out-of-range"}),
                ("gap: 1 mm, length: 100 mm, initial: {eccentricity: [0, 0.6 mm], angle: -10 mrad}, " + laws, {"id": "out-of-range"})):
            with self.subTest(keys):
                self.refusal(head + "clearance: {" + keys + tail, **expected)

    def test_a_block_is_refused_where_its_type_has_no_play(self):
        text = block(gravity="0, 0, -9.81").replace("inertia: 0.01", "inertia: [0.01, 0.01, 0.01]").replace("prismatic", "point-on-line")
        self.refusal(text, head="freeplay: 1\nspace: spatial\n", id="type-space")
        self.refusal(block().replace("prismatic", "fixed"), id="unknown-key")


if __name__ == "__main__":
    unittest.main()
