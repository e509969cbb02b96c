"""Gears whose teeth have play: flanks, start, bearings that feel them, turns, and mistakes."""
import csv
import json
import math
import unittest

from model_cases import EXACT, ModelTest

GEAR = """
gravity: [0, 0]
bodies:
  ground: {frames: {second: [%s, 0]}}
  pinion: {mass: 1, inertia: 1e-3}
  wheel: {mass: 2, inertia: 4e-3}
joints:
  J1: {type: revolute, between: [ground, pinion]}
  J2: {type: revolute, between: %s}
  G: {type: gear, of: [J1, J2], ratio: %s, clearance: {%s, contact: %s}}
drivers: {D: {joint: J1, kind: angle, value: %s}}
%s
simulation: {end: %s, %s, output: {interval: 0.1 ms}}
"""
RADIUS, GAP, ANGLE, TORQUE, INERTIA = 0.06, 5e-5, math.radians(20), 6.0, 4e-3
KEYS = "pitch_radius: 60 mm, gap: 50 um"
FINE = "integrator: dopri5, accuracy: 0.01 nm"
SOFT, HARD = "{law: kelvin-voigt, K: 1e6, D: 1500}", "{law: hertz, K: 1e9}"
LOAD = "forces: {T: {type: torque, on: wheel, value: %g}}"


def gear(apart="90 mm", second="[ground/second, wheel]", ratio="-0.5", keys=KEYS, contact=SOFT, angle="0",
         more=LOAD % TORQUE, end="40 ms", simulation=EXACT):
    return GEAR % (apart, second, ratio, keys, contact, angle, more, end, simulation)


