"""Lengths, parts and springs that make another mechanism than is meant: what is wrong is named, and what is meant is not doubted."""
import json
import unittest

from program import ProgramTest

STRUT = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {up: {position: [0, 0], angle: 90 deg}, road: {position: [0.42, 0], angle: 90 deg}}}
  body: {mass: 320, inertia: 90, com: [0, 0.55], frames: {up: {position: [0, 0], angle: 90 deg}, pivot: [0, 0.35], top: [0.3, 0.75]}}
  arm: {mass: 42, inertia: 1.6, com: [0.36, 0], frames: {hub: [0.42, 0], seat: [0.3, 0.03]}, pose: {position: [0, 0.35], angle: -8 deg}}
  road: {mass: 1, inertia: 0.01, frames: {up: {position: [0, 0], angle: 90 deg}}}
joints:
  heave: {type: prismatic, between: [ground/up, body/up]}
  pivot: {type: revolute, between: [body/pivot, arm]}
  track: {type: prismatic, between: [ground/road, road/up]}
forces:
  coil: {type: spring-damper, between: [body/top, arm/seat], stiffness: 32e3, damping: 2200, free_length: 0.56}
  tyre: {type: spring-damper, between: [road, arm/hub], stiffness: 190e3, damping: 250, free_length: 0.31}
drivers: {bump: {joint: track, kind: position, value: "0.05*(smooth(t, 0.1, 0.2) - smooth(t, 0.3, 0.4))"}}
simulation: {end: 0.5, accuracy: 1e-6}
"""
LAMP = """freeplay: 1
gravity: [0, -9.81]
bodies: {arm: {mass: 1.2, inertia: 0.03, com: [0.25, 0], frames: {end: [0.5, 0]}}, head: {mass: 0.4, inertia: 1e-3}}
joints: {hinge: {type: revolute, between: [ground, arm]}, neck: {type: revolute, between: [arm/end, head]}}
forces:
  spring: {type: spring-damper, kind: rotational, between: [ground, arm], stiffness: 20 N*m/rad, damping: 0.5}
  grip: {type: spring-damper, kind: rotational, between: [arm/end, head], stiffness: 2 N*m/rad, damping: 0.01}
initial: {joints: {hinge: 0, neck: 0}}
simulation: {end: 0.5, accuracy: 1e-6}
"""
HOIST = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {m: [0.6, 8], d: [0, 8], well: {position: [-0.15, 0], angle: 90 deg}}}
  rotor: {mass: 25, inertia: 0.02}
  drum: {mass: 90, inertia: 1.1}
  cage: {mass: 600, inertia: 150, frames: {up: {position: [0, 0], angle: 90 deg}}}
joints:
  motor_shaft: {type: revolute, between: [ground/m, rotor]}
  drum_shaft: {type: revolute, between: [ground/d, drum]}
  well: {type: prismatic, between: [ground/well, cage/up]}
  reducer: {type: gear, of: [motor_shaft, drum_shaft], ratio: -0.05}
  rope: {type: gear, of: [drum_shaft, well], ratio: -0.15}
drivers: {motor: {joint: motor_shaft, kind: torque, value: "55*(smooth(t, 0, 0.2) - smooth(t, 1.5, 1.6))"}}
initial: {joints: {well: 0.5}}
simulation: {end: 2, accuracy: 1e-6}
"""
FORCED = HOIST.replace(HOIST[HOIST.index("drivers:"):HOIST.index("initial:")],
                       'forces: {motor: {type: torque, on: rotor, value: "55 N*m*(1 - joint.motor_shaft.speed/(150 rad/s))"}}\n')
