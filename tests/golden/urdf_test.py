"""URDF files: loops in every dialect run like their YAML twins; messages; side-cars."""
import csv
import json
import math
import os
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest
from robot_twins import closed_four_bar

DATA = os.path.join(ROOT, "tests", "data", "urdf")

# The five-bar of five_bar_twin.yaml in the plane xz: the normal is -y, so the axes are 0 -1 0.
LINKS = {"left": (1, 0.1, 0.004), "right": (1, 0.1, 0.004), "left_rod": (0.5, 0.125, 0.003),
         "right_rod": (0.5, 0.125, 0.003)}
LOOPS = {
    "constraint": """<constraint name="tip" type="revolute">
    <parent link="left_rod"/> <parent_origin xyz="0.25 0 0" rpy="0 0 0"/> <parent_axis xyz="0 -1 0"/>
    <child link="right_rod"/> <child_origin xyz="0.25 0 0"/> <child_axis xyz="0 -1 0"/>
  </constraint>""",
    "loop": """<loop name="tip" type="revolute">
    <predecessor link="left_rod"><origin xyz="0.25 0 0"/></predecessor>
    <successor link="right_rod"><origin xyz="0.25 0 0"/></successor>
    <axis xyz="0 -1 0"/>
  </loop>""",
    "loop_joint": """<loop_joint name="tip" type="continuous">
    <axis xyz="0 -1 0"/>
    <link1 link="left_rod" xyz="0.25 0 0" rpy="0 0 0"/>
    <link2 link="right_rod" xyz="0.25 0 0" rpy="0 0 0"/>
  </loop_joint>""",
    "gazebo": """<gazebo>
    <joint name="tip" type="revolute">
      <parent>left_rod</parent> <child>right_rod</child>
      <pose>0.25 0 0 0 0 0</pose>
      <axis><xyz>0 -1 0</xyz></axis>
    </joint>
  </gazebo>""",
    "two-parents": """<link name="end"/>
  <joint name="weld" type="fixed">
    <parent link="right_rod"/> <child link="end"/> <origin xyz="0.25 0 0"/>
  </joint>
  <joint name="tip" type="continuous">
    <parent link="left_rod"/> <child link="end"/> <origin xyz="0.25 0 0"/> <axis xyz="0 -1 0"/>
  </joint>""",
}


def four_bar_loop(dialect):
    """The closing element of the four-bar of four_bar_loop.urdf, in the plane xy."""
    text = LOOPS[dialect].replace("0 -1 0", "0 0 1").replace('"tip"', '"C"')
    text = text.replace("left_rod", "coupler").replace("right_rod", "rocker")
    # 0.25 m is right for the rocker, which is where gazebo counts from; the coupler is 0.3 m long.
    if dialect == "gazebo":
        return text
    at = text.index("coupler")
    place = text.index("0.25 0 0", at)
    return text[:place] + "0.3 0 0" + text[place + len("0.25 0 0"):]


def link(name, mass, com, inertia):
    return """  <link name="%s">
    <inertial>
      <origin xyz="%s 0 0" rpy="0 0 0"/> <mass value="%s"/>
      <inertia ixx="%s" ixy="0" ixz="0" iyy="%s" iyz="0" izz="%s"/>
    </inertial>
  </link>""" % (name, com, mass, inertia / 2, inertia, inertia / 2)


def joint(name, parent, child, x, turn=0.0):
    return """  <joint name="%s" type="continuous">
    <parent link="%s"/> <child link="%s"/> <origin xyz="%r 0 0" rpy="0 %r 0"/> <axis xyz="0 -1 0"/>
  </joint>""" % (name, parent, child, x, -turn)


def knee_angles():
    """Angles of the rods, from the meeting point of two circles about the knees."""
    a, b = math.radians(100), math.radians(60)
    knees = [(0.2 * math.cos(a), 0.2 * math.sin(a)), (0.15 + 0.2 * math.cos(b), 0.2 * math.sin(b))]
    dx, dy = knees[1][0] - knees[0][0], knees[1][1] - knees[0][1]
    half = math.hypot(dx, dy) / 2
    height = math.sqrt(0.25 ** 2 - half ** 2)
    tip = (knees[0][0] + dx / 2 - dy / (2 * half) * height, knees[0][1] + dy / 2 + dx / (2 * half) * height)
    return a, b, [math.atan2(tip[1] - y, tip[0] - x) for x, y in knees]


