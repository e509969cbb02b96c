"""Start values: what the file gives is kept, or freeplay says how far it was moved; the nearest position is taken."""
import math
import unittest

from program import mechanism
from start_values import BALL, RUN, StartTest

# A crank moves the knee of two links between a hinge above and a ram below. Link angles of -75 and -105 degrees fit
# with the knee on the right, and its mirror image with the knee on the left.
TOGGLE = """freeplay: 1
parameters: {upper: -90 deg, lower: -90 deg}
bodies:
  upper: {mass: 1, inertia: 0.01, frames: {end: [0.3, 0]}, pose: {angle: $upper}}
  lower: {mass: 1, inertia: 0.01, frames: {end: [0.3, 0]}, pose: {angle: $lower}}
  ram: {mass: 1, inertia: 0.01}
frames: {ground/guide: {angle: -90 deg}}
joints:
  top: {type: revolute, between: [ground, upper]}
  knee: {type: revolute, between: [upper/end, lower]}
  foot: {type: revolute, between: [lower/end, ram]}
  guide: {type: prismatic, between: [ground/guide, ram]}
initial: {joints: {guide: "0.6*cos(15 deg)"}}
""" + RUN

CRANK = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {tip: [0.09, 0]}}
  rod: {mass: 1, inertia: 0.01, frames: {tip: [0.27, 0]}, pose: {angle: %s}}
  slider: {mass: 1, inertia: 0.01}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, rod]}
  C: {type: revolute, between: [rod/tip, slider]}
  G: {type: prismatic, between: [ground, slider]}
""" + RUN

RACK = """freeplay: 1
bodies:
  pinion: {mass: 1, inertia: 0.01, pose: {angle: %r rad}}
  rack: {mass: 1, inertia: 0.01, pose: {position: [%r m, -0.03 m]}}
frames: {ground/guide: [0, -0.03]}
joints:
  axle: {type: revolute, between: [ground, pinion]}
  guide: {type: prismatic, between: [ground/guide, rack]}
  teeth: {type: gear, of: [axle, guide], ratio: 30 mm, offset: 0}
""" + RUN

WHEELS = """freeplay: 1
bodies:
  small: {mass: 1, inertia: 0.01, pose: {position: [0, 0], angle: %r rad}}
  large: {mass: 1, inertia: 0.01, pose: {position: [0.14, 0], angle: %r rad}}
frames: {ground/large: [0.14, 0]}
joints:
  first: {type: revolute, between: [ground, small]}
  second: {type: revolute, between: [ground/large, large]}
  teeth: {type: gear, of: [first, second], ratio: -0.4, offset: 0}
""" + RUN

# A bar on three parallel links of one length, the third with a loose pin: closed it has one constraint too many.
TABLE = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {two: [0.3, 0], three: [0.5, 0]}}
  foot1: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}}
  foot2: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}}
  foot3: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}}
  top: {mass: 1, inertia: 0.01, com: [0.2, 0], frames: {two: [0.3, 0], three: [0.5, 0]}}
joints:
  foot1_pin: {type: revolute, between: [ground, foot1]}
  foot2_pin: {type: revolute, between: [ground/two, foot2]}
  foot3_pin: {type: revolute, between: [ground/three, foot3]}
  head1: {type: revolute, between: [foot1/tip, top]}
  head2: {type: revolute, between: [foot2/tip, top/two]}
  head3:
    type: revolute
    between: [foot3/tip, top/three]
    clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e9}%s}
drivers: {motor: {joint: foot1_pin, kind: velocity, value: 5}}
initial: {joints: {foot1_pin: 40 deg}}
simulation: {end: 1 ms, step: 10 us}
"""

CARDAN = """freeplay: 1
space: spatial
bodies:
  in: {mass: 1, inertia: [0.01, 0.01, 0.01], frames: {tip: {position: [0, 0, 1]}}}
  out: {mass: 1, inertia: [0.01, 0.01, 0.01], pose: {position: [0, 0, 1], rpy: [%s]}}
joints:
  axle: {type: revolute, between: [ground, in]}
  cardan: {type: universal, between: [in/tip, out]}
initial: {joints: {axle: 0}}
""" + RUN


