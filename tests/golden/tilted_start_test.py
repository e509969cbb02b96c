"""Starts with a tilt in the play of spatial joints: where their blocks say, and where force and moment of the ideal joint hold them."""
import csv
import math
import unittest

from model_cases import ModelTest

FINE = "integrator: dopri5, accuracy: 0.01 nm"
SHAFT = """
space: spatial
gravity: [%s]
bodies: {shaft: {mass: 2, inertia: [1e-3, 2e-3, 1e-3], com: [%s]%s}}
joints: {S: {type: %s, between: [ground, shaft], axis: [%s], clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, length: 40 mm, contact: {law: hertz, K: 1e9}%s}}}
%ssimulation: {end: %s, %s, output: {interval: 0.5 ms}}
"""
BLOCK = """
%sgravity: [%s]
bodies: {block: {mass: 2, inertia: %s, com: [%s]}}
joints: {G: {type: prismatic, between: [ground, block]%s, clearance: {%s, contact: {law: hertz, K: 1e9}%s}}}
%ssimulation: {end: 5 ms, %s, output: {interval: 0.5 ms}}
"""
KEYS = "width: 40 mm, length: 100 mm, gap: 0.2 mm"
CLEARANCE, LENGTH, WEIGHT = 1e-4, 0.04, 2 * 9.81
# What a journal at rest may move by [m/s, rad/s]: squares of its tilt are left out. It would fall over with 1 rad/s by then.
TILTED = 2e-5


def shaft(kind="cylindrical", gravity="0, 0, -9.81", com="0, 0, 0", velocity="", axis="0, 1, 0", rest="", more="", end="5 ms", simulation=FINE):
    return SHAFT % (gravity, com, velocity, kind, axis, rest, more, end, simulation)


def block(space="space: spatial\n", gravity="0, -9.81, 0", inertia="[2e-3, 3e-3, 4e-3]", com="0, 0, 0", axis=", axis: [1, 0, 0]",
          keys=KEYS + ", height: 30 mm", rest="", more=""):
    return BLOCK % (space, gravity, inertia, com, axis, keys, rest, more, FINE)


def flat(com="0, 0", rest="", more=""):
    return block("", "0, -9.81", "4e-3", com, "", KEYS, rest, more)


def depth(force):
    """Of one end of a journal, which has half of the law."""
    return (force / 0.5e9) ** (2 / 3)


