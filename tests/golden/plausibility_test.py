"""Models that can be read but are hardly meant: `validate` and `run` say so in one sentence, and stay silent otherwise."""
import glob
import json
import os
import unittest

from doubtful_models import (
    BELT, BOB, BOX, CAM, CART, COUPLED, CRANK, ECCENTRIC, FOOT, GUIDED, HAMMER, HANGER, HOURS, PLATE, RACK, ROD, ROPE,
    SATELLITE, SHAKER, SPATIAL, STOP, TEETH, TOGGLE, TRAIN, WATCH)
from program import ROOT, ProgramTest

DRIVEN = "kind: velocity, value: 100}}\ninitial: {joints: {main: 1}}"
PIN = "  crankpin: {type: revolute, between: [crank/tip, coupler]}\n"
GUIDE = "  guide: {type: prismatic, between: [ground, slider]}\n"
INERTIA, MASS, LENGTH, VALUE, ANGLE = ["doubtful-" + word for word in ("inertia", "mass", "length", "value", "angle")]
BEND = "  bend: {type: revolute, between: [upper/end, lower]}\n"

# Model, text, what stands in its place, id of the warning, line of the new text where it stands, words of the message.
PRESS = "  press: {type: force, at: box, value: [0, -100 N]}\n"
DRAG = PRESS.replace("-100 N", "-100 N*s/m*body.box.vy")
BRAKE = "{type: brake, between: [ground/b, two], limit: '2 N*m*smooth(t, 0, 0.1)', stiffness: 1 kN*m/rad}"
MISTAKES = [
    (HANGER, "inertia: 2e-3", "inertia: 200", INERTIA, "200", "its frames reach 0.1 m"),  # one pin: its length is the arm's
    (CRANK, "2.5e-4", "250", INERTIA, "250", "radius of gyration"),
    (CRANK, "inertia: 2.5e-4", "inertia: 250 kg*m^2", INERTIA, "250", "radius of gyration would be 34.5 m"),
    (CRANK, "inertia: 2.5e-4", "inertia: 2.5e5", INERTIA, "2.5e5", "radius of gyration"),  # g mm^2
    (CRANK, "inertia: 2.5e-4", "inertia: 2.5", INERTIA, "2.5,", "radius of gyration"),  # kg cm^2
    (CRANK, "mass: 0.3", "mass: 300", MASS, "300", "density"),
    (CRANK, "mass: 0.21", "mass: 210", MASS, "210", "density"),
    (CRANK, "mass: 0.21", "mass: 210 kg", MASS, "210", "density"),
    (CRANK, "[0.12, 0]", "[120, 0]", LENGTH, "[120", "120 mm"),
    (CRANK, "[0.12, 0]", "{position: [120, 0], angle: 10 deg}", LENGTH, "{position", "120 mm"),
    (CRANK, "[0.12, 0]", "{polar: [120, 10 deg]}", LENGTH, "{polar", "120 mm"),
    (CRANK, "[0.12, 0]", "[120 m, 0]", INERTIA, "2.5e-4", "its frame 'coupler/tip' is 119.9 m away"),
    (CRANK, "com: [0.06, 0], frames: {tip: [0.12, 0]}", "com: [60, 0], frames: {tip: [120, 0]}", LENGTH, "[60", "mm"),
    (CRANK, "com: [0.06, 0]", "com: [60, 0]", LENGTH, "[60", "mm"),
    (CRANK, "com: [0.06, 0]", "com: [0.2, 0]", "doubtful-com", "[0.2", "away from its frames"),
    (CRANK, "[0.3, 0]", "[300, 0]", LENGTH, "[300", "mm"),
    (CRANK, "bearing_radius: 0.01", "bearing_radius: 10", LENGTH, "10", "mm"),
    (CRANK, "length: 0.015", "length: 15", LENGTH, "15", "mm"),
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 0.5 nm", "doubtful-clearance", "wrist", "roughness"),
    (CRANK, "E: 207e9", "E: 207", VALUE, "207", "moduli"),
    (CRANK, "E: 207e9", "E: 207e3", VALUE, "207e3", "moduli"),
    (CRANK, "E: 207e9", "E: 207e9 GPa", VALUE, "207e9", "moduli"),
    (CRANK, "stiffness: 200", "stiffness: 200e12", VALUE, "200e12", "N/m"),
    (CRANK, "kind: velocity, value: 100", "kind: torque, value: 5e6", VALUE, "5e6", "N m on 0.65 kg"),
    (CRANK, "kind: velocity, value: 100", "kind: torque, value: 5e6 N*m*sin(300*t)", VALUE, "5e6", "more than any machine"),
    (CRANK, "forces:\n", "forces:\n  push: {type: force, at: slider, value: [-2e6 N, 0]}\n", VALUE, "[-2e6", "N on 0.65 kg"),
    (CRANK, "forces:\n", "forces:\n  turn: {type: torque, on: crank, value: 1e5}\n", VALUE, "1e5}", "N m on 0.65 kg"),
    (CRANK, "forces:\n", "forces:\n  rub: {type: joint-friction, between: [ground, slider], friction: 20, vs: 1e-12 m/s}\n", VALUE, "1e-12", "1 nm/s"),
    (CRANK, "forces:\n", "forces:\n  rub: {type: joint-friction, between: [ground, slider], friction: 20, vs: 1000}\n", VALUE, "1000", "1 nm/s"),
    (CRANK, "restitution: 0.9}", "restitution: 0.9}\n      friction: {law: coulomb-tanh, mu: 0.1, vs: 1e-12}", VALUE, "1e-12", "1 nm/s"),
    (CART, "kind: position, value: 0.1*sin(3*t)", "kind: force, table: {points: [[0, 0], [0.5, 3e6], [1, 0]]}", VALUE, "{points", "N on 1.2 kg"),
    (CRANK, "free_length: 0.15", "free_length: 150", LENGTH, "150", "mm"),
    (CRANK, "free_length: 0.15", "free_length: 0.15 mm", LENGTH, "buffer", "free length"),
    (CRANK, "-9.81", "-9810", VALUE, "[0, -9810", "mm/s^2"),
    (CRANK, "value: 100", "value: 3000", "doubtful-speed", "3000", "rpm"),
    (CRANK, DRIVEN, "kind: angle, value: 3000*t}}", "doubtful-speed", "3000*t", "rpm"),
    (CRANK, "{main: 1}", "{main: 60}", ANGLE, "60", "60 deg"),
    (CART, "{hinge: -1.2}", "{hinge: -1.2}, speeds: {hinge: 1500}", "doubtful-speed", "1500", "rpm"),
    (CRANK, "slider: {", "slider: {pose: {angle: 180}, ", ANGLE, "180", "deg"),
    (CRANK, "{ground/wall: [0.3, 0]}", "{ground/wall: {position: [0.3, 0], angle: 90}}", ANGLE, "90", "deg"),
    (CRANK, "tip: [0.05, 0]", "tip: {polar: [0.05, 45]}", ANGLE, "45", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: 60*sin(3*t)}}", ANGLE, "60", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: 60 + sin(3*t)}}", ANGLE, "60", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: 60 + 30*sin(2*pi*t)}}", ANGLE, "60", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: 'pi/3 + 30*sin(360 deg*t/(1 s))'}}", ANGLE, "'pi/3", "30 deg"),
    (CRANK, DRIVEN, "kind: angle, value: '4*pi + 30*sin(2*pi*t)'}}", ANGLE, "'4*pi", "30 deg"),
    (CRANK, DRIVEN, "kind: velocity, value: '3000*smooth(t, 0 s, 5 ms)'}}", "doubtful-speed", "'3000", "rpm"),
    (CRANK, DRIVEN, "kind: angle, value: '90*smooth(t, 0, 0.01)'}}", ANGLE, "'90", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: 60}}", ANGLE, "60", "deg"),
    (CRANK, "end: 0.02, step: 1e-5", "end: 2, step: 1", "doubtful-time", "1}", "ms"),
    (CRANK, "step: 1e-5", "step: 0.015 s, output: {interval: 0.015 s}", "doubtful-time", "100", "in one step"),
    (CRANK, "step: 1e-5", "step: 1e-5, output: {interval: 0.02}", "doubtful-time", "0.02}}", "ms"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10, 1], [20, 2]]}}}", "doubtful-time", "{points", "time_unit: ms"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10, 60], [20, 90]], unit: deg}}}", "doubtful-time", "{points", "time_unit: ms"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10, 60 deg], [20, 90 deg]]}}}", "doubtful-time", "{points", "time_unit: ms"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10, 90], [20, 0]], time_unit: ms}}}", ANGLE, "{points", "unit: deg"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [0.01, 90], [0.02, 0]]}}}", ANGLE, "{points", "unit: deg"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [0.005, 20], [0.01, 60], [0.02, 60]]}}}", ANGLE, "{points", "unit: deg"),
    (CRANK, PIN, PIN + PIN.replace("crankpin", "again"), "duplicate-joint", "again", "'crankpin'"),
    (CRANK, GUIDE, GUIDE + GUIDE.replace("guide", "guide2"), "duplicate-joint", "guide2", "'guide'"),
    (CRANK, GUIDE, GUIDE + "  pin: {type: revolute, between: [coupler/tip, slider]}\n", "play-bypassed", "wrist", "'pin'"),
    (CRANK, "joints:\n", "  block: {mass: 0.1, inertia: 1e-5}\njoints:\n  glue: {type: fixed, between: [slider, block]}\n"
                         "  pin: {type: revolute, between: [coupler/tip, block]}\n", "play-bypassed", "wrist", "what is fixed to the same"),
    # A triangle of pins.
    (CRANK, "joints:\n", "  block: {mass: 0.1, inertia: 1e-4, frames: {low: [0, -0.1], up: [0, 0.1]}, pose: {position: [0.14, 0], angle: 0}}\n"
     "  strut: {mass: 0.1, inertia: 1e-4, com: [-0.05, 0.05], frames: {up: [-0.1, 0.1]}, pose: {position: [0.24, 0], angle: 0}}\n"
     "joints:\n  foot: {type: revolute, between: [slider/low, block/low]}\n  side: {type: revolute, between: [slider/side, strut]}\n"
     "  top: {type: revolute, between: [strut/up, block/up]}\n  pin: {type: revolute, between: [coupler/tip, block]}\n", "play-bypassed",
     "wrist", "nowhere", {"slider: {": "slider: {frames: {low: [0, -0.1], side: [0.1, 0]}, "}),
    (CRANK, GUIDE, "", "left-free", "coupler", "guide"),
    (CRANK, "slider: {mass", "extra: {mass: 1, inertia: 0.01}\n  slider: {mass", "not-connected", "extra", "'extra'"),
    (CRANK, "slider: {mass", "one: {mass: 1, inertia: 0.01}\n  two: {mass: 1, inertia: 0.01}\n  slider: {mass", "not-connected", "one",
     "ties 'one' and 'two' to the others", {"joints:\n": "joints:\n  tie: {type: revolute, between: [one, two]}\n"}),
    (CRANK, "frames: {tip: [0.05, 0]}", "frames: {tip: [0.05, 0], twin: [0.05, 0]}", "unused", "twin", "frame 'twin'"),
    (CRANK, "ground/wall: [0.3, 0]", "ground/wall: [0.3, 0], ground/floor: [0, 0.1]", "unused", "ground/floor", "frame"),
    (CART, "value: 0.1*sin(3*t)", "value: 100*sin(3*t)", LENGTH, "100", "mm"),
    (CART, ", output: {frames: [pole/tip]}", "", "unused", "tip", "frame 'tip'"),
    (CART, "initial: {joints: {hinge: -1.2}}\n", "", "left-free", "pole", "start"),
    (CART, "gravity: [0, -9.81]", "gravity: [0, 9.81]", VALUE, "[0, 9.81]", "write -9.81 in place of 9.81"),
    (CART, "gravity: [0, -9.81]\n", "", "left-free", "pole", "nothing acts"),
    (CART, "hinge: -1.2", "hinge: -70", ANGLE, "-70", "deg"),
    (CART, "drivers: {motor: {joint: rail, kind: position, value: 0.1*sin(3*t)}}\n", "", LENGTH, "25", "25 mm",
     {"hinge: -1.2": "hinge: -1.2, rail: 25"}),
    (ROD, "[1e-5, 0.0208, 0.0208]", "[0.0208, 1e-5, 0.0208]", INERTIA, "[0.0208", "Ixx, Iyy, Izz"),
    (ROD, "[1e-5, 0.0208, 0.0208]", "[0.0208, 1.5e-3, 0.0208]", INERTIA, "[0.0208", "Ixx, Iyy, Izz"),
    (CRANK, GUIDE, "", "left-free", "slider", "no start is given for 'slider'", {"coupler: {": "coupler: {pose: {angle: 0.3}, "}),
    (CRANK, GUIDE, "", "left-free", "coupler", "no start is given for 'coupler', 'slider'", {"slider: {": "slider: {pose: {position: [0.14, 0]}, "}),
    (CRANK, GUIDE, "", "left-free", "coupler", "no start is given for 'coupler'", {"slider: {": "slider: {pose: {position: [0.14, 0], angle: 0}, "}),
    (CRANK, GUIDE, "", "left-free", "coupler", "no start is given for 'coupler', 'slider'",
     {"slider: {": "slider: {pose: {position: [0.14, 0]}, com: [0, 0.01], "}),
    (CRANK, "restitution: 0.9", "restitution: 0.9, K: 1e3", VALUE, "wrist", "rubber"),
    (CRANK, "restitution: 0.9", "restitution: 0.9, K: 2e6", VALUE, "wrist", "its material makes 1.1e+11 Pa; check the number and its unit, as in '2e+06 N/mm^1.5'"),
    (CRANK, "restitution: 0.9}", "restitution: 0.9}\n      friction: {law: coulomb-tanh, mu: 20}", VALUE, "20}", "coefficients of friction"),
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 0.0005\n      initial: {eccentricity: [0.002, 0]}",
     "doubtful-clearance", "wrist", "deep in its wall"),
    (CRANK, "length: 0.015", "length: 1.5", LENGTH, "1.5", "mm"),
    (CRANK, "inertia: 2.5e-4", "inertia: 3e-7 kg*m^2", INERTIA, "3e-7", "radius of gyration"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 70], [0.01, 80.5], [0.02, 91]]}}}", ANGLE, "{points", "unit: deg"),
    (CRANK, DRIVEN, "kind: velocity, table: {points: [[0, 0], [0.01, 2000], [0.02, 2000]]}}}", "doubtful-speed", "{points", "rpm"),
    (CART, "value: 0.1*sin(3*t)", "table: {points: [[0, 0], [0.5, 80], [1, 120]]}", LENGTH, "{points", "unit: mm"),
    (CART, "value: 0.1*sin(3*t)", "value: 300*t", "doubtful-speed", "300", "mm/s"),
    (CART, "kind: position, value: 0.1*sin(3*t)", "kind: velocity, value: 80", "doubtful-speed", "80", "mm/s"),
    (CART, "drivers: {motor: {joint: rail, kind: position, value: 0.1*sin(3*t)}}\n", "", "doubtful-speed", "70", "mm/s",
     {"hinge: -1.2}": "hinge: -1.2}, speeds: {rail: 70}"}),
    (CRANK, "between: [ground, crank]", "between: [ground, crank/tip]", "same-frame", "crankpin", "'crank/tip'"),
    (SPATIAL, "between: [ground/axle, crank]", "between: [ground/axle, crank/tip]", "same-frame", "ball", "'axle' and 'ball' hold 'crank'"),
    (TOGGLE, BEND, "", "left-free", "lower", "no start is given for 'lower', 'ram'"),  # their poses are those of a closed loop
    (CRANK, "step: 1e-5", "accuracy: 1", VALUE, "1", "accuracy of 1 m says nothing of a mechanism of 0."),
    (ROD, "step: 1e-3", "accuracy: 200 mm", VALUE, "200 mm", "ask for a thousandth"),
    (CRANK, "step: 1e-5", "accuracy: 0.4 mm", VALUE, "wrist", "coarse against the clearance"),
    (CRANK, "step: 1e-5", "step: 1e-5, output: {interval: 50 ms}", "doubtful-time", "50 ms", "start and its end"),
    (CRANK, "step: 1e-5", "step: 1e-5, output: {interval: 1 ns}", "doubtful-time", "1 ns", "rows would be written"),
    (TRAIN, "drivers:", "  again: {type: gear, of: [b, a], ratio: 0.5}\ndrivers:", "duplicate-joint", "again", "'pair'"),
    (RACK, "ratio: 0.05", "ratio: 50", LENGTH, "50", "mm/rad"),
    (RACK, "of: [p, s], ratio: 0.05", "of: [s, p], ratio: 1/50", LENGTH, "1/50", "50 m in each radian"),
    (RACK, "ratio: 0.05", "ratio: 0.4", LENGTH, "0.4", "50.27 m in all",
     {"value: 0.5*sin(2*pi*t)": "table: {points: [[0, 0], [0.5, 20], [1, 0]], unit: rev, ends: clamped}"}),
    (RACK, "ratio: 0.05", "ratio: 0.4", "doubtful-speed", "0.4", "62.83 m/s",
     {"kind: angle, value: 0.5*sin(2*pi*t)": "kind: velocity, value: 1500 rpm"}),
    (RACK, "ratio: 0.05", "ratio: 7 m", "doubtful-speed", "7 m", "faster than any machine",
     {"kind: angle, value: 0.5*sin(2*pi*t)": "kind: velocity, value: 1500 rpm"}),
    (RACK, "ratio: 0.05", "ratio: 0.05, offset: 25", LENGTH, "25", "25 mm"),
    (TRAIN, "ratio: 2", "ratio: -2000", VALUE, "-2000", "2e+04 rad/s"),
    (TRAIN, "ratio: 2", "ratio: 180/pi", "doubtful-angle", "90", "90 deg", {"ratio: 180/pi": "ratio: 2, offset: 90"}),
    (TRAIN, "ratio: 2", "ratio: 1e-4", VALUE, "1e-4", "turn by 1 to 1e+04 of 'a'"),
    (TRAIN, "ratio: 2", "ratio: 2e4", "doubtful-speed", "2e4", "faster than any machine"),
    (TRAIN, "ratio: 2", "ratio: 360", VALUE, "360", "360 times", {"kind: velocity, value: 10": "kind: angle, value: 0.1*sin(300*t)"}),
    (BOX, FOOT, FOOT + FOOT.replace("foot", "again"), "duplicate-force", "again", "'foot'"),
    (BOX, FOOT, FOOT + FOOT.replace("foot", "again").replace("ground/floor, box", "box, ground/floor"), "duplicate-force", "again", "'foot'"),
    (CAM, "60 deg, 120 deg", "60, 120", ANGLE, '"25 mm', "all the way round, though it changes with 'x', which is in radians", {"180 deg, 240 deg": "180, 240"}),
    (PLATE, "100 deg, 180 deg", "100, 180", ANGLE, '"20 mm', "'forces.t.first' is 0.02 m all the way round", {"180 deg, 260 deg": "180, 260"}),
    (BOX, FOOT, FOOT + PRESS + PRESS.replace("press", "again"), "duplicate-force", "again", "'again' is the same force at the same place as 'press'"),
    (BOX, FOOT, FOOT + DRAG + DRAG.replace("press", "again"), "duplicate-force", "again", "'press'"),
    (TRAIN, "drivers:", "forces: {a: {type: torque, on: two, value: -1 N*m}, b: {type: torque, on: two, value: -1 N*m}}\ndrivers:",
     "duplicate-force", "b: {type", "is the same torque"),
    (TRAIN, "drivers:", "forces:\n  c: %s\n  d: %s\ndrivers:" % (BRAKE, BRAKE), "duplicate-force", "d: ", "'c'"),
    (BOX, FOOT, FOOT + "  idle: {type: spring-damper, between: [ground, box], free_length: 0.1}\n", "unused", "idle", "does nothing"),
    (BOX, "ground/floor, box", "ground, box", LENGTH, "foot", "at one place", {", ground/floor: [0, -0.3]": ""}),
    (BOX, "stiffness: 2e4", "stiffness: 20", VALUE, "foot", "98.1 m"),
    (BOX, "stiffness: 2e4", "stiffness: 20", VALUE, "foot", "98.1 m", {GUIDED: "", ", frames: {up: {angle: 90 deg}}": "", "ground/up: {angle: 90 deg}, ": ""}),
    (TRAIN, "  pair: {type: gear, of: [a, b], ratio: 2}\n", "", "left-free", "two", "'two' never moves"),
    (ROD, "  held:", "  again: {type: spherical, between: [ground, rod]}\n  held:", "duplicate-joint", "again", "'hung'"),
    (CART, "value: 0.1*sin(3*t)", "value: '10 m*smooth(t, 0.5, 0.501)'", "doubtful-speed", "'10 m", "faster than any machine"),
    (CRANK, DRIVEN, "kind: angle, value: '90 deg*smooth(t, 0.01, 0.01001)'}}", "doubtful-speed", "'90", "faster than any machine"),
    (CART, "value: 0.1*sin(3*t)", "table: {unit: mm, points: [[0, 0], [0.5, 2e4], [0.501, 2.5e6], [1, 3e6]], interpolation: linear}",
     "doubtful-speed", "{unit", "faster than any machine"),
    (CRANK, "com: [0.06, 0]", "com: [600 mm, 0]", "doubtful-com", "[600", "away from its frames"),
    (CART, "kind: position, value: 0.1*sin(3*t)", "kind: force, table: {points: [[0, 0], [0.5, 0], [0.501, 1000], [0.502, 0], [2, 0]]}",
     VALUE, "{points", "linear"),
    (ROD, "bob: {", "bob: {pose: {rpy: [0, 0, 90]}, ", ANGLE, "90", "deg"),
    (CRANK, DRIVEN, "kind: angle, value: '2*smooth(t, 20, 40)'}}", "doubtful-time", "'2*smooth", "long before it begins to change"),
    (CRANK, "forces:\n", "forces:\n  push: {type: force, at: slider, value: ['-2*smooth(t, 20, 21)', 0]}\n", "doubtful-time", "['-2", "ends at 0.02 s"),
    (CRANK, DRIVEN, "kind: angle, value: '2*smooth(t, 0.1, 0.2)'}}", "doubtful-time", "'2*smooth", "before it begins to change, at 0.1 s"),
    (CRANK, "forces:\n", "forces:\n  push: {type: force, at: slider, value: ['-2 N*smooth(t, 0.2, 0.4)', 0]}\n", "doubtful-time", "['-2", "at 0.2 s, so that it is zero all the time: write the unit"),
    (CRANK, "forces:\n", "forces:\n  turn: {type: torque, on: crank, value: '2 N*m*smooth(t, 0.2 s, 0.4 s)'}\n", "doubtful-time", "'2 N", "zero all the time: check its times"),
    (CART, "kind: position, value: 0.1*sin(3*t)", "kind: force, table: {points: [[5, 0], [6, 10], [8, 0]]}", "doubtful-time", "{points", "at 5 s, so that it is zero"),
    (BOX, "stiffness: 2e4", "stiffness: '2e4 + 1e4*smooth(t, 20, 30)'", "doubtful-time", "'2e4", "at 20 s: write the unit"),
    (BOX, "stiffness: 2e4", "stiffness: '2e4 + 1e4*smooth(t, 20, 30)*sin(body.box.y/(1 m))'", "doubtful-time", "'2e4", "at 20 s: write the unit"),
    (BOX, "damping: 100", "damping: '10 N*s/m*smooth(t, 20 s, 30 s)'", "doubtful-time", "'10 N", "zero all the time: check its times"),
    (BOX, "stiffness: 2e4", "preload: '-50 N*sin(t/(1 s))', stiffness: '2e4 N/m*smooth(t, 20 s, 30 s)'", "doubtful-time", "'2e4", "zero all the time"),
    (TRAIN, "drivers:", "forces: {hold: {type: brake, kind: rotational, between: [ground, two], limit: '5 N*m*smooth(t, 20 s, 21 s)', stiffness: 1e4}}\ndrivers:",
     "doubtful-time", "'5 N", "zero all the time"),
    (BOX, "simulation:", "drivers: {up: {inverse_kinematics: {frame: box, path: {y: '0.1*smooth(t, 200, 300)'}, joints: [guide]}}}\nsimulation:",
     "doubtful-time", "'0.1", "at 200 s: write the unit"),
    *[(CRANK, DRIVEN, "kind: %s}}" % motion, "doubtful-time", motion[motion.index("'"):motion.index("'") + 4], "and goes on to")
      for motion in ("velocity, value: '50*smooth(t, 0, 4)'", "angle, value: '60 deg*s_curve(t, 0, 10, 3, 1)'",
                     "angle, value: '60 deg*trapezoid(t, 0, 10, 3)'", "torque, value: '0.5*smooth(t, 0.001, 4)'")],
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 2 mm", "doubtful-clearance", "wrist", "times the smaller radius"),
    (TRAIN, "ratio: 2", "ratio: -2000", VALUE, "-2000", "the motor is on the slow side", {"kind: velocity, value: 10": "kind: torque, value: 1"}),
    (TRAIN, "of: [a, b], ratio: 2", "of: [b, a], ratio: 1/2000", VALUE, "1/2000", "turn by 1 to 2000", {"kind: velocity, value: 10": "kind: torque, value: 1"}),
    (TRAIN, "kind: velocity, value: 10", "kind: velocity, value: 600000 rpm", "doubtful-speed", "600000", "'one' would turn with 1.99e+03 m/s"),
    (WATCH, "1.2e-9", "1.2", INERTIA, "1.2", "a disc of it would have 4.8e-10 kg/m^2"),
    (TEETH, "w: [150 mm, 0]", "w: [150, 0]", LENGTH, "20 deg", "150 m apart, but the radii of gyration of their wheels come to 0.074 m"),
    (CRANK, "forces:\n", "  second: {type: distance, between: [coupler, slider], length: 0.12}\nforces:\n", "play-bypassed", "wrist",
     "'second', which holds the same two bodies without play in one of its directions"),
    (BELT, "stiffness: 2e5", "stiffness: 0.2", VALUE, "belt", "by 1500 m"),
    (BELT, "damping: 100", "damping: 1e8", VALUE, "belt", "from swinging: it takes 5e+02 s"),
    (BELT, "pretension: 300", "pretension: 3e5 N", VALUE, "belt", "by 1.5 m"),
]

