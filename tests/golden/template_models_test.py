"""Templates, instances, presets, parameters, expressions, text: what is read is what is written."""
import json
import math
import unittest

from model_cases import EXACT, ModelTest


class Templates(ModelTest):
    def test_a_chain_of_instances_reaches_its_neighbours(self):
        text = """
gravity: [0, -9.81]
parameters: {links: 4}
bodies: {link0.bar: {mass: 1, inertia: 1e-2, frames: {end: [0.2, 0]}}}
templates:
  link:
    parameters: {l: required, m: 2 kg/$n, half: $l/2}
    bodies: {bar: {mass: $m, inertia: $m*$l^2/12, com: [$half, 0], frames: {end: [$l, 0]}}}
    joints: {pin: {type: revolute, between: ["link{$i-1}.bar/end", bar]}}
  hook:
    bodies: {bar: {mass: 1, inertia: 1, frames: {end: [0.2, 0]}}}
    joints: {pin: {type: fixed, between: [ground, bar]}}
instances:
  link0: {template: hook}
  link: {template: link, count: $links, with: {l: 0.1 m * (1 + $i)}}
frames: {link3.bar/probe: {polar: [0.5, 30 deg]}}
simulation: {end: 10 ms, output: {frames: [link3.bar/probe]}}
"""
        # A dotted name is never declared by hand.
        self.refusal(text, id="bad-name", line=5)
        text = text.replace("bodies: {link0.bar: {mass: 1, inertia: 1e-2, frames: {end: [0.2, 0]}}}\n", "")
        verdict = self.facts(text, bodies=5, joints=5, constraints=11, dof=4)
        self.assertEqual(["link0.bar", "link1.bar", "link2.bar", "link3.bar", "link4.bar"], list(verdict["start"]))
        for i in range(1, 5):
            before = 0.2 + sum(0.1 * (1 + k) for k in range(1, i))
            self.assertAlmostEqual(before + 0.05 * (1 + i), verdict["start"]["link%d.bar" % i]["x"], places=12)
        columns = self.run_model(text)
        self.assertAlmostEqual(0.25, columns["frame.link3.bar/probe.y"][0], places=12)
        # The last link cannot reach one that is not there.
        self.refusal(text.replace("link{$i-1}", "link{$i+1}"), id="unknown-name", line=9)
        self.refusal(text.replace("link{$i-1}", "link{$i/2}"), id="wrong-type", line=9)

    def test_gears_of_instances_mesh_with_their_neighbours(self):
        text = """
parameters: {count: 5}
bodies: {w0: {mass: 1, inertia: 0.1}}
joints: {in: {type: revolute, between: [ground, w0]}}
templates:
  first:
    bodies: {w: {mass: 1, inertia: 0.2}}
    joints: {axle: {type: revolute, between: [ground/h, w]}, mesh: {type: gear, of: [in, axle], ratio: -2}}
    frames: {ground/h: [1, 0]}
  next:
    parameters: {r: -(1 + 1/$i)}
    bodies: {w: {mass: 1, inertia: 0.1*$i}}
    joints:
      axle: {type: revolute, between: [ground/h, w]}
      mesh: {type: gear, of: ["g{$i-1}.axle", axle], ratio: $r, offset: 10 deg}
    frames: {ground/h: [$i + 1, 0]}
instances:
  g0: {template: first}
  g: {template: next, count: $count}
drivers: {m: {joint: in, kind: torque, value: 1}}
simulation: {end: 1, output: {interval: 100 ms}, %s}
""" % EXACT
        self.facts(text, bodies=7, joints=13, constraints=20, rank=20, dof=1)
        ratio, inertia = [1.0, -2.0], [0.1, 0.2]
        for i in range(1, 6):
            ratio.append(-ratio[-1] * (1 + 1 / i))
            inertia.append(0.1 * i)
        a = 1 / sum(j * r * r for j, r in zip(inertia, ratio))
        columns = self.run_model(text)
        self.assert_column(columns, "joint.in.angle", lambda t: a * t * t / 2)
        for i in range(1, 6):
            before, here = (columns["joint.g%d.axle.angle" % k] for k in (i - 1, i))
            for x, y in zip(before, here):
                self.assertAlmostEqual(math.radians(10) - (1 + 1 / i) * x, y, places=9)

    def test_a_closed_ring_of_instances(self):
        text = """
templates:
  side:
    parameters: {next: "$i - $n * smooth($i, $n - 1, $n) + 1"}
    bodies: {rod: {mass: 1, inertia: 0.1, frames: {a: [-0.5, 0], b: [0.5, 0]},
                   pose: {position: ["cos(2*pi*$i/$n)", "sin(2*pi*$i/$n)"], angle: 2*pi*$i/$n + 90 deg}}}
    joints: {pin: {type: revolute, between: [rod/b, "s{$next}.rod/a"]}}
instances: {s: {template: side, count: 6}}
simulation: {end: 10 ms}
"""
        verdict = self.facts(text, bodies=6, joints=6, constraints=12, rank=12, dof=6)
        start = verdict["start"]
        for i in range(1, 7):
            here, there = start["s%d.rod" % i], start["s%d.rod" % (i % 6 + 1)]
            self.assertAlmostEqual(here["x"] + math.cos(here["angle"]) / 2,
                                   there["x"] - math.cos(there["angle"]) / 2, places=9)

    def test_a_template_brings_frames_drivers_and_forces(self):
        text = """
parameters: {k: 3}
presets: {wheel: {mass: $m, inertia: $m * $r^2 / 2}}
bodies: {sled: {mass: 5, inertia: 1}}
joints: {rail: {type: fixed, between: [ground, sled]}}
templates:
  unit:
    parameters: {r: 0.2, m: 10 kg/m * $r, k: 7, at: required}
    bodies: {wheel: {use: wheel}}
    frames: {sled/hub: [$at, 0]}
    joints: {axle: {type: revolute, between: [sled/hub, wheel]}}
    drivers: {spin: {joint: axle, kind: angle, value: $k * t^2}}
    forces: {wind: {type: force, at: sled/hub, value: [$i, 0]}}
instances:
  left: {template: unit, with: {at: -1 m}}
  right: {template: unit, with: {at: 1 m, k: $k, r: 100 mm}}
simulation: {end: 1, step: 10 ms}
"""
        self.facts(text, bodies=3, joints=3, drivers=2, constraints=7, dof=2, dof_driven=0)
        columns = self.run_model(text)
        self.assert_column(columns, "joint.left.axle.angle", lambda t: 7 * t * t)
        self.assert_column(columns, "joint.right.axle.angle", lambda t: 3 * t * t)
        self.assert_column(columns, "body.right.wheel.x", lambda t: 1)
        self.assert_column(columns, "driver.left.spin.torque", lambda t: 2 * 0.04 / 2 * 14, 1e-8)
        self.assert_column(columns, "driver.right.spin.torque", lambda t: 1 * 0.01 / 2 * 6, 1e-8)
        self.assert_column(columns, "joint.rail.fx", lambda t: -2, 1e-8)
        head = self.read("out", "results.csv").split("\n", 1)[0].split(",")
        joints = [name for name in head if name.startswith("joint.") and name.endswith(".fx")]
        self.assertEqual(["joint.rail.fx", "joint.left.axle.fx", "joint.right.axle.fx"], joints)

    def test_an_instance_without_a_count_is_number_one_of_one(self):
        text = """
templates: {p: {bodies: {b: {mass: $i + $n, inertia: 1, com: ["{", 0]}}}}
instances: {one: {template: p}}
simulation: {end: 1 ms}
""".replace('com: ["{", 0]', "com: [$i, $n]")
        verdict = self.facts(text, bodies=1, dof=3)
        self.assertEqual((1, 1), (verdict["start"]["one.b"]["x"], verdict["start"]["one.b"]["y"]))