class GearWithPlay(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_facts_with_and_without_play(self):
        self.facts(gear(), clearance_joints=1, constraints=4, dof=2)
        self.facts(gear(), "--ideal", "G", clearance_joints=0, constraints=5, dof=1)

    def test_its_ideal_twin_has_the_bytes_of_the_gear_without_the_block(self):
        text = gear(angle="sin(20*t)")
        begin, end = text.index(", clearance:"), text.index("}}}\ndrivers") + 2
        for model, options in ((text, ("--ideal", "all")), (text[:begin] + text[end:], ())):
            self.freeplay("run", self.model(model), "--out", "ideal" + str(len(options)), "--quiet", *options)
        self.assertEqual(self.read("ideal2", "results.csv"), self.read("ideal0", "results.csv"))

    def test_the_first_flank_is_met_when_the_play_is_used_up(self):
        """From the middle under a constant torque: R T/I t^2/2 = g; the depth grows along the line of action."""
        for torque, kind in ((TORQUE, "ahead_contact_begin"), (-TORQUE, "behind_contact_begin")):
            self.run_model(gear(more=LOAD % torque, end="2 ms", simulation=FINE))
            first = next(event for event in self.events() if event["kind"].endswith("contact_begin"))
            time = math.sqrt(2 * GAP * INERTIA / (RADIUS * TORQUE))
            self.assertEqual(kind, first["kind"])
            self.assertAlmostEqual(time, float(first["time"]), delta=1e-10)
            self.assertAlmostEqual(math.cos(ANGLE) * RADIUS * TORQUE / INERTIA * time, float(first["speed"]), delta=1e-8)

    def test_it_rests_where_statics_puts_it_and_its_bearings_feel_the_teeth(self):
        """As the play goes to zero the place tends to the ideal one, by the play itself."""
        force = TORQUE / (RADIUS * math.cos(ANGLE))
        yields = force / 1e6 / math.cos(ANGLE)
        for gap in (GAP, GAP / 2, GAP / 4):
            keys = "pitch_radius: 60 mm, gap: %.17g" % gap
            columns = self.run_model(gear(keys=keys, end="0.1 s"))
            self.assertAlmostEqual(gap + yields, columns["joint.G.shift"][-1], delta=1e-12)
            self.assertAlmostEqual(force, columns["joint.G.fn"][-1], delta=1e-6)
            self.assertAlmostEqual(force * math.sin(ANGLE), abs(columns["joint.J2.fx"][-1]), delta=1e-6)
            self.assertAlmostEqual(force * math.cos(ANGLE), abs(columns["joint.J2.fy"][-1]), delta=1e-6)
            self.assertAlmostEqual(-TORQUE, columns["joint.G.torque"][-1], delta=1e-6)
            self.assertAlmostEqual(TORQUE / RADIUS * 0.03, abs(columns["driver.D.torque"][-1]), delta=1e-6)
            # The teeth push the axes apart.
            self.assertLess(columns["joint.J2.fx"][-1], 0.0)

    def test_without_a_pressure_angle_nothing_parts_the_axes(self):
        columns = self.run_model(gear(ratio="-0.5, pressure_angle: 0", end="0.1 s"))
        self.assertAlmostEqual(TORQUE / RADIUS, columns["joint.G.fn"][-1], delta=1e-6)
        self.assertAlmostEqual(0.0, columns["joint.J2.fx"][-1], delta=1e-6)

    def test_backlash_is_the_angle_from_flank_to_flank(self):
        other = self.run_model(gear(keys="pitch_radius: 60 mm, backlash: %.17g" % (2 * GAP / RADIUS)))
        columns = self.run_model(gear())
        self.assertAlmostEqual(columns["joint.G.shift"][-1], other["joint.G.shift"][-1], delta=1e-15)

    def test_energy_is_kept_from_flank_to_flank(self):
        columns = self.run_model(gear(contact=HARD, more=LOAD % TORQUE, end="50 ms", simulation=FINE))
        summary = json.loads(self.read("out", "summary.json"))
        self.assertGreater(summary["joints"]["G"]["play"]["impacts"], 5)
        self.assertLess(summary["residuals"]["energy_max"], 1e-9)
        self.assertLess(max(abs(x) for x in columns["energy.dissipated"]), 1e-9)

    def test_it_follows_over_many_turns(self):
        columns = self.run_model(gear(ratio="-0.37", apart="82.2 mm", angle="100*t^2", more="", end="1 s",
                                      simulation="accuracy: 1 um, integrator: dopri5"))
        self.assertGreater(columns["joint.J1.angle"][-1], 99.0)
        for first, second in zip(columns["joint.J1.angle"], columns["joint.J2.angle"]):
            self.assertLess(RADIUS * abs(second + 0.37 * first), 1.5 * GAP)

    def test_a_wheel_that_is_named_first_turns_the_same_way(self):
        one = self.run_model(gear())
        other = self.run_model(gear(second="[wheel, ground/second]", ratio="0.5"))
        for a, b in zip(one["body.wheel.angle"], other["body.wheel.angle"]):
            self.assertAlmostEqual(a, b, delta=1e-13)

    def test_a_pinion_inside_of_a_ring_is_pushed_inwards(self):
        columns = self.run_model(gear(ratio="0.5", apart="30 mm", end="0.1 s"))
        force = TORQUE / (RADIUS * math.cos(ANGLE))
        self.assertAlmostEqual(GAP + force / 1e6 / math.cos(ANGLE), columns["joint.G.shift"][-1], delta=1e-12)
        # The ring is pushed off its pinion: towards +x, its bearing back.
        self.assertAlmostEqual(force * math.sin(ANGLE), columns["joint.J2.fx"][-1], delta=1e-6)

    def test_a_planet_rolls_on_its_sun(self):
        """The arm turns by a, the sun rests: the planet turns by (1 - ratio) a against the frame."""
        text = gear(angle="-(10*t^2)", more="", end="0.5 s", simulation="accuracy: 1 um, integrator: dopri5")
        text = text.replace("ground: {frames: {second: [90 mm, 0]}}", "arm: {mass: 1, inertia: 0.01, frames: {second: [90 mm, 0]}}")
        text = text.replace("[ground, pinion]", "[arm, pinion]").replace("ground/second", "arm/second")
        text = text.replace("joints:\n", "joints:\n  A: {type: revolute, between: [ground, arm]}\n")
        text = text.replace("drivers: {", "drivers: {E: {joint: A, kind: angle, value: 10*t^2}, ")
        columns = self.run_model(text)
        self.assertGreater(columns["body.wheel.angle"][-1], 3.7)
        for arm, planet in zip(columns["joint.A.angle"], columns["body.wheel.angle"]):
            self.assertLess(RADIUS * abs(planet - 1.5 * arm), 1.5 * GAP)

    def test_mistakes_have_place_and_remedy(self):
        cases = (
            (gear(keys="pitch_radius: 60 mm"), {"id": "missing-key", "line": 11}),
            (gear(keys=KEYS + ", backlash: 1 mrad"), {"id": "conflicting-keys", "line": 11}),
            (gear(keys="gap: 50 um"), {"id": "missing-key", "line": 11}),
            (gear(keys="pitch_radius: 60 mm, gap: 61 mm"), {"id": "out-of-range", "line": 11}),
            (gear(keys="pitch_radius: 61 mm, gap: 50 um"), {"id": "out-of-range", "line": 11}),
            (gear(ratio="-0.5, pressure_angle: 50 deg"), {"id": "out-of-range", "line": 11}),
            (gear(keys=KEYS + ", gapp: 1 mm"), {"id": "unknown-key", "line": 11, "suggestion": "gap"}),
            (gear(ratio="1", apart="0"), {"id": "out-of-range", "line": 11}),
            (gear(second="[pinion, wheel]"), {"id": "out-of-range", "line": 11, "suggestion": None}),
            (gear(second="[link, wheel]").replace("  wheel:", "  link: {mass: 1, inertia: 1}\n  wheel:"), {"id": "wrong-type", "line": 12}))
        for text, expected in cases:
            with self.subTest(expected):
                self.refusal(text, **expected)

    def test_slides_and_space_have_no_teeth_with_play(self):
        rack = gear(ratio="50 mm").replace("J2: {type: revolute", "J2: {type: prismatic")
        self.refusal(rack, id="wrong-type", line=11)
        self.refusal(gear().replace("G: {type: gear, of: [J1, J2], ratio: -0.5,", "G: {type: gear-clearance, between: [pinion, wheel],"),
                     id="unknown-type", line=11)


if __name__ == "__main__":
    unittest.main()
