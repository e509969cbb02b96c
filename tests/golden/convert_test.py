"""freeplay convert: URDF to YAML and back."""
import csv
import json
import os
import unittest

from program import ROOT, ProgramTest, mechanism

DATA = os.path.join(ROOT, "tests", "data", "urdf")


class Convert(ProgramTest):
    def verdict(self, model):
        return json.loads(self.freeplay("validate", model, "--json")[0])

    def results(self, model, *options):
        out = model.replace("/", "_") + ".out"
        self.freeplay("run", model, "--out", out, "--quiet", *options)
        rows = list(csv.reader(self.read(out, "results.csv").splitlines()))
        return {name: [float(x) for x in values] for name, *values in zip(*rows)}

    def assert_same(self, one, other, *options, names=lambda name: name):
        """`names` tells the name in `other` of a body in `one`."""
        first, second = self.verdict(one), self.verdict(other)
        self.assertEqual(first["facts"], second["facts"])
        self.assertEqual(set(map(names, first["start"])), set(second["start"]))
        for body, pose in first["start"].items():
            for key, value in pose.items():
                self.assertAlmostEqual(value, second["start"][names(body)][key], delta=1e-9)

        def renamed(column):
            if column == "time":
                return column
            kind, *name, quantity = column.split(".")
            return ".".join([kind, names(".".join(name)), quantity]) if name else column

        expected, actual = self.results(one, *options), self.results(other, *options)
        expected = {renamed(name): values for name, values in expected.items()}
        self.assertEqual(set(expected), set(actual))
        for name, values in expected.items():
            # What is left of an energy balance is rounding of the energies.
            scale = max(1.0, *(abs(x) for x in expected["energy.kinetic" if name.startswith("energy.") else name]))
            for x, y in zip(values, actual[name], strict=True):
                self.assertLess(abs(x - y), 1e-9 * scale, name)

    def test_there_and_back_is_the_same_motion(self):
        for name, end in (("pendulum", "0.2 s"), ("four-bar", "0.2 s"), ("slider-crank", "100 us")):
            with self.subTest(name):
                self.freeplay("convert", mechanism(name), name + ".urdf")
                self.assert_same(mechanism(name), name + ".urdf.sidecar.yaml", "--end", end)
                self.freeplay("convert", name + ".urdf.sidecar.yaml", name + "-back.yaml")
                self.assertNotIn("urdf", self.read(name + "-back.yaml"))
                self.assert_same(mechanism(name), name + "-back.yaml", "--end", end)

    def test_what_it_writes_has_no_warning_that_the_model_has_not(self):
        for name in ("four-bar", "slider-crank", "3-rrr", "gallery/toggle-press", "gallery/shaper"):
            model = mechanism(name)
            self.freeplay("convert", model, "r.urdf", "--force")
            of_model = [w["code"] for w in self.verdict(model)["messages"]]
            self.assertEqual(of_model, [w["code"] for w in self.verdict("r.urdf.sidecar.yaml")["messages"]], name)
        self.write("kept.yaml", self.read(mechanism("four-bar")).replace("step: 1 ms", "step: 1 ms, output: {frames: [crank/tip]}"))
        self.freeplay("convert", "kept.yaml", "r.urdf", "--force")
        self.assertIn("frame.crank/tip.x", self.results("r.urdf.sidecar.yaml"))

    def test_instances_are_written_out_under_names_of_their_own(self):
        for name, end in (("3-rrr", "100 us"), ("4-rrr", "100 us"), ("validation/a02-chain", "20 ms")):
            with self.subTest(name):
                out = os.path.basename(name) + ".urdf"
                self.freeplay("convert", mechanism(name), out)
                self.assert_same(mechanism(name), out + ".sidecar.yaml", "--end", end,
                                 names=lambda name: name.replace(".", "_"))

    def test_everything_a_template_may_hold_keeps_its_meaning(self):
        os.mkdir(self.path("to"))
        self.write("push.csv", "t,x\n0,0\n0.1,0.02\n0.3,0.05\n")
        self.write("m.yaml", """freeplay: 1
gravity: [0, -9.81]
parameters: {k: 3, r: 100 mm}
presets:
  wheel: {mass: $m, inertia: $m * $r^2 / 2, use: light}
  light: {mass: 1}
  turn: {kind: angle, value: "$k * t^2 + $phase"}
  push: {kind: position, table: push.csv}
bodies:
  sled: {mass: 5, inertia: 1}
joints:
  rail: {type: prismatic, between: [ground, sled]}
templates:
  unit:
    parameters: {m: 10 kg/m * $r, k: 7, at: required, phase: 30 deg, arm: 20 cm, free: 2}
    bodies:
      ground: {frames: {mark: [$at, 1 m]}}
      wheel: {use: wheel, frames: {rim: {polar: [$r, 90 deg]}}}
    frames: {sled/hub: [$at, 0]}
    joints: {axle: {type: revolute, between: [sled/hub, wheel]}}
    drivers: {spin: {joint: axle, use: turn, x-why: nothing}}
    forces:
      wind: {type: force, at: wheel/rim, value: ["$i * 2 N * cos($k*t)", $n]}
      tie: {type: spring-damper, between: [ground/mark, wheel/rim], stiffness: 5 N/m * $k}
      twist: {type: torque, on: wheel, value: $arm * 3 N * sin(t)}
      odd: {type: torque, on: wheel, value: $free * 3 mm}
      moon: {type: gravity, on: ["wh*"], value: [0, -1.6]}
instances:
  u: {template: unit, count: 2, with: {at: $r * $i, k: $k}}
  other: {template: unit, with: {at: -1 m}}
frames: {u1.wheel/probe: [1 mm, 0]}
drivers: {d: {joint: rail, use: push}}
simulation:
  end: 0.3 s
  step: 1 ms
  output: {frames: [u1.wheel/probe], channels: ["body.u*.x", "joint.*", time, "energy.*", "frame.*"]}
  stop: [{channel: joint.u1.axle.angle, above: 100}]
study: {axes: {k: [1, 2], bodies.u2.wheel.mass: [1 kg], w: {target: joints.u1.axle.type, list: [revolute]}}, reducers: {a: {channel: joint.u2.axle.angle, reduce: max}}}
""")
        self.freeplay("convert", "m.yaml", os.path.join("to", "m.urdf"))
        side = os.path.join("to", "m.urdf.sidecar.yaml")
        self.assertIn("table: ../push.csv", self.read(side))
        self.assertRegex(self.read(side), r'channels: \["?body.u\*.x"?, "?joint.\*"?, "?time"?, "?energy.\*"?, "?frame.\*"?\]')
        self.assert_same("m.yaml", side, names=lambda name: name.replace(".", "_"))
        for model in ("m.yaml", side):
            self.assertIn("study of 2 points", self.freeplay("validate", model)[0])
        self.freeplay("convert", side, "back.yaml")
        self.assertIn("table: push.csv", self.read("back.yaml"))
        self.assert_same("m.yaml", "back.yaml", names=lambda name: name.replace(".", "_"))

    def test_a_name_that_is_taken_is_not_taken_twice(self):
        self.write("m.yaml", """freeplay: 1
bodies: {a_b: {mass: 1, inertia: 1}, a_b_2: {mass: 1, inertia: 1}}
templates: {t: {bodies: {b: {mass: 2, inertia: 2}}}}
instances: {a: {template: t}}
""")
        self.freeplay("convert", "m.yaml", "m.urdf")
        self.assert_same("m.yaml", "m.urdf.sidecar.yaml", names={"a.b": "a_b_3", "a_b": "a_b", "a_b_2": "a_b_2"}.get)

    def test_a_robot_becomes_a_complete_model(self):
        for name in ("four_bar_loop.urdf", "four_bar_sidecar.yaml"):
            with open(os.path.join(DATA, name), encoding="utf-8") as file:
                self.write(name, file.read())
        self.freeplay("convert", "four_bar_sidecar.yaml", "complete.yaml")
        self.assert_same("four_bar_sidecar.yaml", "complete.yaml", "--end", "0.1 s")
        self.freeplay("convert", "four_bar_loop.urdf", "robot.yaml")
        self.assertIn("  crank: {mass: 0.3, inertia: 0.001, com: [0.05, 0], frames: {A: [0, 0], B: [0.1, 0]}}\n",
                      self.read("robot.yaml"))

    def test_frames_away_from_the_body_origin_keep_angles_and_coordinates(self):
        self.write("m.yaml", """freeplay: 1
gravity: [0, -9.81]
bodies:
  arm: {mass: 2, inertia: 0.1, com: [0.3, 0.1], frames: {pin: {position: [0.1, 0.2], angle: 30 deg}, end: [0.7, 0]}}
  car: {mass: 1, inertia: 0.1, frames: {shoe: {position: [0, 0.05], angle: -20 deg}}}
joints:
  turn: {type: revolute, between: [ground/post, arm/pin]}
  slide: {type: prismatic, between: [arm/end, car/shoe]}
frames:
  ground/post: {position: [1, 2], angle: 10 deg}
forces:
  pull: {type: spring-damper, between: [ground/post, car/shoe], stiffness: 40, damping: 2, free_length: 0.5}
initial: {joints: {turn: 15 deg, slide: 0.1}, speeds: {turn: 2 rad/s}}
simulation: {end: 0.3 s, step: 1 ms, integrator: {type: bathe, newton: {tolerance: 1e-13}}}
""")
        # By default a step is solved to 1e-10, so other roundings may end it one iteration earlier.
        self.freeplay("convert", "m.yaml", "m.urdf")
        self.assert_same("m.yaml", "m.urdf.sidecar.yaml")

    def test_names_that_begin_with_a_digit_are_changed_and_said(self):
        with open(os.path.join(DATA, "four_bar_loop.urdf"), encoding="utf-8") as file:
            self.write("r.urdf", file.read().replace('"crank"', '"1st"'))
        _, err = self.freeplay("convert", "r.urdf", "r.yaml")
        self.assertIn("'1st' is called '_1st' there [urdf-renamed]", err)
        self.assertIn("[_1st/B, coupler/B]", self.read("r.yaml"))

    def test_set_is_written(self):
        self.freeplay("convert", mechanism("pendulum"), "p.yaml", "--set", "l=3 m")
        self.assertAlmostEqual(1.5, self.verdict("p.yaml")["start"]["rod"]["x"], places=12)

    def test_nothing_is_overwritten_without_force(self):
        self.write("p.yaml", "mine")
        self.freeplay("convert", mechanism("pendulum"), "p.yaml", code=6)
        self.assertEqual("mine", self.read("p.yaml"))
        self.freeplay("convert", mechanism("pendulum"), "p.yaml", "--force")

    def test_wrong_usage(self):
        self.freeplay("convert", mechanism("pendulum"), code=2)
        self.freeplay("convert", mechanism("pendulum"), "p.txt", code=2)
        self.freeplay("convert", "none.yaml", "p.yaml", code=3)


if __name__ == "__main__":
    unittest.main()
