"""Pins in open slots, discs at arcs, and the Geneva drive that they make, against formulas."""
import csv
import math
import os
import unittest

from model_cases import EXACT, ModelTest
from program import MECHANISMS

STIFF = 1e6  # [N/m]
# A body of 2 kg that slides without turning, `between` two frames of it and of the ground.
SLIDE = """
gravity: [0, -9.81]
bodies:
  ground: {frames: {rail: {position: [%s, 0], angle: 90 deg}, part: {angle: %s}}}
  block: {mass: 2, inertia: 1, frames: {rail: {angle: 90 deg}}, pose: {position: [%s, %s]}}
joints: {guide: {type: prismatic, between: [ground/rail, block/rail]}}
forces: {c: {%s, contact: {law: kelvin-voigt, K: 1e6, D: 0}}}
simulation: {end: %s, output: {interval: 1 ms}, %s}
"""
# Two free discs that meet.
PAIR = """
bodies:
  a: {mass: 2, inertia: 3e-3, velocity: {angular: 20}}
  b: {mass: 1, inertia: 1e-3, pose: {position: [0.2, %s]}, velocity: {linear: [-2, 0.3], angular: -5}}
forces:
  c: {type: arc-contact, between: [%s], arc: {radius: %s}, disc: %s, contact: {law: kelvin-voigt, K: 1e5, D: 20},
      friction: {law: threlfall, mu: 0.3, v_r: 10 mm/s}}
simulation: {end: 0.2 s, output: {interval: 1 ms}, %s}
"""
GENEVA = """
bodies:
  crank: {mass: 1, inertia: 1e-3, frames: {pin: [%r, 0]}}
  wheel: {mass: 1, inertia: 1e-3, frames: {slot: {angle: %r}}, pose: {position: [0.1, 0], angle: %r}}
frames: {ground/shaft: [0.1, 0]}
joints:
  crank: {type: revolute, between: [ground, crank]}
  wheel: {type: revolute, between: [ground/shaft, wheel]}
  slot: {type: point-on-line, between: [wheel/slot, crank/pin]}
drivers: {motor: {joint: crank, kind: angle, value: "%r + (5 rad/s)*t"}}
simulation: {end: %r s, accuracy: 1 nm, output: {interval: 1 ms, channels: [body.wheel.angle, body.wheel.omega, body.wheel.alpha]}}
"""


