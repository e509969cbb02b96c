"""Formulas where the model file gives laws, springs, parameters of plugins and columns: from outside."""
import json
import os
import unittest

from program import BUILD, ProgramTest

LIBRARY = os.path.join(BUILD, "plugins", "tests", "wavy_spring.so")
PUCK = """freeplay: 1
gravity: [0, -9.81]
bodies: {puck: {mass: 0.2, inertia: 1e-4}}
joints:
  ring:
    type: revolute
    between: [ground, puck]
    clearance:
      bearing_radius: 5 mm
      radial_clearance: 0.1 mm
      contact: {law: expression, force: %s}
      friction: {law: expression, coefficient: %s}
simulation: {end: 8 ms, accuracy: 1e-8, output: {interval: 1 ms}}
"""
HERTZ, TANH = "7.5e10 N/m^1.5*delta^1.5*(1 + 0.1*rate/v0)", '"0.1*tanh(vt/(1 mm/s))"'

# Force or coefficient, by what; id, column, suggestion or a part of the hint.
MISTAKES = [
    ("7.5e10 N/m^1.5*detla^1.5", None, "unknown-name", 56, "delta"),
    ("7.5e10 N/m^1.5*penetration", None, "unknown-name", 56, "it may hold delta, rate or v0"),
    ("7.5e10 N/m*delta^1.5", None, "dimension-mismatch", 41, ""),
    ("1e6 N/m*delta*t", None, "time-not-allowed", 55, ""),
    ("$K*delta", None, "unknown-name", 41, ""),
    (None, "0.2", "out-of-range", 48, ""),
    (None, "0.2*tanh(vt)", "dimension-mismatch", 57, ""),
]
TEMPLATE = """freeplay: 1
templates:
  arm:
    parameters: {k: required, c: 0.3, x: required}
    bodies: {rod: {mass: 1, inertia: 0.1, com: [0.3, 0]}}
    joints: {pin: {type: revolute, between: [ground, rod]}}
    forces:
      coil: {type: spring-damper, kind: rotational, between: [ground, rod], spring: "$k*x - $c*x^3", damper: "${c}*v"}
instances: {one: {template: arm, with: {k: 30 N*m, x: 1}}, two: {template: arm, with: {k: 40, c: -0.2, x: 2}}}
initial: {joints: {one.pin: 1, two.pin: 1}}
simulation: {end: 0.5, step: 1 ms}
"""


