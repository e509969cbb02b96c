"""Steps so short that a run would not end are told, with what to look at."""
import json
import math
import re
import unittest

from program import ProgramTest

# The damper alone brings the block to rest within m/c seconds, which an explicit method follows step by step.
MODEL = """freeplay: 1
bodies: {puck: {mass: 1 kg, inertia: 0.01, frames: {tip: [20 mm, 0]}}}
joints: {slide: {type: prismatic, between: [ground, puck]}}
frames: {ground/wall: [300 mm, 0]}
forces:
  buffer: {type: spring-damper, between: [ground/wall, puck/tip], stiffness: 1e9, free_length: 270 mm, damping: $c}
parameters: {c: 1e12}
simulation: {end: 2 s, accuracy: 1 um, integrator: dopri5}
"""

# A pin that just touches its hole: its contact begins at no speed, by which the law divides its damping.
DROP = """freeplay: 1
gravity: [0, -9.81]
bodies: {pin: {mass: 1, inertia: 1e-3}}
joints:
  hole:
    type: revolute
    between: [ground, pin]
    clearance:
      radial_clearance: 0.1 mm
      bearing_radius: 10 mm
      initial: {eccentricity: [0 mm, -0.1 mm]}
      contact: {law: flores, K: 1e8, restitution: 0.001}
simulation: {end: 0.1 s, accuracy: 1 um}
"""

LIFT = "forces: {lift: {type: force, at: pin, value: [0, '9.82 N*(1 - smooth(t, 1 ms, 2 ms))']}}\n"

# A pin that comes to rest in its hole, by a friction that sets in over 1 um/s.
RUB = DROP.replace("simulation:", "initial: {speeds: {hole: 0.01 rad/s}}\nsimulation:").replace("initial: {eccentricity: [0 mm, -0.1 mm]}", "initial: loaded").replace(
    "contact: {law: flores, K: 1e8, restitution: 0.001}",
    "contact: {law: hertz, K: 1e8}\n      friction: {law: coulomb-tanh, mu: 1, vs: 1 um/s}")

# A load that turns with the speed of the plunger, which it brings to rest and holds there.
PUMP = """freeplay: 1
bodies:
  wheel: {mass: 2, inertia: 3e-3, frames: {pin: [8 mm, 0]}}
  rod: {mass: 0.6, inertia: 1e-3, com: [50 mm, 0], frames: {end: [110 mm, 0]}, pose: {position: [8 mm, 0]}}
  plunger: {mass: 0.3, inertia: 1e-4}
joints:
  shaft: {type: revolute, between: [ground, wheel]}
  pin: {type: revolute, between: [wheel/pin, rod]}
  end: {type: revolute, between: [rod/end, plunger]}
  bore: {type: prismatic, between: [ground, plunger]}
forces: {oil: {type: force, at: plunger, value: ["-400 N*sign(body.plunger.vx)", 0]}}
initial: {joints: {shaft: 20 deg}, speeds: {shaft: 3}}
simulation: {end: 0.3 s, accuracy: 1 um, stop: [{value: t, above: 7.622e-3}]}
"""