class Start(StartTest):
    # --- redundant constraints ---------------------------------------------------------------------------------------

    def test_a_start_in_play_that_redundant_constraints_forbid_is_as_near_as_can_be(self):
        # The third link turns about its foot: its journal moves across it, and not along it.
        across, along = math.cos(math.radians(40)), math.sin(math.radians(40))
        self.start(TABLE % ", initial: {eccentricity: [0, 0.06 mm]}")
        moved, = self.changes["moved"]
        self.assertEqual(("head3", "eccentricity", True), (moved["joint"], moved["quantity"], moved["far"]))
        self.assertAlmostEqual(0.06e-3 * along, moved["by"], delta=1e-7)
        self.start(TABLE % ", initial: {velocity: [0, 0.2]}")
        moved, = self.changes["moved"]
        self.assertEqual(("head3", "velocity"), (moved["joint"], moved["quantity"]))
        self.assertAlmostEqual(0.2 * along, moved["by"], places=9)
        row, out, _ = self.first_row(TABLE % ", initial: {eccentricity: [%r mm, %r mm]}" % (-0.06 * along, 0.06 * across))
        self.assertNotIn("moved", out)
        self.assertAlmostEqual(-0.04e-3, row["joint.head3.delta"], delta=1e-7)

    def test_a_journal_of_redundant_constraints_can_be_loaded(self):
        row, out, _ = self.first_row(TABLE % ", initial: loaded")
        self.assertRegex(out, r"the journal of joint 'head3' starts \S+ m from where its load alone would press it: other joints hold it\n")
        self.assertLess(row["joint.head3.delta"], 1e-5)

    # --- positions ---------------------------------------------------------------------------------------------------

    def test_the_nearest_of_two_positions_is_taken(self):
        for upper, lower, sign in ((-70, -100, 1), (-80, -117, 1), (-100, -80, -1), (-112, -71, -1)):
            start, messages = self.start(TOGGLE, "--set", "upper=%d deg" % upper, "--set", "lower=%d deg" % lower)
            self.assertEqual([], messages)
            self.assertAlmostEqual(-90 + sign * 15, math.degrees(start["upper"]["angle"]), places=9)
            self.assertAlmostEqual(-90 - sign * 15, math.degrees(start["lower"]["angle"]), places=9)
            moved = [one for one in self.changes["moved"] if one["body"] == "lower"]
            self.assertEqual("angle", moved[0]["quantity"])
            self.assertAlmostEqual(abs(-90 - sign * 15 - lower), math.degrees(moved[0]["by"]), places=9)
            self.assertEqual(abs(-90 - sign * 15 - lower) > 10, moved[0]["far"])

    def test_a_pose_that_is_wrong_by_half_a_turn_moves_no_other_body(self):
        for name, body, old, new in (("pantograph", "inner", "[60 mm, 80 mm], angle: -53.13 deg", "[60 mm, 80 mm], angle: 126.87 deg"),
                                     ("windscreen-wiper", "tie", "[150 mm, -40 mm]}", "[150 mm, -40 mm], angle: 175 deg}")):
            with self.subTest(name):
                with open(mechanism("gallery/" + name), encoding="utf-8") as file:
                    text = file.read()
                self.assertEqual(1, text.count(old))
                self.start(text.replace(old, new))
                self.assertEqual({body}, {one["body"] for one in self.changes["moved"] if one["far"]})

    def test_two_positions_that_are_equally_near_are_both_named(self):
        for down in (270, -810, 990, -90):
            start, messages = self.start(TOGGLE, "--set", "upper=%d deg" % down, "--set", "lower=%d deg" % down)
            text, = [m["message"] for m in messages if (m["id"], m["severity"]) == ("ambiguous-start", "warning")]
            self.assertIn("at %d.0 deg (taken) or at %d.0 deg" % (down + 15, down - 15), text)
            self.assertAlmostEqual(down + 15, math.degrees(start["upper"]["angle"]), places=9)  # as the rows have it
        self.freeplay("validate", "m.yaml", "--strict", code=3)

    def test_a_motion_that_is_left_free_serves_the_given_poses(self):
        free = TOGGLE.replace('initial: {joints: {guide: "0.6*cos(15 deg)"}}\n', "")
        start, messages = self.start(free, "--set", "upper=-60 deg", "--set", "lower=-100 deg")
        self.assertEqual([], messages)
        # -90 + a and -90 - a are nearest to -60 and -100 with a = (30 + 10) / 2.
        self.assertAlmostEqual(-70, math.degrees(start["upper"]["angle"]), places=6)
        self.assertAlmostEqual(-110, math.degrees(start["lower"]["angle"]), places=6)

    def test_a_pose_beyond_its_reach_has_one_nearest_position(self):
        start, messages = self.start(CRANK % "-23 deg")
        self.assertEqual([], messages)
        self.assertAlmostEqual(math.asin(0.09 / 0.27), -start["rod"]["angle"], places=9)
        self.assertAlmostEqual(90, math.degrees(start["crank"]["angle"]), places=4)

    def test_angles_start_at_the_turn_of_their_poses(self):
        for crank, pose in ((60, 100), (120, 100), (88, 265)):
            start, _ = self.start(CRANK % ("%d deg" % pose) + "initial: {joints: {A: %d deg}}\n" % crank)
            self.assertLess(abs(math.degrees(start["rod"]["angle"]) - pose), 180.0001)

    def test_gears_keep_the_whole_turns_of_given_poses(self):
        for turned in (3.5, 6.2, 9, 40, -14):
            start, _ = self.start(RACK % (turned, 0.03 * turned))
            self.assertEqual([], self.changes["moved"], turned)
            self.assertAlmostEqual(turned, start["pinion"]["angle"], places=9)
            start, _ = self.start(WHEELS % (turned, -0.4 * turned))
            self.assertEqual([], self.changes["moved"], turned)

    def test_a_rod_between_two_balls_may_spin_as_it_likes(self):
        _, messages = self.start("""freeplay: 1
space: spatial
bodies:
  ground: {frames: {o2: {position: [0.3, 0, 0], rpy: [90 deg, 0, 0]}}}
  crank: {mass: 0.3, inertia: [1e-5, 2e-4, 2e-4], com: [0.02, 0, 0], frames: {tip: [0.05, 0, 0]}}
  rod: {mass: 0.3, inertia: [1e-5, 2e-3, 2e-3], com: [0.14, 0, 0], frames: {tip: [0.28, 0, 0]}}
  out: {mass: 0.3, inertia: [1e-4, 5e-4, 5e-4], com: [0.05, 0, 0], frames: {tip: [0.15, 0, 0]}, pose: {rpy: [90 deg, -90 deg, 0]}}
joints:
  a: {type: revolute, between: [ground, crank]}
  b: {type: spherical, between: [crank/tip, rod]}
  c: {type: spherical, between: [rod/tip, out/tip]}
  d: {type: revolute, between: [ground/o2, out]}
drivers: {m: {joint: a, kind: velocity, value: 60 rpm}}
simulation: {end: 1 s, accuracy: 1 um}
""")
        self.assertEqual([], [m["id"] for m in messages])

    def test_a_motor_on_a_mechanism_that_cannot_move_is_named(self):
        braced = """freeplay: 1
bodies:
  ground: {frames: {c: [0.3, 0]}}
  crank: {mass: 1, inertia: 2e-3, frames: {tip: [0.1, 0]}, pose: {angle: 60 deg}}
  bar: {mass: 1, inertia: 5e-3, frames: {tip: [0.25, 0]}}
  rocker: {mass: 1, inertia: 5e-3, frames: {tip: [0.25, 0]}, pose: {angle: 100 deg}}
joints:
  a: {type: revolute, between: [ground, crank]}
  d: {type: revolute, between: [ground/c, rocker]}
  b: {type: revolute, between: [crank/tip, bar]}
  c: {type: revolute, between: [bar/tip, rocker/tip]}
  brace: {type: distance, between: [ground/c, crank/tip], length: 0.25}
drivers: {m: {joint: a, kind: torque, value: 20 N*m}}
simulation: {end: 1 s, accuracy: 1 um}
"""
        _, messages = self.start(braced)
        self.assertIn("locked", [m["id"] for m in messages])
        _, messages = self.start("".join(line for line in braced.splitlines(True) if "brace" not in line))
        self.assertNotIn("locked", [m["id"] for m in messages])

    def test_a_force_on_a_slider_in_dead_centre_is_said_to_move_nothing(self):
        model = """freeplay: 1
bodies:
  crank: {mass: 0.3 kg, inertia: 1e-4, frames: {tip: [50 mm, 0]}}
  coupler: {mass: 0.2 kg, inertia: 2.5e-4, frames: {tip: [120 mm, 0]}}
  slider: {mass: 0.1 kg, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  guide: {type: prismatic, between: [ground, slider]}
  wrist: {type: revolute, between: [coupler/tip, slider]}
drivers: {m: {joint: guide, kind: force, value: -100}}
initial: {joints: {main: 0}}
simulation: {end: 0.05 s, step: 10 us}
"""
        _, messages = self.start(model)
        self.assertEqual(["dead-point"], [m["id"] for m in messages])
        self.assertIn("driver 'm' starts joint 'guide' at a dead point: it moves nothing", messages[0]["message"])
        _, messages = self.start(model.replace("main: 0}", "main: 1 deg}"))
        self.assertEqual([], messages)

    def test_a_train_finds_the_turn_in_which_given_poses_fit(self):
        # The poses hold up to whole turns: the large wheel turns by 144 deg less each turn of the small one.
        for turned in (9, 14, 40, -14):
            given = [math.remainder(angle, 2 * math.pi) for angle in (turned, -0.4 * turned)]
            start, messages = self.start(WHEELS % tuple(given))
            self.assertEqual([], self.changes["moved"], turned)
            self.assertEqual([], [m for m in messages if m["id"] == "ambiguous-start"])
            for body, angle in zip(("small", "large"), given):
                self.assertAlmostEqual(0, math.remainder(start[body]["angle"] - angle, 2 * math.pi), places=9)

    def test_a_rack_takes_the_turn_that_is_nearest_to_what_is_given(self):
        # 0.5 rad on are 15 mm, and 188 mm more with each turn.
        start, _ = self.start(RACK % (0.5, 0.39))
        self.assertLess(abs(start["rack"]["x"] - 0.39), 0.01)

    def test_a_pose_inside_the_play_is_not_moved_in_silence(self):
        self.start(BALL.replace("velocity: {linear: [0.3, -0.1]}", "frames: {far: [30, 0]}, pose: {position: [0.4 mm, 0]}").replace(
            "step: 10 us", "step: 10 us, output: {frames: [ball/far]}") % "")
        moved, = self.changes["moved"]
        self.assertEqual(("ball", "position"), (moved["body"], moved["quantity"]))
        self.assertAlmostEqual(0.4e-3, moved["by"], places=12)

    def test_a_cardan_joint_says_how_far_it_turned_its_body(self):
        _, out, _ = self.first_row(CARDAN % "20 deg, 20 deg, 40 deg")
        self.assertIn("from the orientation that its `pose` gives: that is far", out)
        _, out, _ = self.first_row(CARDAN % "0, 20 deg, 0")
        self.assertNotIn("moved", out)

    def test_show_draws_given_and_assembled_poses(self):
        self.write("m.yaml", TOGGLE)
        words = ("show", "m.yaml", "--format", "svg", "--set", "lower=-140 deg")
        self.assertEqual(1 + 1, self.freeplay(*words, "--set", "upper=-70 deg")[0].count('class="given"'))
        self.assertEqual(0, self.freeplay("show", "m.yaml", "--format", "svg", "--set", "upper=-75 deg", "--set",
                                          "lower=-105 deg")[0].count('class="given"'))
        self.write("s.yaml", CARDAN % "20 deg, 20 deg, 40 deg")
        self.assertEqual(4, self.freeplay("show", "s.yaml", "--format", "svg")[0].count('class="given"'))  # views

    # --- positions that cannot be ------------------------------------------------------------------------------------

    def test_a_mechanism_that_cannot_close_says_how_far_and_where_it_would(self):
        text = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}}
  coupler: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}}
  rocker: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}}
