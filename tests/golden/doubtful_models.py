"""Sound models; a mistake is put into each of them by plausibility_test."""
import os

from program import ROOT


def shipped(*path):
    with open(os.path.join(ROOT, "mechanisms", *path)) as file:
        return file.read()


SPATIAL, TOGGLE = shipped("spatial", "slider-crank.yaml"), shipped("gallery", "toggle-press.yaml")

# A loose slider-crank, written in SI without units, with a spring and gravity.
CRANK = """freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 0.3, inertia: 1e-4, com: [0.025, 0], frames: {tip: [0.05, 0]}}
  coupler: {mass: 0.21, inertia: 2.5e-4, com: [0.06, 0], frames: {tip: [0.12, 0]}}
  slider: {mass: 0.14, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  guide: {type: prismatic, between: [ground, slider]}
  wrist:
    type: revolute
    bearing: coupler/tip
    journal: slider
    clearance:
      bearing_radius: 0.01
      radial_clearance: 0.0005
      length: 0.015
      material: {E: 207e9, nu: 0.3}
      contact: {law: lankarani-nikravesh, restitution: 0.9}
forces:
  buffer: {type: spring-damper, between: [ground/wall, slider], stiffness: 200, free_length: 0.15}
frames: {ground/wall: [0.3, 0]}
drivers: {motor: {joint: main, kind: velocity, value: 100}}
initial: {joints: {main: 1}}
simulation: {end: 0.02, step: 1e-5}
"""
# A pendulum on a driven slide, in SI without units.
CART = """freeplay: 1
gravity: [0, -9.81]
bodies:
  cart: {mass: 1, inertia: 0.01}
  pole: {mass: 0.2, inertia: 0.002, com: [0.15, 0], frames: {tip: [0.3, 0]}}
joints:
  rail: {type: prismatic, between: [ground, cart]}
  hinge: {type: revolute, between: [cart, pole]}
drivers: {motor: {joint: rail, kind: position, value: 0.1*sin(3*t)}}
initial: {joints: {hinge: -1.2}}
simulation: {end: 1, step: 1e-3, output: {frames: [pole/tip]}}
"""
# A rod between two balls in space.
ROD = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies:
  rod: {mass: 1, inertia: [1e-5, 0.0208, 0.0208], com: [0.25, 0, 0], frames: {end: [0.5, 0, 0]}}
  bob: {mass: 1, inertia: [1e-3, 1e-3, 1e-3]}
joints:
  hung: {type: spherical, between: [ground, rod]}
  held: {type: spherical, between: [rod/end, bob]}
simulation: {end: 0.1, step: 1e-3}
"""
# A box on a spring.
BOX = """freeplay: 1
gravity: [0, -9.81]
bodies: {box: {mass: 200, inertia: 3, frames: {up: {angle: 90 deg}}}}
frames: {ground/up: {angle: 90 deg}, ground/floor: [0, -0.3]}
joints: {guide: {type: prismatic, between: [ground/up, box/up]}}
forces:
  foot: {type: spring-damper, between: [ground/floor, box], stiffness: 2e4, damping: 100, free_length: 0.4}
simulation: {end: 0.1, step: 1e-3}
"""
FOOT = "  foot: {type: spring-damper, between: [ground/floor, box], stiffness: 2e4, damping: 100, free_length: 0.4}\n"
GUIDED = "joints: {guide: {type: prismatic, between: [ground/up, box/up]}}\n"
# Two wheels.
TRAIN = """freeplay: 1
bodies:
  one: {mass: 1, inertia: 1e-3}
  two: {mass: 1, inertia: 1e-3}
frames: {ground/b: [0.1, 0]}
joints:
  a: {type: revolute, between: [ground, one]}
  b: {type: revolute, between: [ground/b, two]}
  pair: {type: gear, of: [a, b], ratio: 2}
drivers: {motor: {joint: a, kind: velocity, value: 10}}
simulation: {end: 0.1, step: 1e-3}
"""
# A belt between a motor and a fan.
BELT = """freeplay: 1
bodies:
  motor: {mass: 4, inertia: 8e-3}
  fan: {mass: 10, inertia: 0.4}
frames: {ground/fan: [0.5, 0.1]}
joints:
  motor: {type: revolute, between: [ground, motor]}
  fan: {type: revolute, between: [ground/fan, fan]}
forces:
  belt: {type: belt, between: [motor, fan], first_radius: 0.05, second_radius: 0.12, stiffness: 2e5, damping: 100, pretension: 300}