class ShortSteps(ProgramTest):
    def test_a_run_that_would_take_days_ends_and_names_the_cause(self):
        self.write("m.yaml", MODEL)
        _, err = self.freeplay("run", "m.yaml", "--out", "r", code=4)
        self.assertRegex(err, r"error: t = \S+ s: the run does not come to its end: steps of \S+ s at t = \S+ s, of which "
                              r"the whole run would take \de\+11; likely cause: 'buffer'")
        self.assertEqual(100000, json.loads(self.read("r", "summary.json"))["counts"]["steps"])

    def test_a_run_of_hours_is_told_while_it_goes_on(self):
        self.write("m.yaml", MODEL.replace("simulation: {", "simulation: {stop: [{channel: body.puck.x, above: -1, after: 10 ms}], "))
        _, err = self.freeplay("run", "m.yaml", "--out", "r", "--set", "c=1e8")
        self.assertRegex(err, r"warning: steps of \S+ s at t = \S+ s, of which the whole run would take \d(\.\d)?e\+07")

    def test_a_run_of_ordinary_steps_is_not_told_so(self):
        self.write("m.yaml", MODEL.replace("end: 2 s", "end: 20 ms"))
        out, err = self.freeplay("run", "m.yaml", "--out", "r", "--set", "c=1e5")
        self.assertNotIn("of which the whole run", out + err)

    def test_a_contact_that_damps_too_much_for_longer_steps_is_named(self):
        self.write("m.yaml", DROP)
        out, err = self.freeplay("run", "m.yaml", "--out", "r")
        self.assertRegex(err, r"warning: steps of \S+ s at t = \S+ s, of which the whole run would take \S+; joint 'hole' limits the last "
                              r"of them to \S+ s: its contact \(law 'flores', begun at \S+ m/s\) is damped .*\('initial: loaded'\)")
        reasons = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
        self.assertIn(("short-steps", "joint 'hole'"), [(r["id"], r["element"]) for r in reasons])
        self.assertIn("trust: doubtful", out)

    def test_a_load_that_jumps_with_each_step_is_named(self):
        self.write("m.yaml", PUMP)
        err = self.freeplay("run", "m.yaml", "--out", "r")[1]
        self.assertRegex(err, r"warning: steps of \S+ s at .*; force 'oil' changes by 100 % from each to the next: it jumps, or is stiff")
        reasons = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
        self.assertIn(("short-steps", "force 'oil'"), [(r["id"], r["element"]) for r in reasons])

    def test_a_contact_that_starts_under_its_load_is_not_named(self):
        self.write("m.yaml", DROP.replace("initial: {eccentricity: [0 mm, -0.1 mm]}", "initial: loaded"))
        out, err = self.freeplay("run", "m.yaml", "--out", "r")
        self.assertNotIn("no longer", out + err)

    def test_lengths_and_counts_of_steps_agree(self):
        self.write("m.yaml", DROP)
        err = self.freeplay("run", "m.yaml", "--out", "r")[1]
        length, at, whole = map(float, re.search(r"steps of (\S+) s at t = (\S+) s, of which the whole run would take (\S+);", err).groups())
        steps = 100000 * math.ceil(at / (100000 * length))  # of whole blocks
        self.assertAlmostEqual(whole, steps + (0.1 - at) / length, delta=0.1 * whole)

    def test_a_load_at_the_start_is_no_remedy_where_it_is_one_already(self):
        self.write("m.yaml", DROP.replace("initial: {eccentricity: [0 mm, -0.1 mm]}", "initial: loaded").replace(
            "0.001}", "1e-9}").replace("end: 0.1 s", "end: 35 ms") + LIFT)
        err = self.freeplay("run", "m.yaml", "--out", "r")[1]
        self.assertRegex(err, r"its contact \(law 'flores', begun at \S+ m/s\) is damped")
        self.assertNotIn("initial: loaded", err)

    def test_a_friction_that_makes_steps_short_is_named(self):
        """A law of contact without damping: what is fast is the friction, mu N/(m vs)."""
        self.write("m.yaml", RUB)
        err = self.freeplay("run", "m.yaml", "--out", "r")[1]
        said = re.search(r"joint 'hole' limits the last of them to (\S+) s: its friction \(law 'coulomb-tanh'\) brings "
                         r"sliding to rest with a time constant of (\S+) s; .*'vs'", err)
        self.assertTrue(said, err)
        self.assertNotIn("initial: loaded", err)
        # (1/m + R^2/i) mu m g/vs with R = 9.9 mm, at rest
        self.assertAlmostEqual(1e-6 / (9.81 * (1 + 9.9e-3 ** 2 / 1e-3)), float(said[2]), delta=2e-9)


if __name__ == "__main__":
    unittest.main()
