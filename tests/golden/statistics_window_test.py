"""Statistics of an instant of a slow drive are doubted."""
import json
import unittest

from program import ProgramTest


class StatisticsWindow(ProgramTest):
    def ids(self, text):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--out", "r", "--force", "--quiet")
        return [reason["id"] for reason in json.loads(self.read("r", "summary.json"))["trust"]["reasons"]]

    def test_an_instant_of_a_slow_drive_is_no_window(self):
        crank = """freeplay: 1
bodies: {crank: {mass: 1, inertia: 1e-3}}
joints: {main: {type: revolute, between: [ground, crank]}}
drivers: {motor: {joint: main, kind: %s, value: %s}}
initial: {joints: {main: 0}}
simulation: {end: %s, step: 10 us%s}
"""
        if_less = [("velocity", "1 rad/s", "1 ms", ", output: {discard: 0.9 ms}"), ("velocity", "1 rad/s", "1 ms", ""),
                   ("velocity", "1 rad/s", "1 s", ", output: {discard: 0.5 s}"), ("velocity", "0.5*cos(2*pi*t)", "1 ms", ""),
                   ("velocity", "0.5*sin(0.1*t)", "1 ms", "")]
        for case in if_less:
            self.assertIn("statistics-window", self.ids(crank % case), case)
        self.assertEqual([], self.ids(crank % ("velocity", "1 rad/s", "1 s", "")))

    def test_a_hundredth_of_what_is_left_out_is_no_window(self):
        pendulum = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.1, com: [0.2, 0]}}
joints: {pin: {type: revolute, between: [ground, rod]}}
initial: {joints: {pin: 20 deg}}
simulation: {end: 2, accuracy: 1 um, output: {discard: %s}}
"""
        self.assertEqual(["statistics-window"], self.ids(pendulum % "1.999"))
        self.assertEqual([], self.ids(pendulum % "1.9"))


if __name__ == "__main__":
    unittest.main()