drivers: {motor: {joint: motor, kind: torque, value: 5}}
simulation: {end: 0.1, step: 1e-3}
"""
# A balance wheel, whose model has no lengths.
WATCH = """freeplay: 1
bodies: {balance: {mass: 60 mg, inertia: 1.2e-9}}
joints: {staff: {type: revolute, between: [ground, balance]}}
forces: {hair: {type: spring-damper, between: [ground, balance], kind: rotational, stiffness: 7.5e-7}}
initial: {joints: {staff: 270 deg}}
simulation: {end: 2 s, accuracy: 10 nm}
"""
# Two wheels whose teeth press on their bearings.
TEETH = """freeplay: 1
bodies:
  ground: {frames: {w: [150 mm, 0]}}
  pinion: {mass: 0.8, inertia: 4e-4}
  wheel: {mass: 3, inertia: 8e-3}
joints:
  P: {type: revolute, between: [ground, pinion]}
  W: {type: revolute, between: [ground/w, wheel]}
  mesh: {type: gear, of: [P, W], ratio: -1/2, pressure_angle: 20 deg}
drivers: {motor: {joint: P, kind: torque, value: 2}}
forces: {load: {type: torque, on: wheel, value: "-0.05 N*m*s/rad*body.wheel.omega"}}
simulation: {end: 2 s, accuracy: 1 um}
"""
# A wheel and a slide that it moves.
RACK = """freeplay: 1
bodies:
  wheel: {mass: 1, inertia: 1e-3}
  rack: {mass: 3, inertia: 0.01, frames: {end: [0.3, 0]}}
frames: {ground/r: [0, -0.05]}
joints:
  p: {type: revolute, between: [ground, wheel]}
  s: {type: prismatic, between: [ground/r, rack]}
  mesh: {type: gear, of: [p, s], ratio: 0.05}
forces: {load: {type: force, at: rack/end, value: [-20, 0]}}
drivers: {motor: {joint: p, kind: angle, value: 0.5*sin(2*pi*t)}}
simulation: {end: 1, step: 1e-3}
"""
# A motor with an unbalanced rotor on a spring, whose offset is no length of the machine.
SHAKER = """freeplay: 1
gravity: [0, -9.81]
bodies:
  frame: {mass: 20, inertia: 1, frames: {axle: [0, 0.2]}}
  rotor: {mass: 3, inertia: 0.02, com: [0.001, 0]}
frames: {ground/up: {angle: 90 deg}, frame/up: {angle: 90 deg}, ground/floor: [0, -0.3]}
joints:
  guide: {type: prismatic, between: [ground/up, frame/up]}
  axle: {type: revolute, between: [frame/axle, rotor]}
forces: {foot: {type: spring-damper, between: [ground/floor, frame], stiffness: 3e4, free_length: 0.307}}
drivers: {motor: {joint: axle, kind: velocity, value: 1000 rpm}}
initial: {joints: {guide: 0}}
simulation: {end: 0.1, step: 1e-4}
"""
# A spindle in a loose bearing, turned through a coupling.
COUPLED = """freeplay: 1
bodies:
  spindle: {mass: 0.1, inertia: 4e-6, com: [2e-6, 0]}
  motor: {mass: 0.3, inertia: 2e-5}
joints:
  hub: {type: revolute, between: [ground, motor]}
  seat: {type: revolute, bearing: ground, journal: spindle, clearance: {bearing_radius: 6 mm, radial_clearance: 20 um,
         material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.6}}}
forces: {coupling: {type: spring-damper, kind: rotational, between: [motor, spindle], stiffness: 40}}
drivers: {motor: {joint: hub, kind: velocity, value: 9000 rpm}}
simulation: {end: 0.01, step: 1e-5}
"""
# An eccentric with a heavy flywheel, a rope with a load, a hammer whose head is far from its pivots.
ECCENTRIC = """freeplay: 1
bodies:
  wheel: {mass: 900, inertia: 900*0.5^2, frames: {pin: [0.015, 0]}}
  rod: {mass: 25, inertia: 0.4, com: [0.1, 0], frames: {end: [0.3, 0]}}
  ram: {mass: 150, inertia: 8}
joints:
  main: {type: revolute, between: [ground, wheel]}
  pin: {type: revolute, between: [wheel/pin, rod]}
  end: {type: revolute, between: [rod/end, ram]}
  guide: {type: prismatic, between: [ground, ram]}
drivers: {motor: {joint: main, kind: velocity, value: 80 rpm}}
initial: {joints: {main: 0.5}}
simulation: {end: 0.1, step: 1e-3}
"""
ROPE = """freeplay: 1
gravity: [0, -9.81]
bodies:
  rope: {mass: 3 kg, inertia: 3 kg*(80 m)^2/12, com: [40 m, 0], frames: {hook: [80 m, 0]}}
  load: {mass: 300 kg, inertia: 60, frames: {eye: [0, 0.6 m]}}
joints:
  top: {type: revolute, between: [ground, rope]}
  hook: {type: revolute, between: [rope/hook, load/eye]}