def five_bar(dialect):
    """Links lie along x at coordinates zero, but for gazebo, whose joints stand where the tree puts them."""
    a, b, rods = knee_angles() if dialect == "gazebo" else (0.0, 0.0, [0.0, 0.0])
    parts = ['<robot name="five_bar">', '  <link name="base"/>'] + [link(n, *v) for n, v in LINKS.items()]
    parts += [joint("hip_left", "base", "left", 0.0, a), joint("hip_right", "base", "right", 0.15, b),
              joint("knee_left", "left", "left_rod", 0.2, rods[0] - a),
              joint("knee_right", "right", "right_rod", 0.2, rods[1] - b), "  " + LOOPS[dialect], "</robot>"]
    return "\n".join(parts) + "\n"


class UrdfTest(ProgramTest):
    def copy(self, name):
        with open(os.path.join(DATA, name), encoding="utf-8") as file:
            return self.write(name, file.read())

    def columns(self, model, *options, environment=None):
        """Results of a run: column names to numbers."""
        out = model + ".out"
        self.freeplay("run", model, "--out", out, "--quiet", *options, environment=environment)
        rows = list(csv.reader(self.read(out, "results.csv").splitlines()))
        return {name: [float(x) for x in values] for name, *values in zip(*rows)}

    def assert_same_motion(self, expected, actual):
        for name, values in expected.items():
            if not name.startswith("body."):
                continue
            turn = name.endswith(".angle")
            for x, y in zip(values, actual[name], strict=True):
                gap = math.remainder(x - y, 2 * math.pi) if turn else x - y
                self.assertLess(abs(gap), 1e-10 * max(1.0, abs(x)), name)


