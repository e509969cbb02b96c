"""Screws, links with a pin and a ball, and balls on planes move and bear as closed forms say."""
import math
import unittest

from model_cases import EXACT, ModelTest


class InSpace(ModelTest):
    def test_a_ball_slides_down_a_plane(self):
        columns = self.run_model("""
space: spatial
gravity: [0, 0, -9.81]
frames: {ground/slope: {rpy: [0, 30 deg, 0]}}
bodies: {ball: {mass: 2, inertia: [1e-3, 1e-3, 1e-3], velocity: {angular: [1, 2, 3]}}}
joints: {plane: {type: point-on-plane, between: [ground/slope, ball]}}
simulation: {end: 1, output: {interval: 50 ms}, %s}
""" % EXACT)
        slope = math.radians(30)
        self.assert_column(columns, "body.ball.x", lambda t: 9.81 * math.sin(slope) * math.cos(slope) * t * t / 2)
        self.assert_column(columns, "body.ball.z", lambda t: -9.81 * math.sin(slope) ** 2 * t * t / 2)
        self.assert_column(columns, "body.ball.wy", lambda t: 2)
        self.assert_column(columns, "joint.plane.fz", lambda t: 2 * 9.81 * math.cos(slope) ** 2)

    def test_a_link_with_a_pin_and_a_ball_is_a_distance_in_a_plane(self):
        text = """
space: spatial
gravity: [0, -9.81, 0]
frames: {ground/pin: {rpy: [0.3, 0.2, 0.1]}}
bodies: {bob: {mass: 1.5, inertia: [1e-3, 2e-3, 2e-3], pose: {position: [0.3, 0.05, 0.1]}}}
joints: %s
simulation: {end: 2, output: {interval: 50 ms}, %s}
"""
        link = self.run_model(text % ("{link: {type: revolute-spherical, between: [ground/pin, bob], length: 0.4 m}}", EXACT))
        apart = self.run_model(text % ("{plane: {type: point-on-plane, between: [ground/pin, bob]}, rod: {type: distance, "
                                       "between: [ground/pin, bob], length: 0.4 m}}", EXACT))
        for axis in "xyz":
            for a, b in zip(link["body.bob." + axis], apart["body.bob." + axis], strict=True):
                self.assertAlmostEqual(a, b, delta=1e-8)
            for row in range(len(link["time"])):
                self.assertAlmostEqual(apart["joint.plane.f" + axis][row] + apart["joint.rod.f" + axis][row],
                                       link["joint.link.f" + axis][row], delta=1e-6)
        self.assertLess(max(map(abs, link["energy.residual"])), 1e-8)
        self.assertGreater(max(link["body.bob.y"]) - min(link["body.bob.y"]), 0.2)

    def test_a_nut_falls_down_its_screw_as_slowly_as_it_has_to_turn(self):
        text = """
space: spatial
gravity: [0, 0, -9.81]
frames: {ground/up: {rpy: [0, 0, 0.4]}}
bodies: {nut: {mass: 2 kg, inertia: [1, 1, 0.01], pose: {position: [0, 0, 10 mm]}}}
joints: {thread: {type: screw, between: [ground/up, nut], lead: %s, offset: 10 mm}}
%s
simulation: {end: 2, output: {interval: 50 ms}, %s}
"""
        for lead in (0.1, -0.1):
            columns = self.run_model(text % (lead, "", EXACT))
            per_angle = lead / (2 * math.pi)
            a = 9.81 / (1 + 0.01 / (2 * per_angle ** 2))
            self.assert_column(columns, "body.nut.z", lambda t: 0.01 - a * t * t / 2)
            self.assert_column(columns, "joint.thread.angle", lambda t: -a * t * t / 2 / per_angle)
            self.assertGreater(abs(columns["joint.thread.angle"][-1]), 20)
        columns = self.run_model(text % ("20 mm", "drivers: {m: {joint: thread, kind: angle, value: 3 rad*t}}", EXACT))
        self.assert_column(columns, "body.nut.z", lambda t: 0.01 + 0.02 * 3 * t / (2 * math.pi))
        self.assert_column(columns, "driver.m.torque", lambda t: 2 * 9.81 * 0.02 / (2 * math.pi))
        self.refusal(text % ("0", "", EXACT), id="out-of-range")

    def test_they_are_of_space_alone(self):
        for joint in ("type: screw, lead: 1 mm", "type: point-on-plane", "type: revolute-spherical, length: 1"):
            self.refusal("bodies: {a: {mass: 1, inertia: 1}}\njoints: {j: {%s, between: [ground, a]}}\n" % joint,
                         id="type-space", line=3)


if __name__ == "__main__":
    unittest.main()
