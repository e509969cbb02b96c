"""Mechanisms of every joint type move as formulas of their own say."""
import math
import unittest

from model_cases import EXACT, ModelTest

G = 9.81


class Bushings(ModelTest):
    TEXT = """
bodies:
  ground: {frames: {bed: {angle: 30 deg}}}
  engine: {mass: 20, inertia: 0.5, frames: {foot: {angle: 30 deg}}, pose: {position: [%r, %r], angle: 0.1}}
forces:
  bed: {type: bushing, between: [ground/bed, engine/foot], stiffness: {x: 2000, y: 18000, %s: 50}, damping: {x: 40, turn_z: 0.2}}
simulation: {end: 0.5 s, output: {interval: 5 ms}, %s}
"""

    def test_a_body_on_an_elastic_bed_swings_along_each_axis_of_the_bed_by_itself(self):
        c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
        columns = self.run_model(self.TEXT % (c * 1e-3 - s * 2e-3, s * 1e-3 + c * 2e-3, "turn_z", EXACT))

        def damped(start, mass, k, d):
            w, fall = math.sqrt(k / mass - (d / (2 * mass)) ** 2), d / (2 * mass)
            return lambda t: start * math.exp(-fall * t) * (math.cos(w * t) + fall / w * math.sin(w * t))
        along, across = damped(1e-3, 20, 2000, 40), damped(2e-3, 20, 18000, 0)
        self.assert_column(columns, "body.engine.x", lambda t: c * along(t) - s * across(t))
        self.assert_column(columns, "body.engine.y", lambda t: s * along(t) + c * across(t))
        self.assert_column(columns, "body.engine.angle", damped(0.1, 0.5, 50, 0.2))

    def test_what_acts_out_of_the_plane_is_refused_in_it(self):
        for key in ("z", "turn_x"):
            errors = self.refusal(self.TEXT % (0, 0, key, ""), line=7)
            self.assertIn("in the plane", str(errors))