class Loops(UrdfTest):
    def test_a_four_bar_runs_like_its_twin(self):
        self.copy("four_bar_loop.urdf")
        twin = self.columns(self.copy("four_bar_twin.yaml"))
        robot = self.columns(self.copy("four_bar_sidecar.yaml"))
        self.assert_same_motion(twin, robot)
        for name in ("joint.C.fx", "joint.C.fy", "joint.A.angle", "force.D-damping.torque", "energy.kinetic"):
            for x, y in zip(twin[name], robot[name], strict=True):
                self.assertAlmostEqual(x, y, delta=1e-9 * max(1.0, abs(x)), msg=name)
        self.assertEqual(self.read("four_bar_loop.urdf"),
                         self.read("four_bar_sidecar.yaml.out", "inputs", "four_bar_loop.urdf"))

    def test_a_four_bar_in_every_dialect_runs_like_its_twin(self):
        twin = self.columns(self.copy("four_bar_twin.yaml"))
        sidecar, robot = self.read_data("four_bar_sidecar.yaml"), self.read_data("four_bar_loop.urdf")
        self.assertIn("  <loop ", robot)
        for dialect in LOOPS:
            with self.subTest(dialect=dialect):
                text = robot[:robot.index("  <loop ")] + "  " + four_bar_loop(dialect) + "\n</robot>\n"
                side = sidecar.replace("four_bar_loop.urdf", "{file: %s.urdf, loops: %s}" % (
                    dialect, "two-parents" if dialect == "two-parents" else "elements"))
                if dialect == "gazebo":
                    # Such a joint stands where the tree puts its link, so the tree stands closed.
                    a, coupler, rocker = closed_four_bar()
                    for name, place, turn in (("crank", "", a), ("coupler", "0.1 0 0", coupler - a),
                                              ("rocker", "0.4 0 0", rocker)):
                        old = '<child link="%s"/>\n' % name + ('    <origin xyz="%s"/>\n' % place if place else "")
                        self.assertIn(old, text)
                        text = text.replace(old, '<child link="%s"/>\n    <origin xyz="%s" rpy="0 0 %r"/>\n' % (
                            name, place or "0 0 0", turn))
                    side = re.sub(r"bodies:\n(  .*\n)+|initial: .*\n", "", side)
                self.write(dialect + ".urdf", text)
                self.assert_same_motion(twin, self.columns(self.write(dialect + ".yaml", side)))

    def test_a_five_bar_in_every_dialect_runs_like_its_twin(self):
        twin = self.columns(self.copy("five_bar_twin.yaml"))
        text = self.read("five_bar_twin.yaml")
        rest = text[text.index("forces:"):]
        for dialect in LOOPS:
            with self.subTest(dialect=dialect):
                self.write(dialect + ".urdf", five_bar(dialect))
                loops = "two-parents" if dialect == "two-parents" else "elements"
                head = "freeplay: 1\nurdf: {file: %s.urdf, plane: xz, loops: %s}\ngravity: [0, -9.81]\n" % (
                    dialect, loops)
                if dialect == "gazebo":
                    tail = rest[:rest.index("initial:")] + rest[rest.index("simulation:"):]
                else:
                    tail = rest + "bodies:\n  left_rod: {pose: {angle: 40 deg}}\n  right_rod: {pose: {angle: 130 deg}}\n"
                self.assert_same_motion(twin, self.columns(self.write(dialect + ".yaml", head + tail)))

    def test_a_second_parent_closes_a_loop_only_where_asked_for(self):
        second = """  <joint name="C" type="continuous">
    <parent link="coupler"/> <child link="tip"/> <origin xyz="0.3 0 0"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="weld" type="fixed"> <parent link="rocker"/> <child link="tip"/> <origin xyz="0.25 0 0"/> </joint>
"""
        text = self.read_data("four_bar_loop.urdf")
        text = text[:text.index("  <loop ")] + '  <link name="tip"/>\n' + "".join(
            reversed([p + "</joint>\n" for p in second.split("</joint>\n")[:2]])) + "</robot>\n"
        self.write("two.urdf", text)
        self.copy("four_bar_loop.urdf")
        sidecar = self.read_data("four_bar_sidecar.yaml")
        self.write("no.yaml", sidecar.replace("four_bar_loop.urdf", "two.urdf"))
        _, err = self.freeplay("validate", "no.yaml", code=3)
        self.assertRegex(err, r"two\.urdf:\d+:\d+: error: link 'tip' has two parents.*\[bad-urdf\]")
        self.write("yes.yaml", sidecar.replace("four_bar_loop.urdf", "{file: two.urdf, loops: two-parents}"))
        self.assert_same_motion(self.columns(self.copy("four_bar_twin.yaml")), self.columns("yes.yaml"))

    def read_data(self, name):
        with open(os.path.join(DATA, name), encoding="utf-8") as file:
            return file.read()

    def test_clearance_comes_from_the_sidecar(self):
        self.copy("four_bar_loop.urdf")
        text = self.read_data("four_bar_sidecar.yaml") + """joints:
  B: {clearance: {radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e9}}}
"""
        out, _ = self.freeplay("validate", self.write("play.yaml", text), "--json")
        facts = json.loads(out)["facts"]
        self.assertEqual((1, 6), (facts["clearance_joints"], facts["constraints"]))
        self.freeplay("validate", "play.yaml", "--ideal", "B")

    def test_a_robot_alone_runs_under_gravity_along_minus_z(self):
        self.write("bar.urdf", five_bar("gazebo"))
        self.freeplay("run", "bar.urdf", "--end", "1 ms", "--quiet")
        self.assertEqual(self.read("bar.urdf"), self.read("results", "bar", "model.urdf"))
        model = json.loads(self.freeplay("show", "bar.urdf", "--json")[0])
        self.assertEqual([0, -9.81], model["gravity"])

    def test_a_comma_locale_changes_no_byte(self):
        self.copy("four_bar_loop.urdf")
        model = self.copy("four_bar_sidecar.yaml")
        available = subprocess.run(["locale", "-a"], capture_output=True, text=True).stdout.lower()
        if "de_de" not in available:
            subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", self.path("de_DE.UTF-8")], check=True,
                           capture_output=True)
        german = {"LC_ALL": "de_DE.UTF-8", **({} if "de_de" in available else {"LOCPATH": self.folder})}
        self.columns(model)
        here = self.read(model + ".out", "results.csv")
        self.columns(model, environment=german)
        self.assertEqual(here, self.read(model + ".out", "results.csv"))


