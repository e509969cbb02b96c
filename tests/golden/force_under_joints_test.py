"""Springs, stops and brakes under `joints` act, start and are doubted as under `forces`."""
import csv
import io
import json
import unittest

from program import ProgramTest

PENDULUM = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.01, com: [0.2, 0], frames: {bob: [0.4, 0]}}}
joints:
  pin: {type: revolute, between: [ground, rod]}
  ELEMENT
initial: {joints: {pin: 200 deg}}
simulation: {end: 0.5, accuracy: 1 um, output: {frames: [rod/bob]}}
"""
# By rest in the turn of the pin: in the other one it would be wound by a whole turn.
ELEMENTS = {
    "spring": "spring: {type: spring-damper, kind: rotational, between: [ground, rod], stiffness: 10, free_angle: 200 deg}",
    "turned": "spring: {type: spring-damper, kind: rotational, between: [rod, ground], stiffness: 10, free_angle: -200 deg}",
    "stop": "end: {type: joint-stop, kind: rotational, between: [ground, rod], lower: 190 deg, upper: 210 deg, stiffness: 1e4}",
}


class ForceUnderJoints(ProgramTest):
    def text(self, element, section):
        return PENDULUM.replace("  ELEMENT", ("forces:\n  " if section == "forces" else "  ") + element)

    def last_angle(self, element, section):
        self.freeplay("run", self.write("m.yaml", self.text(element, section)), "--out", "r", "--force")
        reasons = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
        self.assertEqual([], reasons)
        table = list(csv.reader(io.StringIO(self.read("r", "results.csv"))))
        return float(table[-1][table[0].index("body.rod.angle")])

    def test_an_angle_starts_in_the_turn_of_the_joint_beside(self):
        for name, element in ELEMENTS.items():
            with self.subTest(name):
                self.assertEqual(self.last_angle(element, "forces"), self.last_angle(element, "joints"))

    def test_a_start_of_its_own_is_kept(self):
        text = self.text(ELEMENTS["spring"], "joints").replace("pin: 200 deg", "spring: 560 deg")
        self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force")
        table = list(csv.reader(io.StringIO(self.read("r", "results.csv"))))
        self.assertAlmostEqual(-62.83185307, float(table[1][table[0].index("joint.spring.torque")]), places=6)

    def messages(self, element, section):
        self.write("m.yaml", self.text(element, section).replace(", output: {frames: [rod/bob]}", ""))
        found = json.loads(self.freeplay("validate", "m.yaml", "--json")[0])["messages"]
        return sorted((m["id"], m["message"].replace("joints.", "").replace("forces.", "")) for m in found)

    def test_what_is_doubted_does_not_hang_on_the_section(self):
        unused = ("unused", "frame 'bob' is not used")
        for element, ids in (
                (ELEMENTS["stop"], []),
                (ELEMENTS["stop"].replace("190 deg", "0.2").replace("210 deg", "0.5"), ["doubtful-value"]),
                ("rub: {type: joint-friction, between: [ground, rod], friction: 5}", ["idle-force"]),
                ("damp: {type: spring-damper, kind: rotational, between: [ground, rod], damping: 1e7}", ["doubtful-value"]),
                ("none: {type: spring-damper, kind: rotational, between: [ground, rod]}", ["unused"])):
            with self.subTest(element):
                found = self.messages(element, "joints")
                self.assertEqual(self.messages(element, "forces"), found)
                self.assertEqual(sorted(ids + ["unused"]), [one for one, _ in found])
                self.assertIn(unused, found)


if __name__ == "__main__":
    unittest.main()
