"""MJCF files: loops, trees and geoms against twins, integrals and equations of their own; messages; side-cars."""
import json
import math
import os
import random
import unittest

from robot_twins import TwinTest, closed_four_bar


class MjcfTest(TwinTest):
    def model(self, text, name="r.xml"):
        """The model that a file stands for, as `show` writes it."""
        out, _ = self.freeplay("show", self.write(name, text), "--format", "json")
        return json.loads(out)

    def complaint(self, text):
        return self.freeplay("validate", self.write("bad.xml", text), code=3)[1]

    def remark(self, text):
        return self.freeplay("validate", self.write("remark.xml", text))[1]


def mujoco(world, rest=""):
    return "<mujoco>\n%s<worldbody>\n%s\n</worldbody>\n</mujoco>\n" % (rest, world)


def four_bar(loop, sites=("", "")):
    """In the plane xy, drawn closed, with angles in degrees."""
    a, b, c = (math.degrees(angle) for angle in closed_four_bar())
    body = """<body name="%s" pos="%s" euler="0 0 %r"><joint name="%s"%s/>
<inertial pos="%s 0 0" mass="%s" diaginertia="1 1 %s"/>%s"""
    return mujoco(
        body % ("crank", "0 0 0", a, "A", "", 0.05, 0.5, 0.001, "") +
        body % ("coupler", "0.1 0 0", b - a, "B", ' damping="0.02"', 0.15, 1.5, 0.02, sites[0]) + "</body></body>" +
        body % ("rocker", "0.4 0 0", c, "D", "", 0.125, 1.2, 0.01, sites[1]) + "</body>",
        '<option gravity="0 -9.81 0"/>\n').replace("</mujoco>", "<equality>%s</equality></mujoco>" % loop)


def four_bar_twin(ends="coupler/C, rocker/C"):
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
  C: {type: revolute, between: [%s]}
forces:
  damper: {type: spring-damper, kind: rotational, between: [crank/B, coupler/B], damping: 0.02}
""" % (a, 0.1 * math.cos(a), 0.1 * math.sin(a), b, c, ends)


RUN = ("--end", "0.4 s", "--step", "0.5 ms")


class Loops(MjcfTest):
    def test_a_four_bar_closed_by_connect_runs_like_its_twin(self):
        twins = {ends: self.columns(self.write("twin.yaml", four_bar_twin(ends)), *RUN)
                 for ends in ("coupler/C, rocker/C", "rocker/C, coupler/C")}
        for loop in ('<connect name="C" body1="coupler" body2="rocker" anchor="0.3 0 0"/>',
                     '<connect name="C" body1="rocker" body2="coupler" anchor="0.25 0 0"/>',
                     '<connect name="C" site1="one" site2="two"/>'):
            with self.subTest(loop=loop):
                text = four_bar(loop, ('<site name="one" pos="0.3 0 0"/>', '<site name="two" pos="0.25 0 0"/>'))
                robot = self.columns(self.write("r.xml", text), *RUN)
                twin = twins["rocker/C, coupler/C" if 'body1="rocker"' in loop else "coupler/C, rocker/C"]
                # The other end of the anchor is computed and may differ in the last digit; steps converge to 1e-10.
                self.assert_same_motion(twin, robot, 1e-9)
                for x, y in zip(twin["joint.C.fx"], robot["joint.C.fx"], strict=True):
                    self.assertAlmostEqual(x, y, delta=1e-8 * max(1.0, abs(x)))

    def test_a_connect_is_a_ball_and_socket_in_space(self):
        text = four_bar('<connect name="C" body1="coupler" body2="rocker" anchor="0.3 0 0"/>')
        self.write("r.xml", text)
        side = self.write("side.yaml", "freeplay: 1\nurdf: r.xml\nspace: spatial\n")
        self.assertEqual(self.model_of(side)["joints"]["C"]["type"], "spherical")
        twin = self.columns(self.write("twin.yaml", four_bar_twin()), *RUN)
        space = self.columns(side, *RUN)
        for name in ("body.crank.x", "body.coupler.y", "body.rocker.y"):
            for x, y in zip(twin[name], space[name], strict=True):
                self.assertAlmostEqual(x, y, delta=1e-8)

    def model_of(self, file):
        return json.loads(self.freeplay("show", file, "--format", "json")[0])

    def test_a_weld_holds_two_bodies_as_they_are_drawn_or_as_it_says(self):
        pair = """<body name="a"><joint name="j" axis="0 1 0"/><inertial mass="2" pos="0.3 0 0" diaginertia=".1 .1 .1"/></body>
