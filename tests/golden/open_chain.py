"""Open chains by the recursive Newton-Euler method, from the XML of a URDF file alone: what tests of robots in space
compare with. Everything is in world axes at one instant.

The accelerations are those for which the joint efforts are the given ones: a column of the mass matrix is the effort of
a unit acceleration without gravity and speed, the bias that of no acceleration (Featherstone 2008, Rigid Body Dynamics
Algorithms, tables 5.1 and 6.1)."""
import math
import xml.etree.ElementTree as tree


def add(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def scale(k, a):
    return [k * x for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def transform(m, a):
    return [dot(row, a) for row in m]


def multiply(a, b):
    return [[dot(row, column) for column in zip(*b)] for row in a]


def transposed(m):
    return [list(column) for column in zip(*m)]


def about(axis, angle):
    """Rotation by Rodrigues' formula."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis
    skew = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    square = multiply(skew, skew)
    return [[float(r == k) + s * skew[r][k] + (1 - c) * square[r][k] for k in range(3)] for r in range(3)]


def from_rpy(r, p, y):
    return multiply(about([0, 0, 1], y), multiply(about([0, 1, 0], p), about([1, 0, 0], r)))


def solve(m, b):
    """Gauss with row pivots."""
    rows = [list(row) + [value] for row, value in zip(m, b)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            f = rows[i][k] / rows[k][k]
            for c in range(k, n + 1):
                rows[i][c] -= f * rows[k][c]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][c] * x[c] for c in range(k + 1, n))) / rows[k][k]
    return x


def numbers(element, key, default):
    text = None if element is None else element.get(key)
    return [float(word) for word in text.split()] if text else list(default)


class Link:
    def __init__(self, xml):
        self.name = xml.get("name")
        self.mass, self.com, self.inertia = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]
        inertial = xml.find("inertial")
        if inertial is None:
            return
        origin = inertial.find("origin")
        self.mass = float(inertial.find("mass").get("value"))
        self.com = numbers(origin, "xyz", [0, 0, 0])
        turn = from_rpy(*numbers(origin, "rpy", [0, 0, 0]))
        i = {k: float(v) for k, v in inertial.find("inertia").items()}
        own = [[i["ixx"], i["ixy"], i["ixz"]], [i["ixy"], i["iyy"], i["iyz"]], [i["ixz"], i["iyz"], i["izz"]]]
        self.inertia = multiply(turn, multiply(own, transposed(turn)))  # axes of the link


class Joint:
    def __init__(self, xml):
        self.name, self.type = xml.get("name"), xml.get("type")
        self.parent, self.child = xml.find("parent").get("link"), xml.find("child").get("link")
        origin = xml.find("origin")
        self.place = numbers(origin, "xyz", [0, 0, 0])
        self.turn = from_rpy(*numbers(origin, "rpy", [0, 0, 0]))
        axis = numbers(xml.find("axis"), "xyz", [1, 0, 0])
        self.axis = scale(1 / math.sqrt(dot(axis, axis)), axis) if any(axis) else [1.0, 0.0, 0.0]
        dynamics = xml.find("dynamics")
        self.damping = 0.0 if dynamics is None else float(dynamics.get("damping", 0))
        self.friction = 0.0 if dynamics is None else float(dynamics.get("friction", 0))
        self.slides, self.turns = self.type == "prismatic", self.type in ("revolute", "continuous")
        self.moves = self.slides or self.turns

    def loss(self, speed):
        """Effort of damping and of Coulomb friction, whose change of sign is smoothed by 1e-3 m/s or rad/s."""
        return -self.damping * speed - self.friction * math.tanh(speed / 1e-3)


class Motion:
    """Pose, twist and acceleration of a link's frame."""

    def __init__(self):
        self.turn, self.place = about([0, 0, 1], 0.0), [0.0] * 3
        self.w, self.v, self.alpha, self.a = [0.0] * 3, [0.0] * 3, [0.0] * 3, [0.0] * 3

    def at(self, arm):
        """Velocity and acceleration of a point at `arm` from the origin."""
        return (add(self.v, cross(self.w, arm)),
                add(self.a, cross(self.alpha, arm), cross(self.w, cross(self.w, arm))))


class Robot:
    def __init__(self, text):
        root = tree.fromstring(text)
        self.links = {link.name: link for link in map(Link, root.findall("link"))}
        joints = [Joint(xml) for xml in root.findall("joint")]
        self.joint_of = {joint.child: joint for joint in joints}  # by child
        self.root = next(name for name in self.links if name not in self.joint_of)
        self.order, self.joints = [self.root], []
        for name in self.order:
            for joint in joints:
                if joint.parent == name:
                    self.order.append(joint.child)
                    self.joints.append(joint)  # each behind the joint that carries it
        self.free = [joint.name for joint in self.joints if joint.moves]

    def motions(self, q, speeds, accelerations, base):
        """Of every link; `base`: Motion of the root link."""
        out = {self.root: base}
        for joint in self.joints:
            parent, child = out[joint.parent], Motion()
            turn = multiply(parent.turn, joint.turn)
            axis = transform(turn, joint.axis)
            at, rate, rise = (x.get(joint.name, 0.0) for x in (q, speeds, accelerations))
            arm = transform(parent.turn, joint.place)
            child.w, child.alpha = parent.w, parent.alpha
            child.turn = turn
            if joint.turns:
                child.turn = multiply(turn, about(joint.axis, at))
                child.w = add(parent.w, scale(rate, axis))
                child.alpha = add(parent.alpha, scale(rise, axis), cross(parent.w, scale(rate, axis)))
            if joint.slides:
                arm = add(arm, scale(at, axis))
            child.place = add(parent.place, arm)
            child.v, child.a = parent.at(arm)
            if joint.slides:
                child.v = add(child.v, scale(rate, axis))
                child.a = add(child.a, scale(rise, axis), scale(2 * rate, cross(parent.w, axis)))
            out[joint.child] = child
        return out

    def wrenches(self, motions, gravity):
        """Force and moment about its origin that each link gets from what carries it."""
        force, moment = {}, {}
        for name in reversed(self.order):
            link, motion = self.links[name], motions[name]
            arm = transform(motion.turn, link.com)
            own = scale(link.mass, sub(motion.at(arm)[1], gravity))
            inertia = multiply(motion.turn, multiply(link.inertia, transposed(motion.turn)))
            spin = transform(inertia, motion.w)
            couple = add(transform(inertia, motion.alpha), cross(motion.w, spin))
            force[name], moment[name] = own, add(couple, cross(arm, own))
            for joint in self.joints:
                if joint.parent != name:
                    continue
                reach = sub(motions[joint.child].place, motion.place)
                force[name] = add(force[name], force[joint.child])
                moment[name] = add(moment[name], moment[joint.child], cross(reach, force[joint.child]))
        return force, moment

    def efforts(self, motions, gravity, floats):
        """Along every coordinate: those of the base first, if it floats, then those of the joints."""
        force, moment = self.wrenches(motions, gravity)
        out = force[self.root] + moment[self.root] if floats else []
        for joint in self.joints:
            if joint.moves:
                # The child's turn leaves the axis where it is.
                axis = transform(motions[joint.child].turn, joint.axis)
                out.append(dot((moment if joint.turns else force)[joint.child], axis))
        return out

    def accelerate(self, q, speeds, gravity, floats=False, base=None):
        """The motions of all links with the accelerations that gravity, damping and friction of the joints cause."""
        still, start = Motion(), base or Motion()
        still.turn, still.place = start.turn, start.place

        def with_base(of, rise):
            moved = Motion()
            moved.turn, moved.place, moved.w, moved.v = of.turn, of.place, of.w, of.v
            if floats:
                moved.a, moved.alpha = rise[:3], rise[3:6]
            return moved

        first = 6 if floats else 0
        size = first + len(self.free)

        def named(rise):
            return dict(zip(self.free, rise[first:]))

        columns = []
        for k in range(size):
            unit = [float(i == k) for i in range(size)]
            columns.append(self.efforts(self.motions(q, {}, named(unit), with_base(still, unit)), [0, 0, 0], floats))
        bias = self.efforts(self.motions(q, speeds, {}, with_base(start, [0.0] * size)), gravity, floats)
        given = [0.0] * first + [joint.loss(speeds.get(joint.name, 0.0)) for joint in self.joints if joint.moves]
        rise = solve(transposed(columns), sub(given, bias)) if size else []
        return self.motions(q, speeds, named(rise), with_base(start, rise))
