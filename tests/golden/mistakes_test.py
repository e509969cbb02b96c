"""A sound model with one mistake at a time: its id, its place, the word that was meant."""
import json
import unittest

from program import ProgramTest

SOUND = """freeplay: 1
parameters: {a: 1}
bodies:
  rod: {mass: $a, inertia: 1, com: [0.5, 0], frames: {tip: [1, 0]}}
  bob: {mass: 1, inertia: 1}
joints:
  A: {type: revolute, between: [ground, rod]}
  B: {type: revolute, between: [rod/tip, bob]}
drivers:
  m: {joint: A, kind: angle, value: 3*t}
forces:
  w: {type: force, at: bob, value: [1, 0]}
initial: {joints: {B: 30 deg}}
simulation: {end: 2, step: 1 ms}
"""
LEG = "freeplay: 1\ntemplates: {leg: {parameters: {l: required, k: 1}, bodies: {b: {mass: $l, inertia: $k}}}}\n"
FORCE = "  w: {type: force, at: bob, value: [1, 0]}"
PIN = "  B: {type: revolute, between: [rod/tip, bob]}"
MOTOR = "  m: {joint: A, kind: angle, value: 3*t}"

IN_SPACE = "freeplay: 1\nspace: spatial\nbodies: {a: {mass: 1, inertia: %s}}\n"