FLYWHEEL = """freeplay: 1
bodies: {wheel: {mass: 2, inertia: 0.1}, box: {mass: 1, inertia: 0.1, com: [0.2, 0]}}
joints: {axle: {type: revolute, between: [ground, wheel]}, bolts: {type: fixed, between: [ground, box]}}
initial: {speeds: {axle: 10}}
simulation: {end: 1, accuracy: 1 um}
"""
CRUSHER = """freeplay: 1
bodies:
  shaft: {mass: 60, inertia: 0.4, frames: {pin: [12 mm, 0]}}
  jaw: {mass: 300, inertia: 40, com: [0, -0.5], frames: {toe: [0, -1.1]}}
  toggle: {mass: 30, inertia: 0.5, com: [0.195, 0], frames: {end: [0.39, 0]}}
frames: {ground/seat: [-0.32, -1.2]}
joints:
  main: {type: revolute, between: [ground, shaft]}
  pitman: {type: revolute, between: [shaft/pin, jaw]}
  front: {type: revolute, between: [jaw/toe, toggle/end]}
  rear: {type: revolute, between: [ground/seat, toggle]}
drivers: {motor: {joint: main, kind: velocity, value: 26}}
simulation: {end: 0.2, accuracy: 1 um}
"""
SCREEN = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {l: [-0.8, 0], r: [0.8, 0]}}
  deck: {mass: 260, inertia: 60, frames: {l: [-0.8, 0], r: [0.8, 0], shaft: [0, 0.1]}, pose: {position: [0, 0.2]}}
  rotor: {mass: 12, inertia: 0.1, com: [6 mm, 0]}
joints: {shaft: {type: revolute, between: [deck/shaft, rotor]}}
forces:
  left: {type: spring-damper, between: [ground/l, deck/l], stiffness: 60e3, damping: 300, free_length: 0.222}
  right: {type: spring-damper, between: [ground/r, deck/r], stiffness: 60e3, damping: 300, free_length: 0.222}
