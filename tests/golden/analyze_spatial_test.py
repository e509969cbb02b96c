"""freeplay analyze on mechanisms in space: columns, poses, reach, what stays planar. Most numbers are those of a Stewart platform."""
import csv
import io
import json
import math
import os
import unittest

from program import MECHANISMS, ProgramTest

HEIGHT, ROD, PLAY, BACKLASH = 0.6, 0.3, 1e-4, 5e-5
BASE = [(0.5 * math.cos(math.radians(a)), 0.5 * math.sin(math.radians(a)), 0.0) for a in (10, 50, 130, 170, 250, 290)]
TOP = [(0.25 * math.cos(math.radians(a)), 0.25 * math.sin(math.radians(a)), 0.0) for a in (-10, 70, 110, 190, 230, 310)]


def numbers(values):
    return "[" + ", ".join(repr(value) for value in values) + "]"


def stewart(lower="universal", clearance=True):
    bodies, frames, joints, drivers = [], [], [], []
    for k, (b, p) in enumerate(zip(BASE, TOP)):
        leg = [p[0] - b[0], p[1] - b[1], p[2] + HEIGHT - b[2]]
        length = math.hypot(*leg)
        turns = "rpy: [0, %r, %r]" % (-math.asin(leg[2] / length), math.atan2(leg[1], leg[0]))
        far = [b[i] + leg[i] * (1 - ROD / length) for i in range(3)]
        bodies += ["  low%d: {mass: 0.8, inertia: [1e-4, 1e-2, 1e-2], pose: {position: %s, %s}}" % (k, numbers(b), turns),
                   "  rod%d: {mass: 0.5, inertia: [1e-4, 8e-3, 8e-3], frames: {end: [%r, 0, 0]}, pose: {position: %s, %s}}"
                   % (k, ROD, numbers(far), turns)]
        frames += ["  ground/B%d: {position: %s, rpy: [0, 0, %r]}" % (k, numbers(b), math.atan2(leg[1], leg[0])),
                   "  platform/P%d: %s" % (k, numbers(p))]
        play = ", clearance: {radial_clearance: %r, bearing_radius: 10 mm, contact: {law: hertz, K: 1e9}}" % PLAY if clearance else ""
        joints += ["  U%d: {type: %s, between: [ground/B%d, low%d]}" % (k, lower, k, k),
                   "  L%d: {type: prismatic, between: [low%d, rod%d]}" % (k, k, k),
                   "  S%d: {type: spherical, between: [rod%d/end, platform/P%d]%s}" % (k, k, k, play)]
        drivers.append("  D%d: {joint: L%d, kind: position, value: %r}" % (k, k, length - ROD))
    return "\n".join(["freeplay: 1", "space: spatial", "gravity: [0, 0, -9.81]", "bodies:",
                      "  platform: {mass: 5, inertia: [0.1, 0.12, 0.2], pose: {position: [0, 0, %r]}}" % HEIGHT, *bodies,
                      "frames:", *frames, "joints:", *joints, "drivers:", *drivers,
                      "analysis: {frame: platform, error: {input: %r}}" % BACKLASH, ""])


def leg_lengths(x, y, z, roll, pitch, yaw):
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    turn = ((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr), (-sp, cp * sr, cp * cr))
    return [math.dist([s + sum(r * c for r, c in zip(row, p)) for s, row in zip((x, y, z), turn)], b) for b, p in zip(BASE, TOP)]


ARM = """freeplay: 1
space: spatial
bodies:
  base: {mass: 1, inertia: [1, 1, 1]}
  upper: {mass: 1, inertia: [1, 1, 1], frames: {end: [0.3, 0, 0]}}
  lower: {mass: 1, inertia: [1, 1, 1], frames: {tip: [0.2, 0, 0]}}
joints:
  yaw: {type: revolute, between: [ground, base]}
  lift: {type: revolute, between: [base, upper], axis: [0, -1, 0]}
  bend: {type: revolute, between: [upper/end, lower], axis: [0, -1, 0]}
initial: {joints: {yaw: 0, lift: 30 deg, bend: -60 deg}}
analysis: {frame: lower/tip, joints: [yaw, lift, bend]}
"""