class BoundaryContacts(ModelTest):
    def events(self, folder="out"):
        with open(self.path(folder, "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def assert_bounce(self, columns, gap):
        """A block of 2 kg falls by `gap` onto a spring, along y, and comes back as high."""
        omega, sag = math.sqrt(STIFF / 2), 9.81 * 2 / STIFF
        down = math.sqrt(2 * gap / 9.81)
        speed = 9.81 * down
        size = math.hypot(speed / omega, sag)
        touch = (math.pi + 2 * math.atan2(sag, speed / omega)) / omega
        start = columns["body.block.y"][0]

        def height(t):
            if t < down:
                return start - 9.81 * t * t / 2
            if t < down + touch:
                return start - gap - sag - size * math.sin(omega * (t - down) - math.atan2(sag, speed / omega))
            s = t - down - touch
            return start - gap + speed * s - 9.81 * s * s / 2
        last = down + touch + 1.5 * down
        for t, y in zip(columns["time"], columns["body.block.y"]):
            if t < last:
                self.assertAlmostEqual(height(t), y, delta=1e-8)
        self.assertGreater(columns["time"][-1], down + touch)
        times = [float(event["time"]) for event in self.events()]
        self.assertAlmostEqual(down, times[0], delta=1e-9)
        self.assertAlmostEqual(down + touch, times[1], delta=1e-8)

    def test_a_block_bounces_on_every_part_of_a_boundary_as_on_a_spring(self):
        slot = "type: slot-contact, between: [ground/part, block], pin_radius: 10 mm, gap: 1 mm, bottom: 20 mm, length: 40 mm"
        arcs = "type: arc-contact, between: [ground/part, block], arc: {radius: %s}, disc: 20 mm"
        cases = {
            # x of the block, angle of the part, height at which they touch, the element
            "wall": (0.04, "0", -1e-3, slot),
            "bottom": (0.0, "90 deg", 0.02 - 1e-3, slot),
            "edge": (0.011, "90 deg", 0.06 + 0.01, slot),
            "other edge": (-0.011, "90 deg", 0.06 + 0.01, slot),
            "disc on disc": (0.0, "30 deg", 0.07, arcs % "50 mm"),
            "disc in hollow": (0.0, "30 deg", -0.03, arcs % "50 mm"),
            "disc on arc": (0.0, "0", 0.07, arcs % "50 mm, from: 45 deg, to: 100 deg"),
            "disc in arc": (0.0, "0", -0.03, arcs % "50 mm, from: 200 deg, to: 300 deg"),
            "disc on end": (0.05, "0", 0.02, arcs % "50 mm, from: -90 deg, to: 0 deg"),
            "disc on end of hollow": (0.05, "0", 0.02, arcs % "50 mm, from: 180 deg, to: 360 deg"),
        }
        for name, (x, angle, height, element) in cases.items():
            with self.subTest(name):
                gap = 0.5e-3 if name == "wall" else 5e-3
                text = SLIDE % (x, angle, x, height + gap, element, "0.1 s" if gap > 1e-3 else "25 ms", EXACT)
                columns = self.run_model(text)
                self.assert_bounce(columns, gap)
                self.assertLess(max(map(abs, columns["energy.residual"])), 1e-9)

    def test_two_discs_move_alike_whichever_is_named_first(self):
        motions = [self.run_model(PAIR % (offset, *names, "accuracy: 1e-11"))
                   for offset in ("30 mm", "-45 mm")
                   for names in (("a, b", "60 mm", "40 mm"), ("b, a", "40 mm", "60 mm"))]
        for one, other in (motions[:2], motions[2:]):
            self.assertGreater(max(one["force.c.fn"]), 10)
            for name in one:
                if name.startswith("body.") or name in ("force.c.fn", "force.c.delta", "energy.total"):
                    for t, x, y in zip(one["time"], one[name], other[name]):
                        self.assertAlmostEqual(x, y, delta=1e-8 * max(1.0, abs(x)), msg="%s at %r" % (name, t))
            # Nothing else acts: momentum and angular momentum stay.
            for k in (0, -1):
                c = {name: values[k] for name, values in one.items()}
                momentum = 2 * c["body.a.vx"] + c["body.b.vx"], 2 * c["body.a.vy"] + c["body.b.vy"]
                spin = sum(m * (c["body.%s.x" % b] * c["body.%s.vy" % b] - c["body.%s.y" % b] * c["body.%s.vx" % b])
                           + i * c["body.%s.omega" % b] for b, m, i in (("a", 2, 3e-3), ("b", 1, 1e-3)))
                if k == 0:
                    before = *momentum, spin
            for x, y in zip(before, (*momentum, spin)):
                self.assertAlmostEqual(x, y, delta=1e-10)

    def test_a_pin_leaves_its_slot_and_rounds_the_edge_without_a_jump_of_force(self):
        # Pressed to the lower wall and pulled out: it slides along, and goes round the edge by the law's own softness.
        text = """
bodies:
  ground: {frames: {slot: {}}}
  block: {mass: 2, inertia: 1, pose: {position: [40 mm, -1.02 mm]}, velocity: {linear: [0.5, 0]}}
forces:
  c: {type: slot-contact, between: [ground/slot, block], pin_radius: 10 mm, gap: 1 mm, bottom: 20 mm, length: 40 mm,
      contact: {law: kelvin-voigt, K: 1e6, D: 0}}
  down: {type: force, at: block, value: [0, -20 N]}
simulation: {end: 62 ms, output: {interval: 0.1 ms}, %s}
""" % EXACT
        columns = self.run_model(text)
        places, forces = columns["force.c.along"], columns["force.c.fn"]
        self.assertGreater(max(places), 0.065)
        inside = [f for x, f in zip(places, forces) if x < 0.06]
        for force in inside:
            self.assertAlmostEqual(20, force, delta=1e-6)
        # Round the edge the pin falls with the arc: m v^2/r less of the force, as a pin of that radius on a corner.
        for t, x, y, f in zip(columns["time"], places, columns["force.c.across"], forces):
            if 0.06 < x < 0.0625 and f > 0:
                distance = math.hypot(x - 0.06, y + 0.011)
                self.assertAlmostEqual(STIFF * (0.01 - distance), f, delta=1e-6)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-9)

    def test_a_geneva_wheel_has_its_known_acceleration(self):
        # With L = sin(pi/n): angle b of the wheel, tan(b) = L sin(a)/(1 - L cos(a)), turns against the crank's angle a.
        for slots in (3, 4, 6):
            ratio, part = math.sin(math.pi / slots), math.pi / 2 - math.pi / slots
            begin = -0.98 * part
            angle = lambda a: math.atan2(ratio * math.sin(a), 1 - ratio * math.cos(a))
            # x of the slot points from the wheel to the pin.
            start = -angle(begin)
            columns = self.run_model(GENEVA % (0.1 * ratio, math.pi, start, begin, 2 * 0.98 * part / 5))
            for k, t in enumerate(columns["time"]):
                a = begin + 5 * t
                bottom = 1 + ratio * ratio - 2 * ratio * math.cos(a)
                self.assertAlmostEqual(-angle(a), columns["body.wheel.angle"][k], delta=1e-9)
                self.assertAlmostEqual(-5 * (ratio * math.cos(a) - ratio * ratio) / bottom, columns["body.wheel.omega"][k], delta=1e-9)
                known = 25 * ratio * math.sin(a) * (1 - ratio * ratio) / bottom ** 2
                self.assertAlmostEqual(known, columns["body.wheel.alpha"][k], delta=1e-9 * max(1, abs(known)))

    def test_a_geneva_drive_goes_on_by_a_slot_a_turn_and_is_locked_between(self):
        out, _ = self.freeplay("run", os.path.join(MECHANISMS, "gallery", "geneva.yaml"), "--out", "g")
        self.assertIn("trust: good", out)
        rows = list(csv.reader(self.read("g", "results.csv").splitlines()))
        columns = {name: [float(x) if x else math.nan for x in values] for name, *values in zip(*rows)}
        ratio, turn = math.sin(math.pi / 4), 2 * math.pi
        # By so much the play of the pin and the give of the contact, or the play of a tip, let the wheel turn.
        slack = 0.07e-3 / 0.0234
        locked = 0.05e-3 / (0.08 * math.sin(math.radians(40))) + 1e-4
        for crank, wheel in zip(columns["joint.crank.angle"], columns["joint.wheel.angle"]):
            done = math.floor((crank + math.pi) / turn)
            a = crank - turn * done
            if abs(a) < math.pi / 4:
                ideal = math.atan2(ratio * math.sin(a), 1 - ratio * math.cos(a))
                self.assertAlmostEqual(-math.pi / 4 - ideal - done * math.pi / 2, wheel, delta=slack)
            elif abs(a) > math.radians(86):  # the disc is before the whole hollow
                self.assertAlmostEqual(-(done + (a > 0)) * math.pi / 2, wheel, delta=locked)
        elements = {event["joint"] for event in self.events("g") if event["kind"] == "contact_begin"}
        self.assertIn("quarter4.drive", elements)
        self.assertTrue(any(".tip" in name or ".edge" in name for name in elements), elements)

    def test_boundaries_that_cannot_be_are_refused_where_they_stand(self):
        slot = "type: slot-contact, between: [ground/part, block], %s"
        arcs = "type: arc-contact, between: [ground/part, block], %s"
        whole = "pin_radius: 10 mm, gap: 1 mm, bottom: 20 mm, length: 40 mm"
        for element, told in ((slot % whole.replace("gap: 1", "gap: 0"), "gap"),
                              (slot % whole.replace("40", "-40"), "length"),
                              (slot % whole.replace("pin_radius", "pinradius"), "pin_radius"),
                              (arcs % "arc: {radius: 5 mm, from: 0 deg, to: 9 deg}, disc: 5 mm", "smaller than the circle"),
                              (arcs % "arc: {radius: 5 mm, from: 0 deg}, disc: 5 mm", "'from' and 'to'"),
                              (arcs % "arc: {radius: 5 mm, from: 10 deg, to: 0 deg}, disc: 5 mm", "'to' must be above"),
                              (arcs % "arc: {radius: 5 mm, form: 1}, disc: 5 mm", "from")):
            errors = self.refusal(SLIDE % (0, "0", 0, 1, element, "1 s", ""), line=8)
            self.assertIn(told, str(errors))


if __name__ == "__main__":
    unittest.main()