drivers: {motor: {joint: shaft, kind: velocity, value: "100*smooth(t, 0, 1)"}}
simulation: {end: 2, accuracy: 1 um}
"""
# A slot along the way in place of across it: far out, a turn of the yoke by 0.03 mrad would bring the slot to the pin.
YOKE = """freeplay: 1
bodies:
  crank: {mass: 1.1, inertia: 6e-4, frames: {pin: [30 mm, 0]}}
  yoke: {mass: 0.9, inertia: 2e-3, frames: {slot: {angle: 90 deg}, face: [80 mm, 0]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  way: {type: prismatic, between: [ground, yoke]}
  slot: {type: point-on-line, between: [yoke/slot, crank/pin]}
forces: {gas: {type: spring-damper, between: [ground, yoke/face], stiffness: 2 N/mm, damping: 15, free_length: 100 mm}}
drivers: {motor: {joint: main, kind: velocity, value: 300 rpm}}
initial: {joints: {main: 40 deg}}
simulation: {end: 0.1, accuracy: 1 um}
"""
# A crank in space about its own length.
SPUN = """freeplay: 1
space: spatial
bodies:
  crank: {mass: 0.3, inertia: [1e-5, 2e-4, 2e-4], frames: {tip: [0.035, 0, 0]}}
  rod: {mass: 0.2, inertia: [2e-5, 1e-3, 1e-3], com: [0.1, 0, 0], frames: {end: [0.2, 0, 0]}, pose: {position: [0.035, 0, 0]}}
  slide: {mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], pose: {position: [0.235, 0, 0]}}
joints:
  main: {type: revolute, between: [ground, crank], axis: [0, 0, 1]}
  big: {type: spherical, between: [crank/tip, rod]}
  small: {type: spherical, between: [rod/end, slide]}
  bore: {type: prismatic, between: [ground, slide], axis: [1, 0, 0]}
drivers: {motor: {joint: main, kind: velocity, value: 60}}
initial: {joints: {main: 0.5}}
simulation: {end: 0.1, accuracy: 1 um}
"""
LINK = "jaw: {mass: 300, inertia: 40, com: [0, -0.5]"
SLIPS = [
    (STRUT, "stiffness: 32e3", "stiffness: 32", "doubtful-value", "'coil' is so weak that it would have to give by 138 m"),
    (LAMP, "stiffness: 20 N*m/rad", "stiffness: 0.02 N*m/rad", "doubtful-value", "'spring' is so weak that it would have to give by"),
    (HOIST, "inertia: 0.02", "inertia: 200", "doubtful-inertia", "a ball of that size would be as light as air"),
    (HOIST, "smooth(t, 1.5, 1.6)", "smooth(t, 1500, 1600)", "doubtful-time", "and again at 1500 s"),
    (FORCED, "  rope:", "  direct: {type: gear, of: [motor_shaft, drum_shaft], ratio: 0.1}\n  rope:", "locked", "nothing can move"),
    (CRUSHER, LINK, LINK.replace("[0, -0.5]", "[0.01 m, -50]"), "doubtful-length", "write the unit after the numbers, as in '50 mm'"),
    (CRUSHER, "shaft: {mass: 60,", "shaft: {mass: 60, com: [30, 0],", "doubtful-length", "the centre of mass of 'shaft' is 29.99 m away from its joints"),
    (SCREEN, "[ground/r, deck/r]", "[ground/l, deck/r]", "doubtful-length", "'right' starts pulled to 7.26 times its free length"),
    (SCREEN, "100*smooth", "1000*smooth", "doubtful-speed", "that is 9549 rpm"),
    (SPUN, "crank], axis: [0, 0, 1]", "crank], axis: [1, 0, 0]", "locked", "driver 'motor' moves nothing but 'crank'"),
]
OPEN = [
    (CRUSHER, "[12 mm, 0]", "[12, 0]", "that of 'shaft' is longer than the others together"),
    (CRUSHER, "[0.39, 0]", "[0.039, 0]", "the sides of its loop are 'shaft' 0.012 m, 'jaw' 1.1 m, 'toggle' 0.039 m and ground 1.242 m"),
    (CRUSHER, "front: {type: revolute, between: [jaw/toe, toggle/end]}\n  rear: {type: revolute",
     "front: {type: fixed, between: [jaw/toe, toggle/end]}\n  rear: {type: fixed", "hold 1 freedom more than the bodies have"),
    (YOKE, "slot: {angle: 90 deg}", "slot: [0, 0]", "m away: check the directions of slides and slots"),
]
# A bearing that rests 60 nm deep under its load.
ROBOT = """freeplay: 1
gravity: [0, -9.81]
bodies:
  upper: {mass: 6, inertia: 0.06, com: [0.17, 0], frames: {elbow: [0.35, 0]}}
  fore: {mass: 3.5, inertia: 0.035, com: [0.12, 0], pose: {position: [0.29, -0.18], angle: 58 deg}}
joints:
  shoulder: {type: revolute, between: [ground, upper]}
  elbow:
    type: revolute
    bearing: upper/elbow
    journal: fore
    clearance: {bearing_radius: 0.015, radial_clearance: 2e-5, length: 0.03, material: {E: 210e9, nu: 0.3}, contact: {law: johnson, damping: flores, restitution: 0.6}, initial: loaded}
drivers:
  one: {joint: shoulder, kind: angle, value: "-0.6 + 0.3*sin(2*pi*t)"}
  two: {joint: elbow, kind: angle, value: "1.6 + 0.3*sin(2*pi*t)"}
simulation: {end: 1, accuracy: %s}
"""


# A plunger in a lever, whose spring holds it in.
PLUNGER = """freeplay: 1
gravity: [0, -9.81]
bodies: {lever: {mass: 1, inertia: 0.02, com: [0.1, 0], frames: {bore: [0.2, 0]}}, plunger: {mass: 0.3, inertia: 1e-3}}
joints: {pivot: {type: revolute, between: [ground, lever]}, bore: {type: prismatic, between: [lever/bore, plunger]}}
forces: {spring: {type: spring-damper, between: [lever, plunger], stiffness: 400, damping: 5, free_length: 0.2}}
initial: {joints: {pivot: -30 deg, bore: 0}}
simulation: {end: 2, accuracy: 1 um}
"""
# A block that is thrown up from a curve and is back after 0.2 s.
THROWN = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {rail: {angle: 90 deg}, curve: [0, 0]}}
  block: {mass: 2, inertia: 1, frames: {rail: {angle: 90 deg}}}
joints:
  guide: {type: prismatic, between: [ground/rail, block/rail]}
  c: {type: point-on-curve, between: [ground/curve, block], curve: 0*x, lift_off: {contact: {law: kelvin-voigt, K: 2e5, D: 50}}}
initial: {speeds: {guide: 1}}
simulation: {end: %s, accuracy: 1 um}
"""
# A knuckle-joint press.
PRESS = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {head: [450 mm, 300 mm], slide: {position: [450 mm, 0], angle: -90 deg}}}
  crank: {mass: 8 kg, inertia: 0.03, frames: {pin: [60 mm, 0]}}
  rod: {mass: 5 kg, inertia: 0.06, com: [180 mm, 0], frames: {end: [360 mm, 0]}, pose: {position: [0, -60 mm], angle: 23 deg}}
  upper: {mass: 6 kg, inertia: 0.035, com: [125 mm, 0], frames: {knee: [250 mm, 0]}, pose: {position: [450 mm, 300 mm], angle: -118 deg}}
  lower: {mass: 6 kg, inertia: 0.035, com: [125 mm, 0], frames: {end: [250 mm, 0]}, pose: {position: [332 mm, 80 mm], angle: -62 deg}}
  ram: {mass: 30 kg, inertia: 0.15, pose: {position: [450 mm, -141 mm], angle: -90 deg}}