<body name="b" pos="0.4 0 0"><freejoint/><inertial mass="1" pos="0.1 0 0" diaginertia=".2 .2 .2"/></body>"""
        one = """<body name="a"><joint name="j" axis="0 1 0"/><inertial mass="2" pos="0.3 0 0" diaginertia=".1 .1 .1"/>
<body name="b" pos="%s"><inertial mass="1" pos="0.1 0 0" diaginertia=".2 .2 .2"/></body></body>"""
        for place, weld in (("0.4 0 0", ""), ("0.4 0 0", 'relpose="0.4 0 0 1 0 0 0"')):
            text = mujoco(pair).replace("</mujoco>", '<equality><weld body1="a" body2="b" %s/></equality></mujoco>' % weld)
            expected = self.columns(self.write("one.xml", mujoco(one % place)), *RUN)
            welded = self.columns(self.write("two.xml", text), *RUN)
            # The pair with a body that floats is read in space, the other in the plane xz.
            for x, y in zip(expected["body.b.y"], welded["body.b.z"], strict=True):
                self.assertAlmostEqual(x, y, delta=1e-8)

    def test_joints_in_proportion_follow_each_other(self):
        arm = '<body name="%s" pos="%d 0 0"><joint name="%s"/><inertial mass="1" pos=".1 0 0" diaginertia="1 1 .1"/></body>'
        text = mujoco(arm % ("a", 0, "p") + arm % ("b", 1, "q"), '<option gravity="0 -9.81 0"/>').replace(
            "</mujoco>", '<equality><joint joint1="q" joint2="p" polycoef="0 -2 0 0 0"/></equality></mujoco>')
        rows = self.columns(self.write("r.xml", text), *RUN)
        self.assertGreater(abs(rows["joint.p.angle"][-1]), 0.01)
        for p, q in zip(rows["joint.p.angle"], rows["joint.q.angle"], strict=True):
            self.assertAlmostEqual(q, -2 * p, delta=1e-9)


def triple(numbers):
    return " ".join("%.6f" % x for x in numbers)


def random_tree(seed):
    """The same robot as URDF and as MJCF: any origins, axes and turned inertias."""
    rng = random.Random(seed)
    degrees = seed % 2 == 0
    bodies = {"base": []}
    urdf, inside = '<link name="base"/>', {}
    for i in range(5):
        name, parent = "l%d" % i, rng.choice(list(bodies)[-2:])
        place, turn, com, com_turn = ([rng.uniform(-s, s) for _ in range(3)] for s in (0.5, 3, 0.2, 3))
        mass, moments = rng.uniform(0.2, 2), [rng.uniform(0.02, 0.03) for _ in range(3)]
        axis, damping = [rng.uniform(-1, 1) for _ in range(3)], rng.uniform(0, 0.3)
        length = math.sqrt(sum(x * x for x in axis))
        axis = [x / length for x in axis]
        hinge = rng.random() < 0.7
        urdf += """<link name="%s"><inertial><origin xyz="%s" rpy="%s"/><mass value="%r"/>