# What is replaced (None: the whole file), by what; id, line, column and the suggestion, where there is one.
MISTAKES = [
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {a: [1]}, reducers: {r: {channel: joint.A.angel, reduce: max}}}', 'unknown-name', 2, 49, 'joint.A.angle'),
    ('step: 1 ms', 'step: 1 ms, output: {channels: [rod.omega]}', 'unknown-name', 14, 54, 'body.rod.omega'),
    ('step: 1 ms', 'step: 1 ms, output: {channels: [bdy.rod.y]}', 'unknown-name', 14, 54, 'body.rod.y'),
    ('step: 1 ms', 'step: 1 ms, output: {channels: [bdy.rod.yy]}', 'unknown-name', 14, 54, 'body.rod.y'),
    ('mass: $a', 'mas: $a', 'unknown-key', 4, 9, 'mass'),
    ('bodies:\n', 'bodys:\n', 'unknown-key', 3, 1, 'bodies'),
    ('type: revolute, between: [ground', 'type: revolut, between: [ground', 'unknown-type', 7, 13, 'revolute'),
    ('rod/tip, bob', 'rod/tipp, bob', 'unknown-name', 8, 33, 'tip'),
    ('rod/tip, bob', 'rodd/tip, bob', 'unknown-name', 8, 33, 'rod'),
    ('joint: A', 'joint: a', 'unknown-name', 10, 14, 'A'),
    ('kind: angle', 'kind: angel', 'wrong-type', 10, 23, 'angle'),
    ('kind: angle', 'kind: position', 'wrong-type', 10, 23),
    ('kind: angle', 'kind: force', 'wrong-type', 10, 23),
    ('value: 3*t}', 'value: 3*t, table: x.csv}', 'conflicting-keys', 10, 42),
    ('value: 3*t}', 'table: x.csv}', 'file-not-found', 10, 37),
    (', value: 3*t}', '}', 'missing-key', 10, 3),
    ('value: 3*t', 'value: 3 m', 'dimension-mismatch', 10, 37),
    ('value: 3*t', 'value: sqrt(t-1)', 'bad-expression', 10, 37),
    ('at: bob', 'at: bobb', 'unknown-name', 12, 24, 'bob'),
    ('value: [1, 0]', 'value: [1]', 'wrong-length', 12, 36),
    ('value: [1, 0]', 'value: 1', 'wrong-type', 12, 36),
    ('value: [1, 0]', 'value: [1, 0, 0]', 'wrong-length', 12, 36),
    ('B: 30 deg', 'A: 30 deg', 'conflicting-keys', 13, 20),
    ('B: 30 deg', 'C: 30 deg', 'unknown-name', 13, 20),
    ('B: 30 deg', 'B: 30 mm', 'dimension-mismatch', 13, 23),
    ('B: 30 deg', 'B: 30 grad', 'bad-unit', 13, 26),
    ('end: 2', 'end: -1', 'out-of-range', 14, 19),
    ('end: 2', 'end: 2 m', 'dimension-mismatch', 14, 19),
    ('step: 1 ms', 'step: 0', 'out-of-range', 14, 28),
    ('step: 1 ms', 'step: {size: 1 ms, adaptiv: true}', 'unknown-key', 14, 41, 'adaptive'),
    ('step: 1 ms', 'step: {size: 1 ms, adaptive: yes}', 'wrong-type', 14, 51),
    ('step: 1 ms', 'step: 1 ms, accuracy: 1 um', 'conflicting-keys', 14, 34),
    ('step: 1 ms', 'step: 1 ms, integrator: bath', 'unknown-type', 14, 46, 'bathe'),
    ('step: 1 ms', 'step: 1 ms, integrator: {type: bathe, rho: 1}', 'unknown-key', 14, 60),
    ('step: 1 ms', 'step: 1 ms, integrator: {type: bathe, split: 1.2}', 'out-of-range', 14, 67),
    ('step: 1 ms', 'step: 1 ms, integrator: {split: 0.2}', 'missing-key', 14, 34),
    ('step: 1 ms', 'step: 1 ms, integrator: {type: newmark, newton: {tolerence: 1}}', 'unknown-key', 14, 71, 'tolerance'),
    ('step: 1 ms', 'step: 1 ms, output: {channels: [joint.Z.*]}', 'unknown-name', 14, 54),
    ('step: 1 ms', 'step: 1 ms, output: {frames: [rod/tap]}', 'unknown-name', 14, 52, 'tip'),
    ('step: 1 ms', 'step: 1 ms, output: {format: xls}', 'wrong-type', 14, 51),
    ('step: 1 ms', 'step: 1 ms, stop: [{channel: joint.A.angle}]', 'missing-key', 14, 41),
    ('step: 1 ms', 'step: 1 ms, stop: [{channel: joint.A.angle, above: 1, below: 2}]', 'conflicting-keys', 14, 76),
    ('step: 1 ms', 'step: 1 ms, stop: [{channel: joint.A.angel, above: 1}]', 'unknown-name', 14, 51, 'joint.A.angle'),
    ('step: 1 ms', 'step: 1 ms, stop: [{channel: joint.A.angle, above: 1 m}]', 'dimension-mismatch', 14, 73),
    ('[ground, rod]', '[ground, ground]', 'same-body', 7, 32),
    ('[ground, rod]', '[rod, rod/tip]', 'same-body', 7, 32),
    ('[ground, rod]', '[ground]', 'wrong-length', 7, 32),
    ('[ground, rod]', 'ground', 'wrong-type', 7, 32),
    ('  bob: {mass', '  ground: {mass', 'unknown-key', 5, 12),
    ('  bob: {mass: 1', '  bob: {mass: 0', 'out-of-range', 5, 15),
    ('  bob: {mass: 1', '  bob: {mass: -1 kg', 'out-of-range', 5, 15),
    ('  bob: {mass: 1', '  bob: {mass: 1, mass: 2', 'duplicate-key', 5, 18),
    ('  bob: {mass: 1, inertia: 1', '  bob: {mass: 1', 'missing-key', 5, 3),
    ('  bob:', '  rod:', 'duplicate-key', 5, 3),
    ('  bob:', '  2bob:', 'bad-name', 5, 3),
    ('  bob:', '  bob.x:', 'bad-name', 5, 3),
    ('tip: [1, 0]', 'com: [1, 0]', 'reserved-name', 4, 55),
    ('tip: [1, 0]', 'origin: [1, 0]', 'reserved-name', 4, 55),
    ('tip: [1, 0]', 'tip: {polar: [1, 0], position: [1, 0]}', 'conflicting-keys', 4, 61),
    ('tip: [1, 0]', 'tip: {polar: [1 m, 30]}, tap: {polar: [1, 2 m]}', 'dimension-mismatch', 4, 97),
    ('parameters: {a: 1}', 'parameters: {a: $b, b: $a}', 'cyclic-parameter', 2, 14),
    ('parameters: {a: 1}', 'parameters: {a: $a}', 'cyclic-parameter', 2, 14),
    ('parameters: {a: 1}', 'parameters: {a: 1, t: 2}', 'reserved-name', 2, 20),
    ('parameters: {a: 1}', 'parameters: {a: 1, b-c: 2}', 'bad-name', 2, 20),
    ('parameters: {a: 1}', 'parameters: {a: t}', 'time-not-allowed', 2, 17),
    ('parameters: {a: 1}', 'parameters: {b: 1}', 'unknown-name', 4, 15),
    ('mass: $a', 'use: pp, mass: $a', 'unknown-name', 4, 14),
    ('freeplay: 1', 'freeplay: 2', 'bad-version', 1, 11),
    ('freeplay: 1', 'freeplay: 1\nspace: plan', 'wrong-type', 2, 8),
    ('freeplay: 1', 'freeplay: 1\nspace: spatial', 'wrong-type', 5, 28),
    ('freeplay: 1', 'freeplay: 1\ngravity: -9.81', 'wrong-type', 2, 10),
    ('freeplay: 1', 'freeplay: 1\ngravity: [0, -9.81 m/s]', 'dimension-mismatch', 2, 14),
    ('freeplay: 1', 'freeplay: 1\nplugins: [./no.so]', 'plugin-not-found', 2, 11),
    ('freeplay: 1', 'freeplay: 1\nplugins: x', 'wrong-type', 2, 10),
    ('freeplay: 1', 'freeplay: 1\nurdf: no.urdf', 'file-not-found', 2, 7),
    ('freeplay: 1', 'freeplay: 1\nurdf: {file: no.urdf, plane: zx}', 'wrong-type', 2, 30),
    ('freeplay: 1', 'freeplay: 1\ninstances: {x: {template: y}}', 'unknown-name', 2, 27),
    ('freeplay: 1', 'freeplay: 1\ninstances: {x: {count: 1}}', 'missing-key', 2, 13),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg}}', 'missing-key', 3, 13),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, with: {l: 1, j: 2}}}', 'unknown-key', 3, 45),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, count: 0, with: {l: 1}}}', 'out-of-range', 3, 39),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, count: 1.5, with: {l: 1}}}', 'wrong-type', 3, 39),
    ('freeplay: 1', LEG + 'instances: {x: {template: legg, with: {l: 1}}}', 'unknown-name', 3, 27, 'leg'),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, with: {l: 1 m}}}', 'dimension-mismatch', 2, 71),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, with: {l: 1}}}\nframes: {x.b/p: [0, 0], x.c/p: [0, 0]}', 'unknown-name', 4, 25),
    ('freeplay: 1', 'freeplay: 1\nframes: {rod/tip: [0, 0]}', 'duplicate-name', 2, 10),
    ('freeplay: 1', 'freeplay: 1\nframes: {rod: [0, 0]}', 'bad-name', 2, 10),
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {z: [1]}}', 'unknown-name', 2, 16),
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {a: {linspace: [0, 1]}}}', 'wrong-length', 2, 30),
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {a: {logspace: [0, 1, 3]}}}', 'out-of-range', 2, 31),
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {a: [1]}, combine: mix}', 'wrong-type', 2, 34),
    ('freeplay: 1', 'freeplay: 1\nstudy: {axes: {a: [1]}, reducers: {r: {channel: joint.A.angle, reduce: mx}}}', 'wrong-type', 2, 72, 'max'),
    ('freeplay: 1', 'freeplay: 1\nanalysis: {frame: rod/tup}', 'unknown-name', 2, 19),
    ('  m: {joint', '  n: {joint: A, kind: velocity, value: 1}\n  m: {joint', 'duplicate-driver', 11, 3),
    ('  w: {type: force', '  w: {type: forse', 'unknown-type', 12, 13, 'force'),
    (FORCE, '  w: {type: spring-damper, between: [ground, bob], stiffness: -1}', 'out-of-range', 12, 63),
    (FORCE, '  w: {type: spring-damper, between: [ground, bob], stiffness: 1 N}', 'dimension-mismatch', 12, 63),
    (FORCE, '  w: {type: spring-damper, kind: rotational, between: [ground, bob], stiffness: 1, free_length: 1}', 'conflicting-keys', 12, 84),
    (FORCE, '  w: {type: torque, on: bobb, value: 1}', 'unknown-name', 12, 25, 'bob'),
    (FORCE, '  w: {type: gravity, on: [z*], value: [0, 1]}', 'unknown-name', 12, 27),
    (PIN, '  B: {type: gear, of: [A, A], ratio: 2}', 'duplicate-name', 8, 27),
    (PIN, '  B: {type: gear, of: [A], ratio: 2}', 'wrong-length', 8, 23),
    (PIN, '  B: {type: distance, between: [rod/tip, bob]}', 'missing-key', 8, 3),
    (PIN, '  B: {type: distance, between: [rod/tip, bob], length: 0}', 'out-of-range', 8, 56),
    (PIN, '  B: {type: spherical, between: [rod/tip, bob]}', 'type-space', 8, 13),
    (PIN, '  B: {type: revolute, between: [rod/tip, bob], bearing: rod}', 'conflicting-keys', 8, 48),
    (PIN, '  B: {type: revolute, bearing: rod/tip}', 'missing-key', 8, 3),
    (PIN, '  B: {type: revolute, between: [rod/tip, bob], axis: [0, 0, 1]}', 'unknown-key', 8, 48),
    (PIN, '  B: {type: fixed, between: [rod/tip, bob], clearance: {radial_clearance: 1}}', 'unknown-key', 8, 45),
    (PIN, '  B: {type: prismatic, between: [rod/tip, bob], clearance: {radial_clearance: 1}}', 'unknown-key', 8, 61),
    ('value: 3*t', 'value: atan2(1, 2)', 'bad-expression', 10, 42),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1}, joints: [A, C]}}', 'unknown-name', 10, 66),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1}, joints: [A]}}', 'ik-underdetermined', 10, 35),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1, z: 2}, joints: [A]}}', 'unknown-key', 10, 53),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {}, joints: [A]}}', 'missing-key', 10, 40),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 0}, joints: [A], elbow: 2}}', 'out-of-range', 10, 74),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 0, y: 1}, joints: [A, B], elbow: [1]}}', 'wrong-length', 10, 83),
    ('bodies:\n', 'bodies: []\nx: [\n', 'yaml-syntax', 4, 4),
    ('bodies:\n', 'bodies: 3\nq:\n', 'wrong-type', 3, 9),
    (None, 'freeplay: 1\n', 'empty-model', 1, 1),
    (None, '- 1\n', 'wrong-type', 1, 1),
    (None, 'freeplay: 1\nbodies: {a: }\n', 'wrong-type', 2, 10),
    (None, 'freeplay: 1\nbodies: {a: {mass: , inertia: 1}}\n', 'wrong-type', 2, 14),
    (None, 'freeplay: 1\nbodies: {a: {mass: [1], inertia: {x: 1}}}\n', 'wrong-type', 2, 20),
    (None, 'freeplay: 1\nbodies: {a: {mass: 1, inertia: [1, 2, 3]}}\n', 'wrong-type', 2, 32),
    (None, 'freeplay: 1\nbodies: {a: {mass: 1, inertia: -1}}\n', 'out-of-range', 2, 32),
    (None, 'freeplay: 1\nbodies: {a: {mass: 1, inertia: 1, pose: {angle: 30 deg, rpy: [0,0,0]}}}\n', 'unknown-key', 2, 57),
    (None, 'freeplay: 1\nbodies: {a: {mass: 1, inertia: 1, velocity: {angular: 1 m}}}\n', 'dimension-mismatch', 2, 55),
    (None, 'freeplay: 1\nbodies: {a: {mass: 1, inertia: 1, com: [0, 1, 2]}}\n', 'wrong-length', 2, 40),
    (None, 'freeplay: 1\nname: [a]\nbodies: {a: {mass: 1, inertia: 1}}\n', 'wrong-type', 2, 7),
    (None, 'bodies: {a: {mass: 1, inertia: 1}}\n', 'missing-key', 1, 1),
    (None, 'bodies: {a: {mass: 1, inertia: 1}}\njoints:\n  A: {type: revolute, between: [ground, a]}\n'
           '  B: {type: revolute, between: [ground, a]}\ninitial: {speeds: {A: 1, B: 3}}\nfreeplay: 1\n',
     'assembly-failed', 5, 20),
    ('step: 1 ms', 'accuracy: 1e-20 m', 'out-of-range', 14, 32),
    ('simulation:', 'study: {axes: {a: {linspace: [1 m, 2 kg, 3]}}}\nsimulation:', 'dimension-mismatch', 14, 36),
    ('freeplay: 1\nparameters: {a: 1}', 'freeplay: 1\nstudy: {axes: {a: [1 kg]}}\nparameters: {a: 1 m}', 'dimension-mismatch', 2, 20),
    ('value: 3*t', 'value: sqrt(t)*1', 'bad-expression', 10, 37),
    (None, ' freeplay: 1\nbodies: {a: {mass: 1, inertia: 1}}\n', 'yaml-syntax', 2, 1),
    (None, 'freeplay: 1\n---\nbodies: {a: {mass: 1, inertia: 1}}\n', 'yaml-feature', 2, 1),
    (None, 'freeplay: 1\n...\nbodies: {a: {mass: 1, inertia: 1}}\n', 'yaml-feature', 3, 1),
    (FORCE, '  w: {type: gear, of: [A, B], ratio: 2}', 'unknown-type', 12, 13),
    (FORCE, '  w: {type: revolute, between: [rod, bob]}', 'unknown-type', 12, 13),
    (PIN, '  B: {type: spring-damper, between: [rod/tip, bob]}', 'wrong-type', 13, 20),
    (MOTOR, '  m: {joint: A, kind: angle, input: 3}', 'wrong-type', 10, 30),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1, y: 0}, joints: [A, B], elbow: [0, 1]}}', 'out-of-range', 10, 84),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1}, joints: [z*]}}', 'unknown-name', 10, 63),
    (MOTOR, '  m: {inverse_kinematics: {frame: bob, path: {x: 1}, joints: []}}', 'wrong-length', 10, 62),
    ('end: 2', 'start: 3, end: 2', 'out-of-range', 14, 29),
    ('step: 1 ms', 'step: {size: 1 ms, adaptive: true, min: 2 ms}', 'out-of-range', 14, 62),
    ('step: 1 ms', 'step: {size: 1 ms, adaptive: true, max: 0.1 ms}', 'out-of-range', 14, 62),
    ('parameters: {a: 1}', 'parameters: {a: 1, "": 2}', 'bad-name', 2, 20),
    ('freeplay: 1', 'freeplay: 1\nframes: {ground/2x: [0, 0]}', 'bad-name', 2, 10),
    (None, 'freeplay: 1\npresets: {p: {use: q}, q: {use: p}}\nbodies: {a: {use: p, mass: 1, inertia: 1}}\n', 'cyclic-preset', 2, 33),
    ('freeplay: 1', 'freeplay: 1\npresets: {2p: {mass: 1}}', 'bad-name', 2, 11),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, count: 2, with: {l: 1}}, x1: {template: leg, with: {l: 1}}}', 'duplicate-name', 3, 57),
    ('freeplay: 1', LEG + 'instances: {x: {template: leg, count: 100000000, with: {l: 1}}}', 'too-large', 3, 39),
    (None, IN_SPACE % '[[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]]', 'out-of-range', 3, 32),
    (None, IN_SPACE % '[1, 1, 1, 2, 2, 2]', 'out-of-range', 3, 32),
    (None, IN_SPACE % '[1, 2]', 'wrong-type', 3, 32),
    (None, IN_SPACE % '[1, 1, 1], pose: {quaternion: [0, 0, 0, 0]}', 'out-of-range', 3, 62),
    (None, IN_SPACE % '[1, 1, 1], pose: {rpy: [0, 0, 0], quaternion: [1, 0, 0, 0]}', 'conflicting-keys', 3, 66),
]

