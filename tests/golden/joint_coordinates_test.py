"""Coordinates of joints in space with several motions: drivers, start values and gears mean the one that is named."""
import math
import unittest

from model_cases import EXACT, ModelTest

# A ball, so that turns about the two arms of a cross, or about any axis, do not feel each other.
BALL = """
space: spatial
gravity: [0, 0, %s]
bodies: {b: {mass: 2, inertia: [0.5, 0.5, 0.5], frames: {tip: [1, 0, 0]}%s}}
joints: {j: {type: %s, between: [ground, b], coordinate: %s}}
%s
simulation: {end: 1 s, output: {interval: 50 ms, frames: [b/tip]}, %s}
"""


class Coordinates(ModelTest):
    def ball(self, type_name, coordinate, more, pose="", gravity="0"):
        return self.run_model(BALL % (gravity, pose, type_name, coordinate, more, EXACT))

    def assert_tip(self, columns, place):
        for k, name in enumerate("xyz"):
            self.assert_column(columns, "frame.b/tip." + name, lambda t: place(t)[k], 1e-8)

    def test_a_driver_turns_the_cross_of_a_cardan_joint_or_its_second_fork(self):
        turn = lambda t: 0.4 * math.sin(3 * t) + 0.5
        driver = "drivers: {d: {joint: j, kind: angle, value: 0.4 rad*sin(3*t) + 0.5 rad}}"
        # The second fork stands at 0.7 rad all the time: x_b = R_x(first) R_y(0.7) e_x.
        c, s = math.cos(0.7), math.sin(0.7)
        pose = ", pose: {rpy: [0, 0.7, 0]}"
        columns = self.ball("universal", "first", driver, pose)
        self.assert_column(columns, "joint.j.angle", turn)
        self.assert_tip(columns, lambda t: (c, s * math.sin(turn(t)), -s * math.cos(turn(t))))
        columns = self.ball("universal", "second", driver)
        self.assert_column(columns, "joint.j.angle", turn)
        self.assert_tip(columns, lambda t: (math.cos(turn(t)), 0, -math.sin(turn(t))))

    def test_start_values_of_a_cardan_joint_go_on_evenly(self):
        start = "initial: {joints: {j: 0.3 rad}, speeds: {j: 8}}"
        columns = self.ball("universal", "first", start, ", pose: {rpy: [0, 0.7, 0]}")
        self.assert_column(columns, "joint.j.angle", lambda t: 0.3 + 8 * t)  # counted over turns
        self.assert_column(columns, "joint.j.speed", lambda t: 8)
        columns = self.ball("universal", "second", start)
        self.assert_column(columns, "joint.j.angle", lambda t: 0.3 + 8 * t)
        self.assert_tip(columns, lambda t: (math.cos(0.3 + 8 * t), 0, -math.sin(0.3 + 8 * t)))

    def test_a_sleeve_is_driven_along_or_around_and_free_otherwise(self):
        columns = self.ball("cylindrical", "angle", "drivers: {d: {joint: j, kind: angle, value: 7 rad/s*t}}", gravity="-9.81")
        self.assert_tip(columns, lambda t: (math.cos(7 * t), math.sin(7 * t), -9.81 * t * t / 2))
        self.assert_column(columns, "driver.d.torque", lambda t: 0)
        columns = self.ball("cylindrical", "position", "drivers: {d: {joint: j, kind: position, value: 0.2 m*sin(4*t)}}",
                            gravity="-9.81")
        self.assert_tip(columns, lambda t: (1, 0, 0.2 * math.sin(4 * t)))
        self.assert_column(columns, "driver.d.force", lambda t: 2 * 9.81 - 2 * 0.2 * 16 * math.sin(4 * t), 1e-8)

    def test_a_gear_feeds_a_sleeve(self):
        columns = self.run_model("""
space: spatial
bodies: {b: {mass: 2, inertia: [0.5, 0.5, 0.5]}, wheel: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints:
  j: {type: cylindrical, between: [ground, b], coordinate: position}
  w: {type: revolute, between: [ground, wheel]}
  g: {type: gear, of: [w, j], ratio: 30 mm/(1 rad)}
drivers: {d: {joint: w, kind: angle, value: 5 rad/s*t}}
simulation: {end: 1 s, output: {interval: 50 ms}, %s}
""" % EXACT)
        self.assert_column(columns, "joint.j.position", lambda t: 0.15 * t)

    def test_a_ball_joint_is_turned_about_the_axis_of_its_socket(self):
        columns = self.ball("spherical", "angle", "drivers: {d: {joint: j, kind: angle, value: 2 rad/s*t + 0.3 rad/s^2*t^2}}")
        turn = lambda t: 2 * t + 0.3 * t * t
        self.assert_column(columns, "joint.j.angle", turn)
        self.assert_tip(columns, lambda t: (math.cos(turn(t)), math.sin(turn(t)), 0))
        self.assert_column(columns, "driver.d.torque", lambda t: 0.5 * 0.6, 1e-8)

    def test_without_a_coordinate_no_driver_moves_it(self):
        driver = "drivers: {d: {joint: j, kind: angle, value: t}}"
        self.refusal(BALL % ("0", "", "universal", "none", driver, EXACT), id="wrong-type", line=7)
        text = BALL % ("0", "", "spherical", "angel", driver, EXACT)
        self.assertEqual("angle", self.refusal(text, line=6)[0]["suggestion"])


if __name__ == "__main__":
    unittest.main()
