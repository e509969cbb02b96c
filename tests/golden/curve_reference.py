"""Two closed curves that touch, computed apart from Freeplay: points of contact by Newton's method for both angles, the
motion by the classical method of Runge and Kutta.

A curve is a function of the polar angle that gives distance, slope and bend. No tables and no support functions: the
places C_a(s) and C_b(u) are sought where the way between them is at a right angle to one curve, and both tangents are
parallel.
"""
import math


def circle(radius):
    return lambda x: (radius, 0.0, 0.0)


def ellipse(a, b):
    """About its centre: r = (cos^2/a^2 + sin^2/b^2)^(-1/2)."""
    def at(x):
        c, s = math.cos(x), math.sin(x)
        f, d, e = (c / a) ** 2 + (s / b) ** 2, 2 * s * c * (b ** -2 - a ** -2), 2 * (c * c - s * s) * (b ** -2 - a ** -2)
        return f ** -0.5, -0.5 * f ** -1.5 * d, 0.75 * f ** -2.5 * d * d - 0.5 * f ** -1.5 * e
    return at


def lobes(radius, height, count):
    return lambda x: (radius + height * math.cos(count * x), -height * count * math.sin(count * x),
                      -height * count * count * math.cos(count * x))


def focal_ellipse(p, k):
    """About a focus: r = p/(1 + k cos(x))."""
    def at(x):
        c, s = math.cos(x), math.sin(x)
        q = 1 + k * c
        return p / q, p * k * s / q ** 2, p * k * (c / q ** 2 + 2 * k * s * s / q ** 3)
    return at


def place(curve, x, turn=0.0):
    """Point, first and second derivative by x, turned."""
    r, d, e = curve(x)
    c, s = math.cos(x + turn), math.sin(x + turn)
    return (r * c, r * s), (d * c - r * s, d * s + r * c), ((e - r) * c - 2 * d * s, (e - r) * s + 2 * d * c)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def first_guess(first, second, d, theta, grid=180):
    """The pair of opposite normals that come apart last, or are nearest, on a grid."""
    best = None
    angles = [2 * math.pi * i / grid for i in range(grid)]
    others = [(u, place(second, u, theta)) for u in angles]
    for s in angles:
        at, tangent, _ = place(first, s)
        t = math.hypot(*tangent)
        u, there = min(((u, o) for u, o in others if dot(o[1], tangent) < 0),
                       key=lambda o: abs(cross(o[1][1], tangent)) / math.hypot(*o[1][1]))
        w = (d[0] + there[0][0] - at[0], d[1] + there[0][1] - at[1])
        off = abs(dot(w, tangent)) / t
        away = math.hypot(*w)
        if best is None or (away, off) < best[0]:
            best = ((away, off), s, u)
    return best[1], best[2]


def touch(first, second, d, theta, start=None):
    """Gap, normal out of the first curve, arms from both origins in the axes of the first, and both angles."""
    s, u = start or first_guess(first, second, d, theta)
    for _ in range(50):
        a, a1, a2 = place(first, s)
        b, b1, b2 = place(second, u, theta)
        w = (d[0] + b[0] - a[0], d[1] + b[1] - a[1])
        f, g = dot(w, a1), cross(b1, a1)
        fs, fu, gs, gu = dot(w, a2) - dot(a1, a1), dot(b1, a1), cross(b1, a2), cross(b2, a1)
        det = fs * gu - fu * gs
        ds, du = (-f * gu + fu * g) / det, (-fs * g + gs * f) / det
        s, u = s + ds, u + du
        if abs(ds) + abs(du) < 1e-12:
            break
    else:
        raise ArithmeticError("no point of contact was found")
    a, a1, _ = place(first, s)
    b = place(second, u, theta)[0]
    size = math.hypot(*a1)
    normal = (a1[1] / size, -a1[0] / size)
    w = (d[0] + b[0] - a[0], d[1] + b[1] - a[1])
    return dot(normal, w), normal, a, b, (s, u)


def slide_on_ground(first, second, mass, inertia, stiffness, mu, vs, state, end, steps):
    """A body about whose centre of mass the second curve is, on the first curve, which stands still at the origin: x, y,
    angle and their rates at `end`. Normal force K delta, friction mu tanh(v/vs) of it, both halfway between the curves."""
    guess = [None]

    def rates(y):
        gap, n, _, arm, guess[0] = touch(first, second, y[:2], y[2], guess[0])
        normal = stiffness * max(-gap, 0.0)
        arm = (arm[0] - gap / 2 * n[0], arm[1] - gap / 2 * n[1])
        t = (n[1], -n[0])
        v = (y[3] - y[5] * arm[1], y[4] + y[5] * arm[0])
        slip = dot(v, t)
        friction = -mu * math.tanh(slip / vs) * normal
        force = (normal * n[0] + friction * t[0], normal * n[1] + friction * t[1])
        return [*y[3:], force[0] / mass, force[1] / mass - 9.81, cross(arm, force) / inertia]

    h = end / steps
    for _ in range(steps):
        a = rates(state)
        b = rates([y + h / 2 * k for y, k in zip(state, a)])
        c = rates([y + h / 2 * k for y, k in zip(state, b)])
        e = rates([y + h * k for y, k in zip(state, c)])
        state = [y + h / 6 * (p + 2 * q + 2 * r + s) for y, p, q, r, s in zip(state, a, b, c, e)]
    return state