class Parameters(ModelTest):
    def values(self, pairs, *options):
        """The numbers that expressions come to, as places of frames."""
        text = "bodies: {b: {mass: 1, inertia: 1, frames: {%s}}}\n" % ", ".join(
            'f%d: ["%s", 0]' % (i, text) for i, text in enumerate(pairs))
        model = json.loads(self.freeplay("show", self.model(text), "--format", "json", *options)[0])
        frames = model["bodies"]["b"]["frames"]
        return [frames["f%d" % i][0] for i in range(len(pairs))]

    def test_every_unit_of_the_format(self):
        pairs = {
            "1 km": 1e3, "1 cm": 1e-2, "1 mm": 1e-3, "1 um": 1e-6, "1 \u00b5m": 1e-6, "1 nm": 1e-9, "1 in": 0.0254,
            "1 ft": 0.3048, "1 m*1 kg/(1 g)": 1e3, "1 m*1 mg/(1 kg)": 1e-6, "1 m*1 lb/(1 kg)": 0.45359237,
            "1 m/s*1 ms": 1e-3, "1 m/s*1 us": 1e-6, "1 m/s*1 \u00b5s": 1e-6, "1 m/s*1 ns": 1e-9,
            "1 m*180 deg": math.pi, "1 m*1 mrad": 1e-3, "1 m*1 urad": 1e-6, "1 m*60 arcmin": math.pi / 180,
            "1 m*3600 arcsec": math.pi / 180, "1 m*1 rev": 2 * math.pi, "1 m*60 rpm*1 s": 2 * math.pi,
            "1 kN/(1 N/m)": 1e3, "1 mN/(1 N/m)": 1e-3, "1 MN/(1 N/m)": 1e6, "1 lbf/(1 N/m)": 4.4482216152605,
            "1 Nm/(1 N)": 1, "1 Nmm/(1 N)": 1e-3, "1 mNm/(1 N)": 1e-3, "1 kNm/(1 N)": 1e3, "1 N*m/(1 N)": 1,
            "1 Pa*m^3/(1 N*m)*1 m": 1, "1 kPa*m^2/(1 N)*1 m": 1e3, "1 MPa*m^2/(1 N)*1 m": 1e6,
            "1 GPa*m^2/(1 N)*1 m": 1e9, "1 J/(1 N)": 1, "1 mJ/(1 N)": 1e-3, "1 kJ/(1 N)": 1e3,
            "1 W*s/(1 N)": 1, "1 mW*s/(1 N)": 1e-3, "1 kW*s/(1 N)": 1e3, "(1/2) m": 0.5, "2 mm^-1*1 m^2": 2e3,
            "4 m^0.5*4 m^0.5": 16, "sqrt(9 m^2)": 3, "abs(-2 m)": 2, "(2 m)^3/(4 m^2)": 2, "max(1 m, 3, 20 cm)": 3,
            "min(1 m, 3)": 1, "1 kg*m/s^2/(1 N/m)": 1, "-2^2": -4, "2^3^2": 512, "2^-1": 0.5, "1/2/2": 0.25,
            "2*-3": -6, ".5e1": 5, "5.": 5, "010": 10, "1e-3": 1e-3, "log(exp(2))": 2, "atan2(1, 1)": math.pi / 4,
            "atan2(1 m, 1 m)": math.pi / 4, "smooth(5 mm, 0 mm, 10 mm)": 0.5, "sin(30 deg)": 0.5,
            "1 m * cos(pi/3)": 0.5, "tan(45 deg)": 1, "asin(1) + acos(1)": math.pi / 2, " 1   m ": 1,
            "3 m/s^2*(2 s)^2": 12, "1 rev/s*1 m*1 s": 2 * math.pi,
        }
        for (text, expected), value in zip(pairs.items(), self.values(pairs), strict=True):
            self.assertAlmostEqual(1, value / expected, places=12, msg=text)

    def test_what_the_dimensions_forbid(self):
        for text, code, column in (
                ("1 kg", "dimension-mismatch", 1), ("1 m + 1 s", "dimension-mismatch", 5), ("30 deg", None, 0),
                ("sin(1 m)", "dimension-mismatch", 5), ("atan2(1 m, 1 kg)", "dimension-mismatch", 12),
                ("2^(1 m)", "dimension-mismatch", 3), ("smooth(1 m, 0 s, 1 s)", "dimension-mismatch", 13),
                ("1 Hz", "bad-unit", 3), ("1 metre", "bad-unit", 3), ("1 M", "bad-unit", 3), ("$b m", "bad-expression", 4),
                ("1 + ", "bad-expression", 4), ("(1", "bad-expression", 3), ("1)", "bad-expression", 2),
                ("foo(1)", "bad-expression", 1), ("sin(1, 2)", "bad-expression", 1), ("atan2(1)", "bad-expression", 1),
                ("min(1)", "bad-expression", 1), ("1,5", "bad-expression", 2), ("1_000", "bad-expression", 2),
                ("0x10", "bad-expression", 2), ("sqrt(-1)", "bad-expression", 1), ("1/0", "bad-expression", 2),
                ("log(0)", "bad-expression", 1), ("1e999", "bad-number", 1), (".inf", "bad-number", 1),
                ("nan", "bad-number", 1), ("$x", "unknown-name", 1), ("t", "time-not-allowed", 1),
                ("smooth(1, 2, 2)", "bad-expression", 1), ("2 m (3)", "bad-expression", 5), ("1 2", "bad-expression", 3)):
            with self.subTest(text):
                model = 'parameters: {b: 1}\nbodies:\n  b: {mass: $b, inertia: 1, com: [0, "%s"]}\n' % text
                if code is None:
                    self.facts(model.replace(text, "0 deg*1").replace("0 deg*1", "0"))
                    continue
                errors = self.refusal(model, id=code, line=4)
                start = model.split("\n")[2].index('"') + 2
                self.assertLessEqual(start, errors[0]["column"])
                self.assertLessEqual(errors[0]["column"], start + len(text), errors)

    def test_parameters_in_any_order_and_from_outside(self):
        text = """
parameters: {a: 2*$b, b: $c/(2 s), c: 3 m/s * 4 s}
bodies: {b: {mass: 1, inertia: 1, com: [$a, "${b}"]}}
"""
        self.refusal(text, id="dimension-mismatch", line=4)
        text = text.replace("/(2 s)", "/2")
        start = self.facts(text)["start"]["b"]
        self.assertEqual((12, 6), (start["x"], start["y"]))
        start = self.facts(text, "--set", "c=1 m", "--set", "c=50 cm")["start"]["b"]
        self.assertEqual((0.5, 0.25), (start["x"], start["y"]))
        self.refusal(text, "--set", "c=1 kg", id="dimension-mismatch")
        for wrong in ("d=1", "c", "c=1 +", "c=", "=1", "c=1 parsec"):
            self.freeplay("validate", "m.yaml", "--set", wrong, code=2)
        self.freeplay("validate", "m.yaml", "--set", "c=$a", code=3)


