"""SDFormat files: loops, frames, gears and screws against twins and equations of their own; messages; side-cars."""
import json
import math
import os
import random
import unittest

from robot_twins import TwinTest, closed_four_bar


class SdfTest(TwinTest):
    tolerance = 1e-9

    def model(self, text, name="r.sdf"):
        """The model that a file stands for, as `show` writes it."""
        return json.loads(self.freeplay("show", self.write(name, text), "--format", "json")[0])

    def complaint(self, text):
        return self.freeplay("validate", self.write("bad.sdf", text), code=3)[1]

    def remark(self, text):
        return self.freeplay("validate", self.write("remark.sdf", text))[1]


def sdf(inside, version="1.9"):
    return '<sdf version="%s">\n%s\n</sdf>\n' % (version, inside)


def model(inside, head='name="m"'):
    return "<model %s>\n%s\n</model>" % (head, inside)


def link(name, pose="", mass=1.0, com="0 0 0 0 0 0", moments=(0.1, 0.1, 0.1)):
    return """<link name="%s">%s<inertial><pose>%s</pose><mass>%r</mass>
<inertia><ixx>%r</ixx><iyy>%r</iyy><izz>%r</izz></inertia></inertial></link>
""" % (name, pose if pose.startswith("<") or not pose else "<pose>%s</pose>" % pose, com, mass, *moments)


def joint(name, kind, parent, child, axis="0 0 1", rest="", inside=""):
    axis = "<axis><xyz>%s</xyz>%s</axis>" % (axis, inside) if axis else ""
    return '<joint name="%s" type="%s"><parent>%s</parent><child>%s</child>%s%s</joint>\n' % (
        name, kind, parent, child, axis, rest)


def four_bar(joints=None):
    a, b, c = closed_four_bar()
    links = (link("crank", "0 0 0 0 0 %r" % a, 0.5, "0.05 0 0 0 0 0", (1, 1, 0.001))
             + link("coupler", '<pose relative_to="crank">0.1 0 0 0 0 %r</pose>' % (b - a), 1.5, "0.15 0 0 0 0 0", (1, 1, 0.02))
             + link("rocker", "0.4 0 0 0 0 %r" % c, 1.2, "0.125 0 0 0 0 0", (1, 1, 0.01)))
    joints = joints or [
        joint("A", "revolute", "world", "crank"),
        joint("B", "revolute", "crank", "coupler", inside="<dynamics><damping>0.02</damping></dynamics>"),
        joint("D", "continuous", "world", "rocker"),
        joint("C", "revolute", "coupler", "rocker", rest="<pose>0.25 0 0 0 0 0</pose>")]
    return sdf('<world name="w"><gravity>0 -9.81 0</gravity>%s</world>' % model(links + "".join(joints)))


def four_bar_twin():
    a, b, c = closed_four_bar()
    return """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {A: [0, 0], D: [0.4, 0]}}
  crank: {mass: 0.5, inertia: 0.001, com: [0.05, 0], frames: {A: [0, 0], B: [0.1, 0]}, pose: {angle: %r}}
  coupler: {mass: 1.5, inertia: 0.02, com: [0.15, 0], frames: {B: [0, 0], C: [0.3, 0]}, pose: {position: [%r, %r], angle: %r}}
  rocker: {mass: 1.2, inertia: 0.01, com: [0.125, 0], frames: {D: [0, 0], C: [0.25, 0]}, pose: {position: [0.4, 0], angle: %r}}
joints:
  A: {type: revolute, between: [ground/A, crank/A]}
  B: {type: revolute, between: [crank/B, coupler/B]}
  D: {type: revolute, between: [ground/D, rocker/D]}
  C: {type: revolute, between: [coupler/C, rocker/C]}
forces:
  damper: {type: spring-damper, kind: rotational, between: [crank/B, coupler/B], damping: 0.02}
""" % (a, 0.1 * math.cos(a), 0.1 * math.sin(a), b, c)


RUN = ("--end", "0.3 s", "--step", "0.5 ms")