<inertia ixx="%r" iyy="%r" izz="%r" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j%d" type="%s"><parent link="%s"/><child link="%s"/><origin xyz="%s" rpy="%s"/><axis xyz="%s"/>
<limit lower="-3" upper="3" effort="1" velocity="1"/><dynamics damping="%r"/></joint>
""" % (name, triple(com), " ".join(map(repr, com_turn)), mass, *moments, i, "revolute" if hinge else "prismatic", parent, name,
       triple(place), " ".join(map(repr, turn)), " ".join(map(repr, axis)), damping)
        unit = 180 / math.pi if degrees else 1.0
        inside[name] = (parent, """<body name="%s" pos="%s" euler="%s"><inertial pos="%s" euler="%s" mass="%r" diaginertia="%r %r %r"/>
<joint name="j%d" type="%s" axis="%s" damping="%r" range="%r %r"/>""" % (
            name, triple(place), " ".join(repr(x * unit) for x in turn), triple(com), " ".join(repr(x * unit) for x in com_turn),
            mass, *moments, i, "hinge" if hinge else "slide", " ".join(map(repr, axis)), damping,
            *((-3 * unit, 3 * unit) if hinge else (-3, 3))))
        bodies[name] = []

    def nested(parent):
        return "".join(text + nested(name) + "</body>\n" for name, (above, text) in inside.items() if above == parent)

    compiler = '<compiler eulerseq="XYZ"%s/>\n' % ("" if degrees else ' angle="radian"')
    return '<robot name="r">%s</robot>' % urdf, mujoco(nested("base"), compiler)


class Trees(MjcfTest):
    def test_trees_in_space_move_like_the_same_robot_in_urdf(self):
        for seed in range(4):
            with self.subTest(seed=seed):
                urdf, mjcf = random_tree(seed)
                short = ("--end", "0.1 s", "--step", "0.5 ms")
                expected = self.columns(self.write("r.urdf", urdf), *short)
                self.assert_same_motion(expected, self.columns(self.write("r.xml", mjcf), *short), 1e-9)

    def test_a_pendulum_with_a_spring_moves_by_its_own_equation(self):
        """I q'' = -m g l sin(q0 + q) - k (q - (springref - ref)) - d q', q from the drawn pose; by Runge and Kutta."""
        text = mujoco('<body name="p" pos="0 0 1" euler="0 30 0"><joint name="j" axis="0 1 0" pos="0 0 0.2" damping="0.05" '
                      'stiffness="3" springref="25" ref="10"/><geom type="capsule" fromto="0 0 0.2 0 0 -0.4" '
                      'size="0.03"/></body>')
        rows = self.columns(self.write("p.xml", text), "--end", "0.5 s", "--step", "0.2 ms")
        r, length = 0.03, 0.6
        tube, ball = 1000 * math.pi * r * r * length, 1000 * 4 / 3 * math.pi * r ** 3
        h = length / 2
        own = tube * (r * r / 4 + h * h / 3) + ball * (0.4 * r * r + h * h + 0.75 * h * r)
        mass, arm = tube + ball, 0.3
        inertia = own + mass * arm ** 2

        # About y a turn q of a rod that hangs along -z takes its end to -sin(q), and gravity brings it back.
        def rate(q, w):
            return (-mass * 9.81 * arm * math.sin(q + math.radians(30)) - 3 * (q - math.radians(15)) - 0.05 * w) / inertia

        q, w, step, way = 0.0, 0.0, 1e-4, [0.0]
        for _ in range(5000):
            k1, l1 = w, rate(q, w)
            k2, l2 = w + step / 2 * l1, rate(q + step / 2 * k1, w + step / 2 * l1)
            k3, l3 = w + step / 2 * l2, rate(q + step / 2 * k2, w + step / 2 * l2)
            k4, l4 = w + step * l3, rate(q + step * k3, w + step * l3)
            q, w = q + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4), w + step / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
            way.append(q)
        self.assertGreater(max(way) - min(way), 0.1)
        # In the plane xz an angle about y counts the other way.
        for t, angle in zip(rows["time"], rows["joint.j.angle"], strict=True):
            self.assertAlmostEqual(-angle, way[round(t / step)], delta=1e-5)

    def test_joints_of_one_body_are_one_joint(self):
        mass = '<inertial mass="1" pos="0.1 0.05 0" diaginertia=".01 .02 .025"/>'
        for joints, kind in (
                ('<joint name="a" axis="1 0 0"/><joint name="b" axis="0 1 0"/>', "universal"),
                ('<joint name="a" axis="1 0 0"/><joint name="b" axis="0 1 0"/><joint name="c" axis="0 0 1"/>', "spherical"),
                ('<joint name="a" type="slide" axis="1 0 0"/><joint name="b" axis="-1 0 0"/>', "cylindrical"),
                ('<joint name="a" type="slide" axis="1 0 0"/><joint name="b" type="slide" axis="0 0 1"/>'
                 '<joint name="c" axis="0 1 0"/>', "planar"),
                ('<joint name="a" type="ball"/>', "spherical")):
            with self.subTest(kind=kind):
                made = self.model(mujoco('<body name="p">%s%s</body>' % (joints, mass)))["joints"]
                self.assertEqual([joint["type"] for joint in made.values()], [kind])
        err = self.complaint(mujoco('<body name="p"><joint name="a"/><joint name="b" pos="1 0 0"/>%s</body>' % mass))
        self.assertIn("the joints 'a', 'b' of body 'p' together are no joint that is known here [bad-mjcf]", err)

    def test_a_double_pendulum_by_a_universal_joint_keeps_its_energy(self):
        text = mujoco('<body name="p"><joint name="a" axis="1 0 0"/><joint name="b" axis="0 1 0" pos="0 0 0"/>'
                      '<geom type="box" size="0.1 0.2 0.3" pos="0.3 0.2 0.1"/></body>')
        rows = self.columns(self.write("u.xml", text), "--end", "0.5 s", "--step", "0.5 ms")
        total = [k + p for k, p in zip(rows["energy.kinetic"], rows["energy.potential"])]
        self.assertGreater(max(rows["energy.kinetic"]), 1.0)
        self.assertLess(max(total) - min(total), 1e-5 * max(rows["energy.kinetic"]))