# A driven crank from which a double pendulum hangs, a roller that spins on it, a mass between springs, a free puck.
HANGING = """freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  upper: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}, pose: {angle: -1.5}}
  lower: {mass: 0.3, inertia: 1e-3, com: [0.05, 0]}
  roller: {mass: 0.3, inertia: 1e-3}
  mass: {mass: 2, inertia: 1e-2, pose: {position: [1, 0]}}
  puck: {mass: 1, inertia: 1e-2, velocity: {linear: [1, 2]}}
frames: {ground/left: [0.8, 0], ground/right: [1.2, 0]}
joints:
  main: {type: revolute, between: [ground, crank]}
  first: {type: revolute, between: [crank/tip, upper]}
  second: {type: revolute, between: [upper/tip, lower]}
  axle: {type: revolute, between: [crank/tip, roller]}
forces:
  one: {type: spring-damper, between: [ground/left, mass], stiffness: 500, free_length: 0.15}
  two: {type: spring-damper, between: [ground/right, mass], stiffness: 500, free_length: 0.15}
drivers: {motor: {joint: main, kind: angle, value: 0.3*sin(20*t)}}
initial: {joints: {second: 0}}
simulation: {end: 0.1, step: 1e-4}
"""
# What looks like these but is meant: no warning at all.
SOUND = [
    (CAM, "", ""),
    (CAM, "8 mm*(", "0 mm*("),  # a circle in any unit
    (CAM, "25 mm + 8 mm*(smooth(x, 60 deg, 120 deg) - smooth(x, 180 deg, 240 deg))", "25 mm/sqrt(cos(x)^2 + sin(x)^2)"),
    (PLATE, "", ""),
    (STOP, "", ""),
    (STOP, "contact: {law: hertz, K: 1e9}", "stiffness: 1 N/m"),
    (STOP, "contact: {law: hertz, K: 1e9}", "stiffness: 1 N/m, damping: 100"),
    (BOX, FOOT, FOOT + PRESS + PRESS.replace("press", "again").replace("-100", "-101")),
    (BOX, FOOT, FOOT + PRESS + PRESS.replace("press", "again").replace("at: box", "at: box/up")),
    (TRAIN, "drivers:", "forces:\n  c: %s\n  d: %s\ndrivers:" % (BRAKE, BRAKE.replace("0.1)", "0.2)"))),
    (HANGING, "", ""),
    (HANGING, "kind: angle, value: 0.3*sin(20*t)", "kind: torque, value: 1"),

    (CRANK, "", ""),
    (CART, "", ""),
    (ROD, "", ""),
    *[(model, "", "") for model in (TRAIN, BELT, WATCH, TEETH, BOX, RACK, SHAKER, COUPLED, ECCENTRIC, ROPE, HAMMER, BOB, SATELLITE, HOURS)],
    (SHAKER, "initial: {joints: {guide: 0}}\n", ""),
    (CRANK, "restitution: 0.9", "restitution: 0.9, K: 1e8"),
    (CRANK, "restitution: 0.9}", "restitution: 0.9}\n      friction: {law: coulomb-tanh, mu: 1.4}"),
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 0.0005\n      initial: {eccentricity: [0.0005, 0]}"),
    (CRANK, DRIVEN, "kind: velocity, table: {unit: rpm, points: [[0, 0], [0.01, 2000], [0.02, 2000]]}}}"),
    (CRANK, "step: 1e-5", "accuracy: 1 um"),
    (CRANK, "value: 100", "value: 3000 rpm"),
    (CRANK, "value: 100", "value: 1200 rad/s"),
    (CRANK, DRIVEN, "kind: angle, value: 500*t}}"),
    (CRANK, DRIVEN, "kind: angle, value: 60 deg*sin(3*t)}}"),
    (CRANK, DRIVEN, "kind: angle, value: '2*smooth(t, 20 s, 40 s)'}}"),
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 1 mm"),
    (CRANK, "radial_clearance: 0.0005", "radial_clearance: 1.6 mm"),
    *[(CRANK, DRIVEN, "kind: velocity, value: '%s'}}" % value)
      for value in ("50*smooth(t, 0 s, 4 s)", "50*smooth(t, 0, 0.3)", "min(50, 5*t)", "50*sin(9*t)*(1 - smooth(t, 4, 5))")],
    (CRANK, "forces:\n", "forces:\n  none: {type: torque, on: slider, value: 0}\n"),
    (CRANK, "forces:\n", "forces:\n  push: {type: force, at: slider, value: ['-2 N*smooth(t, 10 ms, 15 ms)', 0]}\n"),
    (BOX, "stiffness: 2e4", "stiffness: '2e4 N/m + 1e4 N/m*smooth(t, 20 s, 30 s)'"),
    (BOX, "stiffness: 2e4, damping: 100", "stiffness: '2e4 + 1e4*smooth(t, 10 ms, 20 ms)', damping: '10*sin(t)^2'"),
    (BOX, "stiffness: 2e4", "stiffness: '2e4 + 1e4*smooth(t, 0.01, 0.02)*sin(body.box.y/(1 m))'"),
    (CRANK, DRIVEN, "kind: angle, value: '2*smooth(t, 0.001, 0.009)*(1 - smooth(t, 0.009, 0.019))'}}"),
    (TRAIN, "ratio: 2", "ratio: 1/2000", "", {"kind: velocity, value: 10": "kind: torque, value: 1"}),
    (TRAIN, "kind: velocity, value: 10", "kind: velocity, value: 200000 rpm", "", {"step: 1e-3": "accuracy: 1 um"}),
    (CRANK, DRIVEN, "kind: angle, value: 60 rad + sin(3*t)}}"),
    (CRANK, DRIVEN, "kind: angle, value: 60 rad + 30 rad*sin(2*pi*t)}}"),
    (CRANK, DRIVEN, "kind: angle, value: '8*pi*smooth(t, 0, 0.1)'}}"),
    (CRANK, "{main: 1}", "{main: 60 rad}"),
    (SHAKER, "{guide: 0}", "{guide: 25 m}", "", {"stiffness: 3e4": "stiffness: 90"}),
    (RACK, "ratio: 0.05", "ratio: 5 m/rad"),
    (BOX, FOOT, FOOT + FOOT.replace("foot", "again").replace("2e4", "1e4")),
    (BOX, FOOT, FOOT + "  idle: {type: spring-damper, between: [ground, box], preload: 10}\n"),
    (BOX, "stiffness: 2e4", "stiffness: 8e3"),
    (BOX, "stiffness: 2e4", "stiffness: 20", "drivers: {jack: {joint: guide, kind: position, value: 0.01*t}}\n"),
    (TRAIN, "  pair: {type: gear, of: [a, b], ratio: 2}\n", "", "initial: {speeds: {b: 10}}\n"),
    (TRAIN, "  pair: {type: gear, of: [a, b], ratio: 2}\n", "", "forces: {load: {type: torque, on: two, value: 0.1}}\n"),
    (TRAIN, "  pair: {type: gear, of: [a, b], ratio: 2}\n", "",
     "forces: {belt: {type: spring-damper, kind: rotational, between: [one, two], stiffness: 10}}\n"),
    (RACK, "of: [p, s], ratio: 0.05", "of: [s, p], ratio: 20"),
    (TRAIN, "ratio: 2", "ratio: 2, offset: 90 deg"),
    (TRAIN, "ratio: 2", "ratio: 90"),
    (CRANK, "{main: 1}", "{main: 7*pi}"),
    (CRANK, "{main: 1}", "{main: 2*pi}"),
    (CRANK, "-9.81", "-9810 mm/s^2"),
    (CRANK, "E: 207e9", "E: 50 kPa"),
    (CRANK, "[0.3, 0]", "[9 m, 0]", "", {"stiffness: 200": "stiffness: 5"}),
    (CRANK, "E: 207e9", "E: 1.5e6"),
    (CRANK, "mass: 0.14, inertia: 1e-4", "mass: 8, inertia: 1e-3"),
    (CRANK, "{main: 1}", "{main: $a}", "parameters: {a: 7*pi/6 + 3*pi/2}\n"),
    (CRANK, "step: 1e-5", "step: 1e-4"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [0.01, 5], [0.02, 10]]}}}"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [0.01, 6.283185307], [0.02, 9.424777961], [0.03, 9.424777961]]}}}"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10, 1], [20, 2]], time_unit: s}}}"),
    (CRANK, DRIVEN, "kind: angle, table: {points: [[0, 0], [10 s, 1], [20 s, 2]]}}}"),
    (CRANK, DRIVEN, "kind: angle, table: {unit: deg, points: [[0, 0], [0.01, 90], [0.02, 0]]}}}"),
    (CART, "value: 0.1*sin(3*t)", "value: '0.1 m*smooth(t, 0.5, 0.501)'"),
    (CART, "value: 0.1*sin(3*t)", "table: {unit: mm, points: [[0, 0], [0.125, 70.7], [0.375, 70.7], [0.625, -70.7], [0.875, -70.7], [1, 0]]}"),
    (CART, "kind: position, value: 0.1*sin(3*t)",
     "kind: force, table: {points: [[0, 0], [0.5, 0], [0.501, 1000], [0.502, 0], [2, 0]], interpolation: linear}"),
    (CART, "value: 0.1*sin(3*t)", "table: {points: [[0, 0.1], [0.17, 0.1], [0.29, 0.1], [2, 0.1]]}"),
]