# Studies, from column 9 of line 2 on; id, column and a part of the message.
STUDIES = [
    ('axes: {a: []}', 'wrong-length', 19, 'must have at least 1 item'),
    ('axes: {a: {cases: {}}}', 'wrong-length', 27, 'there is no case'),
    ('axes: {x: {cases: {"a,b": {a: 1}}}}', 'bad-name', 28, "'a,b' cannot stand in a table"),
    ('axes: {a: {uniform: [2, 1]}}', 'out-of-range', 33, 'the high end must be above the low one'),
    ('axes: {a: {triangular: [3, 2, 1]}}', 'out-of-range', 36, '[low, mode, high], in this order'),
    ('axes: {a: {linspace: [0, 1, 1000000000]}}', 'too-large', 37, 'at most 10^8 points'),
    ('axes: {a: {uniform: [1, 2]}}', 'missing-key', 16, 'is random: the study needs `sample`'),
    ('axes: {a: {uniform: [1, 2]}}, combine: star, sample: {method: sobol, points: 2, seed: 1}', 'conflicting-keys', 48,
     'random axes have no values to take one at a time'),
    ('axes: {a: [1, 2]}, combine: star, zip: [[a, b]]', 'conflicting-keys', 43, '`combine` is no grid'),
    ('axes: {a: [1, 2], bodies.bob.mass: [1, 2], bodies.rod.mass: [1, 2]}, zip: [[a, bodies.bob.mass], [a, bodies.rod.mass]]',
     'duplicate-name', 107, "'a' goes side by side with others already"),
    ('axes: {a: [1, 2]}, zip: [[a, b]]', 'unknown-name', 38, "unknown axis 'b'"),
    ('axes: {a: {uniform: [1, 2]}}, sample: {method: sobol, points: 2, seed: 1}, warm_start: {along: a}', 'conflicting-keys', 104,
     'no order to go along'),
    ('axes: {a: [1, 2]}, combine: star, warm_start: {along: a}', 'conflicting-keys', 63, 'no way along an axis'),
    ('axes: {a: [1, 2]}, warm_start: {along: b}', 'unknown-name', 48, "unknown axis 'b'"),
    ('axes: {a: [1, 2]}, stop: {reducer: r, of: mean, half_width: 1}', 'conflicting-keys', 28, 'no samples to end'),
]

