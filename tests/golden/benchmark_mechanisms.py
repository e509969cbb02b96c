"""Two mechanisms of the IFToMM Library of Computational Benchmark Problems, each by equations of its own freedoms."""
import math

from model_cases import rk4

G = 9.81


def governor(end, steps):
    """Height of the slider [m] and speed of the shaft [rad/s] of the stiff flyball governor at `end` [s].

    Lagrange's equations in the droop of the arms q and the height s; the momentum p = J(q) w about the shaft stays.
    """
    side, l, h, offset = 0.01, 1.0, 0.5, 0.05
    bar, block, ball = 3000 * l * side * side, 3.0, 5.0
    mass = bar + ball
    reach = (bar * l / 2 + ball * l) / mass
    along = bar * side * side / 6
    across = bar * (l * l + side * side) / 12 + bar * (reach - l / 2) ** 2 + ball * (l - reach) ** 2
    fixed = along + block * 0.1 ** 2 / 6  # of shaft and slider

    def turning(q):
        out = offset + reach * math.cos(q)
        return fixed + 2 * (mass * out * out + across * math.cos(q) ** 2 + along * math.sin(q) ** 2)

    def turning_slope(q):
        out = offset + reach * math.cos(q)
        return -4 * math.sin(q) * (mass * out * reach + (across - along) * math.cos(q))

    droop = math.radians(30)
    momentum = turning(droop) * 2 * math.pi

    def rates(_, state):
        q, s, q_rate, s_rate = state
        u = l - h * math.sin(q) - s
        d = math.hypot(h * math.cos(q), u)
        d_q, d_s = -(h * math.cos(q) * (h * math.sin(q) + u)) / d, -u / d
        pull = 8e5 * (d - 0.5) + 4e4 * (d_q * q_rate + d_s * s_rate)
        # Two arms; both spring-dampers pull alike.
        torque = momentum ** 2 / (2 * turning(q) ** 2) * turning_slope(q) + 2 * mass * G * reach * math.cos(q) - 2 * pull * d_q
        return [q_rate, s_rate, torque / (2 * (mass * reach ** 2 + across)), -G - 2 * pull * d_s / block]

    q, s, _, _ = rk4(rates, [droop, 0.5, 0.0, 0.0], end, steps)
    return s, momentum / turning(q)


def bricard(end, steps):
    """Position [m] of the joint P3 of Bricard's mechanism at `end` [s].

    Links of equal length whose axes turn by a right angle from one to the next keep their joint angles a, b, a, b, a, b
    with (1 + cos a)(1 + cos b) = 1 (Chen, You and Tarnai 2005, Int J Solids Struct 42); the motion is along this curve,
    m r' + (dm/dr) r'^2/2 + dV/dr = 0 in its parameter r.
    """
    cross = lambda x, y: [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    dot = lambda x, y: sum(p * q for p, q in zip(x, y))
    along, across = 0.1 ** 2 / 6, (1 + 0.1 ** 2) / 12

    def turn(vector, axis, angle):
        c, s = math.cos(angle), math.sin(angle)
        by, share = cross(axis, vector), dot(axis, vector) * (1 - c)
        return [c * v + s * w + share * x for v, w, x in zip(vector, by, axis)]

    def direction(a, b):
        return math.sin(b) * (1 + math.cos(a)), -math.sin(a) * (1 + math.cos(b))

    def chain(a, b):
        """Places of the joints, mass and potential for a parameter that grows along `direction`."""
        rate_a, rate_b = direction(a, b)
        place, speed, spin, total, weight = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0, 0.0
        # The ground link points along -z, the first axis along -y; each link is across both its axes.
        link, axis, places = [0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [[0.0, 0.0, 0.0]]
        for i in range(5):
            angle, rate = ((a, rate_a), (b, rate_b))[i % 2]
            spin = [w + rate * x for w, x in zip(spin, axis)]
            link = turn(link, axis, angle)
            half = [v / 2 for v in cross(spin, link)]
            middle = [v + w for v, w in zip(speed, half)]
            w_along = dot(spin, link)
            total += dot(middle, middle) + along * w_along ** 2 + across * (dot(spin, spin) - w_along ** 2)
            weight += G * (place[1] + link[1] / 2)
            place, speed = [p + x for p, x in zip(place, link)], [v + 2 * w for v, w in zip(speed, half)]
            places.append(place)
            axis = turn(axis, link, (-1) ** i * math.pi / 2)
        return places, total, weight

    def rates(_, state):
        a, b, speed = state
        rate_a, rate_b = direction(a, b)
        step = 1e-5
        ahead, behind = (chain(a + e * rate_a, b + e * rate_b) for e in (step, -step))
        mass = chain(a, b)[1]
        slope = ((ahead[1] - behind[1]) / 2 * speed ** 2 + ahead[2] - behind[2]) / (2 * step)
        return [rate_a * speed, rate_b * speed, -slope / mass]

    start = [math.pi / 2, math.pi / 2, 0.0]
    a, b, _ = rk4(rates, start, end, steps)
    return chain(a, b)[0]