joints:
  main: {type: revolute, between: [ground, crank]}
  pin: {type: revolute, between: [crank/pin, rod]}
  head: {type: revolute, between: [ground/head, upper]}
  knee: {type: revolute, between: [rod/end, upper/knee]}
  knuckle:
    type: revolute
    bearing: lower
    journal: upper/knee
    clearance: {bearing_radius: 25 mm, radial_clearance: 60 um, length: 60 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.7}, initial: loaded}
  wrist: {type: revolute, between: [lower/end, ram]}
  guide: {type: prismatic, between: [ground/slide, ram]}
drivers: {motor: {joint: main, kind: velocity, value: 60 rpm}}
forces: {blank: {type: force, at: ram, value: [0, "15 kN*smooth(-body.ram.y, 170 mm, 190 mm)"]}}
initial: {joints: {main: -90 deg}}
simulation: {end: 0.7 s, accuracy: 2 um, output: {interval: 1 ms}}
"""
SWUNG = PRESS.replace("initial: {joints: {main: -90 deg}}\n", "").replace(
    "kind: velocity, value: 60 rpm", 'kind: angle, value: "-90 deg + 20 deg*sin(t*3 rad/s)"')
# A valve whose cam dwells at the start.
VALVE = """freeplay: 1
bodies:
  ground: {frames: {bore: {position: [0, 0], angle: 90 deg}, shaft: [30 mm, 220 mm], stem: {position: [75 mm, 150 mm], angle: 90 deg}, seat: [75 mm, 180 mm]}}
  cam: {mass: 0.6, inertia: 1.2e-4}
  tappet: {mass: 55 g, inertia: 1e-5, frames: {axis: {angle: 90 deg}, cup: [0, 50 mm]}, pose: {position: [0, 18 mm]}}
  rod: {mass: 40 g, inertia: 8e-5, com: [0, 76 mm], frames: {ball: [0, 152 mm]}, pose: {position: [0, 68 mm]}}
  rocker: {mass: 110 g, inertia: 4.5e-5, com: [4 mm, 2 mm], frames: {cup: [-30 mm, 0], nose: [45 mm, 0]}, pose: {position: [30 mm, 220 mm]}}
  valve: {mass: 75 g, inertia: 6e-5, com: [0, -60 mm], frames: {axis: {angle: 90 deg}, top: [0, 0]}, pose: {position: [75 mm, 220 mm]}}
joints:
  camshaft: {type: revolute, between: [ground, cam]}
  bore: {type: prismatic, between: [ground/bore, tappet/axis]}
  follower: {type: point-on-curve, form: polar, between: [cam, tappet], curve: "18 mm + 5 mm*(smooth(x, 120 deg, 180 deg) - smooth(x, 180 deg, 240 deg))"}
  lower: {type: revolute, between: [tappet/cup, rod]}
  upper: {type: revolute, between: [rod/ball, rocker/cup]}
  shaft: {type: revolute, between: [rocker, ground/shaft]}
  contact: {type: point-on-line, between: [valve/top, rocker/nose]}
  stem: {type: prismatic, between: [ground/stem, valve/axis]}
