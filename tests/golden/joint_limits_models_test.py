"""Friction of constant size in joints and stops at their ends, in the plane and in space, against formulas."""
import csv
import json
import math
import unittest

from model_cases import EXACT, ModelTest

# The stiffness jumps where a stop is met, in the middle of a step.
FINE = "integrator: bathe, step: 20 us"

# A block of 2 kg on a slide along x, and a wheel of 0.5 kg m^2 on a pin.
PLANE = """
bodies: {block: {mass: 2, inertia: 1}, wheel: {mass: 1, inertia: 0.5}}
joints: {slide: {type: prismatic, between: [ground, block]}, pin: {type: revolute, between: [ground, wheel]}}
"""
# The same along a slanting axis, so that nothing but the joint's own direction counts.
SPACE = """
space: spatial
bodies:
  ground: {frames: {at: {position: [1, 2, 3], rpy: [0.3, -0.5, 0.9]}}}
  block: {mass: 2, inertia: [1, 1.2, 1.4]}
  wheel: {mass: 1, inertia: [0.3, 0.4, 0.5]}
joints: {slide: {type: prismatic, between: [ground/at, block]}, pin: {type: revolute, between: [ground/at, wheel]}}
"""
SPACES = {"plane": (PLANE, "ground"), "space": (SPACE, "ground/at")}