class Loops(SdfTest):
    def test_a_four_bar_runs_like_its_twin_whatever_the_order_and_sense_of_its_joints(self):
        twin = self.columns(self.write("twin.yaml", four_bar_twin()), *RUN)
        damped = "<dynamics><damping>0.02</damping></dynamics>"
        at_tip = '<pose relative_to="rocker">0.25 0 0 0 0 0</pose>'
        orders = (
            None,
            # The rocker hangs on the coupler first, and the loop closes at the ground.
            [joint("C", "revolute", "coupler", "rocker", rest=at_tip), joint("A", "revolute", "world", "crank"),
             joint("B", "revolute", "crank", "coupler", inside=damped), joint("D", "revolute", "world", "rocker")],
            # The coupler is a child twice, which leaves the crank a child of none.
            [joint("B", "revolute", "coupler", "crank", rest='<pose relative_to="coupler"/>', inside=damped),
             joint("C", "revolute", "coupler", "rocker", rest=at_tip), joint("D", "revolute", "world", "rocker"),
             joint("A", "revolute", "world", "crank")],
        )
        for number, order in enumerate(orders):
            with self.subTest(order=order):
                rows = self.columns(self.write("r.sdf", four_bar(order)), *RUN)
                self.assert_same_motion(twin, rows)
                if number == 2:  # its C is turned round
                    continue
                for x, y in zip(twin["joint.C.fx"], rows["joint.C.fx"], strict=True):
                    self.assertAlmostEqual(x, y, delta=1e-8 * max(1.0, abs(x)))

    def test_a_joint_keeps_the_sense_of_its_coordinate_when_it_is_turned_round(self):
        """b hangs on the ground and a on b; a file that says that b hangs on a says the same with the axis reversed."""
        spring = "<dynamics><spring_stiffness>4</spring_stiffness><spring_reference>0.3</spring_reference></dynamics>"
        motions = []
        for last in (joint("j", "revolute", "a", "b", "0 1 0", '<pose relative_to="a"/>', spring),
                     joint("j", "revolute", "b", "a", "0 -1 0", "", spring)):
            text = sdf(model(link("b", "", 1, "0.1 0 0 0 0 0") + link("a", "0.2 0 0 0 0 0", 1, "0.1 0 0 0 0 0")
                             + joint("g", "revolute", "world", "b", "0 1 0") + last))
            motions.append(self.columns(self.write("r.sdf", text), *RUN))
        self.assertGreater(abs(motions[0]["joint.j.angle"][-1]), 0.1)
        self.assert_same_motion(*motions)