class AnalyzeInSpace(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("stewart.yaml", stewart())

    def rows(self, *words):
        out, _ = self.freeplay("analyze", *words)
        return list(csv.DictReader(io.StringIO(out)))

    def message(self, *words, code):
        out, err = self.freeplay("analyze", *words, code=code)
        self.assertEqual("", out)
        return err

    def test_columns_of_each_kind(self):
        pose = "x,y,z,roll,pitch,yaw,"
        changes = ["dx", "dy", "dz", "drx", "dry", "drz", "position", "dangle"]
        wanted = {"error": pose + "reachable," + ",".join(changes + ["ls_" + change for change in changes]),
                  "singularity": pose + "reachable,sigma_min,sigma_max,condition,inverse_min,kind",
                  "ik": "time," + pose + ",".join("joint.L%d.%s" % (k, q) for k in range(6) for q in ("position", "speed", "acceleration")),
                  "inverse-dynamics": "time," + pose + ",".join(
                      ["driver.L%d.force" % k for k in range(6)] +
                      ["joint.%s%d.%s" % (j, k, f) for k in range(6) for j in "ULS" for f in ("fx", "fy", "fz", "tx", "ty", "tz")])}
        for kind, columns in wanted.items():
            out, err = self.freeplay("analyze", kind, "stewart.yaml", "--pose", "0,0,0.6")
            self.assertEqual("", err)
            self.assertEqual(columns, out.splitlines()[0])
            self.assertEqual(2, len(out.splitlines()))

    def test_poses_on_a_grid_have_the_leg_lengths_of_the_formula(self):
        self.write("spun.yaml", stewart(lower="spherical"))  # six legs that may spin: no matter
        for model in ("stewart.yaml", "spun.yaml"):
            rows = self.rows("ik", model, "--grid", "x=-0.05:0.05:3", "--grid", "z=0.55:0.65:3", "--grid", "y=0.01:0.01:1",
                             "--grid", "pitch=-0.1:0.1:2")
            self.assertEqual(18, len(rows))
            for row in rows:
                lengths = leg_lengths(*(float(row[name]) for name in ("x", "y", "z", "roll", "pitch", "yaw")))
                for k, length in enumerate(lengths):
                    self.assertAlmostEqual(length - ROD, float(row["joint.L%d.position" % k]), 10)

    def test_inputs_decide_the_pose(self):
        pose = (0.02, -0.01, 0.58, 0.05, -0.1, 0.15)
        words = ",".join("L%d=%r" % (k, length - ROD) for k, length in enumerate(leg_lengths(*pose)))
        row, = self.rows("ik", "stewart.yaml", "--input", words)
        for name, value in zip(("x", "y", "z", "roll", "pitch", "yaw"), pose):
            self.assertAlmostEqual(value, float(row[name]), 9)

    def test_errors_have_causes_and_samples_within_them(self):
        out, _ = self.freeplay("analyze", "error", "stewart.yaml", "--pose", "0.02,0,0.6,0.1", "--samples", "20000", "--json")
        document = json.loads(out)
        row = dict(zip(document["columns"], document["rows"][0]))
        worst = document["summary"]["worst"]
        self.assertAlmostEqual(row["position"], math.hypot(*worst["displacement"][:3]), 14)
        self.assertAlmostEqual(row["position"], sum(worst["share"].values()), 14)
        self.assertEqual(12, len(worst["share"]))
        self.assertLess(row["sample_max_position"], row["position"])
        self.assertLess(row["sample_max_dangle"], row["dangle"])
        summary = document["summary"]
        self.assertEqual((6, 0, 0, False), (summary["freedoms"], summary["redundant_inputs"], summary["redundant_constraints"],
                                            summary["special_configuration"]))

    def test_standing_platform_is_carried_by_its_legs(self):
        self.write("ideal.yaml", stewart(clearance=False))
        row, = self.rows("inverse-dynamics", "ideal.yaml", "--pose", "0.03,0.02,0.6,0.1,0,0.2")
        self.assertAlmostEqual(9.81 * (5 + 6 * 1.3), sum(float(row["joint.U%d.fz" % k]) for k in range(6)), 9)
        for axis in "xy":
            self.assertAlmostEqual(0.0, sum(float(row["joint.U%d.f%s" % (k, axis)]) for k in range(6)), 9)
        # A spin of a leg has no torque to hold it.
        self.write("spun.yaml", stewart(lower="spherical", clearance=False))
        self.assertIn("still has 6 freedoms [ik-underdetermined]", self.message("inverse-dynamics", "spun.yaml", "--pose", "0,0,0.6", code=3))

    def test_map_over_two_components(self):
        self.freeplay("analyze", "error", "stewart.yaml", "--grid", "x=-0.05:0.05:5", "--grid", "y=-0.05:0.05:5", "--grid", "z=0.6:0.6:1",
                      "--svg", "map.svg", "--out", "map.csv")
        self.assertIn("z 0.6 m", self.read("map.svg"))
        self.assertEqual(26, len(self.read("map.csv").splitlines()))

    def test_what_is_planar_says_so(self):
        for words, what in ((["ik", "stewart.yaml", "--pose", "0,0,0.6", "--branches"], "--branches"),
                            (["ik", "stewart.yaml", "--pose", "0,0,0.6", "--elbow", "1"], "--elbow")):
            self.assertIn(what + " works on planar models only, but 'stewart.yaml' is spatial [type-space]", self.message(*words, code=3))
        for key, place, says in (("elbow: 1", 29, "working modes work in planar models only"),
                                 ("grid: {x: [0, 1], angle: 0}", 47, "'angle' is no number of a pose in space, which has x, y, z, roll, pitch, yaw")):
            self.write("refused.yaml", stewart().replace("frame: platform,", "frame: platform, %s," % key))
            err = self.message("error", "refused.yaml", "--pose", "0,0,0.6", code=3)
            self.assertIn("refused.yaml:%d:%d: error" % (len(stewart().splitlines()), place), err)
            self.assertIn(says + " [type-space]", err)

    def test_poses_in_space_have_their_own_words(self):
        self.assertIn("no poses are known [missing-argument]", self.message("error", "stewart.yaml", code=2))
        for pose, answer in (("angle=1", "'angle' is none of x, y, z, roll, pitch and yaw"), ("yow=1", "did you mean 'yaw'?"),
                             ("1,2,3,4,5,6,7", "at most x, y, z, roll, pitch and yaw can be given"),
                             ("x=0,y=0", "it must give x, y and z, and may give roll, pitch and yaw")):
            self.assertIn(answer, self.message("ik", "stewart.yaml", "--pose", pose, code=2))

    def workspace(self, *words):
        return json.loads(self.freeplay("analyze", "workspace", *words, "--json")[0])

    def test_an_arm_reaches_a_shell_of_two_spheres(self):
        self.write("arm.yaml", ARM)
        axes = [word for axis in "xyz" for word in ("--grid", axis + "=-0.54:0.54:7")]
        document = self.workspace("arm.yaml", *axes)
        self.assertEqual(["x", "y", "z", "roll", "pitch", "yaw", "reachable", "legs", "condition"], document["columns"])
        for row in document["rows"]:
            inside = 0.1 < math.hypot(*row[:3]) < 0.5
            self.assertEqual((inside, inside), (row[6] == 1, row[8] is not None), row)
        summary, count = document["summary"], sum(row[6] for row in document["rows"])
        self.assertAlmostEqual(count * 0.18 ** 3, summary["volume"], 12)
        self.assertEqual((1, 1), (summary["regions"], summary["holes"]))  # the middle, which the arm cannot fold back to
        self.assertEqual({axis: [-0.36, 0.36] for axis in "xyz"},
                         {axis: [round(end, 9) for end in ends] for axis, ends in summary["bounds"].items()})

    def test_a_section_has_an_area_a_boundary_and_a_map(self):
        self.write("arm.yaml", ARM)
        section = ("--grid", "x=0.02:0.54:14", "--grid", "z=-0.54:0.54:28", "--grid", "y=0.15:0.15:1")
        summary = self.workspace("arm.yaml", *section)["summary"]
        self.assertAlmostEqual(math.pi / 2 * (0.25 - 0.0225), summary["area"], delta=0.01)
        self.assertGreater(len(summary["boundary"]), 20)
        for x, y, z in summary["boundary"]:
            self.assertAlmostEqual(0.15, y, 12)
            self.assertAlmostEqual(0.5, math.hypot(x, y, z), delta=1e-6)
        self.freeplay("analyze", "workspace", "arm.yaml", *section, "--svg", "map.svg", "--out", "map.csv")
        drawn = self.read("map.svg")
        for words in (">x [mm]</text>", ">z [mm]</text>", "condition number, y 0.15 m", "out of reach"):
            self.assertIn(words, drawn)
        self.assertIn("on a grid of two of x, y and z", self.message("workspace", "arm.yaml", *section[:4], "--grid", "y=0:0.1:2", "--svg", "no.svg", code=2))

    def test_a_delta_robot_reaches_where_every_arm_does(self):
        base, top, arm, rod = 0.2, 0.05, 0.25, 0.55
        document = self.workspace(os.path.join(MECHANISMS, "spatial", "delta.yaml"), "--frame", "platform", "--grid", "x=-0.45:0.45:5",
                                  "--grid", "y=-0.4:0.4:5", "--grid", "z=-0.8:-0.2:4")
        reached = set()
        for row in document["rows"]:
            legs = 0
            for k in range(3):  # u cos(q) + h sin(q) = s of a corner u outside the shoulder, v beside and h below it
                c, s = math.cos(2 * math.pi * k / 3), math.sin(2 * math.pi * k / 3)
                u, v, h = row[0] * c + row[1] * s + top - base, row[1] * c - row[0] * s, -row[2]
                legs += abs(u * u + v * v + h * h + arm * arm - rod * rod) <= 2 * arm * math.hypot(u, h)
            self.assertEqual(legs == 3, row[6] == 1, row)
            self.assertGreaterEqual(row[7], legs)  # by itself an arm may tilt the platform
            reached.add(legs)
        self.assertEqual({0, 1, 2, 3}, reached)

    def test_a_single_angle_among_the_outputs_leaves_the_condition_open(self):
        self.write("scara.yaml", """freeplay: 1
space: spatial
bodies:
  upper: {mass: 1, inertia: [1, 1, 1], frames: {end: [0.3, 0, 0]}}
  lower: {mass: 1, inertia: [1, 1, 1], frames: {end: [0.2, 0, 0]}}
  wrist: {mass: 1, inertia: [1, 1, 1]}
  quill: {mass: 1, inertia: [1, 1, 1]}
joints:
  first: {type: revolute, between: [ground, upper]}
  second: {type: revolute, between: [upper/end, lower]}
  hand: {type: revolute, between: [lower/end, wrist]}
  stroke: {type: prismatic, axis: [0, 0, 1], between: [wrist, quill]}
initial: {joints: {first: 0, second: 60 deg}}
analysis: {frame: quill, joints: [first, second, hand, stroke]}
""")
        out, err = self.freeplay("analyze", "workspace", "scara.yaml", "--grid", "x=-0.56:0.56:5", "--grid", "y=-0.42:0.42:4", "--grid", "z=0.1:0.1:1",
                                 "--grid", "yaw=0.5:0.5:1", "--svg", "map.svg")
        self.assertIn("the condition is known with all angles as outputs or with none, not with x, y, z and yaw: it is empty", err)
        rows = list(csv.DictReader(io.StringIO(out)))
        for row in rows:
            self.assertEqual(0.1 < math.hypot(float(row["x"]), float(row["y"])) < 0.5, row["reachable"] == "1")
            self.assertEqual("", row["condition"])

    def test_arm_reaches_as_far_as_its_links(self):
        self.write("arm.yaml", ARM)
        row, = self.rows("ik", "arm.yaml", "--pose", "x=0.2,y=0.2,z=0.1")
        bend = -math.acos((0.2 ** 2 + 0.2 ** 2 + 0.1 ** 2 - 0.3 ** 2 - 0.2 ** 2) / (2 * 0.3 * 0.2))
        self.assertAlmostEqual(math.pi / 4, float(row["joint.yaw.angle"]), 10)
        self.assertAlmostEqual(bend, float(row["joint.bend.angle"]), 10)
        self.assertIn("does not reach it", self.message("ik", "arm.yaml", "--pose", "x=0.4,y=0.4,z=0.1", code=4))
        row, = self.rows("singularity", "arm.yaml", "--pose", "x=0.2,y=0.2,z=0.1")
        self.assertEqual("none", row["kind"])
        err = self.message("singularity", "arm.yaml", "--pose", "x=0.2,z=0.1,yaw=1", code=3)
        self.assertIn("with all angles as outputs or with none, not with x, z and yaw [type-space]", err)


if __name__ == "__main__":
    unittest.main()