frames: {ground/D: [0.4, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
initial: {joints: {A: 180 deg}}
"""
        _, err = self.freeplay("validate", self.write("m.yaml", text), code=3)
        # The crank's tip is 0.6 m from D, and two links of 0.2 m are between.
        self.assertIn("stays open by 0.2 m", err)
        limit = math.degrees(math.acos((0.2**2 + 0.4**2 - 0.4**2) / (2 * 0.2 * 0.4)))
        self.assertIn("can turn from -%.4g deg to %.4g deg" % (limit, limit), err)
        self.assertIn("assembly-failed", err)

    def test_a_speed_driver_without_a_start_begins_where_the_mechanism_was_put_together(self):
        """Two positions are equally near, and the one that was compared last is not the one that was taken."""
        planar = """freeplay: 1
bodies:
  crank: {mass: 0.3, inertia: 3e-4, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  coupler: {mass: 0.5, inertia: 3e-3, com: [0.15, 0], frames: {tip: [0.3, 0]}}
  rocker: {mass: 0.4, inertia: 2e-3, com: [0.1, 0], frames: {tip: [0.2, 0]}}
frames: {ground/D: [0.3, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {motor: {joint: A, kind: velocity, value: 20}}
simulation: {end: 0.5, accuracy: 1 um}
"""
        spatial = planar.replace("freeplay: 1\n", "freeplay: 1\nspace: spatial\n").replace("0]", "0, 0]")
        for moment in ("3e-4", "3e-3", "2e-3"):
            spatial = spatial.replace("inertia: %s" % moment, "inertia: [1e-4, %s, %s]" % (moment, moment))
        for text in (planar, spatial):
            out, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force")
            self.assertIn("ambiguous-start", err)
            self.assertIn("completed, 0.5 s", out)


if __name__ == "__main__":
    unittest.main()