ARM = """<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0.1 0 0"/>
      <mass value="1"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    </inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""


class Messages(UrdfTest):
    def verdict(self, text, code=3):
        out, _ = self.freeplay("validate", self.write("arm.urdf", text), "--json", code=code)
        return json.loads(out)["messages"]

    def check(self, old, new, line, column, words):
        self.assertIn(old, ARM)
        messages = [m for m in self.verdict(ARM.replace(old, new, 1)) if m["severity"] == "error"]
        self.assertEqual((line, column), (messages[0]["line"], messages[0]["column"]), messages)
        self.assertRegex(messages[0]["message"], words)
        return messages[0]

    def test_mistakes_have_a_place_and_a_remedy(self):
        self.check('value="1"', 'value="0,5"', 7, 13, "not a number")
        self.check('value="1"', 'value="nan"', 7, 13, "not a finite number")
        self.check('value="1"', 'value="1e400"', 7, 13, "range")
        self.check('value="1"', 'value="-1"', 7, 13, "positive")
        self.assertEqual("value", self.check('value="1"', 'vaule="1"', 7, 8, "'value'.*missing").get("suggestion") or "value")
        self.check('xyz="0.1 0 0"', 'xyz="0.1 0"', 6, 15, "three numbers, not 2")
        self.check('xyz="0 0 1"', 'xyz="0 0 0"', 14, 11, "zero length")
        self.check('type="revolute"', 'type="revolut"', 11, 26, "unknown type")
        self.assertEqual("upper", self.check('child link="upper"', 'child link="uper"', 13, 12, "unknown link")["suggestion"])
        self.check('<limit lower="-1"', '<limit lower="2"', 15, 12, "above")
        self.check('    <limit lower="-1" upper="1" effort="1" velocity="1"/>\n', '', 11, 3, "'limit'.*missing")
        self.check('<link name="base"/>', '<link name="base"/>stray', 3, 22, "unexpected text")
        self.check('<link name="base"/>', '<link name="base"/><xacro:if value="1"/>', 3, 23, "not expanded")
        self.check('izz="0.01"', 'izz="-0.01"', 8, 62, "negative")
        self.check('</robot>', '', 2, 19, "never closed")
        self.check('<mass value="1"/>', '<mass value="1" value="2"/>', 7, 23, "given twice")
        self.check('<robot name="arm">', '<!DOCTYPE robot [<!ENTITY a "b">]>\n<robot name="arm">', 2, 1, "not allowed")

    def test_what_is_not_used_is_named(self):
        text = ARM.replace("</robot>", '<transmission name="t1"/><coupling name="tie"/><thing/></robot>')
        messages = self.verdict(text, code=0)
        words = " ".join(m["message"] for m in messages)
        for word in ("limits of joint 'shoulder'", "transmission 't1'", "coupling 'tie'", "thing"):
            self.assertIn(word, words)
        self.assertEqual({"urdf-ignored"}, {m["id"] for m in messages})
        self.assertEqual({"warning"}, {m["severity"] for m in messages})

    def test_limits_of_a_turn_that_look_like_degrees_are_doubted(self):
        for lower, upper, place in (("-90", "90", "lower"), ("0", "120", "upper"), ("-1", "87.5", "upper")):
            text = ARM.replace('lower="-1" upper="1"', 'lower="%s" upper="%s"' % (lower, upper))
            message = next(m for m in self.verdict(text, code=0) if m["id"] == "doubtful-angle")
            self.assertIn("'%s' of the limit of joint 'shoulder'" % place, message["message"])
            self.assertIn("not in degrees", message["message"])
        for lower, upper in (("-6.981317", "6.981317"), ("-12.566371", "31.415927"), ("-1e16", "1e16")):
            text = ARM.replace('lower="-1" upper="1"', 'lower="%s" upper="%s"' % (lower, upper))
            self.assertNotIn("doubtful-angle", {m["id"] for m in self.verdict(text, code=0)})

    def test_out_of_plane_joints_are_named_with_their_residual(self):
        second = ARM.replace("</robot>", """<link name="fore"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><axis xyz="0 0.1 1"/></joint></robot>""")
        self.write("arm.urdf", second)
        for said in ("urdf: {file: arm.urdf, plane: xy}", "urdf: arm.urdf\nspace: planar"):
            out, _ = self.freeplay("validate", self.write("arm.yaml", "freeplay: 1\n" + said + "\n"), "--json", code=3)
            message = [m for m in json.loads(out)["messages"] if m["severity"] == "error"][0]
            self.assertEqual("urdf-not-planar", message["id"])
            self.assertIn("0.0997 rad", message["message"])  # atan(0.1)
        near = self.verdict(second.replace("0 0.1 1", "0 0.000008 1"), code=0)
        self.assertTrue(any("8e-06 rad, of joint 'elbow'" in m["message"] for m in near), near)

    def test_impossible_inertia_can_be_mended(self):
        self.write("arm.urdf", ARM.replace('izz="0.01"', 'izz="-0.01"'))
        self.write("arm.yaml", "freeplay: 1\nurdf: {file: arm.urdf, repair: inertia}\n")
        _, err = self.freeplay("validate", "arm.yaml")
        self.assertIn("is mended", err)

    def test_sidecar_may_not_change_the_robot(self):
        self.write("arm.urdf", ARM)
        self.write("arm.yaml", """freeplay: 1
