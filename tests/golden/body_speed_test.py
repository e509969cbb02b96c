"""Bodies faster than machines are make a verdict doubtful, and the motor that made them so is named."""
import json
import unittest

from program import ProgramTest

ARM = """freeplay: 1
bodies: {arm: {mass: 1, inertia: 0.01, com: [%s, 0]}}
joints: {axle: {type: revolute, between: [ground, arm]}}
drivers: {motor: {joint: axle, kind: torque, value: 2000}}
simulation: {end: 0.2, accuracy: 1 um}
"""

HOIST = """freeplay: 1
gravity: [0, -9.81]
bodies: {drum: {mass: 120, inertia: 5.4}, cage: {mass: 800, inertia: 100}}
frames: {ground/shaft: {position: [0.3, 0], angle: 90 deg}}
joints:
  axle: {type: revolute, between: [ground, drum]}
  rails: {type: prismatic, between: [ground/shaft, cage]}
  rope: {type: gear, of: [axle, rails], ratio: 0.3 m}
drivers: {motor: {joint: axle, kind: torque, value: %s}}
simulation: {end: 2, accuracy: 1 um}
"""

CRANK = """freeplay: 1
bodies:
  crank: {mass: 1.2, inertia: 1.1e-3, com: [10 mm, 0], frames: {pin: [40 mm, 0]}}
  rod: {mass: 0.55, inertia: 1.4e-3, com: [50 mm, 0], frames: {small: [150 mm, 0]}}
  piston: {mass: 0.4, inertia: 4e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  big: {type: revolute, between: [rod, crank/pin], clearance: {bearing_radius: 20 mm, radial_clearance: 0.05 mm, length: 20 mm,
        material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.8}}}
  small: {type: revolute, between: [rod/small, piston]}
  bore: {type: prismatic, between: [ground, piston]}
%s
initial: {joints: {main: 0.5}}
simulation: {end: 140 ms, output: {discard: 70 ms}, %s}
"""
MOTOR = "drivers: {motor: {joint: main, kind: torque, value: %s}}"


class BodySpeed(ProgramTest):
    def reasons(self, text):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--out", "r", "--force", "--quiet")
        return json.loads(self.read("r", "summary.json"))["trust"]["reasons"]

    def test_what_moves_slides_or_turns_faster_than_in_machines_is_doubted(self):
        for text, element, limit in ((ARM % "0.1", "body 'arm'", 200), (ARM % "0", "body 'arm'", 1000), (HOIST % "24 kN*m", "body 'cage'", 100)):
            with self.subTest(element):
                reason = next(r for r in self.reasons(text) if r["id"] == "body-speed")
                self.assertEqual(("doubtful", element, limit), (reason["level"], reason["element"], reason["limit"]))
                self.assertIn("driver 'motor' has put", reason["message"])

    def test_what_gave_a_run_its_energy_is_the_cause_of_its_end(self):
        """Each for itself is a torque or a spring that machines have; what it did in the run is not."""
        spring = "forces: {main_spring: {type: spring-damper, kind: rotational, between: [ground, crank], stiffness: 0, preload: -2000}}"
        for what, step, words in ((MOTOR % 2000, "accuracy: 1 um", "driver 'motor'"), (MOTOR % 2000, "step: 1 us", "driver 'motor'"),
                                  (MOTOR % -4000, "accuracy: 1 um", "driver 'motor'"), (spring, "accuracy: 1 um", "force 'main_spring'")):
            with self.subTest((what, step)):
                _, err = self.freeplay("run", self.write("m.yaml", CRANK % (what, step)), "--out", "r", "--force", code=4)
                self.assertRegex(err, r"which no material bears; likely cause: %s has put \S+ J into 2.15 kg, the energy of all of it at "
                                      r"[34]\d\d m/s: check its number and unit" % words)

    def test_the_rotor_of_a_centrifuge_is_not(self):
        """419 m/s at its radius of gyration, of carbon fibre."""
        rotor = ARM.replace("mass: 1, inertia: 0.01", "mass: 4, inertia: 6.4e-3").replace("torque, value: 2000", "velocity, value: 100000 rpm")
        self.assertEqual([], [r for r in self.reasons(rotor % "0") if r["id"] == "body-speed"])

    def test_a_hoist_whose_motor_fits_is_not(self):
        self.assertEqual([], self.reasons(HOIST % "2.5 kN*m"))


if __name__ == "__main__":
    unittest.main()
