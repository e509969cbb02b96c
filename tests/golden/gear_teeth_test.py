"""Teeth of gears press at the pitch point, so that bearings feel what statics says."""
import csv
import math
import unittest

from model_cases import EXACT, ModelTest

ALPHA = math.radians(20)
PAIR = """
bodies:
  pinion: {mass: 0.5 kg, inertia: 0.001}
  wheel: {mass: 2 kg, inertia: 0.02}
frames: {ground/w: [120 mm, 0]}
joints:
  P: {type: revolute, between: [%s]}
  W: {type: revolute, between: [%s]}
  mesh: {type: gear, of: [%s], ratio: %s, pressure_angle: 20 deg}
"""
EXTERNAL = PAIR % ("ground, pinion", "ground/w, wheel", "P, W", "-0.5")


class GearTeeth(ModelTest):
    def assert_teeth(self, columns, tangential, row, push=1):
        """Of the wheel at the right: across the line of centres as given, along it pushed off, bearings bear both."""
        radial = push * abs(tangential) * math.tan(ALPHA)
        scale = 1e-10 * max(1.0, abs(tangential))
        for name, sign in (("mesh", 1), ("W", -1), ("P", 1)):
            x = -radial if name == "W" else radial
            self.assertAlmostEqual(x, columns["joint." + name + ".fx"][row], delta=scale)
            self.assertAlmostEqual(sign * tangential, columns["joint." + name + ".fy"][row], delta=scale)

    def test_bearings_of_a_held_pair_feel_what_statics_says_whichever_way_it_is_loaded(self):
        inside = EXTERNAL.replace("120 mm", "40 mm")
        cases = ((EXTERNAL, -1, 1), (inside.replace("-0.5", "0.5"), -1, -1),
                 (PAIR % ("pinion, ground", "ground/w, wheel", "P, W", "0.5"), -1, 1),
                 (PAIR % ("ground, pinion", "wheel, ground/w", "P, W", "0.5"), -1, 1),
                 # The pinion's teeth are reported where its joint is the second.
                 (EXTERNAL.replace("P, W], ratio: -0.5", "W, P], ratio: -2"), -0.5, 1),
                 (inside.replace("P, W], ratio: -0.5", "W, P], ratio: 2"), 0.5, -1))
        for torque in (50, -50):
            for pair, passed, push in cases:
                columns = self.run_model(pair + """
drivers: {hold: {joint: P, kind: angle, value: 0}}
forces: {load: {type: torque, on: wheel, value: %s N*m}}
simulation: {end: 1 ms, output: {interval: 0.5 ms}}
""" % torque)
                if "of: [W, P]" in pair:
                    for name in ("fx", "fy"):
                        columns["joint.mesh." + name] = [-x for x in columns["joint.mesh." + name]]
                for row in range(len(columns["time"])):
                    self.assertAlmostEqual(passed * torque, columns["joint.mesh.torque"][row], delta=5e-9)
                    if "pinion, ground" in pair or "wheel, ground/w" in pair:
                        name = "joint.P.f" if "pinion, ground" in pair else "joint.W.f"
                        for axis in "xy":
                            columns[name + axis][row] *= -1
                    self.assert_teeth(columns, torque / 0.08, row, push)

    def test_the_analysis_of_drive_forces_has_the_teeth_too(self):
        text = EXTERNAL.replace("120 mm, 0]", "120 mm, 0], wheel/rim: [10 mm, 0]").replace("-0.5,", "-0.5, offset: 0,") + """
drivers: {hold: {joint: P, kind: angle, value: 0.1*t}}
forces: {load: {type: torque, on: wheel, value: 50 N*m}}
analysis: {frame: wheel/rim, joints: P}
"""
        out, _ = self.freeplay("analyze", "inverse-dynamics", self.model(text), "--time", "0:1:3")
        rows = list(csv.reader(out.splitlines()))
        columns = {name: [float(x) for x in values] for name, *values in zip(*rows)}
        for row in range(3):
            self.assert_teeth(columns, 625, row)
            self.assertAlmostEqual(-50, columns["joint.mesh.torque"][row], delta=5e-9)

    def test_every_integrator_moves_as_without_teeth_while_the_load_turns_round(self):
        text = EXTERNAL + """
drivers: {motor: {joint: P, kind: torque, value: 3 N*m * cos(7*t)}}
simulation: {end: 0.9, %s, output: {interval: 30 ms}}
"""
        fixed = ["step: 5 ms, integrator: " + name for name in ("bathe", "newmark", "hht", "generalized-alpha")]
        for steps in fixed + [EXACT, "integrator: verner6, accuracy: 1 um", "accuracy: 1 um"]:
            bare = self.run_model(text.replace(", pressure_angle: 20 deg", "") % steps)
            columns = self.run_model(text % steps)
            for name, values in bare.items():
                if not name.startswith(("joint.P.f", "joint.W.f", "joint.mesh.f", "joint.mesh.torque")):
                    self.assertEqual(values, columns[name], name)
            for row, t in enumerate(columns["time"]):
                self.assert_teeth(columns, columns["joint.mesh.fy"][row], row)
                if steps == EXACT:
                    # The pinion turns twice as fast as the wheel: 0.02 of the wheel and 0.001 times 4 of the pinion.
                    acceleration = -2 * 3 * math.cos(7 * t) / 0.024
                    self.assertAlmostEqual(-0.02 * acceleration / 0.08, columns["joint.mesh.fy"][row], places=6)
            self.assertLess(min(columns["joint.mesh.fy"]) * max(columns["joint.mesh.fy"]), 0)

    def test_forces_of_a_planetary_gear_are_what_its_bodies_need_to_move(self):
        """Newton and Euler hold for each body with the columns of the joints and of the teeth."""
        columns = self.run_model("""
gravity: [0, -9.81]
bodies:
  carrier: {mass: 2, inertia: 0.3, frames: {p: [36 mm, 0]}}
  sun: {mass: 0.4, inertia: 0.1}
  planet: {mass: 0.5 kg, inertia: 1e-3}
  ring: {mass: 1, inertia: 1}
joints:
  hold: {type: fixed, between: [ground, ring]}
  k: {type: revolute, between: [ground, carrier]}
  s: {type: revolute, between: [carrier, sun]}
  p: {type: revolute, between: [carrier/p, planet]}
  r: {type: revolute, between: [carrier, ring]}
  inner: {type: gear, of: [s, p], ratio: -20/16, pressure_angle: 20 deg}
  outer: {type: gear, of: [r, p], ratio: 52/16, pressure_angle: 20 deg}
drivers: {motor: {joint: s, kind: torque, value: 9 N*m*cos(9*t)}}
simulation: {end: 0.5, output: {interval: 50 ms, channels: ["*", "body.*.ax", "body.*.ay", "body.*.alpha"]}, %s}
""" % EXACT)
        for row in range(len(columns["time"])):
            at = lambda name: columns[name][row]
            force = lambda name: complex(at("joint." + name + ".fx"), at("joint." + name + ".fy"))
            needed = lambda name, mass: mass * complex(at("body." + name + ".ax"), at("body." + name + ".ay") + 9.81)
            same = lambda a, b: self.assertLess(abs(a - b), 1e-8)
            line = complex(math.cos(at("body.carrier.angle")), math.sin(at("body.carrier.angle")))  # to the planet
            motor = 9 * math.cos(9 * at("time"))
            same(needed("planet", 0.5), force("p") + force("inner") + force("outer"))
            same(1e-3 * at("body.planet.alpha"), at("joint.inner.torque") + at("joint.outer.torque"))
            same(needed("sun", 0.4), force("s") - force("inner"))
            same(0.1 * at("body.sun.alpha"), motor - 0.02 * (line.conjugate() * force("inner")).imag)
            same(needed("ring", 1), force("r") + force("hold") - force("outer"))
            same(0, at("joint.hold.torque") - 0.052 * (line.conjugate() * force("outer")).imag)
            same(needed("carrier", 2), force("k") - force("s") - force("p") - force("r"))
            same(0.3 * at("body.carrier.alpha"), -motor - 0.036 * (line.conjugate() * force("p")).imag)
            for name, push in (("inner", 1), ("outer", -1)):
                along = line.conjugate() * force(name)
                same(push * abs(along.imag) * math.tan(ALPHA), along.real)
            same(3.6 * at("body.carrier.angle"), at("body.sun.angle"))

    def test_a_rack_is_pushed_off_its_pinion(self):
        rack, pinion = 1, -1
        for force in (200, -200):
            for guide, of, ratio, reported in (("ground/up, rack/up", "A, G", "40 mm", rack),
                                               ("rack/up, ground/up", "A, G", "-40 mm", rack),
                                               ("ground/up, rack/up", "G, A", "1 rad/(40 mm)", pinion)):
                columns = self.run_model("""
bodies: {pinion: {mass: 1, inertia: 0.001}, rack: {mass: 3 kg, inertia: 0.01}}
frames: {ground/up: {position: [55 mm, 0], angle: 90 deg}, rack/up: {angle: 90 deg}}
joints:
  A: {type: revolute, between: [ground, pinion]}
  G: {type: prismatic, between: [%s]}
  mesh: {type: gear, of: [%s], ratio: %s, pressure_angle: 20 deg}
drivers: {hold: {joint: A, kind: angle, value: 0}}
forces: {load: {type: force, at: rack, value: [0, %s N]}}
initial: {joints: {G: 0.3 m}}
simulation: {end: 1 ms, output: {interval: 0.5 ms}}
""" % (guide, of, ratio, force))
                radial = 200 * math.tan(ALPHA)
                height = columns["body.rack.y"][0]
                along = 1 if guide.startswith("ground") else -1
                for row in range(len(columns["time"])):
                    same = lambda value, name: self.assertAlmostEqual(value, columns["joint." + name][row], delta=2e-8)
                    same(reported * radial, "mesh.fx")
                    same(-reported * force, "mesh.fy")
                    # They press at (40 mm, 0), the frame of the rack is at (55 mm, height).
                    moment = 15e-3 * force + height * radial
                    same(moment if reported == rack else 40e-3 * force, "mesh.torque")
                    same(-moment if along > 0 else 15e-3 * force, "G.torque")
                    same(radial, "A.fx")
                    same(-force, "A.fy")
                    same(-along * radial, "G.fx")
                    same(0, "G.fy")

    def test_what_cannot_have_teeth_is_refused_where_it_stands(self):
        for joints, ratio, words in (
                ("P, W", "1", "do not turn equally fast"), ("P, Q", "-2", "two axles at a distance"),
                ("P, X", "-2", "on one body that carries both wheels"),
                ("P, B", "-2", "a wheel whose axle is held, but 'B' leaves it free"),
                ("P, S", "10 mm", "a rack that does not turn, but 'S' leaves it free"), ("G, H", "2", "both joints slide")):
            text = PAIR.replace("mesh:", "Q: {type: revolute, between: [ground, other]}\n"
                                "  X: {type: revolute, between: [wheel, far]}\n"
                                "  G: {type: prismatic, between: [ground, r]}\n"
                                "  H: {type: prismatic, between: [ground, s]}\n"
                                "  B: {type: brake, between: [ground, far], limit: 1 N*m, stiffness: 1e3}\n"
                                "  S: {type: point-on-line, between: [ground, far]}\n  mesh:")
            text = text.replace("frames:", "  other: {mass: 1, inertia: 1}\n  far: {mass: 1, inertia: 1}\n"
                                "  r: {mass: 1, inertia: 1}\n  s: {mass: 1, inertia: 1}\nframes:")
            text = text % ("ground, pinion", "ground/w, wheel", joints, ratio)
            self.assertIn(words, self.refusal(text, id="conflicting-keys")[0]["message"])
        self.assertIn("write '20 deg'", self.refusal(EXTERNAL.replace("20 deg", "20"), id="out-of-range", line=10)[0]["suggestion"])
        self.assertEqual("usual are 14.5 deg, 20 deg and 25 deg",
                         self.refusal(EXTERNAL.replace("20 deg", "50 deg"), id="out-of-range", line=10)[0]["suggestion"])
        for angle in ("0", "-20 deg", "50 deg", "nan"):
            self.assertEqual(10, self.refusal(EXTERNAL.replace("20 deg", angle))[0]["line"])
        self.refusal(EXTERNAL.replace("pressure_angle", "presure_angle"), id="unknown-key", suggestion="pressure_angle", line=10)
        self.refusal(EXTERNAL.replace("revolute, between: [ground, pinion]", "revolute, between: [ground, pinion], pressure_angle: 20 deg"),
                     id="unknown-key", line=8)
        loose = EXTERNAL.replace("wheel]}", "wheel], clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, "
                                 "contact: {law: hertz, K: 1e9}}}")
        self.assertIn("'clearance'", self.refusal(loose, id="conflicting-keys", line=10)[0]["suggestion"])
        self.facts(loose.replace("20 deg", "20 deg, clearance: {pitch_radius: 80 mm, gap: 1 um, contact: {law: hertz, K: 1e9}}"),
                   clearance_joints=2)
        in_space = EXTERNAL.replace("[120 mm, 0]", "[120 mm, 0, 0]").replace("inertia: 0.001", "inertia: [1, 1, 1]")
        in_space = in_space.replace("inertia: 0.02", "inertia: [1, 1, 1]")
        self.assertIn("planar models only", self.refusal("space: spatial" + in_space)[0]["message"])


if __name__ == "__main__":
    unittest.main()