def text_of(model, old, new, more=""):
    assert old in model, old
    return model.replace(old, new, 1) + more


def models(*folders):
    for folder in folders:
        yield from sorted(glob.glob(os.path.join(ROOT, folder, "**", "*.yaml"), recursive=True))


class Plausibility(ProgramTest):
    def messages(self, text, *options, code=0):
        self.write("m.yaml", text)
        return json.loads(self.freeplay("validate", "m.yaml", "--json", *options, code=code)[0])["messages"]

    def test_mistakes_that_can_be_read_are_doubted_where_they_stand(self):
        for model, old, new, wanted, place, words, *more in MISTAKES:
            with self.subTest(new or "without " + old):
                text = text_of(model, old, new)
                for part, instead in more[0].items() if more else ():
                    text = text_of(text, part, instead)
                found = [m for m in self.messages(text) if m["id"] == wanted]
                self.assertTrue(found, self.messages(text))
                one = next((m for m in found if words in m["message"]), None)
                self.assertIsNotNone(one, found)
                self.assertEqual("warning", one["severity"])
                line = text.splitlines()[one["line"] - 1]
                self.assertTrue(line[one["column"] - 1:].startswith(place), (line, one))

    def test_a_rod_held_twice_at_one_frame_is_reported_with_the_gap(self):
        found = self.messages(text_of(CRANK, "bearing: coupler/tip", "bearing: coupler"), code=3)
        self.assertEqual(["unused", "assembly-failed", "same-frame"], [m["id"] for m in found])
        self.assertIn("'crankpin' and 'wrist' both hold 'coupler/origin'", found[0]["message"])

    def test_what_is_meant_is_not_doubted(self):
        for model, old, new, *more in SOUND:
            with self.subTest(new or model[:60]):
                text = text_of(model, old, new, *more[:1])
                for part, instead in more[1].items() if len(more) > 1 else ():
                    text = text_of(text, part, instead)
                self.assertEqual([], self.messages(text))

    def test_a_start_that_is_given_is_meant(self):
        """A pose with its angle says where a body begins; a frame that a loop was to close on makes a guess of it."""
        hanging = text_of(CART, "initial: {joints: {hinge: -1.2}}\n", "").replace("pole: {", "pole: {pose: {angle: 0.2}, ")
        stone = "bodies:\n  stone: {mass: 1, inertia: 1e-3, pose: {position: [1, 1]%s}}"
        disc = "bodies:\n  disc: {mass: 1, inertia: 1e-3%s}"
        axle = "joints:\n  axle: {type: revolute, between: [pole/tip, disc]}"
        bar = "bodies:\n  bar: {mass: 1, inertia: 1e-2, frames: {end: [0.3, 0]}, pose: {position: [%s, 0.06], angle: 2}}"
        foot = "joints:\n  foot: {type: revolute, between: [ground/post, bar/end]}"
        base = {"simulation:": "frames: {ground/post: [0.17, 0.33]}\nsimulation:", "joints:": foot}
        for changes, wanted in [
                ({}, []),
                ({"tip: [0.3, 0]": "tip: [0.3, 0], shoe: [0.3, 0.1]"}, ["unused"]),
                ({"bodies:": stone % ""}, ["not-connected"]),
                ({"bodies:": stone % ", angle: 0.3"}, ["not-connected"]),
                ({"bodies:": stone % ", angle: 0.3", "tip: [0.3, 0]": "tip: [0.3, 0], shoe: [0.3, 0.1]"}, ["not-connected", "unused"]),
                ({"bodies:": disc % ", pose: {angle: 0}", "joints:": axle}, []),
                ({"bodies:": disc % "", "joints:": axle}, ["left-free"]),
                ({"bodies:": bar % "0.29", **base}, []),
                # The pin between both bars is missing.
                ({"bodies:": bar % "0.29", "tip: [0.3, 0]": "tip: [0.3, 0], top: [0.3, 0]", **base}, ["left-free", "unused"])]:
            with self.subTest(changes):
                text = hanging
                for old, new in changes.items():
                    text = text_of(text, old, new)
                self.assertEqual(wanted, sorted(m["id"] for m in self.messages(text)), self.messages(text))

    def test_a_structure_that_is_hardly_meant_is_in_the_verdict(self):
        for old, new, words in [(GUIDE, "", "left over"), (GUIDE, GUIDE + GUIDE.replace("guide", "two"), "joint 'two' holds nothing")]:
            self.write("m.yaml", text_of(CRANK, old, new))
            self.freeplay("run", "m.yaml", "--out", "r", "--force", "--end", "1 ms")
            trust = json.loads(self.read("r", "summary.json"))["trust"]
            messages = [r["message"] for r in trust["reasons"] if r["id"] == "doubtful-structure"]
            self.assertEqual(1, len(messages), trust)
            self.assertIn(words, messages[0])
            self.assertNotEqual("good", trust["verdict"])

    def test_a_motor_that_runs_away_ends_the_run(self):
        """What turns so fast bursts: the run does not go on for minutes."""
        motor = text_of(CART, "motor: {joint: rail, kind: position, value: 0.1*sin(3*t)}", "motor: {joint: %s, kind: %s, value: %s}")
        wheel = ("freeplay: 1\nbodies: {wheel: {mass: 2, inertia: 0.02}}\njoints: {axle: {type: revolute, between: [ground, wheel]}}\n"
                 "drivers: {motor: {joint: axle, kind: torque, value: 2000}}\nsimulation: {end: 1e4, %s}\n")
        for text, body, cause in ((motor % ("hinge", "torque", "3e6"), "(cart|pole)", "driver 'motor' gives 3e+06 N m"),
                                  (wheel % "accuracy: 1 um", "wheel", "driver 'motor' has put 1e+08 J into 2 kg"),
                                  (wheel % "step: 10 ms", "wheel", "driver 'motor' has put")):
            with self.subTest(text):
                out, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force", code=4)
                self.assertRegex(err, r"body '%s' at t = \S+ s: it turns with \S+ m/s at its radius of gyration, more than "
                                      r"twice the speed of sound in steel; likely cause: " % body)
                self.assertIn(cause, err)
                self.assertIn("trust: bad (body", out)
        # Planets and pulses on a slider do not burst.
        free = "freeplay: 1\nbodies: {earth: {mass: 6e24, inertia: 9.7e37, velocity: {linear: [3e4, 0]}}}\nsimulation: {end: 1, accuracy: 1 um}\n"
        self.freeplay("run", self.write("m.yaml", free), "--out", "r", "--force")

    def test_strict_makes_doubts_errors_before_and_after_assembly(self):
        for old, new, wanted in [("{main: 1}", "{main: 60}", "doubtful-angle"), (GUIDE, GUIDE + GUIDE.replace("guide", "two"), "duplicate-joint")]:
            text = text_of(CRANK, old, new)
            found = self.messages(text, "--strict", code=3)
            self.assertEqual([("error", wanted)], [(m["severity"], m["id"]) for m in found])
            self.freeplay("run", "m.yaml", "--strict", code=3)
            _, err = self.freeplay("run", "m.yaml", "--dry-run")
            self.assertIn("warning:", err)
            self.assertIn("[%s]" % wanted, err)

    def test_an_option_is_doubted_as_the_key_is(self):
        self.write("m.yaml", text_of(CRANK, "step: 1e-5", "accuracy: 1 um"))
        for options in (("--accuracy", "1"), ("--set", "simulation.accuracy=1")):
            _, err = self.freeplay("run", "m.yaml", *options, "--dry-run")
            self.assertRegex(err, "m.yaml: warning: the accuracy of 1 m says nothing of .*[doubtful-value]")

    def test_instances_of_a_template_share_a_doubt(self):
        text = """freeplay: 1
templates:
  leg:
    bodies: {b: {mass: 300, inertia: 1e-4, com: [0.025, 0], frames: {tip: [0.05, 0]}}}
    joints: {j: {type: revolute, between: [ground, b]}}
instances: {leg: {template: leg, count: 300}}
simulation: {end: 0.01, step: 1e-3}
"""
        found = self.messages(text, "--no-assemble")
        self.assertEqual([("doubtful-mass", 4), ("unused", 4)], [(m["id"], m["line"]) for m in found])
        self.assertIn("'leg1.b'", found[0]["message"])

    def test_facts_name_what_is_free_and_what_is_not_determined(self):
        self.write("m.yaml", CART)
        out, _ = self.freeplay("validate", "m.yaml")
        self.assertRegex(out, r"\n  left_free +pole\n")
        self.write("m.yaml", text_of(CRANK, GUIDE, GUIDE + GUIDE.replace("guide", "two")))
        facts = json.loads(self.freeplay("validate", "m.yaml", "--json")[0])["facts"]
        self.assertEqual([["guide", "two"], []], [facts["undetermined"], facts["left_free"]])

    def test_shipped_models_are_not_doubted(self):
        files = [file for file in models("mechanisms")]
        out, _ = self.freeplay("validate", *files, "--json")
        for one in json.loads(out):
            with self.subTest(one["file"]):
                self.assertEqual([], [m for m in one["messages"] if m["id"] not in ("zero-inertia",)])


if __name__ == "__main__":
    unittest.main()