drivers: {belt: {joint: camshaft, kind: velocity, value: 1200 rpm}}
forces: {spring: {type: spring-damper, between: [ground/seat, valve/top], stiffness: 25 kN/m, damping: 8 N*s/m, free_length: 50 mm}}
initial: {joints: {camshaft: 180 deg}}
simulation: {end: 30 ms, accuracy: 0.2 um}
"""
# An arm that draws.
PLOTTER = """freeplay: 1
bodies:
  upper: {mass: 2, inertia: 0.02, com: [0.15, 0], frames: {elbow: [0.3, 0]}, pose: {angle: 40 deg}}
  fore: {mass: 1, inertia: 0.01, com: [0.15, 0], frames: {pen: [0.3, 0]}, pose: {position: [0.23, 0.19], angle: -40 deg}}
joints: {shoulder: {type: revolute, between: [ground, upper]}, elbow: {type: revolute, between: [upper/elbow, fore]}}
drivers: {move: {inverse_kinematics: {frame: fore/pen, path: {x: "0.4 m + 40 mm*cos(360 deg*t/1 s)", y: "50 mm*smooth(t, 0, 1 s)"}, joints: [shoulder, elbow]}}}
simulation: {end: 1, accuracy: 1 um}
"""
# A four-bar whose rocker pulls a ram along a rail and, by a stay, a lever: each loop but the first hangs on the first.
SHAPER = """freeplay: 1
bodies:
  ground: {frames: {rocker: [160 mm, 0], lever: {position: [260 mm, 450 mm], angle: 120 deg}, rail: [0, 300 mm]}}
  crank: {mass: 1, inertia: 1e-3, frames: {pin: [50 mm, 0]}}
  coupler: {mass: 1, inertia: 1e-3, frames: {end: [160 mm, 0]}, pose: {position: [50 mm, 0], angle: 40 deg}}
  rocker: {mass: 2, inertia: 1e-2, frames: {pin: [120 mm, 0], tip: [300 mm, 0]}, pose: {position: [160 mm, 0], angle: 90 deg}}
  stay: {mass: 1, inertia: 1e-3, frames: {end: [100 mm, 0]}, pose: {position: [160 mm, 300 mm]}}
  lever: {mass: 1, inertia: 1e-3, frames: {end: [150 mm, 0]}, pose: {position: [260 mm, 450 mm], angle: -90 deg}}
  link: {mass: 1, inertia: 1e-3, frames: {end: [110 mm, 0]}, pose: {position: [160 mm, 300 mm]}}
  ram: {mass: 4, inertia: 1e-2, pose: {position: [270 mm, 300 mm]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/pin, coupler]}
  knee: {type: revolute, between: [coupler/end, rocker/pin]}
  pivot: {type: revolute, between: [ground/rocker, rocker]}
  foot: {type: revolute, between: [rocker/tip, stay]}
  eye: {type: revolute, between: [stay/end, lever/end]}
  post: {type: revolute, between: [ground/lever, lever]}
  swing: {type: revolute, between: [rocker/tip, link]}
  wrist: {type: revolute, between: [link/end, ram]}
  rail: {type: prismatic, between: [ground/rail, ram]}
