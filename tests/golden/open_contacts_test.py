"""Contacts that no clearance measures, of teeth, ends, discs, curves and cams: surfaces that have gone through each other are judged."""
import json
import unittest

from program import ProgramTest

TEETH = """freeplay: 1
bodies:
  ground: {frames: {w: [60 mm, 0]}}
  pinion: {mass: 0.8 kg, inertia: 1e-4}
  wheel: {mass: 3 kg, inertia: 2e-3}
joints:
  P: {type: revolute, between: [ground, pinion]}
  W: {type: revolute, between: [ground/w, wheel]}
  mesh: {type: gear, of: [P, W], ratio: -1/2, clearance: {pitch_radius: 40 mm, gap: 50 um,
         contact: {law: hunt-crossley, K: %s, restitution: 0.95}}}
drivers:
  motor: {joint: P, kind: velocity, value: 20}
forces:
  load: {type: torque, on: wheel, value: "-0.8 N*m*s/rad*body.wheel.omega"}
simulation: {end: 0.2 s, accuracy: 1 um}
"""
LID = """freeplay: 1
gravity: [0, -9.81]
bodies:
  lid: {mass: 8 kg, inertia: 0.3, com: [0.3, 0], frames: {edge: [0.6, 0]}}
joints:
  hinge: {type: revolute, between: [ground, lid]}
forces:
  stop: {type: joint-stop, between: [ground, lid], kind: rotational, lower: 0 deg, upper: 110 deg,
         contact: {law: hu-guo, K: %s, restitution: 0.5}, radius: 100 mm}
initial: {joints: {hinge: 80 deg}}
simulation: {end: 2 s, accuracy: 10 um, output: {frames: [lid/edge]%s}}
"""
FALL = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {up: {angle: 90 deg}}}
  roller: {mass: 2 kg, inertia: 1e-3}
joints:
  guide: {type: prismatic, between: [ground/up, roller]}
forces:
  hit: {%s, contact: {law: flores, K: %%s, restitution: 0.6}}
initial: {joints: {guide: 100 mm}}
simulation: {end: 0.3 s, accuracy: 1 um}
"""
DISC = FALL % "type: arc-contact, between: [ground, roller], arc: {radius: 50 mm}, disc: 20 mm"
CURVE = FALL % 'type: curve-contact, between: [ground, roller], first: 30 mm, second: "1/sqrt((cos(x)/12 mm)^2 + (sin(x)/8 mm)^2)"'
CAM = """freeplay: 1
bodies:
  ground: {frames: {guide: {position: [0, 0], angle: 90 deg}, seat: [0, 0.2]}}
  cam: {mass: 1 kg, inertia: 1e-3}
  follower: {mass: 0.3 kg, inertia: 1e-4, frames: {top: [60 mm, 0]}, pose: {position: [0, 30 mm], angle: 90 deg}}
joints:
  shaft: {type: revolute, between: [ground, cam]}
  roll: {type: point-on-curve, form: polar, between: [cam, follower], curve: "30 mm + 8 mm*smooth(x, 60 deg, 150 deg)*(1 - smooth(x, 210 deg, 300 deg))",
         lift_off: {contact: {law: hertz, K: %s}}}
  guide: {type: prismatic, between: [ground/guide, follower]}
drivers: {motor: {joint: shaft, kind: velocity, value: 600 rpm}}
forces:
  spring: {type: spring-damper, between: [ground/seat, follower/top], stiffness: 8 N/mm, damping: 5, free_length: 150 mm}
simulation: {end: 0.1 s, step: 50 us}
"""


class OpenContacts(ProgramTest):
    def trust(self, text):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--out", "r", "--force")
        return json.loads(self.read("r", "summary.json"))["trust"]

    def depth(self, text):
        return [r for r in self.trust(text)["reasons"] if r["id"] == "penetration"]

    def test_surfaces_that_pass_through_each_other_are_bad(self):
        for text, joint, of in [(TEETH % "1e4", "mesh", "the model's size"), (LID % ("1000", ""), "stop", "the model's size"),
                                (DISC % "1e4", "hit", "the smaller radius"), (CURVE % "1e4", "hit", "the smaller radius")]:
            with self.subTest(joint + " " + of):
                reasons = self.depth(text)
                self.assertEqual(1, len(reasons), text)
                self.assertEqual("bad", reasons[0]["level"])
                self.assertEqual(f"{'joint' if joint == 'mesh' else 'force'} '{joint}'", reasons[0]["element"])
                self.assertIn("deep in each other", reasons[0]["message"])
                self.assertIn(of, reasons[0]["message"])

    def test_a_follower_that_sinks_into_its_cam_is_doubtful(self):
        reasons = self.depth(CAM % "1e6")
        self.assertEqual(["doubtful"], [r["level"] for r in reasons])
        self.assertIn("joint 'roll'", reasons[0]["message"])

    def test_what_discard_leaves_out_counts(self):
        self.assertEqual("bad", self.depth(LID % ("1000", ", discard: 1.9 s"))[0]["level"])

    def test_contacts_of_metal_are_good(self):
        for text in (TEETH % "1e9", LID % ("1e9", ""), DISC % "1e9", CURVE % "1e9", CAM % "1e9"):
            with self.subTest(text):
                self.assertEqual([], self.depth(text))

    def test_a_stiffness_of_no_material_is_doubted(self):
        """Steel has K = 4/3 E* sqrt(R), 1e10 to 1e11 N/m^1.5 here: a mistake in its unit makes a thousand times as much, or a millionth."""
        stop = FALL % "type: joint-stop, between: [ground/up, roller], lower: -20 mm, upper: 200 mm"  # no frames: nothing says how large it is
        cases = [(TEETH, "mesh"), (LID.replace("[lid/edge]%s", "[lid/edge]"), "stop"), (DISC, "hit"), (CURVE, "hit"), (CAM, "roll"), (stop, "hit")]
        for text, name in cases:
            for given, doubted in (("5e10", False), ("5e13", True), ("5e16", True), ("5e3", True), ("1e7", False)):
                with self.subTest(text=text, K=given):
                    found = self.doubts(text % given)
                    self.assertEqual(["doubtful-value"] if doubted else [], [m["id"] for m in found], found)
                    if not doubted:
                        continue
                    self.assertIn(f"K of '{name}' is {float(given):.4g} N/m^1.5, as of bodies with a modulus of ", found[0]["message"])
                    self.assertTrue((text % given).splitlines()[found[0]["line"] - 1].startswith(f"  {name}: "), found)

    def doubts(self, text):
        self.write("m.yaml", text)
        found = json.loads(self.freeplay("validate", "m.yaml", "--json")[0])["messages"]
        return [m for m in found if m["severity"] == "warning"]


if __name__ == "__main__":
    unittest.main()