class Gears(ModelTest):
    def test_a_rack_falls_against_the_inertia_of_its_pinion(self):
        text = """
gravity: [0, -9.81]
parameters: {r: 40 mm, J: 0.002, m: 3 kg}
bodies:
  pinion: {mass: 1, inertia: $J}
  rack: {mass: $m, inertia: 0}
joints:
  axle: {type: revolute, between: [ground, pinion]}
  guide: {type: prismatic, between: [ground/down, rack]}
  mesh: {type: gear, of: [axle, guide], ratio: $r / (1 rad)}
frames: {ground/down: {position: [$r, 0], angle: -90 deg}}
simulation: {end: 0.4 s, output: {interval: 20 ms}, %s}
""" % EXACT
        self.facts(text, bodies=2, joints=3, constraints=5, rank=5, redundant=0, dof=1, dof_driven=1)
        a = 3 * G / (3 + 0.002 / 0.04 ** 2)
        columns = self.run_model(text)
        self.assert_column(columns, "joint.guide.position", lambda t: a * t * t / 2)
        self.assert_column(columns, "joint.axle.angle", lambda t: a * t * t / 2 / 0.04)
        self.assert_column(columns, "body.rack.y", lambda t: -a * t * t / 2)

    def test_a_slide_drives_a_turn_with_angle_per_length(self):
        text = """
bodies: {rack: {mass: 1, inertia: 1}, wheel: {mass: 1, inertia: 1}}
joints:
  s: {type: prismatic, between: [ground, rack]}
  w: {type: revolute, between: [ground, wheel]}
  mesh: {type: gear, of: [s, w], ratio: 30 deg/mm, offset: 15 deg}
drivers: {push: {joint: s, kind: position, value: 2 mm * sin(3*t)}}
simulation: {end: 1, step: 10 ms}
"""
        self.facts(text, drivers=1, constraints=5, driver_constraints=1, dof=1, dof_driven=0)
        columns = self.run_model(text)
        self.assert_column(columns, "body.wheel.angle",
                           lambda t: math.radians(15) + math.radians(30) * 2 * math.sin(3 * t))
        self.assert_column(columns, "joint.w.speed", lambda t: math.radians(30) * 6 * math.cos(3 * t))

    def test_a_planetary_gear_has_the_ratio_of_willis(self):
        text = """
parameters: {zs: 20, zp: 16, zr: 2*$zp + $zs}
bodies:
  carrier: {mass: 1, inertia: 0.3, frames: {p: [36 mm, 0]}}
  sun: {mass: 0.4, inertia: 0.1}
  planet: {mass: 0.2, inertia: 0.05}
  ring: {mass: 1, inertia: 1}
joints:
  hold: {type: fixed, between: [ground, ring]}
  k: {type: revolute, between: [ground, carrier]}
  s: {type: revolute, between: [carrier, sun]}
  p: {type: revolute, between: [carrier/p, planet]}
  r: {type: revolute, between: [carrier, ring]}
  inner: {type: gear, of: [s, p], ratio: -$zs/$zp}
  outer: {type: gear, of: [r, p], ratio: $zr/$zp}
  in: {type: revolute, between: [ground, sun]}
drivers: {motor: {joint: in, kind: torque, value: 0.7 N*m}}
simulation: {end: 1, output: {interval: 50 ms}, %s}
""" % EXACT
        # 4 bodies, 3 + 5*2 + 2 rows, of which sun and ring on ground repeat two each; one motion is left.
        self.facts(text, joints=8, constraints=15, rank=11, redundant=4, dof=1)
        ratio = 1 + 52 / 20  # sun to carrier with the ring at rest
        spin = 1 - (ratio - 1) * 20 / 16  # absolute, per turn of the carrier
        moment = 0.3 + 0.1 * ratio ** 2 + 0.05 * spin ** 2 + 0.2 * 0.036 ** 2
        a = 0.7 * ratio / moment
        columns = self.run_model(text)
        self.assert_column(columns, "body.carrier.angle", lambda t: a * t * t / 2)
        self.assert_column(columns, "body.sun.angle", lambda t: ratio * a * t * t / 2)
        self.assert_column(columns, "body.planet.angle", lambda t: spin * a * t * t / 2)
        self.assert_column(columns, "body.ring.angle", lambda t: 0.0)

    def test_an_offset_ties_positions_and_auto_keeps_what_is_found(self):
        text = """
bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground, b]}
  mesh: {type: gear, of: [A, B], ratio: 2, offset: %s}
initial: {joints: {A: 400 deg%s}}
drivers: {m: {joint: B, kind: torque, value: 5}}
simulation: {end: 1, step: 10 ms}
"""
        columns = self.run_model(text % ("10 deg", ""))
        self.assertAlmostEqual(math.radians(810), columns["joint.B.angle"][0], places=9)
        self.assertAlmostEqual(math.radians(400), columns["joint.A.angle"][0], places=9)
        columns = self.run_model(text % ("auto", ", B: 30 deg"))
        self.assertAlmostEqual(math.radians(30), columns["joint.B.angle"][0], places=9)
        self.assert_column(columns, "joint.B.angle", lambda t: math.radians(30) + 5 / 1.25 * t * t / 2, 1e-7)


    def test_a_train_counts_turns_from_what_is_given(self):
        text = """
bodies: {rack: {mass: 1, inertia: 1}, a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}
joints:
  b: {type: gear, of: [B, A], ratio: -0.5, offset: 1 rad}
  a: {type: gear, of: [A, s], ratio: 50 mm, offset: 0}
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground, b]}
  s: {type: prismatic, between: [ground, rack]}
initial: {joints: {s: 1 m}}
simulation: {end: 0.1, step: 10 ms}
"""
        columns = self.run_model(text)
        self.assertAlmostEqual(20, columns["joint.A.angle"][0], places=9)
        self.assertAlmostEqual(-38, columns["joint.B.angle"][0], places=9)


    def test_a_rack_that_a_linkage_puts_far_away_has_turned_its_pinion(self):
        text = """
bodies:
  rack: {mass: 1, inertia: 1}
  wheel: {mass: 1, inertia: 1}
  rod: {mass: 1, inertia: 1, frames: {end: [2, 0]}, pose: {angle: 30 deg}}
joints:
  s: {type: prismatic, between: [ground, rack]}
  A: {type: revolute, between: [ground, wheel]}
  mesh: {type: gear, of: [A, s], ratio: 50 mm, offset: 0}
  low: {type: revolute, between: [ground/low, rod]}
  far: {type: revolute, between: [rod/end, rack]}
frames: {ground/low: [0, -1.2]}
simulation: {end: 0.1, step: 10 ms}
"""
        self.facts(text, constraints=9, dof=0)
        columns = self.run_model(text)
        self.assertAlmostEqual(1.6, columns["joint.s.position"][0], places=9)
        self.assertAlmostEqual(32, columns["joint.A.angle"][0], places=9)


    def test_a_load_lets_down_a_braked_drum(self):
        text = """
gravity: [0, -9.81]
parameters: {R: 0.1 m}
bodies: {drum: {mass: 5, inertia: "0.5*5 kg*$R^2"}, load: {mass: 2, inertia: 0}}
joints:
  d: {type: revolute, between: [ground, drum]}
  l: {type: prismatic, between: [ground/up, load/up]}
  rope: {type: gear, of: [l, d], ratio: 1/$R}
forces: {brake: {type: spring-damper, kind: rotational, between: [ground, drum], damping: 0.05 N*m*s}}
frames: {ground/up: {position: [$R, 0], angle: 90 deg}, load/up: {angle: 90 deg}}
simulation: {end: 1, output: {interval: 100 ms}, %s}
""" % EXACT
        self.facts(text, constraints=5, dof=1)
        mass, damping = 2 + 0.5 * 5, 0.05 / 0.1 ** 2
        speed = lambda t: -2 * G / damping * (1 - math.exp(-damping / mass * t))
        columns = self.run_model(text)
        self.assert_column(columns, "joint.l.speed", speed, 1e-8)
        self.assert_column(columns, "joint.d.speed", lambda t: speed(t) / 0.1, 1e-8)