class Forces(ModelTest):
    def events(self, kind):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return [event for event in csv.DictReader(file) if kind in event["kind"]]

    def columns_of(self, type_name, linear, rotational, start, end, steps=EXACT):
        for space, (model, ground) in SPACES.items():
            with self.subTest(space=space):
                yield self.run_model("""%s
forces:
  a: {type: %s, kind: linear, between: [%s, block], %s}
  b: {type: %s, kind: rotational, between: [%s, wheel], %s}
%s
simulation: {end: %s, output: {interval: 10 ms}, %s}
""" % (model, type_name, ground, linear, type_name, ground, rotational, start, end, steps))

    def test_friction_of_constant_size_takes_speed_evenly_until_rest(self):
        start = "initial: {speeds: {slide: 3, pin: -4}}"
        for columns in self.columns_of("joint-friction", "friction: 5, vs: 1e-4", "friction: 1.5, vs: 1e-4", start, "0.5 s"):
            # 2.5 m/s^2 and 3 rad/s^2: the speeds have not come near vs.
            self.assert_column(columns, "joint.slide.speed", lambda t: 3 - 2.5 * t, 1e-9)
            self.assert_column(columns, "joint.pin.speed", lambda t: -4 + 3 * t, 1e-9)
            self.assert_column(columns, "energy.dissipated", lambda t: 9 + 4 - (3 - 2.5 * t) ** 2 - (4 - 3 * t) ** 2 / 4, 1e-8)

    def test_friction_creeps_at_small_speeds_as_its_smoothing_says(self):
        start = "initial: {speeds: {slide: 1e-3, pin: 1e-3}}"
        # v' = -(F/m) tanh(v/vs): sinh(v/vs) falls exponentially.
        def speed(rate, vs):
            return lambda t: vs * math.asinh(math.sinh(1e-3 / vs) * math.exp(-rate / vs * t))
        for columns in self.columns_of("joint-friction", "friction: 0.02, vs: 0.01", "friction: 0.005, vs: 0.02", start, "1 s"):
            self.assert_column(columns, "joint.slide.speed", speed(0.01, 0.01), 1e-9)
            self.assert_column(columns, "joint.pin.speed", speed(0.01, 0.02), 1e-9)

    def test_a_stop_without_damping_gives_all_speed_back(self):
        start = "initial: {speeds: {slide: 2, pin: -3}}"
        for columns in self.columns_of("joint-stop", "lower: -1, upper: 0.2, stiffness: 5000, damping: 0",
                                       "lower: -0.3, upper: 2, stiffness: 800, damping: 0", start, "0.4 s", FINE):
            for name, v, end, omega in (("slide.position", 2.0, 0.2, 50.0), ("pin.angle", -3.0, -0.3, 40.0)):
                first, over = end / v, end / v + math.pi / omega  # half a period of the spring

                def place(t):
                    if t < first:
                        return v * t
                    return end + v / omega * math.sin(omega * (t - first)) if t < over else end - v * (t - over)
                self.assert_column(columns, "joint." + name, place, 1e-7)

    def test_a_damped_stop_takes_energy_and_never_pulls(self):
        start = "initial: {speeds: {slide: 2, pin: -3}}"
        for columns in self.columns_of("joint-stop", "lower: -1, upper: 0.2, stiffness: 5000, damping: 0.5",
                                       "lower: -0.3, upper: 2, stiffness: 800, damping: 5", start, "0.4 s", FINE):
            self.assertTrue(all(x <= 1e-12 for x in columns["force.a.power"][:1]))
            self.assertLess(abs(columns["joint.slide.speed"][-1]), 1.9)
            self.assertLess(abs(columns["joint.pin.speed"][-1]), 2.0)
            self.assertLess(columns["joint.slide.speed"][-1], 0.0)
            for k in range(1, len(columns["time"])):
                self.assertGreaterEqual(columns["energy.dissipated"][k] - columns["energy.dissipated"][k - 1], -1e-9)
            # The integrator's own damping over one touch of 6.25 J; it falls with the square of the step.
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-5)

    def test_hunt_and_crossley_speed_after_a_stop(self):
        # m v dv/d(d) = -k d (1 + a v) over in and out: v - ln(1 + a v)/a is the same at both ends of the touch.
        start = "initial: {speeds: {slide: 2, pin: 0}}"
        kept = lambda v, a: v / a - math.log(1 + a * v) / a ** 2
        for columns in self.columns_of("joint-stop", "lower: -9, upper: 0.2, stiffness: 5000, damping: 0.3",
                                       "lower: -1, upper: 1, stiffness: 1", start, "0.3 s", FINE):
            after = columns["joint.slide.speed"][-1]
            self.assertLess(after, -1.0)
            self.assertAlmostEqual(kept(2.0, 0.3), kept(after, 0.3), delta=1e-6)

    def test_a_stop_by_a_law_of_contact_moves_as_the_spring_of_its_stiffness(self):
        """r^2 K is the stiffness of a turn; and with error control the begin and the end of each contact are met."""
        start = "initial: {speeds: {slide: 2.1, pin: -2.9}}"
        for columns in self.columns_of("joint-stop", "lower: -1, upper: 0.2, contact: {law: kelvin-voigt, K: 5000, D: 0}",
                                       "lower: -0.3, upper: 2, radius: 0.1, contact: {law: kelvin-voigt, K: 80000, D: 0}", start,
                                       "0.3 s", EXACT):
            for name, force, v, end, omega, lever in (("slide.position", "a.", 2.1, 0.2, 50.0, 1.0),
                                                      ("pin.angle", "b.", -2.9, -0.3, 40.0, 0.1)):
                first, over = end / v, end / v + math.pi / omega

                def place(t):
                    if t < first:
                        return v * t
                    return end + v / omega * math.sin(omega * (t - first)) if t < over else end - v * (t - over)
                self.assert_column(columns, "joint." + name, place, 1e-9)
                depth = lever * abs(v) / omega
                self.assertAlmostEqual(0.0, max(columns["force." + force + "delta"]) / depth - 1.0, delta=0.1)
            begins = [event for event in self.events("contact_begin")]
            self.assertEqual([("a", "upper_contact_begin"), ("b", "lower_contact_begin")], [(e["joint"], e["kind"]) for e in begins])
            for event, time, speed in zip(begins, (0.2 / 2.1, 0.3 / 2.9), (2.1, 0.29)):
                self.assertAlmostEqual(time, float(event["time"]), delta=1e-10)
                self.assertAlmostEqual(speed, float(event["speed"]), delta=1e-9)

    def test_a_stop_by_a_law_of_contact_gives_the_speed_back_that_its_restitution_says(self):
        start = "initial: {speeds: {slide: 2.1, pin: -2.9}}"
        law = "contact: {law: hu-guo, K: 1e8, restitution: 0.6}"
        for columns in self.columns_of("joint-stop", "lower: -1, upper: 0.2, " + law, "lower: -0.3, upper: 2, radius: 0.1, " + law,
                                       start, "0.15 s", EXACT):
            for name, v in (("slide", 2.1), ("pin", -2.9)):
                self.assertAlmostEqual(-0.6, columns["joint.%s.speed" % name][-1] / v, delta=0.03)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)

    def test_a_stop_has_statistics_of_its_contacts_wherever_it_stands(self):
        end = "end: {type: joint-stop, between: [ground, block], lower: -0.1, upper: 0.2, contact: {law: hertz, K: 1e8}}"
        rest = "initial: {speeds: {slide: 2.1}}\nsimulation: {end: 0.5 s, %s}\n" % EXACT
        depth = (2.5 * 2.1 ** 2 / 1e8) ** 0.4  # m v^2/2 = 2/5 K d^2.5
        of = {}
        for part, model in (("joints", PLANE[:-2] + ", %s}\n" % end), ("forces", PLANE + "forces: {%s}\n" % end)):
            text, _ = self.freeplay("run", self.model(model + rest), "--out", "out")
            self.assertRegex(text, r"\n *play .*\n *end +\d")
            seen = of[part] = json.loads(self.read("out", "summary.json"))[part]["end"]
            self.assertEqual(3, seen["contacts"])  # at 0.095, about 0.24 and about 0.38 s
            self.assertEqual(3, seen["play"]["impacts"])
            self.assertAlmostEqual(2.1, seen["play"]["max_approach_speed"], delta=1e-9)
            self.assertAlmostEqual(1.0, seen["max_delta"] / depth, delta=1e-3)
            self.assertAlmostEqual(1.0, seen["max_fn"] / (1e8 * depth ** 1.5), delta=1e-3)
        for figure in ("max_fn", "max_delta", "contacts", "contact_fraction", "dissipated", "play"):
            self.assertEqual(of["joints"][figure], of["forces"][figure], figure)

    def test_mistakes_in_a_stop_are_told(self):
        head = PLANE + "forces:\n  a: {type: joint-stop, kind: %s, between: [ground, %s], lower: %s, upper: 1%s}\n"
        law = ", contact: {law: hertz, K: 1e8}"
        for kind, body, lower, rest, expected in (
                ("linear", "block", "0", "", "missing-key"), ("linear", "block", "0", law + ", stiffness: 1", "conflicting-keys"),
                ("linear", "block", "0", law + ", damping: 1", "conflicting-keys"), ("linear", "block", "1", law, "out-of-range"),
                ("linear", "block", "0", law + ", radius: 1", "conflicting-keys"), ("rotational", "wheel", "0", law, "missing-key"),
                ("linear", "block", "0", ", stiffness: 1, radius: 1", "conflicting-keys")):
            self.refusal(head % (kind, body, lower, rest), id=expected, line=6)

    def test_ends_in_the_wrong_order_are_refused(self):
        self.refusal(PLANE + "forces:\n  a: {type: joint-stop, kind: linear, between: [ground, block], lower: 1, upper: 0, "
                     "stiffness: 1}\n", id="out-of-range", line=6)


if __name__ == "__main__":
    unittest.main()