class Frames(SdfTest):
    def test_poses_relative_to_frames_joints_and_nested_models_place_like_plain_numbers(self):
        for seed in range(3):
            with self.subTest(seed=seed):
                rng = random.Random(seed)

                def pose():
                    return [rng.uniform(-1, 1) for _ in range(3)] + [rng.uniform(-1.4, 1.4) for _ in range(3)]

                poses = {name: pose() for name in ("model", "frame", "inner", "a", "b", "j", "mount")}
                text = {name: " ".join(map(repr, numbers)) for name, numbers in poses.items()}
                inner = model(link("b", '<pose relative_to="mount">%s</pose>' % text["b"])
                              + '<frame name="mount" attached_to="b"><pose relative_to="__model__">%s</pose></frame>'
                              % text["mount"],
                              'name="inner"').replace("</model>", '<pose relative_to="f">%s</pose></model>' % text["inner"])
                inside = ('<pose>%s</pose>' % text["model"] + link("a", '<pose relative_to="j">%s</pose>' % text["a"])
                          + '<frame name="f"><pose>%s</pose></frame>' % text["frame"] + inner
                          + joint("j", "ball", "inner::b", "a", "", '<pose relative_to="inner::mount">%s</pose>' % text["j"]))
                made = self.model(sdf(model(inside)))
                m, f, i = (matrix(poses[name]) for name in ("model", "frame", "inner"))
                mount = product(m, f, i, matrix(poses["mount"]))
                b = product(mount, matrix(poses["b"]))
                j = product(mount, matrix(poses["j"]))
                a = product(j, matrix(poses["a"]))
                self.assert_place(made["bodies"]["inner-b"]["pose"], b)
                frames = made["bodies"]["a"]["frames"]
                self.assert_place(frames["j"], product(inverse(a), j))
                self.assert_place(made["bodies"]["inner-b"]["frames"]["j"], product(inverse(b), j))

    def assert_place(self, pose, expected):
        for got, row in zip(pose["position"] if isinstance(pose, dict) else pose, expected):
            self.assertAlmostEqual(got, row[3], delta=1e-12)
        w, x, y, z = pose["quaternion"] if isinstance(pose, dict) else (1, 0, 0, 0)
        column = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
        for got, row in zip(column, expected):
            self.assertAlmostEqual(got, row[0], delta=1e-12)

    def test_an_axis_is_seen_in_the_frame_that_it_names_and_of_the_model_in_old_files(self):
        turned = '<frame name="f"><pose>0 0 0 0 1.5707963267948966 0</pose></frame>'

        def axis(version, xyz, rest="", frames="", pose=None):
            text = sdf(model(link("a", "0 0 0 1.5707963267948966 0 0") + frames + joint("g", "ball", "world", "b", "")
                             + link("b", "", 2) + '<joint name="j" type="revolute"><parent>b</parent><child>a</child>'
                             "<axis>%s%s</axis></joint>" % (xyz, rest)), version)
            made = self.model(text)["joints"]["j"].get("axis", [0, 0, 1])
            return [round(x, 12) + 0.0 for x in made]

        self.assertEqual(axis("1.9", "<xyz>0 1 0</xyz>"), [0, 1, 0])
        self.assertEqual(axis("1.9", '<xyz expressed_in="__model__">0 1 0</xyz>'), [0, 0, -1])
        # z of f is x of the model; x of the model is x of the joint, which is turned about it.
        self.assertEqual(axis("1.9", '<xyz expressed_in="f">0 0 1</xyz>', "", turned), [1, 0, 0])
        self.assertEqual(axis("1.6", "<xyz>0 1 0</xyz>"), [0, 1, 0])
        self.assertEqual(axis("1.6", "<xyz>0 1 0</xyz>", "<use_parent_model_frame>1</use_parent_model_frame>"), [0, 0, -1])
        self.assertEqual(axis("1.4", "<xyz>0 1 0</xyz>"), [0, 0, -1])

    def test_degrees_and_quaternions_turn_like_radians(self):
        half = math.sqrt(0.5)
        for pose in ("<pose>1 2 3 0 0 1.5707963267948966</pose>", '<pose degrees="true">1 2 3 0 0 90</pose>',
                     '<pose rotation_format="quat_xyzw">1 2 3 0 0 %r %r</pose>' % (half, half)):
            with self.subTest(pose=pose):
                made = self.model(sdf(model(link("a", pose))))["bodies"]["a"]["pose"]
                for got, want in zip(made["position"] + made["quaternion"], (1, 2, 3, half, 0, 0, half)):
                    self.assertAlmostEqual(got, want, delta=1e-12)

    def test_a_model_is_placed_by_the_frame_that_it_names(self):
        text = sdf(model("<pose>5 0 0 0 0 0</pose>" + link("a", "0 2 0 0 0 0") + link("b", "0 0 0 0 0 1")
                         + joint("j", "fixed", "a", "b", ""), 'name="m" placement_frame="a"'))
        made = self.model(text)["bodies"]
        self.assertEqual(made["a"]["pose"]["position"], [5, 0, 0])

    def test_a_frame_stands_on_the_link_that_carries_it(self):
        text = sdf(model(link("a", "1 0 0 0 0 0") + '<frame name="tip" attached_to="a"><pose>0 0 0.5 0 0 0</pose></frame>'
                         + '<frame name="still"><pose>0 0 7 0 0 0</pose></frame>' + joint("j", "revolute", "world", "a", "0 1 0")))
        made = self.model(text)["bodies"]
        self.assertEqual(made["a"]["frames"]["tip"], [0, 0.5])
        self.assertEqual(made["a"]["frames"]["still"], [-1, 7])


def matrix(pose):
    """R = Rz(yaw) Ry(pitch) Rx(roll) beside the place, as rows."""
    x, y, z, *angles = pose
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in angles)
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y], [-sp, cp * sr, cp * cr, z]]


def product(*factors):
    out = factors[0]
    for b in factors[1:]:
        out = [[sum(row[k] * b[k][j] for k in range(3)) + (row[3] if j == 3 else 0) for j in range(4)] for row in out]
    return out


def inverse(a):
    turn = [[a[j][i] for j in range(3)] for i in range(3)]
    return [[*row, -sum(row[k] * a[k][3] for k in range(3))] for row in turn]


