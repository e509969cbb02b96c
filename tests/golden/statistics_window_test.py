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
simulation: {end: 4, accuracy: 1 um, output: {discard: %s}}
"""
        self.assertEqual(["statistics-window"], self.ids(pendulum % "3.999"))
        self.assertEqual([], self.ids(pendulum % "1"))

    SWING = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.1, com: [0.2, 0]%s}}
frames: {ground/seat: [0.2, -0.3]}
joints: {pin: {type: revolute, between: [ground, rod]}}
%ssimulation: {end: %s, %s, output: {discard: %s}}
"""
    LET_GO = "initial: {joints: {pin: -70 deg}}\n"
    SPRING = ("forces: {foot: {type: spring-damper, between: [ground/seat, rod/tip], stiffness: 300, damping: %s, free_length: 0.3}}\n"
              "initial: {joints: {pin: 0.1}}\n")
    MOTOR = LET_GO + "forces: {drag: {type: torque, on: rod, value: -0.1 N*m*s/rad*body.rod.omega}}\ndrivers: {m: {joint: pin, kind: torque, value: %s}}\n"

    def test_less_than_the_period_of_a_load_is_no_window(self):
        hits = ("freeplay: 1\nbodies: {m: {mass: 1, inertia: 1}}\njoints: {g: {type: prismatic, between: [ground, m]}}\n"
                "forces: {hit: {type: force, at: m, value: ['20*smooth(sin(2*pi*7*t), 0.5, 0.9)', 0]}}\n"
                "simulation: {end: 3, accuracy: 1 um, output: {discard: %s}}\n")
        self.assertEqual(["statistics-window"], self.ids(hits % "2.95"))
        reason = json.loads(self.read("r", "summary.json"))["trust"]["reasons"][0]
        self.assertEqual("force 'hit'", reason["element"])
        self.assertIn("less than the period of 0.143 s of force 'hit'", reason["message"])
        self.assertEqual([], self.ids(hits % "2"))

    def test_less_than_a_swing_is_no_window(self):
        """A pendulum with i = 0.14 kg m^2 and m g d = 1.962 N m swings by 20 deg in 2 pi sqrt(i/(m g d)) (1 + 20^2/16 rad^2) = 1.691 s."""
        for steps in ("accuracy: 1 um", "step: 1 ms", "step: 1 ms, integrator: bathe"):
            swing = self.SWING % ("", self.LET_GO, "4", steps, "%s")
            for discard, window in (("3.9", 0.1), ("3", 1.0), ("2.35", 1.65)):
                with self.subTest(steps=steps, discard=discard):
                    self.assertEqual(["statistics-window"], self.ids(swing % discard))
                    reason = json.loads(self.read("r", "summary.json"))["trust"]["reasons"][0]
                    self.assertEqual("body 'rod'", reason["element"])
                    self.assertIn("less than the period of 1.69 s of body 'rod'", reason["message"])
                    self.assertAlmostEqual(window, reason["value"], 9)
                    self.assertAlmostEqual(1.691, reason["limit"], 2)
            self.assertEqual([], self.ids(swing % "2.3"))
            self.assertEqual([], self.ids(swing % "0"))

    def test_what_moves_no_more_or_comes_not_again_has_no_period(self):
        tip = ", frames: {tip: [0.2, 0]}"
        self.assertEqual(["statistics-window"], self.ids(self.SWING % (tip, self.SPRING % "0", "2", "accuracy: 1 um", "1.8")))
        died_out = self.SWING % (tip, self.SPRING % "20", "2", "accuracy: 1 um", "1.8")
        self.assertEqual([], self.ids(died_out))
        self.assertEqual(["statistics-window"], self.ids(died_out.replace("end: 2", "end: 1").replace("1.8", "0.9")))
        # A fall, a throw, a flywheel, and a rod that a motor keeps turning: one turn of it is its period.
        fall = self.SWING % (", velocity: {linear: [1, 3]}", "", "1", "accuracy: 1 um", "0.9")
        self.assertEqual([], self.ids(fall.replace("joints: {pin: {type: revolute, between: [ground, rod]}}\n", "")
                                      .replace("frames: {ground/seat: [0.2, -0.3]}\n", "")))
        turning = self.SWING % ("", self.MOTOR % "3", "20", "accuracy: 10 um", "%s")
        self.assertEqual(["statistics-window"], self.ids(turning % "19.9"))
        self.assertEqual([], self.ids(turning % "19.7"))


if __name__ == "__main__":
    unittest.main()