def gauss(function, low, high):
    """Exact for polynomials up to the fifth degree."""
    middle, half = (low + high) / 2, (high - low) / 2
    x = math.sqrt(0.6)
    return half * (5 * function(middle - half * x) + 8 * function(middle) + 5 * function(middle + half * x)) / 9


def slices(areas, ranges):
    """Volume and integrals of x^2, y^2, z^2 of a body by its slices: half axes a(z), b(z); `round` or square."""
    round_, axes = areas
    area = (lambda z: math.pi * axes(z)[0] * axes(z)[1]) if round_ else (lambda z: 4 * axes(z)[0] * axes(z)[1])
    share = 1 / 4 if round_ else 1 / 3
    out = []
    for part in (lambda z: 1, lambda z: share * axes(z)[0] ** 2, lambda z: share * axes(z)[1] ** 2, lambda z: z * z):
        out.append(sum(gauss(lambda z: area(z) * part(z), *one) for one in ranges))
    return out


class Geoms(MjcfTest):
    def test_geoms_weigh_what_integrals_over_their_slices_give(self):
        def ball(r):
            return lambda z: (math.sqrt(max(0.0, r * r - z * z)),) * 2

        def capsule(r, h):
            return lambda z: (math.sqrt(max(0.0, r * r - max(0.0, abs(z) - h) ** 2)),) * 2

        def ellipsoid(a, b, c):
            return lambda z: tuple(s * math.sqrt(max(0.0, 1 - (z / c) ** 2)) for s in (a, b))

        cases = {
            'type="sphere" size="0.2"': ((True, ball(0.2)), [(-0.2, 0.2)]),
            'size="0.2"': ((True, ball(0.2)), [(-0.2, 0.2)]),
            'type="capsule" size="0.1 0.3"': ((True, capsule(0.1, 0.3)), [(-0.4, -0.3), (-0.3, 0.3), (0.3, 0.4)]),
            'type="capsule" size="0.1" fromto="0 0 -0.3 0 0 0.3"': (
                (True, capsule(0.1, 0.3)), [(-0.4, -0.3), (-0.3, 0.3), (0.3, 0.4)]),
            'type="cylinder" size="0.1 0.3"': ((True, lambda z: (0.1, 0.1)), [(-0.3, 0.3)]),
            'type="box" size="0.1 0.2 0.3"': ((False, lambda z: (0.1, 0.2)), [(-0.3, 0.3)]),
            'type="ellipsoid" size="0.1 0.2 0.3"': ((True, ellipsoid(0.1, 0.2, 0.3)), [(-0.3, 0.3)]),
        }
        weighed = [(geom + weight, shape, density) for geom, shape in cases.items()
                   for weight, density in ((' density="700"', 700), ("", 1000), (' mass="3"', None))]
        bodies = self.model(mujoco("".join('<body name="b%d"><joint type="ball"/><geom %s/></body>' % (i, geom)
                                           for i, (geom, _, _) in enumerate(weighed))))["bodies"]
        for i, (geom, shape, density) in enumerate(weighed):
            with self.subTest(geom=geom):
                volume, xx, yy, zz = slices(*shape)
                density = density or 3 / volume
                body = bodies["b%d" % i]
                self.assertAlmostEqual(body["mass"], density * volume, delta=1e-12 * density)
                for got, want in zip(body["inertia"], (yy + zz, xx + zz, xx + yy), strict=False):
                    self.assertAlmostEqual(got, density * want, delta=1e-12 * density)

    def body(self, inside, compiler=""):
        """In space, since it hangs on a ball."""
        return self.model(mujoco('<body name="b"><joint type="ball"/>%s</body>' % inside, compiler))["bodies"]["b"]

    def test_several_geoms_weigh_like_the_body_that_they_make(self):
        whole = self.body('<geom type="box" size="0.1 0.2 0.3" pos="0.5 0 0"/>')
        halves = self.body('<geom type="box" size="0.1 0.2 0.15" pos="0.5 0 0.15"/>'
                           '<geom type="box" size="0.2 0.1 0.15" pos="0.5 0 -0.15" euler="0 0 90"/>')
        self.assertAlmostEqual(whole["mass"], halves["mass"], delta=1e-12)
        for key in ("com", "inertia"):
            for x, y in zip(whole[key], halves[key]):
                self.assertAlmostEqual(x, y, delta=1e-12)

    def test_the_compiler_says_whether_geoms_weigh(self):
        inertial, geom = '<inertial mass="7" diaginertia="1 1 1"/>', '<geom size="0.1" mass="2"/>'
        self.assertEqual(self.body(inertial + geom)["mass"], 7)
        self.assertEqual(self.body(inertial + geom, '<compiler inertiafromgeom="true"/>')["mass"], 2)
        self.assertEqual(self.body(geom + geom.replace("/>", ' group="3"/>'), '<compiler inertiagrouprange="0 1"/>')["mass"], 2)
        self.assertEqual(self.body(geom, '<compiler boundmass="5"/>')["mass"], 5)
        self.assertEqual(self.body(geom, '<compiler settotalmass="4"/>')["mass"], 4)
        err = self.complaint(mujoco('<body name="b"><joint/>%s</body>' % geom, '<compiler inertiafromgeom="false"/>'))
        self.assertIn("link 'b' has no mass", err)

    def test_meshes_are_refused_unless_they_weigh_nothing(self):
        mesh = '<geom type="mesh" mesh="m"%s/>'
        err = self.complaint(mujoco('<body name="b"><joint/>%s</body>' % mesh % ""))
        self.assertRegex(err, r"bad\.xml:3:\d+: error: the mass of a geom of body 'b', a mesh, is not computed here \[bad-mjcf\]")
        self.body(mesh % ' mass="0"' + '<geom size="1"/>')
        self.body(mesh % "" + '<inertial mass="1" diaginertia="1 1 1"/>')