class TiltedStart(ModelTest):
    def begins(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return [event for event in csv.DictReader(file) if event["kind"].endswith("contact_begin")]

    def assert_rests(self, columns, body, tolerance=1e-6, names=("vx", "vy", "vz", "wx", "wy", "wz")):
        for name in names:
            self.assertLess(max(map(abs, columns["body.%s.%s" % (body, name)])), tolerance, name)

    def test_a_journal_starts_with_its_tilt_and_goes_on_tilting(self):
        """(L/2) tan(angle) = c is where an end touches; the part along the axis, about which it turns freely, does nothing."""
        for kind in ("cylindrical", "revolute"):
            text = shaft(kind, gravity="0, 0, 0", rest=", initial: {tilt: [2 mrad, 0.5, 0], tilt_speed: [1 rad/s, 0, 0]}")
            columns = self.run_model(text)
            self.assertAlmostEqual(math.sin(1e-3), columns["body.shaft.qx"][0], delta=1e-14)
            self.assertAlmostEqual(0.0, columns["body.shaft.qy"][0], delta=1e-6)
            self.assertAlmostEqual(1.0, columns["body.shaft.wx"][0], delta=1e-12)
            begins = self.begins()
            self.assertEqual({"upper_contact_begin", "lower_contact_begin"}, {event["kind"] for event in begins[:2]})
            self.assertAlmostEqual(math.atan(CLEARANCE / 0.02) - 2e-3, float(begins[0]["time"]), delta=1e-9)

    def test_a_tilted_journal_spins_about_its_own_axis(self):
        """Else its tilt would go round the bearing with the spin."""
        text = shaft("revolute", gravity="0, 0, 0", rest=", initial: {tilt: [2 mrad, 0, 0]}", more="initial: {speeds: {S: 50 rad/s}}\n")
        columns = self.run_model(text)
        for name, expected in (("wx", 0.0), ("wy", 50.0 * math.cos(2e-3)), ("wz", 50.0 * math.sin(2e-3))):
            self.assertAlmostEqual(expected, columns["body.shaft." + name][0], delta=2e-4)
        self.assertAlmostEqual(math.tan(2e-3), columns["body.shaft.wz"][0] / columns["body.shaft.wy"][0], delta=1e-12)
        self.assertEqual([], self.begins())

    def test_shift_and_tilt_add_up_at_the_ends(self):
        rest = ', initial: {eccentricity: [0, 0, "50 um"], tilt: [2.4 mrad, 0, 0]}'
        columns = self.run_model(shaft("revolute", gravity="0, 0, 0", rest=rest))
        self.assert_column(columns, "joint.S.delta", lambda t: 5e-5 + 0.02 * math.tan(2.4e-3) - CLEARANCE, 1e-13)

    def test_a_loaded_journal_rests_on_two_ends_as_statics_says(self):
        """The weight acts 10 mm along, and 30 mm: beyond the end of the sleeve the other end is pressed up."""
        for kind in ("cylindrical", "revolute"):
            for lever in (0.01, 0.03):
                columns = self.run_model(shaft(kind, com="0, %r, 0" % lever, rest=", initial: loaded"))
                height = slope = 0.0
                for _ in range(6):  # a pin leans on a shoulder, by the force of its tilted ends along it
                    if kind == "revolute" and slope != 0.0:
                        height = -math.copysign(CLEARANCE + (abs(WEIGHT * slope) / 1e9) ** (2 / 3), slope)
                    upper, lower = WEIGHT * (0.5 + (lever + height) / LENGTH), WEIGHT * (0.5 - (lever + height) / LENGTH)
                    ends = [-math.copysign(CLEARANCE + depth(abs(force)), force) for force in (upper, lower)]
                    slope = (ends[0] - ends[1]) / LENGTH
                self.assert_column(columns, "joint.S.fn", lambda t: abs(upper) + abs(lower), 2e-3)
                self.assert_column(columns, "joint.S.ez", lambda t: sum(ends) / 2 + height * slope, 2e-9)
                self.assertAlmostEqual(slope, 2 * columns["body.shaft.qx"][0], delta=1e-7)
                self.assert_rests(columns, "shaft", TILTED, names=("vx", "vz", "wx", "wy", "wz"))
                down = -9.81 * slope * columns["time"][-1] if kind == "cylindrical" else 0.0  # along its axis, which nothing holds
                self.assertAlmostEqual(down, columns["body.shaft.vy"][-1], delta=1e-6)

    def test_a_shaft_far_along_its_sleeve_rests_too(self):
        text = shaft(com="0, 0.01, 0", velocity=", pose: {position: [0, -0.05, 0]}", rest=", initial: loaded", more="")
        self.assert_rests(self.run_model(text), "shaft", TILTED, names=("vx", "vz", "wx", "wy", "wz"))

    def test_a_journal_with_a_load_along_its_axis_rests_on_a_shoulder_as_well(self):
        for axis, com in (("0, 0.6, 0.8", "0, 0.009, 0.012"), ("0, -0.8, 0.6", "0, 0.024, -0.018"), ("0.6, 0, 0.8", "0.003, 0, 0.004")):
            columns = self.run_model(shaft("revolute", com=com, axis=axis, rest=", initial: loaded"))
            self.assertGreater(columns["joint.S.fn"][0], 8.0)
            self.assert_rests(columns, "shaft", TILTED)

    def test_a_universal_joint_bends_by_both_of_its_pins(self):
        text = shaft("universal", gravity="0, 0, 0", rest=", cross: {mass: 0.1, inertia: [1e-5, 1e-5, 2e-5]}, initial: {tilt: [0, 0, 1 mrad]}").replace(
            ", axis: [0, 1, 0]", "")
        columns = self.run_model(text)
        self.assertAlmostEqual(math.sin(0.5e-3), columns["body.S.cross.qz"][0], delta=1e-12)
        self.assertAlmostEqual(math.sin(1e-3), columns["body.shaft.qz"][0], delta=1e-12)

    def test_a_block_starts_with_its_tilt_in_the_axes_of_its_guide(self):
        """Axis x of the guide is y of the world; its y is -x then."""
        rest = ', initial: {eccentricity: [0, "0.05 mm", 0], tilt: [1 mrad, 0.5 mrad, -0.7 mrad], tilt_speed: [0, 0, 20 mrad/s]}'
        columns = self.run_model(block(gravity="0, 0, 0", axis=", axis: [0, 1, 0]", rest=rest))
        for name, expected in (("shift_y", 5e-5), ("tilt_x", 1e-3), ("tilt_y", 5e-4), ("tilt_z", -7e-4)):
            self.assertAlmostEqual(expected, columns["joint.G." + name][0], delta=1e-14)
        self.assertAlmostEqual(2e-2, columns["body.block.wz"][0], delta=1e-12)

    def test_a_tilted_block_that_stays_in_the_plane_moves_as_that_of_the_plane(self):
        deep = self.run_model(block(rest=", initial: {tilt: [0, 0, 2 mrad], tilt_speed: [0, 0, 0.3]}"))
        plane = self.run_model(flat(rest=", initial: {angle: 2 mrad, speed: 0.3}"))
        self.assertGreater(max(plane["joint.G.fn"]), 10.0)
        for one, other, tolerance in (("shift", "shift_y", 1e-12), ("tilt", "tilt_z", 1e-11), ("fn", "fn", 1e-6)):
            for x, y in zip(plane["joint.G." + one], deep["joint.G." + other], strict=True):
                self.assertAlmostEqual(x, y, delta=tolerance)

    def test_a_loaded_block_in_the_plane_rests_where_that_of_the_plane_does(self):
        for lever in (0.03, 0.08):
            deep = self.run_model(block(com="%r, 0, 0" % lever, rest=", initial: loaded"))
            plane = self.run_model(flat(com="%r, 0" % lever, rest=", initial: loaded"))
            for one, other, tolerance in (("shift", "shift_y", 1e-9), ("tilt", "tilt_z", 1e-8), ("fn", "fn", 0.05)):
                self.assertAlmostEqual(plane["joint.G." + one][0], deep["joint.G." + other][0], delta=tolerance, msg=one)
            self.assert_rests(deep, "block")

    def test_a_loaded_block_carries_force_and_moment_in_every_direction(self):
        twist = "forces: {twist: {type: torque, on: block, value: [%s]}}\n"
        for gravity, com, value in (("0, -6, 8", "0.03, 0, 0", "0, 0, 0"), ("0, -9.81, 0", "0, 0, 0.02", "0.1, 0, 0"),
                                    ("0, 3, -9", "-0.07, 0.01, 0.015", "0.4, 0.2, -0.3"), ("0, 0, 0", "0, 0, 0", "0.5, 0, 0")):
            columns = self.run_model(block(gravity=gravity, com=com, rest=", initial: loaded", more=twist % value))
            self.assertGreater(columns["joint.G.fn"][0], 5.0)
            self.assert_rests(columns, "block")

    def test_mistakes_have_place_and_remedy(self):
        tilted = ", initial: {tilt: [%s]}"
        for text, expected in (
                (shaft("revolute", rest=tilted % "6 mrad, 0, 0"), {"id": "assembly-failed", "line": 6}),
                (shaft(rest=', initial: {eccentricity: [0, 0, "90 um"], tilt: [1 mrad, 0, 0]}'), {"id": "assembly-failed", "line": 6}),
                (shaft("spherical", rest=tilted % "1 mrad, 0, 0").replace(", axis: [0, 1, 0]", "").replace(", length: 40 mm", ""), {"id": "unknown-key"}),
                (shaft(rest=tilted % "1 mm, 0, 0"), {"id": "dimension-mismatch"}),
                (block(rest=tilted % "0, 0, 5 mrad"), {"id": "out-of-range", "line": 6}),
                (block(rest=tilted % "0, 0, 190 deg"), {"id": "out-of-range", "line": 6}),
                (block(rest=", initial: {angle: 1 mrad}"), {"id": "type-space"}),
                (flat(rest=tilted % "0, 1 mrad"), {"id": "type-space"})):
            with self.subTest(text):
                self.refusal(text, **expected)

    def test_a_journal_of_the_plane_does_not_tilt(self):
        text = """
bodies: {pin: {mass: 1, inertia: 1e-4}}
joints: {P: {type: revolute, between: [ground, pin], clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e9}, initial: {tilt: [1 mrad, 0]}}}}
"""
        self.refusal(text, id="type-space")


if __name__ == "__main__":
    unittest.main()