# Mistakes of one file, all found at once: result columns are judged although other keys are wrong.
TOGETHER = SOUND.replace("initial: {", "gravty: [0, 1]\ninitial: {assembl: 1, ").replace("end: 2,", """end: 2, stpe: 1,
  stop: [{channel: joint.A.angel, above: 1}, {above: 1}, {channel: driver.m.value, below: 1 kg}],
  output: {channels: [body.rodd.x, 'bdy.*', drivr.m.value], intervall: 1},""") + """
study: {axs: {a: [1]}, reducers: {r: {channel: energy.kinetc, offf: 1}}}
"""
# What one part of an entry has wrong does not hide the rest.
BESIDE = [
    (PIN, '  B: {type: gear, of: [A, C], ratio: 0, offset: none}', [('unknown-name', 27), ('out-of-range', 38), ('bad-expression', 49), ('wrong-type', 20)]),
    (MOTOR, '  m: {joint: Z, kind: angle, value: 1 m}', [('unknown-name', 14), ('dimension-mismatch', 37)]),
    (MOTOR, '  m: {joint: A, kind: angle, table: {unit: m, points: [[0, 1 m], [t, 1]]}}',
     [('dimension-mismatch', 44), ('dimension-mismatch', 60), ('time-not-allowed', 67)]),
    ('forces:', 'templates: {leg: {parameters: {l: required}, bodis: 1, bodies: {b: {mass: $l, inertai: 1}}}}\nforces:',
     [('unknown-key', 46), ("missing-key", 65), ('unknown-key', 79)]),
    ('mass: $a', 'mass: -1', [('out-of-range', 15)]),
]
FOUND = [["unknown-key", 13, "gravity"], ["unknown-key", 14, "assembly"], ["unknown-key", 15, "step"],
         ["unknown-name", 16, "joint.A.angle"], ["missing-key", 16, None], ["dimension-mismatch", 16, None],
         ["unknown-name", 17, "body.rod.x"], ["unknown-name", 17, "body.*"], ["unknown-name", 17, "driver.m.value"],
         ["unknown-key", 17, "interval"], ["unknown-key", 19, "axes"], ["unknown-name", 19, "energy.kinetic"],
         ["unknown-key", 19, "of"]]