class Formulas(ProgramTest):
    def test_mistakes_have_their_place(self):
        for force, coefficient, id_, column, words in MISTAKES:
            with self.subTest(force or coefficient):
                self.write("model.yaml", PUCK % (force or HERTZ, coefficient or TANH))
                report = json.loads(self.freeplay("validate", "model.yaml", "--json", code=3)[0])
                found = report["messages"][0]
                self.assertEqual((id_, 11 if force else 12, column), (found["id"], found["line"], found["column"]), found)
                self.assertIn(words, str(found), found)
                self.assertEqual(1, len(report["messages"]))

    FRAMES = """freeplay: 1
bodies:
  rod: {mass: 1, inertia: 0.1, frames: {tip: [1, 0], end: [2, 0]}}
  arm: {mass: 1, inertia: 0.1, frames: {end: [1, 0]}}
joints: {pin: {type: revolute, between: [ground, rod]}, top: {type: revolute, between: [rod/tip, arm]}, a: {type: revolute, between: [rod/end, ground]}}
forces: {load: {type: torque, on: arm, value: 1 N*%s}}
"""

    def test_frames_are_suggested_by_any_of_their_names(self):
        for name, meant in (("frame.rod.q", "frame.rod.x"), ("frame.rd.y", "frame.rod.y"), ("frame.tp.y", "frame.tip.y"),
                            ("fram.rod/tip.y", "frame.rod/tip.y"), ("frame.end.vx", "frame.arm/end.vx"), ("frame.end.vq", "frame.arm/end.vx"),
                            ("frame.arm/ed.y", "frame.arm/end.y"), ("bdy.rod.y", "body.rod.y")):
            with self.subTest(name):
                self.write("frames.yaml", self.FRAMES % name)
                report = json.loads(self.freeplay("validate", "frames.yaml", "--json", code=3)[0])
                self.assertEqual(("unknown-name", meant), (report["messages"][0]["id"], report["messages"][0]["suggestion"]))

    def test_a_body_alone_is_its_own_frame(self):
        for out, name in (("a", "frame.rod.y"), ("b", "frame.rod/origin.y")):
            self.write("own.yaml", self.FRAMES.replace(", a: {type: revolute, between: [rod/end, ground]}", "") % name +
                       "initial: {joints: {pin: 0.3}, speeds: {pin: 1}}\nsimulation: {end: 0.1 s, step: 1 ms}\n")
            self.freeplay("run", "own.yaml", "--quiet", "--out", out)
        self.assertEqual(self.read("a", "results.csv"), self.read("b", "results.csv"))

    def test_of_a_column_in_error_nothing_more_is_said(self):
        for columns in ("{E: body.sled.q, F: 2*output.E}", "{E: 1 m + 1 s}"):
            self.write("columns.yaml", """freeplay: 1
bodies: {sled: {mass: 1, inertia: 0.1}}
simulation: {end: 1, step: 1 ms, output: {columns: %s, channels: ["*", output.E]}, stop: [{channel: output.E, above: 1}]}
""" % columns)
            report = json.loads(self.freeplay("validate", "columns.yaml", "--json", code=3)[0])
            self.assertEqual(1, len(report["messages"]), report["messages"])

    def test_a_formula_without_a_value_ends_the_run_at_its_place(self):
        self.write("model.yaml", PUCK % ("1e6 N/m*delta/sqrt(1 - delta/(1 um))", TANH))
        _, errors = self.freeplay("run", "model.yaml", code=4)
        self.assertIn("model.yaml:11:55: square root of a negative number [bad-expression]", errors)

    def test_types_say_what_their_formulas_are_of(self):
        text = self.freeplay("describe", "expression")[0]
        self.assertIn("formula in delta [m], rate [m/s], v0 [m/s]", text)
        self.assertIn("formula in vt [m/s], fn [N]", text)

    def test_a_model_without_its_templates_runs_to_the_same_bytes(self):
        self.write("model.yaml", TEMPLATE)
        self.freeplay("convert", "model.yaml", "flat.urdf")
        self.assertNotIn("templates", self.read("flat.urdf.sidecar.yaml"))
        for name, file in ("model", "model.yaml"), ("flat", "flat.urdf.sidecar.yaml"):
            self.freeplay("run", file, "--out", name)
        rows = [self.read(name, "results.csv").splitlines()[1:] for name in ("model", "flat")]
        self.assertEqual(rows[0], rows[1])

    def test_a_type_of_a_plugin_takes_one(self):
        self.write("model.yaml", """freeplay: 1
plugins: [%s]
bodies: {disc: {mass: 1, inertia: 0.2}}
joints:
  pin: {type: revolute, between: [ground, disc]}
forces:
  spring: {type: wavy-spring, between: [ground, disc], stiffness: 0 N*m, more: "turn*(1 + turn^2)*5 N*m"}
initial: {joints: {pin: 1}}
simulation: {end: 0.1, accuracy: 1e-8}
""" % LIBRARY)
        self.freeplay("run", "model.yaml", "--allow-plugins", "--out", "done")
        lines = [line for line in self.read("done", "results.csv").splitlines() if not line.startswith("#")]
        row = dict(zip(lines[0].split(","), map(float, lines[1].split(","))))
        self.assertEqual(-10.0, row["force.spring.torque"])


if __name__ == "__main__":
    unittest.main()