class Text(ModelTest):
    def test_yaml_in_many_dresses(self):
        text = """\ufefffreeplay: "1"   # quoted
name: >
  a folded
  name
x-notes: {anything: [goes, {here: ~}]}
gravity: &g [0, -9.81]
presets:
  'heavy': {mass: 5 kg, x-why: heavy}
  rod: &rod
    inertia: 0.5
    use: heavy
bodies:
  "a":
    use: [rod]
    com: *g
    pose: {position: [0, 9.81]}
    x-colour: red
  b: {mass: !!float 1, inertia: 1}
drivers:
forces:
"""
        self.assertEqual("yaml-feature", self.refusal(text, head="", line=18, column=13)[0]["id"])
        self.model(text.replace("!!float 1", '"1 kg"'), head="")
        verdict = json.loads(self.freeplay("validate", "m.yaml", "--json")[0])
        self.assertEqual({"x": 0, "y": 0, "angle": 0}, verdict["start"]["a"])

    def test_a_later_preset_wins_and_a_key_of_the_entry_over_all(self):
        text = """
presets:
  one: {mass: 1, inertia: 1, com: [1, 1]}
  two: {mass: 2, com: [2, 2], use: three}
  three: {inertia: 3}
bodies:
  a: {use: [one, two]}
  b: {use: [two, one], com: [5, 0]}
"""
        model = json.loads(self.freeplay("show", self.model(text), "--format", "json")[0])["bodies"]
        self.assertEqual((2, 3, [2, 2]), tuple(model["a"][k] for k in ("mass", "inertia", "com")))
        self.assertEqual((1, 1, [5, 0]), tuple(model["b"][k] for k in ("mass", "inertia", "com")))


if __name__ == "__main__":
    unittest.main()
