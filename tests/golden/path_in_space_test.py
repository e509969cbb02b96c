"""A frame in space follows a path: from functions or a file of poses, ideal and with play."""
import bisect
import csv
import json
import math
import os
import re
import unittest

from model_cases import EXACT, ModelTest
from program import ROOT

OMEGA = 2 * math.pi / 0.5


def shipped(name, path, joints, more=""):
    """A file of mechanisms/spatial whose drivers give way to a path of the platform."""
    with open(os.path.join(ROOT, "mechanisms", "spatial", name + ".yaml"), encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"(?ms)^    drivers:\n.*?(?=^\w)", "", text)
    text = re.sub(r"(?m)^simulation:.*\n", "simulation: {end: 0.5, %s, output: {interval: 10 ms}}\n" % EXACT, text)
    return text + "drivers: {path: {inverse_kinematics: {frame: platform, path: %s, joints: %s%s}}}\n" % (path, joints, more)


def natural_spline(times, values):
    """The spline of its own: second derivatives by elimination, value at any time of the table."""
    n = len(times)
    h = [b - a for a, b in zip(times, times[1:])]
    second, above, right = [0.0] * n, [0.0] * n, [0.0] * n
    for i in range(1, n - 1):
        slope = lambda k: (values[k + 1] - values[k]) / h[k]
        pivot = 2 * (h[i - 1] + h[i]) - h[i - 1] * above[i - 1]
        above[i] = h[i] / pivot
        right[i] = (6 * (slope(i) - slope(i - 1)) - h[i - 1] * right[i - 1]) / pivot
    for i in range(n - 2, 0, -1):
        second[i] = right[i] - above[i] * second[i + 1]

    def at(t):
        i = min(max(bisect.bisect_right(times, t) - 1, 0), n - 2)
        b = (t - times[i]) / h[i]
        a = 1 - b
        return (a * values[i] + b * values[i + 1] +
                ((a ** 3 - a) * second[i] + (b ** 3 - b) * second[i + 1]) * h[i] ** 2 / 6)
    return at


def turned(q, v):
    """The vector v turned by the unit quaternion q."""
    w, x, y, z = q
    c = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    first = c((x, y, z), v)
    second = c((x, y, z), [f + w * g for f, g in zip(first, v)])
    return [g + 2 * s for g, s in zip(v, second)]


class PathTest(ModelTest):
    def run_text(self, text, *options):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--out", "out", "--quiet", "--force", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {name: [float(x) for x in values] for name, *values in zip(*rows)}

    def write_poses(self, names, rows, file="poses.csv"):
        self.write(file, "\n".join([",".join(["time"] + names)] + [",".join("%.17g" % x for x in row) for row in rows]) + "\n")

    def assert_no_error(self, columns, tolerance=1e-9):
        for error in ("ex", "ey", "ez", "eangle"):
            self.assertLess(max(map(abs, columns["driver.path." + error])), tolerance, error)


def delta_arm(leg, x, y, z):
    """Elbow of a leg: where the arm's circle meets the sphere of the rod, in the plane of the arm."""
    at = math.radians(120 * (leg - 1))
    out, side = x * math.cos(at) + y * math.sin(at) + 0.05 - 0.2, y * math.cos(at) - x * math.sin(at)
    rod = math.sqrt(0.55 ** 2 - side ** 2)
    inside = math.acos((0.25 ** 2 + out ** 2 + z ** 2 - rod ** 2) / (2 * 0.25 * math.hypot(out, z)))
    return math.atan2(-z, out) - inside