drivers: {motor: {joint: main, kind: velocity, value: 60 rpm}}
initial: {joints: {main: 0}}
simulation: {end: 0.1, accuracy: 1 um}
"""
SLIPS += [
    (PLOTTER, "50 mm*smooth", "50*smooth", "doubtful-length", "has a term of 50 m where the lengths of the mechanism are about"),
    (PLOTTER, "cos(360 deg*t/1 s)", "cos(50*smooth(t, 0, 1 s))", "doubtful-angle", "takes a sine, cosine or tangent of 50 rad"),
    (PRESS, "journal: upper/knee", "journal: upper", "locked", "bodies 'lower', 'ram' cannot move, though the mechanism can: joints 'knuckle', 'wrist', 'guide' hold them"),
    (PRESS, "170 mm, 190 mm", "170, 190", "doubtful-length", "compares 'body.ram.y' with 170 m in a mechanism of"),
    (PRESS, "smooth(-body.ram.y, 170 mm, 190 mm)", "if(body.ram.y < -170, 1, 0)", "doubtful-length", "write '170 mm'"),
    (PRESS, "smooth(-body.ram.y, 170 mm, 190 mm)", "if(joint.main.angle > 30, 1, 0)", "doubtful-angle", "compares 'joint.main.angle' with 30 rad, 4.77 turns"),
    (PRESS, "smooth(-body.ram.y, 170 mm, 190 mm)", "max(joint.head.angle - 40, 0)", "doubtful-angle", "write '40 deg'"),
    (PRESS, "smooth(-body.ram.y, 170 mm, 190 mm)", "sin(360*t/2 s)", "doubtful-angle", "takes a sine, cosine or tangent of 360 rad"),
    (SWUNG, "-90 deg + 20", "-90 + 20", "doubtful-angle", "has a term of 90 rad, 14.3 turns"),
    (SWUNG, "20 deg*sin", "20*sin", "doubtful-angle", "has a term of 20 rad"),
]
OPEN += [
    (PRESS, "207 GPa", "207", "joint 'knuckle' has no start: its load presses it"),
    (VALVE, "18 mm + 5 mm*", "18 + 5*", "joint 'follower' stays open"),
    # The shortest loop through 'pivot' is that of the four-bar, which closes.
    (SHAPER, "frames: {end: [150 mm, 0]}", "frames: {end: [15 mm, 0]}",
     "the sides of its loop are 'stay' 0.1 m, 'lever' 0.015 m, ground 0.461 m and 'rocker' 0.3 m, and that of ground is longer than the others together (joints 'foot', 'eye', 'post' and 'pivot')"),
    (SHAPER, "between: [link/end, ram]", "between: [link/end, rocker]", "the sides of its loop are 'link' 0.11 m and 'rocker' 0.3 m, and that of 'rocker' is longer"),
    (SHAPER, "between: [link/end, ram]", "between: [link/end, rocker/tip]", "its loop has one side, 'link' 0.11 m (joints 'swing' and 'wrist')"),
    (SHAPER, "rail: [0, 300 mm]", "rail: [0, 700 mm]", "joints 'pivot', 'swing', 'wrist' and 'rail' contradict each other (bodies 'rocker', 'link' and 'ram')"),
    (SHAPER, "\ndrivers:", "\n  rest: {type: prismatic, between: [ground/lever, ram]}\ndrivers:", "joints 'rail' and 'rest' contradict each other (body 'ram')"),
    (SHAPER, "coupler/end, rocker/pin]", "coupler/end, rocker]",
     "joints 'main', 'crankpin', 'knee' and 'pivot' and the start value of 'main' contradict each other (bodies 'crank', 'coupler' and 'rocker')"),
    (SHAPER, "joints: {main: 0}", "joints: {pivot: 270 deg}", "and the start value of 'pivot' contradict each other"),
    (FLYWHEEL, "joints: {axle:", "frames: {ground/askew: {position: [0, 2], angle: 120 deg}}\njoints: {slide: {type: prismatic, between: [ground/askew, box]}, axle:",
     "stays open by 1 m and 120 deg with all others closed; joints 'slide' and 'bolts' contradict each other"),
    (SPUN, "[ground, slide]", "[ground, rod]", "joints 'main', 'big' and 'bore' and the start value of 'main' contradict each other (bodies 'crank' and 'rod')"),
]

# A head that a loose parallel rod keeps upright.
PARALLEL = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {rear: [0, 60 mm]}}
  arm: {mass: 2, inertia: 0.02, com: [150 mm, 0], frames: {end: [300 mm, 0], hook: [60 mm, 0]}, pose: {angle: 30 deg}}
  rod: {mass: 0.4, inertia: 4e-3, com: [150 mm, 0], frames: {end: [300 mm, 0]}, pose: {position: [0, 60 mm], angle: 30 deg}}
  head: {mass: 0.5, inertia: 1e-3, com: [20 mm, 30 mm], frames: {back: [0, 60 mm]}, pose: {position: [259.81 mm, 150 mm]}}
joints:
  shoulder: {type: revolute, between: [ground, arm]}
  rear: {type: revolute, between: [ground/rear, rod]}
  front: {type: revolute, between: [arm/end, head]}
  link:
    type: revolute
    bearing: rod/end
    journal: head/back
    clearance: {bearing_radius: 5 mm, radial_clearance: 25 um, length: 14 mm, material: {E: 70 GPa, nu: 0.33}, contact: {law: flores, restitution: 0.7}, initial: loaded}
forces:
  balance: {type: spring-damper, between: [ground/rear, arm/hook], stiffness: 1.2 N/mm, free_length: 40 mm}
  rub: {type: joint-friction, kind: rotational, between: [rod/end, head/back], friction: 0.01 N*m}
drivers: {motor: {joint: shoulder, kind: angle, value: "30 deg + 20 deg*sin(t*3 rad/s)"}}
simulation: {end: 0.5 s, accuracy: 1 um}
"""
TORQUE = PRESS.replace("drivers: {motor: {joint: main, kind: velocity, value: 60 rpm}}", "").replace(
    "forces: {blank:", "forces: {turn: {type: torque, on: crank, value: 40 N*m}, rub: {type: joint-friction, between: [ground/slide, ram], friction: 20 N}, blank:")