urdf: arm.urdf
bodies:
  upper: {mass: 2}
joints:
  shoulder: {type: fixed}
""")
        out, _ = self.freeplay("validate", "arm.yaml", "--json", code=3)
        found = [(m["file"], m["line"], m["column"], m["id"]) for m in json.loads(out)["messages"]
                 if m["severity"] == "error"]
        self.assertEqual([("arm.yaml", 4, 11, "unknown-key"), ("arm.yaml", 6, 14, "unknown-key")], found)

    def test_names_that_no_model_may_have_are_changed_and_said(self):
        messages = self.verdict(ARM.replace('name="shoulder"', 'name="the shoulder"'), code=0)
        self.assertIn("'the_shoulder'", next(m["message"] for m in messages if m["id"] == "urdf-renamed"))

    def test_massless_links_are_frames_on_fixed_joints_only(self):
        tip = ARM.replace("</robot>", """<link name="tip"/>
  <joint name="tip_joint" type="fixed"><parent link="upper"/><child link="tip"/><origin xyz="0.2 0 0"/></joint></robot>""")
        self.verdict(tip, code=0)
        model = json.loads(self.freeplay("show", "arm.urdf", "--json")[0])
        self.assertEqual([0.2, 0], model["bodies"]["upper"]["frames"]["tip"])
        self.assertEqual(["shoulder"], list(model["joints"]))
        messages = self.verdict(tip.replace('type="fixed"', 'type="continuous"'))
        self.assertIn("urdf-massless", [m["id"] for m in messages])

    def test_mimic_becomes_a_gear(self):
        text = ARM.replace("</robot>", """<link name="rack"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="rack"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="shoulder" multiplier="-0.05" offset="0.3"/></joint></robot>""")
        self.verdict(text, code=0)
        gear = json.loads(self.freeplay("show", "arm.urdf", "--json")[0])["joints"]["slide-mimic"]
        self.assertEqual({"type": "gear", "of": ["shoulder", "slide"], "ratio": -0.05, "offset": 0.3}, gear)
        start = json.loads(self.freeplay("validate", "arm.urdf", "--json")[0])["start"]
        self.assertAlmostEqual(start["rack"]["x"], 0.3 - 0.05 * start["upper"]["angle"], places=9)

    def test_mistakes_of_a_sidecar_are_named_beside_those_of_its_robot(self):
        sidecar = """freeplay: 1
urdf: {file: robot.urdf}
gravity: [0]
simulaton: {end: 1}
bodies: {upper: {frames: {tip: [1, 0]}}, extra: {mass: -1, inertia: 1}}
joints: {pin: {type: revolute, between: [upper/tip, extra]}}
"""
        own = [(3, "wrong-length"), (4, "unknown-key"), (5, "out-of-range")]
        for robot, place in ((None, ("model.yaml", 2)), ("<robot name='r'><link name='a'/></robbot>", ("robot.urdf", 1))):
            self.write("model.yaml", sidecar)
            if robot is not None:
                self.write("robot.urdf", robot)
            messages = json.loads(self.freeplay("validate", "model.yaml", "--json", code=3)[0])["messages"]
            places = [((os.path.basename(m["file"]), m["line"]), m["id"]) for m in messages]
            self.assertEqual([place], [at for at, _ in places if at not in [("model.yaml", n) for n, _ in own]], places)
            self.assertEqual(own, [(at[1], i) for at, i in places if (at[1], i) in own], places)

    def test_a_bad_value_of_the_section_hides_nothing_else(self):
        self.write("r.urdf", """<robot name="r"><link name="world"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="A" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 0 1"/></joint></robot>
""")
        for bad in ("limits: hold", "plane: xx", "base: loose", "loops: no", "repair: mass", "merge_fixed: 2"):
            self.write("m.yaml", "freeplay: 1\nurdf: {file: r.urdf, %s}\nframes: {b/x: [0, 0]}\n"
                       "joints: {A: {type: revolute}}\n" % bad)
            messages = json.loads(self.freeplay("validate", "m.yaml", "--json", code=3)[0])["messages"]
            self.assertEqual([(2, "wrong-type"), (3, "unknown-name"), (4, "unknown-key")],
                             [(m["line"], m["id"]) for m in messages if m["severity"] == "error"], bad)


if __name__ == "__main__":
    unittest.main()