class Joints(SdfTest):
    def test_a_model_that_nothing_holds_falls_with_the_gravity_of_sdformat(self):
        rows = self.columns(self.write("r.sdf", sdf(model(link("a", "0 0 3 0 0 0")))), "--end", "0.2 s", "--step", "1 ms")
        for t, z in zip(rows["time"], rows["body.a.z"], strict=True):
            self.assertAlmostEqual(z, 3 - 9.8 / 2 * t * t, delta=1e-9)

    def test_inertia_is_turned_into_the_axes_of_its_link(self):
        """By a quarter turn about z: x of the inertia is y of the link, and its y is -x."""
        inertia = "".join("<i%s>%s</i%s>" % (k, v, k) for k, v in dict(xx=0.3, yy=0.4, zz=0.5, xy=0.01, xz=0.02, yz=0.03).items())
        made = self.model(sdf(model('<link name="a"><inertial><pose degrees="true">0.1 0 0 0 0 90</pose><mass>2</mass>'
                                    "<inertia>%s</inertia></inertial></link>" % inertia)))["bodies"]["a"]
        self.assertEqual((made["mass"], made["com"]), (2, [0.1, 0, 0]))
        for got, want in zip(made["inertia"], (0.4, 0.3, 0.5, -0.01, -0.03, 0.02), strict=True):
            self.assertAlmostEqual(got, want, delta=1e-15)

    def test_a_static_model_is_ground(self):
        table = model("<static>1</static><pose>0 0 1 0 0 0</pose>" + link("top"), 'name="table"')
        robot = model(link("arm", "0 0 1 0 0 0", 1, "0.1 0 0 0 0 0"), 'name="robot"')
        world = sdf('<world name="w">%s%s%s</world>' % (table, robot, joint("j", "revolute", "table::top", "robot::arm", "0 1 0")))
        made = self.model(world)
        self.assertEqual(list(made["bodies"]), ["arm"])
        self.assertEqual(made["joints"]["j"]["between"], ["ground/j", "arm/j"])
        self.assertEqual(made["ground"]["frames"]["j"], [0, 1])

    def test_a_nut_falls_along_its_screw_by_its_own_equation(self):
        """m z'' + I phi''  with z = lead phi / (2 pi): z'' = -g m / (m + I (2 pi / lead)^2)."""
        turn = 0.02
        for pitch in ("<screw_thread_pitch>%r</screw_thread_pitch>" % turn, "<thread_pitch>%r</thread_pitch>" % (-2 * math.pi / turn)):
            text = sdf(model(link("nut", "", 3, moments=(1e-4, 1e-4, 1.5e-4)) + joint("s", "screw", "world", "nut", "0 0 1", pitch)))
            rows = self.columns(self.write("r.sdf", text), "--end", "0.2 s", "--step", "1 ms")
            fall = 9.8 * 3 / (3 + 1.5e-4 * (2 * math.pi / turn) ** 2)
            z, angle = rows["body.nut.z"], rows["joint.s.angle"]
            self.assertAlmostEqual(z[-1], -fall / 2 * 0.2 ** 2, delta=1e-8)
            self.assertAlmostEqual(angle[-1], 2 * math.pi / turn * z[-1], delta=1e-6)

    def test_a_universal_joint_keeps_its_energy_either_way_about(self):
        """The same pair written from either end moves alike."""
        ends = []
        for parent, child in (("world", "a"), ("a", "b")):
            text = sdf(model(link("a", "", 1, "0.3 0.2 0 0 0 0", (0.1, 0.12, 0.15))
                             + (link("b", "0 0 0 0 0 0", 2) if child == "b" else "")
                             + joint("u", "universal", parent, child, "1 0 0", "<axis2><xyz>0 1 0</xyz></axis2>")
                             + (joint("w", "fixed", "world", "b", "") if child == "b" else "")))
            rows = self.columns(self.write("r.sdf", text), "--end", "0.3 s", "--step", "0.5 ms")
            total = [k + p for k, p in zip(rows["energy.kinetic"], rows["energy.potential"])]
            self.assertGreater(max(rows["energy.kinetic"]), 0.1)
            self.assertLess(max(total) - min(total), 1e-5 * max(rows["energy.kinetic"]))
            ends.append((text, rows))
        # Written the other way about, the first axis is that of a: the twin has it as the second axis of its child.
        twin = ends[0][0].replace("<xyz>1 0 0</xyz>", "<xyz>0 -1 0</xyz>").replace(
            "<axis2><xyz>0 1 0</xyz></axis2>", "<axis2><xyz>1 0 0</xyz></axis2>")
        self.assert_same_motion({name: column for name, column in self.columns(
            self.write("twin.sdf", twin), "--end", "0.3 s", "--step", "0.5 ms").items() if "body.a" in name}, ends[1][1])

    def test_a_gearbox_ties_the_angles_from_its_reference(self):
        def wheels(gear, first=("base", "a")):
            return sdf(model(link("base") + link("a", "0 0 0 0 0 0", 1, "0.1 0 0 0 0 0") + link("b", "1 0 0 0 0 0", 2, "0 0.02 0 0 0 0")
                             + joint("w", "fixed", "world", "base", "")
                             + joint("ja", "revolute", *first, "0 1 0", '<pose relative_to="a"/>')
                             + joint("jb", "revolute", "base", "b", "0 1 0") + gear))

        gear = joint("g", "gearbox", "a", "b", "0 1 0", "<gearbox_ratio>2.5</gearbox_ratio>"
                     "<gearbox_reference_body>base</gearbox_reference_body><axis2><xyz>0 1 0</xyz></axis2>")
        for first in (("base", "a"), ("a", "base")):
            with self.subTest(first=first):
                rows = self.columns(self.write("r.sdf", wheels(gear, first)), *RUN)
                self.assertGreater(abs(rows["body.a.angle"][-1]), 0.01)
                for a, b in zip(rows["body.a.angle"], rows["body.b.angle"], strict=True):
                    self.assertAlmostEqual(b, -2.5 * a, delta=1e-9)
        err = self.complaint(wheels(gear.replace(">base<", ">a<")))
        self.assertIn("the gearbox 'g' needs two revolute joints along its axes", err)

    def test_a_follower_follows_with_offset_and_reference(self):
        mimic = '<mimic joint="ja"><multiplier>-2</multiplier><offset>0.3</offset><reference>-0.15</reference></mimic>'
        text = sdf(model(link("a", "", 1, "0.1 0 0 0 0 0") + link("b", "1 0 0 0 0 0") + joint("ja", "revolute", "world", "a", "0 1 0")
                         + joint("jb", "revolute", "world", "b", "0 1 0", inside=mimic)), "1.11")
        rows = self.columns(self.write("r.sdf", text), *RUN)
        for a, b in zip(rows["joint.ja.angle"], rows["joint.jb.angle"], strict=True):
            self.assertAlmostEqual(-b, -2 * (-a + 0.15) + 0.3, delta=1e-9)

    def test_limits_become_stops_with_their_stiffness(self):
        text = sdf(model(link("a", "", 1, "0.1 0 0 0 0 0") + joint("j", "revolute", "world", "a", inside=(
            "<limit><lower>-0.5</lower><upper>inf</upper><stiffness>3e4</stiffness></limit>"))))
        self.write("r.sdf", text)
        side = self.write("s.yaml", "freeplay: 1\nurdf: {file: r.sdf, limits: stop}\n")
        stop = json.loads(self.freeplay("show", side, "--format", "json")[0])["forces"]["j-stop"]
        self.assertEqual((stop["lower"], stop["upper"], stop["stiffness"]), (-0.5, 1e16, 3e4))
        self.assertIn("limits of joint 'j'", self.remark(text))