class Delta(PathTest):
    def test_it_follows_functions_of_x_y_and_z(self):
        columns = self.run_text(shipped("delta", "{x: 0.08*sin(4*pi*t), y: 0.08*(1 - cos(4*pi*t)), z: -0.5 m + 20 mm*sin(4*pi*t)}",
                                        "leg*.shoulder"))
        x, y = (lambda t: 0.08 * math.sin(OMEGA * t)), (lambda t: 0.08 * (1 - math.cos(OMEGA * t)))
        z = lambda t: -0.5 + 0.02 * math.sin(OMEGA * t)
        for name, wanted in (("x", x), ("y", y), ("z", z)):
            self.assert_column(columns, "body.platform." + name, wanted, 1e-9)
        self.assert_column(columns, "body.platform.vz", lambda t: 0.02 * OMEGA * math.cos(OMEGA * t), 1e-9)
        for leg in (1, 2, 3):
            self.assert_column(columns, "joint.leg%d.shoulder.angle" % leg,
                               lambda t, leg=leg: delta_arm(leg, x(t), y(t), z(t)), 1e-9)
        self.assert_no_error(columns)

    def test_it_follows_a_file_of_places(self):
        times = [0.05 * i for i in range(11)]
        rows = [(t, 60 * math.sin(OMEGA * t), 300 * t * (0.5 - t), -500 - 40 * t) for t in times]
        self.write_poses(["x", "y", "z"], rows)
        columns = self.run_text(shipped("delta", "{file: poses.csv, unit: mm}", "leg*.shoulder"))
        splines = [natural_spline(times, [1e-3 * row[i] for row in rows]) for i in (1, 2, 3)]
        for name, spline in zip("xyz", splines):
            self.assert_column(columns, "body.platform." + name, spline, 1e-9)
        for leg in (1, 2, 3):
            self.assert_column(columns, "joint.leg%d.shoulder.angle" % leg,
                               lambda t, leg=leg: delta_arm(leg, *(spline(t) for spline in splines)), 1e-9)
        self.assert_no_error(columns)

    def test_the_analysis_follows_the_path_of_a_file(self):
        times = [0.05 * i for i in range(11)]
        rows = [(t, 0.06 * math.sin(OMEGA * t), 0.3 * t * (0.5 - t), -0.5 - 0.04 * t) for t in times]
        self.write_poses(["x", "y", "z"], rows)
        self.write("m.yaml", shipped("delta", "poses.csv", "leg*.shoulder"))
        splines = [natural_spline(times, [row[i] for row in rows]) for i in (1, 2, 3)]
        found = list(csv.DictReader(self.freeplay("analyze", "ik", "m.yaml", "--time", "0:0.5:8")[0].splitlines()))
        self.assertEqual(8, len(found))
        for row in found:
            place = [spline(float(row["time"])) for spline in splines]
            for leg in (1, 2, 3):
                self.assertAlmostEqual(delta_arm(leg, *place), float(row["joint.leg%d.shoulder.angle" % leg]), 9)

    def test_out_of_reach_says_where_and_when(self):
        self.write("m.yaml", shipped("delta", "{x: 0, y: 0, z: -0.5 - 1.2*t}", "leg*.shoulder"))
        # The arms and rods are in line at z = -sqrt(0.8^2 - 0.15^2).
        lost = (math.sqrt(0.8 ** 2 - 0.15 ** 2) - 0.5) / 1.2
        err = self.freeplay("run", "m.yaml", "--out", "out", "--quiet", code=4)[1]
        self.assertIn("ik-unreachable", err)
        t, z = re.search(r"cannot follow the path at t = (\S+) s, where x = 0 m, y = 0 m, z = (\S+) m", err).groups()
        self.assertAlmostEqual(lost, float(t), 3)
        self.assertAlmostEqual(-0.5 - 1.2 * lost, float(z), 3)