class Inheritance(MjcfTest):
    def test_elements_inherit_from_classes(self):
        classes = """<default><geom density="100"/><joint damping="1"/>
<default class="arm"><geom type="box" size="0.1 0.1 0.1"/><default class="heavy"><geom density="500"/></default></default></default>
"""
        made = self.model(mujoco("""<body name="a" childclass="arm"><joint name="j"/><geom/>
<body name="b"><joint name="k" damping="2"/><geom class="heavy"/></body>
<frame childclass="heavy" pos="1 0 0"><body name="c"><joint name="l"/><geom/></body></frame></body>
<body name="d"><joint name="m"/><geom size="0.1"/></body>""", classes))
        masses = {name: body["mass"] for name, body in made["bodies"].items() if name != "ground"}
        for name, mass in {"a": 0.8, "b": 4.0, "c": 4.0, "d": 100 * 4 / 3 * math.pi * 1e-3}.items():
            self.assertAlmostEqual(masses[name], mass, delta=1e-12)
        dampings = {name: force["damping"] for name, force in made["forces"].items()}
        self.assertEqual(dampings, {"j-damping": 1, "k-damping": 2, "l-damping": 1, "m-damping": 1})
        err = self.complaint(mujoco('<body name="a"><joint/><geom class="hevy" size="1"/></body>', classes))
        self.assertIn("unknown class 'hevy'", err)
        self.assertIn("did you mean 'heavy'?", err)