ARM = model(link("a", "", 1, "0.1 0 0 0 0 0") + joint("j", "revolute", "world", "a", "0 1 0"))


class Messages(SdfTest):
    def test_what_would_change_the_motion_is_named(self):
        text = sdf('<world name="w"><state/>%s</world>' % ARM.replace("</link>", """<gravity>0</gravity><kinematic>true</kinematic>
<velocity_decay><linear>1</linear></velocity_decay><sensor name="s" type="imu"/></link><plugin name="p" filename="x"/>"""))
        err = self.remark(text)
        for words in ("the gravity of link 'a' is not switched off", "the kinematic of link 'a'", "the velocity_decay of link 'a'",
                      "the stored state of the world is not used", "plugin 'p'", "sensor"):
            self.assertIn(words, err)
        self.assertRegex(err, r"remark\.sdf:\d+:\d+: warning")
        err = self.remark(sdf(model('<link name="a"/>' + joint("j", "revolute", "world", "a"))))
        self.assertIn("link 'a' says no mass and inertia; SDFormat takes 1 kg", err)

    def test_angles_in_degrees_are_doubted(self):
        bad = ARM.replace("</xyz>", "</xyz><limit><lower>-90</lower><upper>90</upper></limit>")
        self.assertIn("[doubtful-angle]", self.remark(sdf(bad)))
        self.assertIn("[doubtful-angle]", self.remark(sdf(model(link("a", "0 0 0 0 0 30")))))

    def test_mistakes_are_errors_with_their_places(self):
        def arm(old, new):
            self.assertIn(old, ARM)
            return sdf(ARM.replace(old, new))

        for text, words in (
                (sdf(ARM, "2.0"), "the version '2.0' of SDFormat is not read"),
                (sdf(ARM).replace(' version="1.9"', ""), "the attribute 'version' of the file is missing"),
                (arm('type="revolute"', 'type="revolut"'), "did you mean 'revolute'?"),
                (arm("<parent>world", "<parent>wrld"), "unknown frame 'wrld'"),
                (arm("<child>a", "<child>b"), "unknown frame 'b'"),
                (arm("<child>a", "<child>world"), "the world cannot be the child of joint 'j'"),
                (arm("<parent>world", "<parent>a"), "joint 'j' joins a link to itself"),
                (arm("0 1 0", "0 0 0"), "has zero length"),
                (arm("0 1 0", "0 1"), "'xyz' must be 3 numbers, not 2"),
                (arm("<mass>1", "<mass>1,0"), "'mass': '1,0' is not a number"),
                (arm("<link", '<lnik name="b"/><link'), "unknown element 'lnik' in model 'm'"),
                (arm("<pose>", '<pose degrees="yes">'), "'degrees' of a pose must be true or false, not 'yes'"),
                (arm("<mass>", "<mas>").replace("</mass>", "</mas>"), "unknown element 'mas' in the inertial of link 'a'"),
                (arm('<link name="a">', '<link name="world">'), "the name 'world' is one of SDFormat's own"),
                (arm("<link", '<frame name="a"/><link'), "the name 'a' exists already: first on line"),
                (arm("<link", '<frame name="f"><pose relative_to="g"/></frame><frame name="g"><pose relative_to="f"/></frame><link'),
                 "the place of 'g' depends on itself"),
                (arm("<link", '<frame name="f" attached_to="g"/><frame name="g" attached_to="f"/><link'), "is attached to itself"),
                (arm("<link", "<include><uri>model://x</uri></include><link"), "'include' of 'model://x' is not read"),
                (arm("<inertial>", '<inertial auto="true">'), "is to follow from shapes"),
                (arm('<link name="a">', '<link name="a"><pose relative_to="jj"/>'), "unknown frame 'jj'"),
                (sdf(ARM.replace('<link name="a">', '<link name="a"><pose frame="j"/>'), "1.6"), "'frame' of the pose of link 'a'"),
                (sdf(ARM.replace("<axis>", "<axix>").replace("</axis>", "</axix>")), "the element 'axis' of joint 'j' is missing"),
                (sdf("<world/>" + ARM), "a world and models beside it"),
                (sdf(""), "the file has no link"),
                (sdf(model(link("a") + joint("u", "universal", "world", "a", "1 0 0", "<axis2><xyz>1 1 0</xyz></axis2>"))),
                 "must be at a right angle"),
                (sdf(model(link("a") + joint("s", "screw", "world", "a"))), "needs a screw_thread_pitch"),
                ('<sdf version="1.9"><model></sdf>', "[bad-sdf]"),
        ):
            with self.subTest(words=words):
                err = self.complaint(text)
                self.assertIn(words, err)
                self.assertRegex(err, r"bad\.sdf:\d+:\d+: error")
                self.assertNotIn("urdf]", err)


    def test_the_root_element_says_the_format(self):
        err = self.complaint("<sfd/>")
        self.assertIn("bad.sdf:1:2: error: the root element must be 'robot', 'mujoco' or 'sdf', not 'sfd'", err)
        self.assertIn("did you mean 'sdf'?", err)


class Files(SdfTest):
    def test_a_file_becomes_yaml_that_moves_alike(self):
        self.write("r.sdf", four_bar())
        self.freeplay("convert", "r.sdf", "r.yaml")
        self.assert_same_motion(self.columns("r.sdf", *RUN), self.columns("r.yaml", *RUN))

    def test_a_result_keeps_the_file_and_can_be_made_again(self):
        self.write("r.sdf", sdf(ARM))
        self.freeplay("run", "r.sdf", "--out", "out", "--quiet", *RUN)
        self.assertEqual(self.read("out", "model.sdf"), sdf(ARM))
        self.freeplay("reproduce", "out")
        self.freeplay("report", "out")
        self.assertTrue(os.path.exists(os.path.join(self.folder, "out", "report.html")))


if __name__ == "__main__":
    unittest.main()