class Mistakes(ProgramTest):
    def test_every_mistake_has_its_place(self):
        self.write("sound.yaml", SOUND)
        self.freeplay("validate", "sound.yaml", "--strict")
        for old, new, *expected in MISTAKES:
            with self.subTest(new):
                if old is not None:
                    self.assertIn(old, SOUND)
                self.write("m.yaml", new if old is None else SOUND.replace(old, new, 1))
                plugin = expected[0].startswith("plugin-")
                out, _ = self.freeplay("validate", "m.yaml", "--json", code=5 if plugin else 3)
                messages = json.loads(out)["messages"]
                found = [[m["id"], m["line"], m["column"], m["suggestion"]][:len(expected)] for m in messages]
                self.assertIn(expected, found)

    def test_every_mistake_of_a_study_is_said_at_its_place(self):
        for text, *expected in STUDIES:
            with self.subTest(text):
                self.write("m.yaml", SOUND.replace("freeplay: 1", "freeplay: 1\nstudy: {%s}" % text, 1))
                out, _ = self.freeplay("validate", "m.yaml", "--json", code=3)
                found = [[m["id"], m["line"], m["column"]] for m in json.loads(out)["messages"] if expected[2] in m["message"]]
                self.assertEqual([[expected[0], 2, expected[1]]], found)

    def test_result_columns_are_judged_beside_other_mistakes(self):
        self.write("m.yaml", TOGETHER)
        out, _ = self.freeplay("validate", "m.yaml", "--json", code=3)
        found = [[m["id"], m["line"], m["suggestion"]] for m in json.loads(out)["messages"]]
        self.assertEqual(sorted(FOUND, key=str), sorted(found, key=str))

    def test_mistakes_of_one_entry_do_not_hide_each_other(self):
        columns = ("stop: [{channel: body.bob.xx, above: 1 m}], output: {channels: [bdy.*]}, end: 2",
                   [("unknown-name", 31), ("unknown-name", 78)])
        for old, new, expected in BESIDE:
            with self.subTest(new):
                self.assertIn(old, SOUND)
                self.write("m.yaml", SOUND.replace(old, new, 1).replace("end: 2", columns[0]))
                out, _ = self.freeplay("validate", "m.yaml", "--json", code=3)
                found = [(m["id"], m["column"]) for m in json.loads(out)["messages"] if m["severity"] == "error"]
                self.assertEqual(sorted(expected + columns[1]), sorted(found))

    def test_a_column_is_not_judged_when_what_it_belongs_to_may_be_misspelt(self):
        text = SOUND.replace("drivers:", "driver:").replace("end: 2,", "end: 2, output: {channels: [driver.m.value]},")
        self.write("m.yaml", text)
        out, _ = self.freeplay("validate", "m.yaml", "--json", code=3)
        self.assertEqual(["unknown-key"], [m["id"] for m in json.loads(out)["messages"]])


if __name__ == "__main__":
    unittest.main()