ARM = '<body name="a"%s><joint name="j"%s/><inertial pos="0.1 0 0" mass="1" diaginertia="1 1 1"/></body>'


class Messages(MjcfTest):
    def test_angles_in_the_other_unit_are_doubted(self):
        self.assertIn("'range' of joint 'j': 1.57 counts in degrees, the unit of this file [doubtful-angle]",
                      self.remark(mujoco(ARM % ("", ' range="0 1.57"'))))
        self.assertIn("'range' of joint 'j': 90 counts in radians, the unit of this file [doubtful-angle]",
                      self.remark(mujoco(ARM % ("", ' range="0 90"'), '<compiler angle="radian"/>')))
        self.assertIn("'euler' of body 'a': 1.5708 counts in degrees", self.remark(mujoco(ARM % (' euler="0 0 1.5708"', ""))))
        for fine in (mujoco(ARM % ("", ' range="-90 90"')), mujoco(ARM % ("", ' range="0 1.57"'), '<compiler angle="radian"/>')):
            self.assertNotIn("doubtful", self.remark(fine))

    def test_degrees_and_radians_give_the_same_stops(self):
        self.write("d.xml", mujoco(ARM % ("", ' range="-90 45"')))
        self.write("r.xml", mujoco(ARM % ("", ' range="-1.5707963267948966 0.7853981633974483"'), '<compiler angle="radian"/>'))
        stops = []
        for name in ("d", "r"):
            side = self.write(name + ".yaml", "freeplay: 1\nurdf: {file: %s.xml, limits: stop}\n" % name)
            stops.append(json.loads(self.freeplay("show", side, "--format", "json")[0])["forces"]["j-stop"])
        self.assertEqual(*stops)
        self.assertEqual(stops[0]["lower"], -math.pi / 2)

    def test_what_would_change_the_motion_is_named(self):
        text = mujoco(ARM % (' gravcomp="1"', ' armature="0.1" range="0 45"')).replace(
            "</mujoco>", '<actuator><motor name="m" joint="j"/></actuator><tendon><fixed name="t"/></tendon>'
            '<equality><distance/></equality><keyframe><key/></keyframe></mujoco>')
        err = self.remark(text)
        for words in ("the armature of joint 'j'", "the gravcomp of body 'a'", "the equality distance", "motor of 'actuator' 'm'",
                      "fixed of 'tendon' 't'", "key of 'keyframe'", "limits of joint 'j'"):
            self.assertIn(words, err)
        self.assertRegex(err, r"remark\.xml:3:\d+: warning")

    def test_mistakes_are_errors_with_their_places(self):
        for text, words in (
                (mujoco(ARM % ("", ' dampng="1"')), "unknown attribute 'dampng' of joint 'j'"),
                (mujoco(ARM % ("", ' type="hnge"')), "did you mean 'hinge'?"),
                (mujoco(ARM % ("", ' axis="0 0 0"')), "the axis of joint 'j' has zero length"),
                (mujoco(ARM % ("", ' axis="0,0,1"')), "numbers are separated by blanks"),
                (mujoco(ARM % (' euler="0 0 1" quat="1 0 0 0"', "")), "says twice how it is turned"),
                (mujoco(ARM % ("", ' range="1 0"')), "needs a range from a lower to a higher end"),
                (mujoco(ARM % ("", ' damping="-1"')), "must not be negative"),
                (mujoco(ARM % ("", "") * 2), "the body 'a' exists already"),
                (mujoco('<include file="x.xml"/>' + ARM % ("", "")), "'include' of the file 'x.xml' is not read"),
                (mujoco("<replicate/>" + ARM % ("", "")), "'replicate' is not expanded"),
                (mujoco("<joint/>" + ARM % ("", "")), "the worldbody stands still"),
                (mujoco(ARM % ("", ""), '<compiler coordinate="global"/>'), "global coordinates are not read"),
                (mujoco(ARM % ("", "")).replace("</mujoco>", '<equality><connect body1="a" body2="bb" anchor="0 0 0"/></equality>'
                                                "</mujoco>"), "unknown body 'bb'"),
                (mujoco('<body name="a"><joint/><geom type="box" size="1 1"/></body>'), "must be 3 positive numbers"),
                (mujoco('<body name="a"><joint/></body>'), "link 'a' has no mass"),
                (mujoco(""), "the worldbody has no body"),
                ("<mujoco><worldbody></mujoco>", "[bad-mjcf]"),
        ):
            with self.subTest(words=words):
                err = self.complaint(text)
                self.assertIn(words, err)
                self.assertRegex(err, r"bad\.xml:\d+:\d+: error")
                self.assertNotIn("urdf]", err)


