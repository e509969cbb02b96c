"""URDF robots that leave the plane: their dynamics against the recursive Newton-Euler method, and what the files say."""
import random
import unittest

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
       '<dynamics damping="%.3f"/>' % rng.uniform(0, 0.5) if moves and rng.random() < 0.6 else "")
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


if __name__ == "__main__":
    unittest.main()