initial: {joints: {top: -85 deg, hook: 90 deg}}
simulation: {end: 0.1, step: 1e-3}
"""
HAMMER = """freeplay: 1
gravity: [0, -9.81]
bodies: {hammer: {mass: 15, inertia: 0.3, com: [0.8, 0], frames: {cam: [-0.07, 0]}}}
joints: {axle: {type: revolute, between: [ground, hammer]}}
forces: {lift: {type: force, at: hammer/cam, value: [0, -1000]}}
initial: {joints: {axle: 0}}
simulation: {end: 0.1, step: 1e-3}
"""
BOB = """freeplay: 1
gravity: [0, -9.81]
bodies: {bob: {mass: 30 kg, inertia: 0.05, com: [50 m, 0]}}
joints: {top: {type: revolute, between: [ground, bob]}}
initial: {joints: {top: -88 deg}}
simulation: {end: 0.1, step: 1e-3}
"""
SATELLITE = """freeplay: 1
space: spatial
bodies:
  bus: {mass: 300, inertia: [50, 60, 40], frames: {wheel: [0.2, 0, 0.1]}}
  wheel: {mass: 6, inertia: [0.02, 0.02, 0.03]}
joints: {axle: {type: revolute, between: [bus/wheel, wheel]}}
drivers: {motor: {joint: axle, kind: torque, value: 0.2}}
simulation: {end: 1, step: 0.01}
"""
HOURS = """freeplay: 1
gravity: [0, -9.81]
bodies: {hand: {mass: 1 g, inertia: 1e-6, com: [30 mm, 0], frames: {tip: [90 mm, 0]}}}
joints: {arbor: {type: revolute, between: [ground, hand]}}
drivers: {works: {joint: arbor, kind: velocity, value: "-2*pi/3600"}}
initial: {joints: {arbor: 90 deg}}
simulation: {end: 86400, step: 30, output: {interval: 3600, frames: [hand/tip]}}
"""
HANGER = """freeplay: 1
gravity: [0, -9.81]
bodies: {arm: {mass: 0.5, inertia: 2e-3, com: [0.1, 0]}}
joints: {pivot: {type: revolute, between: [ground, arm]}}
initial: {joints: {pivot: 0.1 rad}}
simulation: {end: 1 s, step: 1 ms}
"""
# A tappet on a disc cam, and a roller on an arm against one.
CAM = """freeplay: 1
gravity: [0, -9.81]
bodies:
  cam: {mass: 1.2 kg, inertia: 1e-3}
  tappet: {mass: 80 g, inertia: 2e-5, pose: {position: [0, 25 mm]}, frames: {v: {angle: 90 deg}}}
frames: {ground/v: {angle: 90 deg}}
joints:
  axle: {type: revolute, between: [ground, cam]}
  guide: {type: prismatic, between: [ground/v, tappet/v]}
  touch: {type: point-on-curve, form: polar, between: [cam, tappet],
          curve: "25 mm + 8 mm*(smooth(x, 60 deg, 120 deg) - smooth(x, 180 deg, 240 deg))"}
drivers: {m: {joint: axle, kind: velocity, value: 300 rpm}}
initial: {joints: {axle: 0}}
simulation: {end: 0.4 s, accuracy: 1 um}
"""
PLATE = """freeplay: 1
gravity: [0, -9.81]
bodies:
  arm: {mass: 0.5 kg, inertia: 1e-3, com: [50 mm, 0], frames: {r: [100 mm, 0]}, pose: {angle: 0}}
  cam: {mass: 1 kg, inertia: 1e-3}
frames: {ground/c: [100 mm, -35 mm]}
joints:
  A: {type: revolute, between: [ground, arm]}
  C: {type: revolute, between: [ground/c, cam]}
drivers: {m: {joint: C, kind: velocity, value: 20 rad/s}}
initial: {joints: {A: 0, C: 0}}
forces:
  t: {type: curve-contact, between: [cam, arm/r], second: 8 mm, contact: {law: hu-guo, K: 1e9, restitution: 0.5},
      first: "20 mm + 8 mm*(smooth(x, 100 deg, 180 deg) - smooth(x, 180 deg, 260 deg))"}
simulation: {end: 0.5 s, accuracy: 1 um}
"""
# A contact that damps by its law alone, and a growth of the effort of a stop by the speed, 1 s/m where nothing is said.
STOP = """freeplay: 1
bodies: {pin: {mass: 1e-8 kg, inertia: 1e-15 kg*m^2}}
joints: {g: {type: prismatic, between: [ground, pin]}}
forces: {st: {type: joint-stop, between: [ground, pin], lower: -1 mm, upper: 1 mm, contact: {law: hertz, K: 1e9}}}
initial: {speeds: {g: 0.5 m/s}}
simulation: {end: 20 ms, accuracy: 0.1 um}
"""
