"""What tests of robots in space share: the program's accelerations at the start against those of open_chain.py."""
import csv
import math
import random
import re

from open_chain import Motion, Robot, add, cross, multiply, scale, solve, sub, transform, transposed
from program import ProgramTest


def model_name(name):
    """The name of a link or joint in a model."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)


def from_quaternion(w, x, y, z):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def carriers(robot, floats):
    """The body that each link is part of; None for ground."""
    root, out = robot.links[robot.root], {}
    out[root.name] = None if root.name in ("world", "ground") or root.mass == 0.0 else root.name
    assert not floats or out[root.name], "a floating root needs mass"
    for joint in robot.joints:
        link = robot.links[joint.child]
        frame = joint.type == "fixed" and link.mass == 0.0
        out[link.name] = out[joint.parent] if frame else link.name
    return out


class RobotTest(ProgramTest):
    GRAVITY = [1.0, -2.0, -9.81]

    def start(self, sidecar):
        """The row of the start of a run: column to number."""
        self.freeplay("run", sidecar, "--out", "out", "--quiet")
        header, first, *_ = csv.reader(self.read("out", "results.csv").splitlines())
        return {name: float(value) if value else math.nan for name, value in zip(header, first)}

    def sidecar(self, file, robot, seed, floats):
        """A model of the robot with all joints somewhere and moving; its name, coordinates and speeds."""
        rng = random.Random(seed)
        q = {name: rng.uniform(-0.6, 0.6) for name in robot.free}
        speeds = {name: rng.uniform(-2.0, 2.0) for name in robot.free}
        held = lambda values: "{%s}" % ", ".join("%s: %r" % (model_name(n), x) for n, x in values.items())
        text = """freeplay: 1
space: spatial
urdf: {file: %s, base: %s}
gravity: [%r, %r, %r]
initial: {joints: %s, speeds: %s}
simulation: {end: 1 us, step: 1 us}
""" % (file, "floating" if floats else "fixed", *self.GRAVITY, held(q), held(speeds))
        return self.write("robot.yaml", text), q, speeds

    @staticmethod
    def found_base(robot, columns):
        base, stem = Motion(), "body." + model_name(robot.root)
        base.w = [columns[stem + ".w" + k] for k in "xyz"]
        base.v = sub([columns[stem + ".v" + k] for k in "xyz"], cross(base.w, robot.links[robot.root].com))
        return base

    def assert_accelerates(self, file, text, seed, floats=False):
        """The robot of `text`, which stands in `file`, at some place and speed: places, accelerations and joint
        reactions are those of the recursive Newton-Euler method to 1e-10 of the largest."""
        robot = Robot(text)
        model, q, speeds = self.sidecar(file, robot, seed, floats)
        columns = self.start(model)
        # The velocity of a floating root follows from the speeds by the least kinetic energy: it is taken as found.
        base = self.found_base(robot, columns) if floats else Motion()
        motions = robot.accelerate(q, speeds, self.GRAVITY, floats=floats, base=base)
        force, moment = robot.wrenches(motions, self.GRAVITY)
        body_of = carriers(robot, floats)
        bodies = [name for name in robot.order if body_of[name] == name]
        expected, found = {}, {}

        def compare(kind, name, is_value, should):
            expected.setdefault(kind, []).extend(should)
            found.setdefault(kind, []).extend(is_value)

        def wrench(column):
            if column + ".fx" not in columns:
                return [0.0] * 3, [0.0] * 3
            return tuple([columns["%s.%s%s" % (column, kind, k)] for k in "xyz"] for kind in "ft")

        for name in bodies:
            link, motion, stem = robot.links[name], motions[name], "body." + model_name(name)
            arm = transform(motion.turn, link.com)
            centre = add(motion.place, arm)
            compare("place", name, [columns[stem + "." + k] for k in "xyz"], centre)
            turn = from_quaternion(*(columns[stem + ".q" + k] for k in "wxyz"))
            compare("turn", name, sum(turn, []), sum(motion.turn, []))
            compare("velocity", name, [columns[stem + ".v" + k] for k in "xyz"], motion.at(arm)[0])
            compare("angular velocity", name, [columns[stem + ".w" + k] for k in "xyz"], motion.w)
            # What acts on the body gives its acceleration.
            total, couple = scale(link.mass, self.GRAVITY), [0.0] * 3
            for joint in [None] + robot.joints:
                child = robot.root if joint is None else joint.child
                if joint is None and floats or body_of[child] != child:
                    continue
                sign = 1.0 if child == name else -1.0
                if sign < 0 and (joint is None or body_of[joint.parent] != name):
                    continue
                label = "base" if joint is None else model_name(joint.name)
                f, n = (add(*parts) for parts in zip(wrench("joint." + label), wrench("force." + label + "-damping"),
                                                     wrench("force." + label + "-friction")))
                total = add(total, scale(sign, f))
                couple = add(couple, scale(sign, add(n, cross(sub(motions[child].place, centre), f))))
                if child == name:
                    compare("force", name, f, force[name])
                    compare("moment", name, n, moment[name])
            inertia = multiply(motion.turn, multiply(link.inertia, transposed(motion.turn)))
            spin = transform(inertia, motion.w)
            compare("acceleration", name, scale(1 / link.mass, total), motion.at(arm)[1])
            compare("angular acceleration", name, solve(inertia, sub(couple, cross(motion.w, spin))), motion.alpha)
        for kind, values in expected.items():
            size = max(map(abs, values))
            worst = max(abs(a - b) for a, b in zip(values, found[kind], strict=True))
            self.assertLessEqual(worst, 1e-10 * size, "%s of %s: off by %.3g of %.3g" % (kind, file, worst, size))
        return len(bodies)