class Slides(ModelTest):
    def test_a_block_runs_down_an_incline(self):
        text = """
gravity: [0, -9.81]
bodies: {block: {mass: 2 kg, inertia: 0, com: [0, 5 cm], frames: {foot: {angle: 10 deg}}}}
frames: {ground/ramp: {position: [1, 2], angle: -25 deg}}
joints: {ramp: {type: prismatic, between: [ground/ramp, block/foot]}}
initial: {joints: {ramp: 0.3 m}, speeds: {ramp: -1 m/s}}
simulation: {end: 0.5, output: {interval: 25 ms}, %s}
"""
        text = text.replace("5 cm", "50 mm") % EXACT
        self.facts(text, constraints=2, dof=1)
        a, turn = math.radians(-25), math.radians(-35)
        s = lambda t: 0.3 - t + G * math.sin(-a) * t * t / 2
        columns = self.run_model(text)
        self.assert_column(columns, "joint.ramp.position", s)
        self.assert_column(columns, "body.block.angle", lambda t: turn)
        self.assert_column(columns, "body.block.x", lambda t: 1 + s(t) * math.cos(a) - 0.05 * math.sin(turn))
        self.assert_column(columns, "body.block.y", lambda t: 2 + s(t) * math.sin(a) + 0.05 * math.cos(turn))
        self.assert_column(columns, "joint.ramp.fy", lambda t: 2 * G * math.cos(a) ** 2)

    def test_the_bar_of_a_trammel_draws_an_ellipse(self):
        text = """
parameters: {l: 0.5}
bodies:
  h: {mass: 1, inertia: 1}
  v: {mass: 1, inertia: 1}
  bar: {mass: 1, inertia: 0.1, frames: {a: [0, 0], b: [$l, 0], pen: [0.7, 0]}, pose: {angle: 100 deg}}
joints:
  x: {type: prismatic, between: [ground, h]}
  y: {type: prismatic, between: [ground/up, v/up]}
  A: {type: revolute, between: [h, bar/a]}
  B: {type: revolute, between: [v, bar/b]}
frames: {ground/up: {angle: 90 deg}, v/up: {angle: 90 deg}}
drivers: {turn: {joint: A, kind: angle, value: 100 deg + 2*t}}
simulation: {end: 3, step: 20 ms, output: {frames: [bar/pen]}}
"""
        self.facts(text, bodies=3, constraints=8, dof=1, dof_driven=0, redundant=0)
        angle = lambda t: math.radians(100) + 2 * t
        columns = self.run_model(text)
        self.assert_column(columns, "joint.x.position", lambda t: -0.5 * math.cos(angle(t)))
        self.assert_column(columns, "joint.y.position", lambda t: 0.5 * math.sin(angle(t)))
        self.assert_column(columns, "frame.bar/pen.x", lambda t: 0.2 * math.cos(angle(t)))
        self.assert_column(columns, "frame.bar/pen.vy", lambda t: 1.4 * math.cos(angle(t)))

    def test_an_oldham_coupling_keeps_the_speed(self):
        text = """
parameters: {e: 30 mm}
bodies:
  in: {mass: 1, inertia: 1, frames: {slot: [0, 0]}}
  disc: {mass: 1, inertia: 1, frames: {a: [0, 0], b: {angle: 90 deg}}}
  out: {mass: 1, inertia: 1, frames: {slot: {angle: 90 deg}}}
joints:
  A: {type: revolute, between: [ground, in]}
  B: {type: revolute, between: [ground/B, out]}
  s: {type: prismatic, between: [in/slot, disc/a]}
  u: {type: prismatic, between: [out/slot, disc/b]}
frames: {ground/B: [$e, 0]}
drivers: {m: {joint: A, kind: velocity, value: 90 rpm}}
simulation: {end: 1, step: 10 ms}
"""
        self.facts(text, constraints=8, rank=8, dof=1)
        w = 3 * math.pi
        columns = self.run_model(text)
        self.assert_column(columns, "body.out.angle", lambda t: w * t)
        # The disc's centre runs round a circle over the distance of the axes, twice a turn.
        self.assert_column(columns, "body.disc.x", lambda t: 0.03 * math.cos(w * t) ** 2)
        self.assert_column(columns, "body.disc.y", lambda t: 0.03 * math.cos(w * t) * math.sin(w * t))

    def test_a_scotch_yoke_is_harmonic(self):
        text = """
gravity: [0, -9.81]
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {pin: [80 mm, 0]}}
  yoke: {mass: 1.5, inertia: 0.01}
joints:
  A: {type: revolute, between: [ground, crank]}
  guide: {type: prismatic, between: [ground, yoke]}
  slot: {type: point-on-line, between: [yoke/slot, crank/pin]}
frames: {yoke/slot: {angle: 90 deg}}
drivers: {m: {joint: A, kind: angle, value: 4*t^2}}
simulation: {end: 1, step: 5 ms}
"""
        self.facts(text, constraints=5, dof=1, dof_driven=0)
        x = lambda t: 0.08 * math.cos(4 * t * t)
        ax = lambda t: -0.08 * (8 * math.sin(4 * t * t) + 64 * t * t * math.cos(4 * t * t))
        columns = self.run_model(text)
        self.assert_column(columns, "joint.guide.position", x)
        self.assert_column(columns, "joint.slot.position", lambda t: 0.08 * math.sin(4 * t * t))
        self.assert_column(columns, "driver.m.torque",
                           lambda t: 0.08 * math.sin(4 * t * t) * -1.5 * ax(t) + 0.01 * 8, 1e-8)
        self.assert_column(columns, "joint.slot.fx", lambda t: -1.5 * ax(t), 1e-8)

    def test_a_slotted_lever_follows_its_crank(self):
        text = """
parameters: {r: 0.1, d: 0.25}
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {pin: [$r, 0]}}
  lever: {mass: 1, inertia: 0.01, pose: {angle: 90 deg}}
joints:
  A: {type: revolute, between: [ground/A, crank]}
  O: {type: revolute, between: [ground, lever]}
  slot: {type: point-on-line, between: [lever, crank/pin]}
frames: {ground/A: [0, $d]}
drivers: {m: {joint: A, kind: velocity, value: 2 rev/s}}
initial: {joints: {A: 0}}
simulation: {end: 1, step: 5 ms}
"""
        self.facts(text, constraints=5, dof=1)
        c = lambda t: (0.1 * math.cos(4 * math.pi * t), 0.25 + 0.1 * math.sin(4 * math.pi * t))
        columns = self.run_model(text)
        self.assert_column(columns, "body.lever.angle", lambda t: math.atan2(c(t)[1], c(t)[0]))
        self.assert_column(columns, "joint.slot.position", lambda t: math.hypot(*c(t)))


