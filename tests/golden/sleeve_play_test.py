"""Shafts with play in a sleeve: where they rest, how they slide and tilt, and mistakes."""
import csv
import math
import unittest

from model_cases import ModelTest

SHAFT = """
space: spatial
gravity: [0, 0, %s]
bodies: {shaft: {mass: 2, inertia: [1e-3, 2e-3, 1e-3], pose: {position: %s}%s}}
joints: {S: {type: %s, between: [ground, shaft], axis: [0, 1, 0], clearance: {%s, contact: {law: hertz, K: 1e9}%s}}}
simulation: {end: %s, %s, output: {interval: 1 ms}}
"""
KEYS = "bearing_radius: 10 mm, radial_clearance: 0.1 mm, length: 40 mm"


def shaft(kind="cylindrical", gravity="-9.81", position="[0, 0, 0]", velocity="", keys=KEYS, rest="", end="20 ms", simulation="integrator: dopri5, accuracy: 0.01 nm"):
    return SHAFT % (gravity, position, velocity, kind, keys, rest, end, simulation)


class ShaftInSleeve(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_facts_with_and_without_play(self):
        self.facts(shaft(), clearance_joints=1, constraints=0, dof=6)
        self.facts(shaft(), "--ideal", "S", clearance_joints=0, constraints=4, dof=2)

    def test_its_ideal_twin_has_the_bytes_of_the_joint_without_the_block(self):
        text = shaft(velocity=", velocity: {linear: [0, 0.3, 0], angular: [0, 4, 0]}")
        begin, end = text.index(", clearance:"), text.index("}}}\nsimulation") + 1
        for model, options in ((text, ("--ideal", "all")), (text[:begin] + text[end:], ())):
            self.freeplay("run", self.model(model), "--out", "ideal" + str(len(options)), "--quiet", *options)
        self.assertEqual(self.read("ideal2", "results.csv"), self.read("ideal0", "results.csv"))

    def test_it_moves_as_a_pin_whose_shoulders_are_far_away(self):
        velocity = ", velocity: {linear: [3 mm/s, 0.2, 0], angular: [1, 20, 0.5]}"
        friction = ", friction: {law: coulomb-tanh, mu: 0.1, vs: 1 mm/s}"
        one = self.run_model(shaft(velocity=velocity, rest=friction))
        other = self.run_model(shaft("revolute", velocity=velocity, rest=friction, keys=KEYS + ", axial_clearance: 1 m"))
        self.assertGreater(max(one["joint.S.fn"]), 1.0)
        for name in (name for name in one if name.startswith("body.")):
            for x, y in zip(one[name], other[name], strict=True):  # steps differ, as it may go along as far as it likes
                self.assertAlmostEqual(x, y, delta=1e-9)

    def test_it_rests_where_statics_puts_it(self):
        """Each end carries half; as the play goes to zero the place tends to the ideal one, by the play itself."""
        depth = (2 * 9.81 / 1e9) ** (2 / 3)
        for play in (1e-4, 5e-5, 2.5e-5):
            keys = "bearing_radius: 10 mm, radial_clearance: %r, length: 40 mm" % play
            columns = self.run_model(shaft(keys=keys, rest=", initial: loaded", end="5 ms"))
            self.assert_column(columns, "body.shaft.z", lambda t: -(play + depth), 1e-12)
            self.assert_column(columns, "joint.S.fn", lambda t: 2 * 9.81, 1e-6)

    def test_friction_slows_it_along_its_axis(self):
        columns = self.run_model(shaft(velocity=", velocity: {linear: [0, 1, 0]}", end="20 ms",
                                       rest=", initial: loaded, friction: {law: coulomb-tanh, mu: 0.2, vs: 1 mm/s}"))
        self.assertAlmostEqual(1 - 0.2 * 9.81 * 0.02, columns["body.shaft.vy"][-1], delta=1e-3)

    def test_both_ends_are_met_wherever_the_shaft_is(self):
        """Its origin is 0.3 m along; 4 mm/s across use up the play of 0.1 mm in 25 ms."""
        text = shaft(gravity="0", position="[0, 0.3, 0]", velocity=", velocity: {linear: [0, 0.5, 4 mm/s]}", end="26 ms")
        columns = self.run_model(text)
        begins = [event for event in self.events() if event["kind"].endswith("contact_begin")]
        self.assertEqual({"upper_contact_begin", "lower_contact_begin"}, {event["kind"] for event in begins[:2]})
        for event in begins[:2]:
            self.assertAlmostEqual(0.025, float(event["time"]), delta=1e-9)
            self.assertAlmostEqual(4e-3, float(event["speed"]), delta=1e-10)
        self.assertLess(max(math.hypot(x, y, z) for x, y, z in zip(*(columns["joint.S.e" + a] for a in "xyz"))), 1.2e-4)
        messages = self.facts(text)["messages"]
        self.assertEqual([], [message for message in messages if message["id"] == "doubtful-clearance"])

    def test_it_tilts_until_one_end_touches(self):
        """Turned about its middle with 2 rad/s: (L/2) tan(angle) = c."""
        self.run_model(shaft(gravity="0", velocity=", velocity: {angular: [2, 0, 0]}", end="4 ms"))
        begins = [event for event in self.events() if event["kind"].endswith("contact_begin")]
        self.assertAlmostEqual(math.atan(1e-4 / 0.02) / 2.0, float(begins[0]["time"]), delta=1e-10)

    def test_energy_is_kept(self):
        columns = self.run_model(shaft(velocity=", velocity: {linear: [10 mm/s, 0.1, 0], angular: [3, 2, 1]}", end="40 ms"))
        self.assertGreater(len(self.events()), 6)
        self.assertLess(max(abs(x) for x in columns["energy.residual"]), 1e-9)

    def test_mistakes_have_place_and_remedy(self):
        for keys, expected in (
                ("bearing_radius: 10 mm, radial_clearance: 0.1 mm", {"id": "missing-key", "line": 6}),
                ("length: 40 mm", {"id": "missing-key", "line": 6}),
                (KEYS + ", axial_clearance: 1 mm", {"id": "unknown-key", "line": 6}),
                ("radial_clearance: 0.1 mm, length: 4 cm, friction: {law: coulomb-tanh, mu: 0.1}", {"id": "missing-key", "line": 6})):
            with self.subTest(keys):
                self.refusal(shaft(keys=keys), **expected)


if __name__ == "__main__":
    unittest.main()