class Files(MjcfTest):
    def test_what_is_not_well_formed_is_what_its_first_tag_says(self):
        for text, word in (("<robot name='r'><mujoco/><link></robot>", "[bad-urdf]"), ("<mujoco><robot></mujoco>", "[bad-mjcf]"),
                           ("<sdf version='1.9'><mujoco></sdf>", "[bad-sdf]"), ("<link></robot>", "[bad-urdf]")):
            with self.subTest(text):
                self.assertIn(word, self.complaint(text))

    def test_a_file_becomes_yaml_that_moves_alike(self):
        self.write("r.xml", four_bar('<connect name="C" body1="coupler" body2="rocker" anchor="0.3 0 0"/>'))
        self.freeplay("convert", "r.xml", "r.yaml")
        self.assert_same_motion(self.columns("r.xml", *RUN), self.columns("r.yaml", *RUN))

    def test_a_result_keeps_the_file_and_can_be_made_again(self):
        text = mujoco(ARM % ("", ""))
        self.write("r.xml", text)
        self.freeplay("run", "r.xml", "--out", "out", "--quiet", *RUN)
        self.assertEqual(self.read("out", "model.xml"), text)
        self.freeplay("reproduce", "out")
        self.freeplay("report", "out")
        self.assertTrue(os.path.exists(os.path.join(self.folder, "out", "report.html")))

    def test_a_side_car_adds_to_a_file_and_takes_its_gravity(self):
        self.write("r.xml", mujoco(ARM % ("", ""), '<option gravity="1 2 3"/>'))
        side = self.write("s.yaml", "freeplay: 1\nurdf: {file: r.xml, plane: xz}\n".replace(", plane: xz", "")
                          + "bodies: {a: {frames: {tip: [0.2, 0]}}}\n")
        out, _ = self.freeplay("show", side, "--format", "json")
        made = json.loads(out)
        self.assertEqual(made["gravity"], [1, 2])
        self.assertIn("tip", made["bodies"]["a"]["frames"])


if __name__ == "__main__":
    unittest.main()