class Springs(ModelTest):
    def test_a_spring_joint_is_a_damped_oscillator(self):
        text = """
bodies: {m: {mass: 2, inertia: 0}}
joints:
  s: {type: prismatic, between: [ground, m]}
  k: {type: spring-damper, between: [ground/wall, m], stiffness: 0.08 N/mm, damping: 4 N*s/m, free_length: 1 m, preload: 8 N}
frames: {ground/wall: [-1.5, 0]}
initial: {joints: {s: 0.2}}
simulation: {end: 2, output: {interval: 50 ms}, %s}
""" % EXACT
        self.facts(text, joints=2, constraints=2, dof=1)
        rest = -0.5 - 8 / 80  # length 1.5 + x; 80 (0.5 + x) + 8 = 0
        w, d = math.sqrt(80 / 2 - 1), 1.0
        x = lambda t: rest + (0.2 - rest) * math.exp(-d * t) * (math.cos(w * t) + d / w * math.sin(w * t))
        v = lambda t: -(0.2 - rest) * math.exp(-d * t) * (d * d / w + w) * math.sin(w * t)
        columns = self.run_model(text)
        self.assert_column(columns, "joint.s.position", x, 1e-8)
        self.assert_column(columns, "joint.k.fx", lambda t: -(80 * (0.5 + x(t)) + 4 * v(t) + 8), 1e-7)

    def test_a_torsion_spring_turns_a_flywheel(self):
        text = """
bodies: {w: {mass: 1, inertia: 0.2}}
joints: {A: {type: revolute, between: [ground/tilt, w]}}
frames: {ground/tilt: {angle: 20 deg}}
forces:
  k: {type: spring-damper, kind: rotational, between: [ground/tilt, w], stiffness: 5, damping: 0.4, free_angle: 30 deg, preload: 0.5}
initial: {joints: {A: 0}}
simulation: {end: 2, output: {interval: 50 ms}, %s}
""" % EXACT
        rest, d = math.radians(30) - 0.1, 1.0
        w = math.sqrt(25 - 1)
        angle = lambda t: rest - rest * math.exp(-d * t) * (math.cos(w * t) + d / w * math.sin(w * t))
        columns = self.run_model(text)
        self.assert_column(columns, "joint.A.angle", angle, 1e-8)
        self.assert_column(columns, "force.k.angle", angle, 1e-8)

    def test_a_torsion_spring_counts_turns_as_the_joint_beside_it(self):
        # Released at 200 degrees, not at -160; the second spring looks at the same angle from the other side.
        text = """
bodies: {w: {mass: 1, inertia: 0.2}}
joints: {A: {type: revolute, between: [ground, w]}}
frames: {w/mark: {angle: 30 deg}}
forces:
  k: {type: spring-damper, kind: rotational, between: [ground, w], stiffness: 3}
  l: {type: spring-damper, kind: rotational, between: [w/mark, ground], stiffness: 2, free_angle: -30 deg}
initial: {joints: {A: 200 deg}}
simulation: {end: 2, output: {interval: 50 ms}, %s}
""" % EXACT
        start, w = math.radians(200), 5.0
        columns = self.run_model(text)
        self.assert_column(columns, "force.k.angle", lambda t: start * math.cos(w * t), 1e-7)
        self.assert_column(columns, "force.l.angle", lambda t: -start * math.cos(w * t) - math.radians(30), 1e-7)


if __name__ == "__main__":
    unittest.main()
