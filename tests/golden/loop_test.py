"""Formulas that would be defined by themselves, and names that formulas do not know: what is said, and where."""
import json
import unittest

from program import ProgramTest

SLED = """freeplay: 1
bodies: {sled: {mass: 2, inertia: 1, frames: {nose: [0.1, 0]}}, bob: {mass: 1, inertia: 1}}
joints:
  rail: {type: prismatic, between: [ground, sled]}
  pin: {type: revolute, between: [sled, bob], clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e9}}}
drivers: {motor: {joint: rail, kind: force, value: %s}}
forces:
  spring: {type: spring-damper, between: [ground, sled], free_length: 0.2, spring: %s}
  load: {type: force, at: sled, value: [%s, 0]}
simulation: {end: 0.1, step: 1 ms, output: {frames: [sled/nose], columns: {%s}}}
"""
ACCELERATION = "is an acceleration: a force that depends on the acceleration it makes is defined by itself"
FORCES = "follows from the forces: one that depends on it is defined by itself"
RESULT = "is a result, on which no force can depend"


class Loops(ProgramTest):
    def errors(self, effort="1 N", spring='"1 N/m*x"', load="1 N", columns="", text=SLED):
        self.write("model.yaml", text % (effort, spring, load, columns))
        out = self.freeplay("validate", "model.yaml", "--json", code=3)[0]
        return [message for message in json.loads(out)["messages"] if message["severity"] == "error"]

    def test_accelerations_and_forces_in_a_force_are_algebraic_loops(self):
        for formula, name, says in (("-1 kg*body.sled.ax", "body.sled.ax", ACCELERATION), ("1 kg*frame.sled/nose.ay", "frame.sled/nose.ay", ACCELERATION),
                                    ("1 kg*frame.nose.ax", "frame.nose.ax", ACCELERATION), ("1 kg*m*body.bob.alpha", "body.bob.alpha", ACCELERATION),
                                    ("-0.1*abs(joint.rail.fy)", "joint.rail.fy", FORCES), ("0.1*joint.pin.fn", "joint.pin.fn", FORCES),
                                    ("0.5*force.spring.fx", "force.spring.fx", FORCES), ("0.5*force.load.fx", "force.load.fx", FORCES),
                                    ("0.5*driver.motor.force", "driver.motor.force", FORCES), ("driver.motor.power*1 s/m", "driver.motor.power", FORCES)):
            with self.subTest(formula):
                found, = self.errors(load='"%s"' % formula)
                self.assertEqual(("algebraic-loop", 9, 42 + formula.index(name)), (found["id"], found["line"], found["column"]), found)
                self.assertEqual("'%s' %s" % (name, says), found["message"])
                self.assertIn("by positions and speeds", found["suggestion"])

    def test_an_effort_of_a_driver_may_not_either(self):
        found, = self.errors(effort='"2 kg*body.sled.ax"')
        self.assertEqual(("algebraic-loop", 6, 58), (found["id"], found["line"], found["column"]))

    def test_other_results_are_no_channels_of_forces(self):
        for formula in ("1 N/m*joint.pin.delta", "1 N/J*energy.kinetic", "1 N/m*output.a", "1 N/m*force.spring.length"):
            found, = self.errors(load='"%s"' % formula)
            self.assertEqual("state-not-allowed", found["id"])
            self.assertIn(RESULT, found["message"])
            self.assertIn("channels such as body.NAME.vx", found["suggestion"])

    def test_what_is_nowhere_is_unknown_as_before(self):
        for name, near in (("body.sled.vxx", "body.sled.vx"), ("body.sleed.ax", "body.sled.x"), ("joint.rail.length", ""), ("body.ground.ax", "")):
            found, = self.errors(load='"1 N*s/m*%s"' % name)
            self.assertEqual("unknown-name", found["id"], found)
            self.assertIn(near or "channels such as body.NAME.vx", found["suggestion"])

    def test_a_bare_word_in_a_force_says_how_channels_are_written(self):
        found, = self.errors(load='"1 N*speed"')
        self.assertIn("channels such as body.NAME.vx", found["suggestion"])

    def test_columns_may_use_each_other_in_any_order(self):
        text = SLED % ("1 N", '"1 N/m*x"', "1 N", 'c: "output.b - output.a", a: "2*body.sled.x", b: "output.a + 3 m"')
        self.write("model.yaml", text)
        self.freeplay("run", "model.yaml", "--out", "done")
        lines = [line for line in self.read("done", "results.csv").splitlines() if not line.startswith("#")]
        names = lines[0].split(",")
        self.assertEqual(["output.c", "output.a", "output.b"], [name for name in names if name.startswith("output.")])
        for line in lines[1:]:
            row = dict(zip(names, map(float, line.split(","))))
            self.assertEqual(2 * row["body.sled.x"], row["output.a"])
            self.assertEqual(row["output.a"] + 3, row["output.b"])
            self.assertEqual(row["output.b"] - row["output.a"], row["output.c"])

    def test_columns_that_go_round_are_a_loop(self):
        for columns, chain in (('a: "output.a"', "output.a -> output.a"), ('a: "2*output.b", b: "output.c", c: "output.a"',
                                                                         "output.a -> output.b -> output.c -> output.a")):
            found, = self.errors(columns=columns)
            self.assertEqual("algebraic-loop", found["id"])
            self.assertTrue(found["message"].endswith("is defined by itself: " + chain), found)

    def test_units_of_columns_hold_in_others(self):
        found, = self.errors(columns='b: "output.a + 1 s", a: "body.sled.x"')
        self.assertEqual("dimension-mismatch", found["id"])

    def test_the_formula_of_a_spring_says_what_it_may_hold(self):
        for formula, column, near in (("50 N/m*stretch", 92, None), ("50 N/m*X", 92, "x"), ("50 N/m*body.sled.x", 92, None),
                                      ("50 N/m*force.spring.length", 92, None), ("50 N*t", 90, None), ("50 N/m*(x - l0)", 97, None)):
            with self.subTest(formula):
                found, = self.errors(spring='"%s"' % formula)
                self.assertEqual((8, column), (found["line"], found["column"]), found)
                self.assertEqual(near or "it may hold x", found["suggestion"])

    def test_where_a_number_must_be_constant_no_result_may_stand(self):
        self.write("model.yaml", (SLED % ("1 N", '"1 N/m*x"', "1 N", "")).replace("mass: 2", "mass: 1 kg/N*driver.motor.force"))
        out = json.loads(self.freeplay("validate", "model.yaml", "--json", code=3)[0])
        self.assertEqual("state-not-allowed", out["messages"][0]["id"])


if __name__ == "__main__":
    unittest.main()