NAMED = PRESS.replace("15 kN*", "$load*").replace("simulation:", "parameters: {load: 15 kN}\nsimulation:")
STOPPED = SWUNG.replace("forces: {blank:", "forces: {stop: {type: joint-stop, kind: rotational, between: [ground, crank], lower: -120 deg, upper: -60 deg, stiffness: 100 N*m/rad}, blank:")
SLIPS += [
    (PARALLEL, "between: [ground/rear, rod]", "between: [ground, rod]", "same-frame",
     "joints 'shoulder' and 'rear' hold 'ground' at one place, so that 'arm', 'rod', 'head' move as one body"),
    (PARALLEL, "kind: rotational, between: [rod/end, head/back], friction: 0.01 N*m", "between: [rod/end, head/back], friction: 3 N", "idle-force",
     "'rub' moves nothing: joint 'link' keeps 'head' from moving"),
    (TORQUE, "  guide: {type: prismatic, between: [ground/slide, ram]}\n", "", "left-free", "no joint guides 'ram' along it against 'ground'"),
    (CRUSHER, "value: 26", "value: 720", "doubtful-speed", "that is 6875 rpm: write '720 deg/s' or '720 rpm'"),
    (CRUSHER, "jaw: {mass: 300", "jaw: {mass: 0.3", "doubtful-inertia", "but its frames reach 0.6 m: check mass and inertia"),
    (STOPPED, "20 deg*sin", "90 deg*sin", "doubtful-value", "driver 'motor' moves joint 'main' 60 deg beyond the ends of 'stop'"),
    (NAMED, "forces: {blank:", 'forces: {again: {type: force, at: ram, value: [0, "$load*smooth(-body.ram.y, 170 mm, 190 mm)"]}, blank:', "duplicate-force",
     "'blank' is the same force at the same place as 'again'"),
]