class Stewart(PathTest):
    JOINTS = "leg*.guide"

    def assert_pose(self, columns, pose):
        for i, name in enumerate("xyz"):
            self.assert_column(columns, "body.platform." + name, lambda t: pose(t)[0][i], 1e-9)
        for i, name in enumerate(("qw", "qx", "qy", "qz")):
            self.assert_column(columns, "body.platform." + name, lambda t: pose(t)[1][i], 1e-9)
        self.assert_legs(columns, pose)
        self.assert_no_error(columns)

    def assert_legs(self, columns, pose):
        """Each leg is as long as from its foot to its ball, at the pose of the platform."""
        for leg in range(1, 7):
            side = (-1) ** leg
            foot, ball = (math.radians(60 * leg + s * side * 20) for s in (1, -1))

            def length(t):
                place, q = pose(t)
                arm = turned(q, (0.2 * math.cos(ball), 0.2 * math.sin(ball), 0.0))
                return math.dist([p + a for p, a in zip(place, arm)], (0.4 * math.cos(foot), 0.4 * math.sin(foot), 0.0))

            self.assert_column(columns, "joint.leg%d.guide.position" % leg, length, 1e-9)

    def test_it_follows_functions_of_all_six(self):
        path = "{x: 0.04*sin(4*pi*t), y: 0.02*t, z: 0.5 + 0.05*t, roll: 0.1*t, pitch: 8 deg*sin(4*pi*t), yaw: 10 deg*sin(4*pi*t)}"
        columns = self.run_text(shipped("stewart", path, self.JOINTS), "--ideal", "all")

        def pose(t):
            r, p, y = 0.05 * t, math.radians(4) * math.sin(OMEGA * t), math.radians(5) * math.sin(OMEGA * t)
            cr, sr, cp, sp, cy, sy = (f(a) for a in (r, p, y) for f in (math.cos, math.sin))
            q = (cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr)
            return (0.04 * math.sin(OMEGA * t), 0.02 * t, 0.5 + 0.05 * t), q

        self.assert_pose(columns, pose)

    NAMES = ["x", "y", "z", "qw", "qx", "qy", "qz"]
    TIMES = [0.05 * i for i in range(11)]

    def poses(self, sign=lambda i: 1):
        rows = []
        for i, t in enumerate(self.TIMES):
            half, axis = 0.1 * math.sin(OMEGA * t), (0.6 * math.cos(3 * t), 0.6 * math.sin(3 * t), 0.8)
            q = [math.cos(half)] + [math.sin(half) * a for a in axis]
            rows.append([t, 0.03 * math.sin(OMEGA * t), 0.02 * t, 0.5 + 0.1 * t] + [sign(i) * x for x in q])
        return rows

    def spline_pose(self, rows):
        splines = [natural_spline(self.TIMES, [row[i] for row in rows]) for i in range(1, 8)]

        def pose(t):
            place, q = [s(t) for s in splines[:3]], [s(t) for s in splines[3:]]
            return place, [x / math.hypot(*q) for x in q]
        return pose

    def test_it_follows_a_file_of_poses_whatever_the_signs_of_its_quaternions(self):
        self.write_poses(self.NAMES, self.poses(lambda i: (1, 1, -1, -1, 1)[i % 5]))
        columns = self.run_text(shipped("stewart", "poses.csv", self.JOINTS), "--ideal", "all")
        pose = self.spline_pose(self.poses())
        self.assert_pose(columns, pose)
        # Angular speed against a difference of the orientations, in axes of the world.
        step = 1e-5
        for k in (7, 23, 41):
            t = columns["time"][k]
            (a, b), q = (pose(t + s)[1] for s in (-step, step)), pose(t)[1]
            rate = [(y - x) / (2 * step) for x, y in zip(a, b)]
            w, x, y, z = q
            spin = [2 * (-rate[0] * x + rate[1] * w - rate[2] * z + rate[3] * y),
                    2 * (-rate[0] * y + rate[1] * z + rate[2] * w - rate[3] * x),
                    2 * (-rate[0] * z - rate[1] * y + rate[2] * x + rate[3] * w)]
            for name, value in zip(("wx", "wy", "wz"), spin):
                self.assertAlmostEqual(value, columns["body.platform." + name][k], 7)

    def test_with_play_the_errors_are_what_the_channels_of_the_platform_say(self):
        self.write_poses(self.NAMES, self.poses())
        text = shipped("stewart", "poses.csv", self.JOINTS).replace(EXACT, "accuracy: 1e-6").replace("end: 0.5", "end: 30 ms")
        text = text.replace("interval: 10 ms", "interval: 1 ms")
        columns = self.run_text(text)
        pose = self.spline_pose(self.poses())
        largest, widest = 0.0, 0.0
        for k, t in enumerate(columns["time"]):
            place, q = pose(t)
            for i, name in enumerate("xyz"):
                error = columns["body.platform." + name][k] - place[i]
                self.assertAlmostEqual(error, columns["driver.path.e" + name][k], 12)
            own = [columns["body.platform." + name][k] for name in ("qw", "qx", "qy", "qz")]
            apart = min(math.dist(own, q), math.dist([-x for x in own], q))
            self.assertAlmostEqual(4 * math.asin(apart / 2), columns["driver.path.eangle"][k], 12)
            largest = max(largest, math.hypot(*(columns["driver.path.e" + name][k] for name in "xyz")))
            widest = max(widest, columns["driver.path.eangle"][k])
        self.assertGreater(largest, 1e-5)
        self.assertGreater(widest, 1e-5)
        # No further than the bound of the analysis allows, for the play and what the balls give.
        self.write("m.yaml", text)
        bounds = list(csv.DictReader(self.freeplay("analyze", "error", "m.yaml", "--time", "0:0.03:4")[0].splitlines()))
        room = 1 + max(max(columns["joint.leg%d.socket.delta" % leg]) for leg in range(1, 7)) / 50e-6
        self.assertLess(largest, room * max(float(row["position"]) for row in bounds))
        self.assertLess(widest, room * max(float(row["dangle"]) for row in bounds))
        seen = json.loads(self.read("out", "summary.json"))["paths"]["path"]
        self.assertGreaterEqual(seen["max_position"], largest)
        self.assertLess(seen["max_position"], 1.2 * largest)
        self.assertGreaterEqual(seen["max_angle"], widest)


