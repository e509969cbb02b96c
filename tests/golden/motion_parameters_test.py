"""Parameters of force elements that depend on the motion, in the plane and in space, and runs that end by a formula."""
import math
import unittest

from joint_limits_models_test import SPACES
from model_cases import EXACT, ModelTest

# A block of 2 kg on `slide`, a wheel of 0.5 kg m^2 on `pin`, without gravity.
STEPS = "step: %s, integrator: bathe"
PAIR = """
bodies: {left: {mass: 1 kg, inertia: 1}, right: {mass: 2 kg, inertia: 1}}
joints: {one: {type: prismatic, between: [ground, left]}, two: {type: prismatic, between: [ground, right]}}
forces:
%s
initial: {joints: {one: %s, two: %s}}
simulation: {end: 0.3 s, output: {interval: 10 ms}, %s}
"""


class MotionParameters(ModelTest):
    def columns_of(self, forces, more="", steps=EXACT, end="0.5 s"):
        for space, (model, ground) in SPACES.items():
            with self.subTest(space=space):
                yield self.run_model("%s\nforces:\n%s\n%s\nsimulation: {end: %s, output: {interval: 10 ms}, %s}\n" % (
                    model, forces.replace("GROUND", ground), more, end, steps))

    def test_a_brake_whose_limit_is_proportional_to_its_speed_damps(self):
        forces = """  a: {type: brake, kind: linear, between: [GROUND, block], limit: "6 N*s/m*joint.slide.speed", stiffness: 1e5 N/m}
  b: {type: brake, between: [GROUND, wheel], limit: "-2 N*m*s/rad*joint.pin.speed", stiffness: 1e4 N*m/rad}"""
        for columns in self.columns_of(forces, "initial: {speeds: {slide: 3, pin: -4}}"):
            self.assert_column(columns, "joint.slide.speed", lambda t: 3 * math.exp(-3 * t), 1e-8)
            self.assert_column(columns, "joint.pin.speed", lambda t: -4 * math.exp(-4 * t), 1e-8)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-7)

    def test_a_clutch_slips_against_a_limit_of_another_body(self):
        # The wheel runs ahead of the ground against 3 N m per metre of the block, which goes evenly.
        forces = """  c: {type: one-way-clutch, between: [GROUND, wheel], limit: "3 N*joint.slide.position", stiffness: 1e5 N*m/rad}"""
        for columns in self.columns_of(forces, "initial: {joints: {slide: 0.5}, speeds: {slide: 2, pin: 5}}"):
            self.assert_column(columns, "joint.pin.speed", lambda t: 5 - 6 * (0.5 * t + t * t), 1e-8)

    def test_friction_follows_time_and_motion(self):
        forces = """  a: {type: joint-friction, between: [GROUND, block], friction: "10 N/s*t", vs: 1e-4}
  b: {type: joint-friction, kind: rotational, between: [GROUND, wheel], friction: "2 N*m*abs(joint.pin.angle)", vs: 1e-4}"""
        for columns in self.columns_of(forces, "initial: {joints: {pin: -0.5}, speeds: {slide: 3, pin: 4}}", end="0.25 s"):
            self.assert_column(columns, "joint.slide.speed", lambda t: 3 - 2.5 * t * t, 1e-8)
            # w^2 = w0^2 + (2/I) c (angle^2 - 0.25)/2 while the angle is negative, less the same beyond
            for angle, speed in zip(columns["joint.pin.angle"], columns["joint.pin.speed"]):
                lost = 0.25 - angle ** 2 if angle < 0 else 0.25 + angle ** 2
                self.assertAlmostEqual(math.sqrt(16 - 4 * lost), speed, delta=1e-7)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-7)

    def test_a_damper_that_changes_with_the_place_changes_there(self):
        forces = """  a: {type: spring-damper, between: [GROUND, block], stiffness: 0, damping: "8 N*s/m*if(joint.slide.position > 1.2 m, 1, 0.25)"}"""
        for columns in self.columns_of(forces, "initial: {joints: {slide: 1}, speeds: {slide: 2}}"):
            for place, speed in zip(columns["joint.slide.position"], columns["joint.slide.speed"]):
                self.assertAlmostEqual(2 - min(place - 1, 0.2) - 4 * max(place - 1.2, 0), speed, delta=1e-8)

    def test_a_spring_pulls_by_what_another_body_does(self):
        # The block swings, the wheel is turned by its place: 0.5 angle'' = -(4 N m/m) x.
        forces = """  a: {type: spring-damper, between: [GROUND, block], stiffness: 50}
  b: {type: spring-damper, kind: rotational, between: [GROUND, wheel], preload: "4 N*joint.slide.position"}"""
        for columns in self.columns_of(forces, "initial: {joints: {slide: 0.3}}"):
            self.assert_column(columns, "joint.slide.position", lambda t: 0.3 * math.cos(5 * t), 1e-8)
            self.assert_column(columns, "joint.pin.angle", lambda t: 8 * 0.3 / 25 * (math.cos(5 * t) - 1), 1e-8)

    def test_stiffness_by_time_is_that_of_the_same_force(self):
        spring = """  s: {type: spring-damper, between: [ground, right], free_length: 0.5 m, stiffness: "40 N/m*(1 + 0.5*sin(20*t/(1 s)))", preload: 3 N}"""
        force = """  s: {type: force, at: right, value: ["-40 N/m*(1 + 0.5*sin(20*t/(1 s)))*(joint.two.position - 0.5 m) - 3 N", 0]}"""
        for steps in (EXACT, STEPS % "0.1 ms"):
            spring_columns, force_columns = (self.run_model(PAIR % (one, "1 m", "0.8 m", steps)) for one in (spring, force))
            for a, b in zip(spring_columns["joint.two.position"], force_columns["joint.two.position"]):
                self.assertAlmostEqual(b, a, delta=1e-9)

    def test_implicit_steps_far_beyond_the_swing_converge_by_exact_derivatives(self):
        # Each pulls by the place of the other: without these derivatives Newton's iteration grows by h^2 k/m = 40.
        forces = """  a: {type: spring-damper, between: [ground, left], preload: "1e5 N/m*(joint.one.position - joint.two.position)"}
  b: {type: spring-damper, between: [ground, right], preload: "1e5 N/m*(joint.two.position - joint.one.position)"}"""
        columns = self.run_model(PAIR % (forces, "1 m", "1.001 m", STEPS % "20 ms"))
        self.assertLess(max(abs(a + 2 * b - 3.002) for a, b in zip(columns["joint.one.position"], columns["joint.two.position"])), 1e-9)
        self.assertLess(max(abs(b - a) for a, b in zip(columns["joint.one.position"], columns["joint.two.position"])), 1.1e-3)

    def test_the_order_of_bathe_is_kept(self):
        forces = """  b: {type: joint-friction, between: [ground, right], friction: "6 N*s/m*joint.two.speed + 1 N/m*joint.one.position"}"""
        errors = []
        for step in ("5 ms", "2.5 ms", "1.25 ms"):
            columns = self.run_model((PAIR % (forces, "1 m", "0 m", STEPS % step)).replace("initial: {", "initial: {speeds: {two: 3}, "))
            exact = (3 + 1 / 6) * math.exp(-3 * 0.3) - 1 / 6
            errors.append(abs(columns["joint.two.speed"][-1] - exact))
        self.assertAlmostEqual(4, errors[0] / errors[1], delta=0.3)
        self.assertAlmostEqual(4, errors[1] / errors[2], delta=0.3)

    def test_mistakes_in_them_have_their_place(self):
        for forces, id_, words in (
                ('{type: brake, between: [ground, left], limit: "1 N*m*s/m*joint.one.sped", stiffness: 1e3}', "unknown-name", "joint.one.speed"),
                ('{type: joint-friction, between: [ground, left], friction: "body.left.vx"}', "dimension-mismatch", "force"),
                ('{type: joint-friction, between: [ground, left], friction: "0.1*joint.two.fy"}', "algebraic-loop", "follows from the forces"),
                ('{type: spring-damper, between: [ground, left], preload: "1 kg*body.left.ax"}', "algebraic-loop", "acceleration"),
                ('{type: spring-damper, between: [ground, left], damping: -1 N*s/m}', "out-of-range", ">= 0"),
                ('{type: spring-damper, between: [ground, left], free_length: "body.right.x"}', "state-not-allowed", "not allowed here")):
            with self.subTest(forces):
                message = self.refusal(PAIR % ("  x: " + forces, 0, 0, EXACT), id=id_)[0]
                self.assertEqual(6, message["line"])
                self.assertIn(words, str(message))

    def test_one_without_a_value_ends_the_run_at_its_place(self):
        forces = """  b: {type: brake, kind: linear, between: [ground, right], limit: "5 N*sqrt(1 - joint.two.position/(0.1 m))", stiffness: 1e5 N/m}"""
        text = (PAIR % (forces, 0, 0, EXACT)).replace("initial: {", "initial: {speeds: {two: 3}, ")
        _, err = self.freeplay("run", self.model(text), "--out", "out", code=4)
        self.assertIn("m.yaml:6:72: square root of a negative number", err)

    def test_what_depends_on_the_motion_is_shown_so(self):
        forces = """  b: {type: brake, kind: linear, between: [ground, right], limit: "5 N*joint.two.position/(1 m)", stiffness: 1e5 N/m}
  f: {type: joint-friction, between: [ground, left], friction: 5 N}"""
        out, _ = self.freeplay("show", self.model(PAIR % (forces, 0, 0, EXACT)), "--json")
        self.assertIn('"function of the motion"', out)
        self.assertIn('"friction":5.0', out.replace(" ", ""))

    def test_a_run_ends_where_a_formula_is_above_its_limit(self):
        text = (PAIR % ("  f: {type: force, at: left, value: [2 N, 0]}", 0, 0, EXACT)).replace(
            "output: {", "stop: [{value: 'body.left.x - 1 m/s*t', above: -0.09 m, after: 0.15 s}], output: {")
        columns = self.run_model(text)
        # t^2 - t = -0.09 at 0.1 s and 0.9 s: from 0.15 s on it is below until 0.9 s
        self.assertAlmostEqual(0.3, columns["time"][-1])
        columns = self.run_model(text.replace("above: -0.09 m, after: 0.15 s", "below: -0.09 m"))
        self.assertAlmostEqual(0.1, columns["time"][-1], delta=1e-9)
        self.assertAlmostEqual(-0.09, columns["output.stop1"][-1], delta=1e-9)
        for stop, id_, words in (("{value: body.lef.x, above: 1 m}", "unknown-name", "body.left.x"),
                                 ("{value: body.left.x, above: 1 kg}", "dimension-mismatch", "length"),
                                 ("{value: body.left.x, channel: body.left.x, above: 1 m}", "conflicting-keys", "exclude"),
                                 ("{value: output.stop1, above: 1 m}", "algebraic-loop", "defined by itself")):
            with self.subTest(stop):
                message = self.refusal(text.replace("{value: 'body.left.x - 1 m/s*t', above: -0.09 m, after: 0.15 s}", stop), id=id_)[0]
                self.assertIn(words, str(message))


if __name__ == "__main__":
    unittest.main()