class WrongPart(ProgramTest):
    def messages(self, text, code=0):
        out, _ = self.freeplay("validate", self.write("m.yaml", text), "--json", code=code)
        return [(m["id"], m["message"]) for m in json.loads(out)["messages"]]

    def test_each_is_named_once(self):
        for model, old, new, wanted, words in SLIPS:
            with self.subTest(new):
                self.assertEqual(1, model.count(old))
                found = self.messages(model.replace(old, new))
                self.assertEqual([wanted], [one for one, _ in found if one == wanted], found)
                self.assertTrue(any(words in message for _, message in found), found)

    def test_a_loop_that_does_not_close_shows_its_sides_and_what_is_held_too_much(self):
        for model, old, new, words in OPEN:
            with self.subTest(new):
                self.assertEqual(1, model.count(old))
                found = [message for one, message in self.messages(model.replace(old, new), code=3) if one == "assembly-failed"]
                self.assertIn(words, "".join(found))

    def test_what_is_meant_is_not_doubted(self):
        turned = PRESS.replace("smooth(-body.ram.y, 170 mm, 190 mm)", "if(joint.main.angle > 30 rad, 100, 10)*smooth(joint.head.angle, 20 deg, 40 deg)")
        swings = SWUNG.replace("20 deg*sin(t*3 rad/s)", "0.4*sin(t*3 rad/s) + 0.2*smooth(t, 0 s, 360 s)")
        for text in (STRUT, LAMP, HOIST, FORCED, FLYWHEEL, CRUSHER, SCREEN, YOKE, SPUN, PRESS, VALVE, PLOTTER, SHAPER, PARALLEL, TORQUE, NAMED, STOPPED, turned, swings):
            with self.subTest(text[:300]):
                self.assertEqual([], self.messages(text))

    def test_a_curve_in_metres_is_doubted_where_nothing_can_be_put_together(self):
        found = self.messages(VALVE.replace("18 mm + 5 mm*", "18 + 5*"), code=3)
        self.assertTrue(any(one == "doubtful-length" and "'joints.follower.curve' is 23 m" in message for one, message in found), found)
        found = self.messages(VALVE.replace("5 mm*(", "5*("))
        self.assertTrue(any(one == "doubtful-length" and "goes from 0.018 m to 5.018 m" in message for one, message in found), found)

    def test_a_mechanism_on_which_nothing_acts_is_in_the_verdict(self):
        self.assertEqual([("doubtful-structure", None)], self.verdict(FLYWHEEL.replace("axle: 10", "axle: 0")))

    def test_what_falls_as_a_whole_is_named(self):
        chain = LAMP[:LAMP.index("forces:")].replace("hinge: {type: revolute, between: [ground, arm]}, ", "") + "simulation: {end: 0.5, accuracy: 1e-6}\n"
        self.assertEqual([("not-connected", "no joint or force ties any body to ground, so that all of them fall: connect one, or give a velocity")], self.messages(chain))
        self.assertEqual([], self.messages(chain.replace("head: {mass: 0.4,", "head: {velocity: {angular: 1}, mass: 0.4,")))

    def verdict(self, text):
        self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force")
        return [(r["id"], r["element"]) for r in json.loads(self.read("r", "summary.json"))["trust"]["reasons"]]

    def test_a_body_that_slides_off_another_is_in_the_verdict(self):
        self.assertEqual([], self.verdict(PLUNGER))
        loose = "spring: {type: spring-damper, between: [lever, plunger], stiffness: 400, damping: 5, free_length: 0.2}"
        drag = "drag: {type: spring-damper, kind: rotational, between: [ground, lever], stiffness: 30, damping: 1}"
        self.assertEqual([("out-of-reach", "joint 'bore'")], self.verdict(PLUNGER.replace(loose, drag)))

    def test_a_follower_that_never_touches_is_in_the_verdict(self):
        self.assertEqual([], self.verdict(THROWN % "0.4 s"))
        self.assertEqual([("never-touches", "joint 'c'")], self.verdict(THROWN % "0.2 s"))
        # A touch of a rounding is none.
        self.assertEqual([("never-touches", "joint 'c'")], self.verdict((THROWN % "0.2 s").replace("-9.81", "0").replace("guide: 1}", "guide: -1e-15}")))

    def noise_and_peak(self, accuracy):
        self.freeplay("run", self.write("m.yaml", ROBOT % accuracy), "--out", "r", "--force")
        summary = json.loads(self.read("r", "summary.json"))
        return summary["noise"]["joints"]["elbow"]["max_force"], summary["joints"]["elbow"]["max_force"]

    def test_what_a_bearing_rings_with_under_a_coarse_accuracy_is_noise_of_its_force(self):
        fine_noise, fine = self.noise_and_peak("10 nm")
        noise, coarse = self.noise_and_peak("10 um")
        self.assertLess(fine_noise, 1e-3 * fine)
        self.assertGreater(abs(coarse - fine), 1e-3 * fine)
        self.assertGreater(2.0 * noise, abs(coarse - fine))


if __name__ == "__main__":
    unittest.main()