class Partly(PathTest):
    def test_an_arm_with_four_joints_follows_its_place_and_its_yaw(self):
        text = """freeplay: 1
space: spatial
bodies:
  upper: {mass: 1, inertia: [0.01, 0.01, 0.01], frames: {end: [0.3, 0, 0]}}
  lower: {mass: 1, inertia: [0.01, 0.01, 0.01], frames: {end: [0.2, 0, 0]}, pose: {rpy: [0, 0, 90 deg]}}
  quill: {mass: 1, inertia: [0.01, 0.01, 0.01]}
  hand: {mass: 1, inertia: [0.01, 0.01, 0.01]}
joints:
  shoulder: {type: revolute, between: [ground, upper]}
  elbow: {type: revolute, between: [upper/end, lower]}
  lift: {type: prismatic, between: [lower/end, quill], axis: [0, 0, 1]}
  wrist: {type: revolute, between: [quill, hand]}
drivers:
  path:
    inverse_kinematics:
      frame: hand
      path: {x: 0.3 + 0.05*sin(3*t), y: 0.2 - 0.05*cos(3*t), z: -0.1*t, yaw: 2*t}
      joints: [shoulder, elbow, lift, wrist]
simulation: {end: 1, %s}
""" % EXACT
        columns = self.run_text(text)
        x, y = (lambda t: 0.3 + 0.05 * math.sin(3 * t)), (lambda t: 0.2 - 0.05 * math.cos(3 * t))
        elbow = lambda t: math.acos((x(t) ** 2 + y(t) ** 2 - 0.13) / 0.12)
        shoulder = lambda t: math.atan2(y(t), x(t)) - math.atan2(0.2 * math.sin(elbow(t)), 0.3 + 0.2 * math.cos(elbow(t)))
        self.assert_column(columns, "joint.elbow.angle", elbow, 1e-9)
        self.assert_column(columns, "joint.shoulder.angle", shoulder, 1e-9)
        self.assert_column(columns, "joint.lift.position", lambda t: -0.1 * t, 1e-9)
        self.assert_column(columns, "joint.wrist.angle", lambda t: 2 * t - elbow(t) - shoulder(t), 1e-9)
        self.assert_no_error(columns)


class Mistakes(PathTest):
    def refused(self, path, more="", name="stewart", code=3):
        text = shipped(name, path, "leg*.guide" if name == "stewart" else "leg*.shoulder", more)
        self.write("m.yaml", text)
        out = json.loads(self.freeplay("validate", "m.yaml", "--json", "--ideal", "all", code=code)[0])
        return next(message for message in out["messages"] if message["severity"] == "error")

    def assert_bad_file(self, text, line, column, words, id="bad-table"):
        self.write("poses.csv", text)
        error = self.refused("poses.csv")
        self.assertEqual((id, line, column), (error["id"], error["line"], error["column"]), error)
        self.assertTrue(error["file"].endswith("poses.csv"), error)
        self.assertIn(words, error["message"])
        return error

    def test_files_of_poses_that_mean_nothing_are_refused_at_their_place(self):
        head, row = "time,x,y,z,qw,qx,qy,qz\n", "0,0,0,0.5,1,0,0,0\n"
        self.assert_bad_file(head + row + "1,0,0,0.5,0,0,0,0\n", 3, 11, "the quaternion has the length 0, not 1")
        self.assert_bad_file(head + row + "1,0,0,0.5,1,0.1,0,0\n", 3, 11, "the quaternion has the length 1.00499, not 1")
        self.assert_bad_file(head + row + "1,0,0,0.5,0,1,0,0\n", 3, 11, "half a turn since the row before")
        self.assert_bad_file("time,x,y,z,qw,qx,qy\n0,0,0,0.5,1,0,0\n", 1, 1, "the column 'qz' is missing")
        self.assert_bad_file(head + row, 2, 1, "at least 2 rows")
        error = self.assert_bad_file("time,x,y,z,qw,qx,qy,pz\n0,0,0,0.5,1,0,0,0\n", 1, 21, "'pz' is no column of a path", "unknown-name")
        self.assertIn("z", error["suggestion"])

    def test_functions_and_keys_that_do_not_fit_are_refused(self):
        self.assertEqual("unknown-key", self.refused("{x: 0, angle: 0}")["id"])
        self.assertEqual("dimension-mismatch", self.refused("{x: 0, y: 0, z: 1 s}")["id"])
        self.assertEqual("unknown-key", self.refused("{x: 0, unit: mm}")["id"])
        self.assertEqual("conflicting-keys", self.refused("{x: 0, file: poses.csv}")["id"])
        self.assertEqual("type-space", self.refused("{x: 0, y: 0, z: 0.5}", ", elbow: 1")["id"])
        self.assertEqual("missing-key", self.refused("{}")["id"])

    def test_a_path_that_leaves_freedoms_or_asks_for_too_many_is_refused(self):
        error = self.refused("{x: 0, y: 0, z: 0.5 m}")
        self.assertEqual("ik-underdetermined", error["id"])
        self.assertIn("still has 3 freedoms", error["message"])
        error = self.refused("{x: 0, y: 0, z: -0.5 m, roll: 0, pitch: 0, yaw: 0}", name="delta")
        self.assertEqual("ik-unreachable", error["id"])
        self.assertEqual("assembly-failed", self.refused("{x: 2 m, y: 0, z: -0.5 m}", name="delta")["id"])


if __name__ == "__main__":
    unittest.main()
