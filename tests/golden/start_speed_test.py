"""Start speeds: what the file gives is kept, or freeplay says how far it was changed and what it chose."""
import json
import unittest

from start_values import BALL, RUN, StartTest

ARM = """freeplay: 1
bodies:
  arm: {mass: 1, inertia: 1/12, com: [0.5, 0], frames: {tip: [1, 0]}%s}
  rotor: {mass: 1, inertia: 0.1%s}
joints:
  pivot: {type: revolute, between: [ground, arm]}
  spin: {type: revolute, between: [arm/tip, rotor]}
%s""" + RUN

TILTED = """freeplay: 1
space: spatial
bodies:
  rotor: {mass: 1, inertia: [0.01, 0.01, 0.02], velocity: {angular: [0.5, 0, 3]}}
joints:
  pin:
    type: revolute
    bearing: ground
    journal: rotor
    clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, length: 20 mm, %scontact: {law: hertz, K: 1e9}}
""" + RUN


class StartSpeed(StartTest):
    def test_a_speed_that_the_file_leaves_open_is_said(self):
        row, out, _ = self.first_row(ARM % ("", "", "initial: {speeds: {spin: 10}}\n"))
        # I1 w + 0.1 (w + 10) = 0 with the arm's moment about its pivot and the rotor's mass at its tip.
        arm = -0.1 * 10 / (1 / 3 + 1 + 0.1)
        self.assertAlmostEqual(10, row["joint.spin.speed"], places=12)
        self.assertAlmostEqual(arm, row["joint.pivot.speed"], places=12)
        self.assertIn("joint 'pivot' starts at %.4g rad/s by least kinetic energy" % arm, out)
        self.assertIn("joint 'pivot' starts at", self.freeplay("validate", "m.yaml")[0])

    # The end of the arm moves at 0.9 m/s, and least energy shares that as the centre of percussion says.
    def test_velocities_of_bodies_between_joints_without_a_coordinate_are_listed(self):
        self.write("ball.yaml", """freeplay: 1
space: spatial
bodies:
  arm: {mass: 1, inertia: [0.01, 0.01, 0.01], frames: {tip: [0.3, 0, 0]}}
  ball: {mass: 1, inertia: [0.01, 0.02, 0.03], frames: {eye: [-0.1, 0, 0]}}
joints:
  main: {type: revolute, between: [ground, arm]}
  tip: {type: spherical, between: [arm/tip, ball/eye]}
drivers: {motor: {joint: main, kind: velocity, value: 3 rad/s}}
simulation: {end: 0.1 s, step: 1 ms}
""")
        out, _ = self.freeplay("validate", "ball.yaml")
        self.assertIn("body 'ball' starts at 0.675 m/s and 2.25 rad/s by least kinetic energy", out)
        self.assertNotIn("body 'arm'", out)

    # The load hangs under the arm's end, which rises at 0.9 m/s; its turn is given.
    def test_of_a_body_whose_turn_is_given_the_other_velocity_alone_is_listed(self):
        self.write("load.yaml", """freeplay: 1
bodies:
  arm: {mass: 1, inertia: 0.01, frames: {tip: [0.3, 0]}}
  load: {mass: 1, inertia: 0.01, pose: {position: [0.3, -0.5]}, velocity: {angular: 2 rad/s}}
joints:
  main: {type: revolute, between: [ground, arm]}
  rope: {type: distance, between: [arm/tip, load], length: 0.5 m}
drivers: {motor: {joint: main, kind: velocity, value: 3 rad/s}}
simulation: {end: 0.1 s, step: 1 ms}
""")
        out, _ = self.freeplay("validate", "load.yaml")
        self.assertIn("body 'load' starts at 0.9 m/s by least kinetic energy", out)
        chosen = json.loads(self.freeplay("validate", "load.yaml", "--json")[0])["start_changes"]["chosen"]
        self.assertEqual(["body", "speed"], sorted(chosen[0]))

    def test_speeds_that_are_all_given_are_kept_without_a_word(self):
        row, out, _ = self.first_row(ARM % ("", "", "initial: {speeds: {spin: 10, pivot: 0}}\n"))
        self.assertAlmostEqual(10, row["joint.spin.speed"], places=12)
        self.assertAlmostEqual(0, row["joint.pivot.speed"], places=12)
        self.assertNotIn("starts", out)

    def test_a_speed_that_a_driver_leaves_open_is_said(self):
        row, out, _ = self.first_row(ARM % ("", "", "drivers: {motor: {joint: spin, kind: velocity, value: 10}}\n"))
        arm = -0.1 * 10 / (1 / 3 + 1 + 0.1)
        self.assertAlmostEqual(arm, row["joint.pivot.speed"], places=12)
        self.assertIn("joint 'pivot' starts at %.4g rad/s by least kinetic energy" % arm, out)

    def test_a_velocity_that_is_given_is_kept_and_another_body_follows(self):
        row, out, _ = self.first_row(ARM % (", velocity: {angular: 2}", "", ""))
        self.assertAlmostEqual(2, row["body.arm.omega"], places=12)
        self.assertAlmostEqual(2, row["body.rotor.vy"], places=12)
        self.assertNotIn("moved", out)

    def test_a_velocity_that_a_start_speed_contradicts_is_listed(self):
        row, out, _ = self.first_row(ARM % (", velocity: {angular: 2}", "", "initial: {speeds: {pivot: 3}}\n"))
        self.assertAlmostEqual(3, row["body.arm.omega"], places=12)
        self.assertIn("body 'arm' starts 1 rad/s", out)
        self.assertIn("from the angular velocity that its `velocity` gives", out)

    def test_a_velocity_in_play_is_kept(self):
        for initial in ("", ", initial: centered", ", initial: {eccentricity: [0.1 mm, 0]}"):
            row, out, _ = self.first_row(BALL % initial)
            self.assertEqual((0.3, -0.1), (row["body.ball.vx"], row["body.ball.vy"]))
            self.assertNotIn("moved", out)

    def test_the_block_of_a_clearance_wins_and_what_it_moved_is_listed(self):
        row, out, _ = self.first_row(BALL % ", initial: {velocity: [0.2, 0]}")
        self.assertAlmostEqual(0.2, row["body.ball.vx"], places=12)
        self.assertIn("body 'ball' starts 0.141 m/s from the velocity that its `velocity` gives", out)

    def test_the_block_of_a_spatial_pin_leaves_its_tilt_to_the_bodies(self):
        start = TILTED % ("initial: {velocity: [0, 0.01, 0]}, ")
        row, out, _ = self.first_row(start)
        self.assertAlmostEqual(0.5, row["body.rotor.wx"], places=9)
        self.assertAlmostEqual(0.01, row["body.rotor.vy"], places=9)
        self.assertNotIn("starts", out)

    def test_a_block_that_gives_zero_gives_a_velocity(self):
        row, out, _ = self.first_row(BALL % ", initial: {velocity: [0, 0]}")
        self.assertEqual((0, 0), (row["body.ball.vx"], row["body.ball.vy"]))
        self.assertIn("body 'ball' starts 0.316 m/s from the velocity that its `velocity` gives", out)

    def test_a_speed_of_rounding_is_not_said(self):
        text = """freeplay: 1
gravity: [0, -9.81]
bodies:
  cart: {mass: 1, inertia: 0.01}
  pole: {mass: 0.2, inertia: 0.002, com: [0.15, 0]}
joints:
  rail: {type: prismatic, between: [ground, cart]}
  hinge: {type: revolute, between: [cart, pole]}
drivers: {motor: {joint: rail, kind: position, value: "0.1 m*exp(-((t - 1 s)/(WIDTH s))^2)"}}
initial: {joints: {hinge: -1.2}}
simulation: {end: 2, step: 1e-3}
"""
        for width, said in ((0.1, False), (0.5, True)):  # the cart starts at 7e-43 m/s and at 0.015 m/s
            out, _ = self.freeplay("validate", self.write("m.yaml", text.replace("WIDTH", str(width))))
            self.assertEqual(said, "joint 'hinge' starts at" in out, out)


if __name__ == "__main__":
    unittest.main()
