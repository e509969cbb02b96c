"""URDF robots that leave the plane: their dynamics against the recursive Newton-Euler method, and what the files say."""
import csv
import json
import math
import os
import random
import unittest

from program import mechanism
from robot_cases import RobotTest


def triple(numbers):
    return " ".join("%.6f" % x for x in numbers)


def random_inertial(rng):
    """Of six point masses, so that some body has it."""
    points = [[rng.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(6)]
    weights = [rng.uniform(0.1, 1.0) for _ in points]
    i = {"ixx": 0.0, "iyy": 0.0, "izz": 0.0, "ixy": 0.0, "ixz": 0.0, "iyz": 0.0}
    for m, (x, y, z) in zip(weights, points):
        i["ixx"] += m * (y * y + z * z)
        i["iyy"] += m * (x * x + z * z)
        i["izz"] += m * (x * x + y * y)
        i["ixy"] -= m * x * y
        i["ixz"] -= m * x * z
        i["iyz"] -= m * y * z
    return """<inertial><origin xyz="%s" rpy="%s"/><mass value="%.6f"/><inertia %s/></inertial>""" % (
        triple(rng.uniform(-0.2, 0.2) for _ in range(3)), triple(rng.uniform(-3, 3) for _ in range(3)), sum(weights),
        " ".join('%s="%.9f"' % item for item in i.items()))


def random_robot(seed, root, joints=7):
    """A tree of links with any origins and axes; `root`: inside of its first link, whose name is base."""
    rng = random.Random(seed)
    text = '<link name="base">%s</link>\n' % (random_inertial(rng) if root else "")
    names = ["base"]
    for i in range(joints):
        name, kind = "l%d" % i, rng.choice(["revolute", "continuous", "prismatic", "fixed", "frame"])
        if i == 0 and kind in ("fixed", "frame"):
            kind = "continuous"
        text += '<link name="%s">%s</link>\n' % (name, "" if kind == "frame" else random_inertial(rng))
        moves = kind not in ("fixed", "frame")
        text += """<joint name="j%d" type="%s"><parent link="%s"/><child link="%s"/>
  <origin xyz="%s" rpy="%s"/>%s%s%s</joint>
""" % (i, kind if moves else "fixed", rng.choice(names[-3:]), name, triple(rng.uniform(-0.5, 0.5) for _ in range(3)),
       triple(rng.uniform(-3, 3) for _ in range(3)), '<axis xyz="%s"/>' % triple(
           rng.choice([[0, 0, 1], [1, 0, 0], [0, -1, 0], [rng.uniform(-1, 1), rng.uniform(-1, 1), 0.5]])) if moves else "",
       '<limit lower="-2" upper="2" effort="9" velocity="9"/>' if kind in ("revolute", "prismatic") else "",
       '<dynamics damping="%.3f" friction="%.3f"/>' % (rng.uniform(0, 0.5), rng.choice([0, rng.uniform(0, 0.5)]))
       if moves and rng.random() < 0.6 else "")
        names.append(name)
    return '<robot name="r">\n%s</robot>\n' % text


class Dynamics(RobotTest):
    def test_trees_on_ground_accelerate_as_newton_and_euler_say(self):
        for seed in range(12):
            with self.subTest(seed=seed):
                text = random_robot(seed, root=seed % 2)
                self.assert_accelerates(self.write("r.urdf", text), text, seed)

    def test_trees_that_float_accelerate_as_newton_and_euler_say(self):
        for seed in range(6):
            with self.subTest(seed=seed):
                text = random_robot(100 + seed, root=True)
                self.assert_accelerates(self.write("r.urdf", text), text, seed, floats=True)


BOX = """<inertial><mass value="2"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>"""


def robot(*content, root=""):
    return '<robot name="r">\n<link name="base">%s</link>\n%s\n</robot>\n' % (root, "\n".join(content))


def link(name, inside=BOX):
    return '<link name="%s">%s</link>' % (name, inside)


def joint(name, kind, parent, child, axis="", inside="", origin=""):
    return '<joint name="%s" type="%s"><parent link="%s"/><child link="%s"/>%s%s%s%s</joint>' % (
        name, kind, parent, child, '<origin %s/>' % origin if origin else "", '<axis xyz="%s"/>' % axis if axis else "",
        '<limit lower="-0.2" upper="0.3" effort="50" velocity="9"/>' if kind in ("revolute", "prismatic") else "", inside)


# Planar in no plane.
TWIST = robot(link("a"), link("b"), joint("A", "continuous", "base", "a", "0 0 1"),
              joint("B", "continuous", "a", "b", "1 0 0", origin='xyz="0.3 0 0.1" rpy="0.2 0 0"'))


class SpaceTest(RobotTest):
    def sections(self, text, sidecar=None):
        self.write("r.urdf", text)
        name = "r.urdf" if sidecar is None else self.write("m.yaml", "freeplay: 1\n" + sidecar)
        return json.loads(self.freeplay("show", name, "--json")[0])

    def verdict(self, text, sidecar=None, code=0):
        self.write("r.urdf", text)
        name = "r.urdf" if sidecar is None else self.write("m.yaml", "freeplay: 1\n" + sidecar)
        return json.loads(self.freeplay("validate", name, "--json", code=code)[0])

    def errors(self, text, sidecar=None):
        return [m for m in self.verdict(text, sidecar, code=3)["messages"] if m["severity"] == "error"]

    def columns(self, model, *options):
        self.freeplay("run", model, "--out", "out", "--quiet", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {name: [float(x) if x else math.nan for x in values] for name, *values in zip(*rows)}

    def run_robot(self, text, sidecar, *options):
        self.write("r.urdf", text)
        return self.columns(self.write("m.yaml", "freeplay: 1\n" + sidecar), *options)


class Space(SpaceTest):
    def test_the_robot_decides_the_space_where_the_model_does_not(self):
        flat = TWIST.replace("1 0 0", "0 0 1").replace('rpy="0.2 0 0"', "")
        self.assertEqual("spatial", self.verdict(TWIST)["facts"]["space"])
        self.assertEqual([0, 0, -9.81], self.sections(TWIST)["gravity"])
        self.assertEqual("planar", self.verdict(flat)["facts"]["space"])
        for said, text, space in (("urdf: r.urdf", TWIST, "spatial"), ("urdf: r.urdf", flat, "planar"),
                                  ("urdf: r.urdf\nspace: spatial", flat, "spatial"),
                                  ("urdf: r.urdf\ngravity: [0, 0, -9.81]\nspace: spatial", TWIST, "spatial")):
            self.assertEqual(space, self.verdict(text, said)["facts"]["space"], said)
        for said in ("urdf: {file: r.urdf, plane: xz}", "urdf: r.urdf\nspace: planar", "urdf: r.urdf\ngravity: [0, -9.81]"):
            self.assertEqual({"urdf-not-planar"}, {m["id"] for m in self.errors(TWIST, said)}, said)
        self.assertEqual("unknown-key", self.errors(TWIST, "urdf: {file: r.urdf, plane: xy}\nspace: spatial")[0]["id"])

    def test_show_prints_how_frames_are_turned(self):
        self.write("r.urdf", TWIST)
        text, _ = self.freeplay("show", "r.urdf")
        self.assertRegex(text, r"frame B +\(0\.3, 0, 0\.1\) m  quaternion \(0\.995004165\d*, 0\.0998334166\d*, 0, 0\)")

    def test_what_floats_falls(self):
        text = robot(link("a"), joint("A", "floating", "base", "a", origin='xyz="1 2 3" rpy="0.1 0.2 0.3"'))
        for name, model in (("a", text), ("base", robot(root=BOX))):
            side = "urdf: {file: r.urdf, base: floating}\ngravity: [0, 0, -9.81]\nsimulation: {end: 0.2 s}\n"
            columns = self.run_robot(model, side)
            self.assertAlmostEqual((3 if name == "a" else 0) - 9.81 * 0.02, columns["body.%s.z" % name][-1], places=9)
            self.assertEqual(6, self.verdict(model, side)["facts"]["dof"])

    def test_a_planar_joint_slides_and_turns_in_its_plane_alone(self):
        text = robot(link("a"), joint("A", "planar", "base", "a", "0 1 1", origin='xyz="0 0 1"'))
        self.assertEqual(3, self.verdict(text)["facts"]["dof"])
        columns = self.columns("r.urdf", "--end", "0.2 s")
        # Down the slope of 45 degrees.
        self.assertAlmostEqual(1 - 0.5 * 9.81 / 2 * 0.04, columns["body.a.z"][-1], places=8)
        self.assertAlmostEqual(0.5 * 9.81 / 2 * 0.04, columns["body.a.y"][-1], places=8)
        self.assertEqual("type-space", self.errors(text, "urdf: r.urdf\nspace: planar")[0]["id"])

    def test_merged_links_move_as_one(self):
        text = robot(link("a"), link("b"), link("c"), joint("A", "continuous", "base", "a", "1 2 3"),
                     joint("B", "fixed", "a", "b", origin='xyz="0.1 0.2 0.3" rpy="1 2 3"'),
                     joint("C", "continuous", "b", "c", "0 1 0", origin='xyz="0.2 0 0.1" rpy="0 1 0"'))
        side = ("urdf: {file: r.urdf, merge_fixed: %s}\ngravity: [0, 0, -9.81]\n"
                "simulation: {end: 0.3 s, step: 0.1 ms, integrator: {type: bathe, newton: {tolerance: 1e-13}}}\n")
        apart, merged = (self.run_robot(text, side % word) for word in ("false", "true"))
        self.assertNotIn("body.b.x", merged)
        for name in ("joint.A.angle", "joint.C.angle", "body.c.x", "body.c.z", "joint.A.fz"):
            for x, y in zip(apart[name], merged[name], strict=True):
                self.assertLess(abs(x - y), 1e-9 * max(1.0, abs(x)), name)

    def test_a_follower_keeps_its_ratio(self):
        text = robot(link("a"), link("b"), joint("A", "continuous", "base", "a", "1 0 0"),
                     joint("B", "prismatic", "base", "b", "0 1 1", '<mimic joint="A" multiplier="-0.05" offset="0.3"/>'))
        columns = self.run_robot(text, "urdf: r.urdf\ngravity: [0, 0, -9.81]\nsimulation: {end: 0.2 s}\n")
        self.assertGreater(abs(columns["joint.A.angle"][-1]), 0.1)
        for angle, place in zip(columns["joint.A.angle"], columns["joint.B.position"], strict=True):
            self.assertAlmostEqual(0.3 - 0.05 * angle, place, places=9)

    def test_drivers_loops_and_clearance_come_from_the_sidecar(self):
        side = """urdf: r.urdf
gravity: [0, 0, -9.81]
bodies: {b: {frames: {tip: [0, 0.2, 0]}}}
joints: {B: {clearance: {radial_clearance: 0.1 mm, length: 20 mm, contact: {law: hertz, K: 1e9}}}}
drivers: {motor: {joint: A, kind: angle, value: 3*t}}
forces: {push: {type: force, at: b/tip, value: [0, 0, 5]}}
simulation: {end: 5 ms, step: 10 us}
"""
        columns = self.run_robot(TWIST, side)
        self.assertAlmostEqual(0.015, columns["joint.A.angle"][-1], places=9)
        self.assertIn("joint.B.ez", columns)
        loop = TWIST.replace("</robot>", """<constraint name="C" type="revolute"><parent link="b"/><child link="base"/>
<parent_origin xyz="0 0 0"/><child_origin xyz="0.3 0 0.1" rpy="0.2 0 0"/><axis xyz="1 0 0"/></constraint></robot>""")
        facts = self.verdict(loop)["facts"]
        self.assertEqual((3, 1, 15), (facts["joints"], facts["dof"], facts["constraints"]))

    def test_a_torque_on_a_joint_turns_its_child_about_the_axis(self):
        ball = BOX.replace("0.02", "0.03").replace("0.04", "0.03")
        text = robot(link("a", ball), joint("A", "continuous", "base", "a", "1 2 2", origin='rpy="0.4 0.5 0.6"'))
        side = "urdf: r.urdf\nspace: spatial\ndrivers: {d: {joint: A, kind: torque, value: 0.06*t}}\nsimulation: {end: 0.5 s}\n"
        columns = self.run_robot(text, side)
        for t, speed, x, y, z in zip(*(columns[k] for k in ("time", "joint.A.speed", "body.a.wx", "body.a.wy", "body.a.wz"))):
            self.assertAlmostEqual(t * t, speed, places=7)
            self.assertAlmostEqual(speed, math.sqrt(x * x + y * y + z * z), places=9)

    def test_a_gazebo_joint_stands_where_its_links_stand(self):
        text = TWIST.replace("</robot>", """<gazebo><joint name="C" type="revolute"><parent>base</parent><child>b</child>
<pose>0.1 0 0 0.4 0.5 0.6</pose><axis><xyz expressed_in="__model__">1 0 0</xyz></axis></joint></gazebo></robot>""")
        # The axis of B is that of C, in axes of the root: about it, the loop moves.
        self.assertEqual(1, self.verdict(text)["facts"]["dof"])
        self.assertEqual(0, self.verdict(text.replace('"__model__">1 0 0', '"__model__">0 1 0'))["facts"]["dof"])

    def test_limits_become_stops_on_request(self):
        for kind, axis, column in (("revolute", "0 1 0", "angle"), ("prismatic", "0 0 1", "position")):
            arm = BOX.replace("<mass", '<origin xyz="0.1 0 0"/><mass')
            text = robot(link("a", arm), joint("A", kind, "base", "a", axis, '<dynamics damping="0.5"/>'))
            side = "urdf: {file: r.urdf, limits: %s}\nspace: spatial\ngravity: [0, 0, -9.81]\nsimulation: {end: 2 s, step: 0.2 ms}\n"
            free, held = (self.run_robot(text, side % word)["joint.A." + column] for word in ("ignore", "stop"))
            self.assertGreater(max(map(abs, free)), 0.9)
            # 50 N m or N push a stop back by 0.01 rad or 1 mm; the weight is less, but falls onto it.
            self.assertLess(max(map(abs, held)), 0.35)
            # At rest on the stop: m g = k d, or m g r cos(angle) = k d.
            end, give = (0.3, 0.01) if kind == "revolute" else (-0.2, 1e-3)
            effort = 2 * 9.81 * (0.1 * math.cos(held[-1]) if kind == "revolute" else -1.0)
            self.assertAlmostEqual(end + effort / 50 * give, held[-1], delta=1e-4)


class Mistakes(SpaceTest):
    def test_impossible_inertias_are_refused_with_their_numbers_or_mended(self):
        for old, new, words in (('izz="0.04"', 'izz="0.09"', "0.02, 0.03, 0.09"), ('ixx="0.02"', 'ixx="-0.02"', "-0.02, 0.03, 0.04")):
            text = TWIST.replace(old, new, 1)
            found = self.errors(text)
            self.assertEqual(["out-of-range"], [m["id"] for m in found])
            self.assertIn(words, found[0]["message"])
            self.assertEqual(3, found[0]["line"])
            self.verdict(text, "urdf: {file: r.urdf, repair: inertia}\n")

    def test_axes_without_length_are_refused_and_others_made_unit_vectors(self):
        found = self.errors(TWIST.replace('"1 0 0"', '"0 0 0"'))
        self.assertEqual(("bad-urdf", 6), (found[0]["id"], found[0]["line"]))
        noted = self.verdict(TWIST.replace('"1 0 0"', '"3 0 4"'))["messages"]
        self.assertTrue(any("length 5" in m["message"] and m["line"] == 6 for m in noted), noted)
        self.assertFalse(any("length" in m["message"] for m in self.verdict(TWIST)["messages"]))
        self.assertEqual([0.6, 0, 0.8], self.sections(TWIST.replace('"1 0 0"', '"3 0 4"'))["joints"]["B"]["axis"])

    def test_a_link_called_ground_that_is_none_gets_another_name(self):
        text = TWIST.replace('"a"', '"ground"')
        self.assertIn("ground_", self.sections(text)["bodies"])
        self.assertIn("urdf-renamed", [m["id"] for m in self.verdict(text)["messages"]])

    def test_a_side_car_in_space_is_judged_in_space_where_its_robot_cannot_be_read(self):
        found = self.errors("<robot/>", "urdf: r.urdf\ngravity: [0, 0, -9.81]\nframes: {ground/x: [0, 0, 1]}\n")
        self.assertEqual({"bad-urdf"}, {m["id"] for m in found})


class Conversion(SpaceTest):
    def assert_same_run(self, model, end):
        self.freeplay("convert", model, "again.yaml", "--force", "--quiet")
        results = []
        for name in (model, "again.yaml"):
            self.freeplay("run", name, "--end", end, "--out", "out", "--quiet")
            results.append(self.read("out", "results.csv"))
        self.assertEqual(*results)

    def test_robots_in_space_become_models_that_move_the_same(self):
        for seed in range(3):
            self.write("r.urdf", random_robot(seed, root=True))
            self.assert_same_run("r.urdf", "20 ms")
        self.write("r.urdf", random_robot(3, root=True))
        self.write("m.yaml", "freeplay: 1\nurdf: {file: r.urdf, base: floating, limits: stop}\ngravity: [0, 1, -9.81]\n"
                   "bodies: {base: {velocity: {linear: [1, 2, 3], angular: [0.1, 0.2, 0.3]}}}\n")
        self.assert_same_run("m.yaml", "20 ms")

    def test_models_in_space_become_models_that_move_the_same(self):
        for name in ("heavy-top", "slider-crank", "spinning-tee"):
            self.assert_same_run(mechanism(os.path.join("spatial", name)), "10 ms")

    def test_names_that_are_numbers_change_no_number(self):
        text = TWIST.replace('"A"', '"0"').replace('"B"', '"1"').replace('"b"', '"2"')
        self.write("r.urdf", text)
        self.freeplay("convert", "r.urdf", "again.yaml", "--quiet")
        self.assertIn("gravity: [0, 0, -9.81]", self.read("again.yaml"))
        self.assertIn("[a/_1, _2/_1]", self.read("again.yaml"))


if __name__ == "__main__":
    unittest.main()
