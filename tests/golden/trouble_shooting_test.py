"""Every heading of docs/trouble-shooting.md is a message that the program prints, and each of them is provoked here."""
import os
import re
import subprocess
import unittest

from program import BUILD, PROGRAM, ROOT, ProgramTest

PENDULUM = """freeplay: 1
name: pendulum
gravity: [0, -9.81]
bodies:
  rod: {mass: 1 kg, inertia: 1 kg*m^2 / 12, com: [0.5 m, 0], frames: {tip: [1 m, 0]}}
joints:
  pivot: {type: revolute, between: [ground, rod]}
initial: {joints: {pivot: 0 deg}}
simulation: {end: 0.1 s, step: 1 ms}
"""
JOURNAL = """freeplay: 1
name: journal
gravity: [0, -9.81]
bodies:
  ball: {mass: 1 kg, inertia: 1 kg*m^2}
joints:
  B:
    type: revolute
    between: [ground, ball]
    clearance:
      bearing_radius: 10 mm
      radial_clearance: 0.1 mm
      length: 10 mm
      material: {E: 207 GPa, nu: 0.3}
      contact: {law: lankarani-nikravesh, restitution: 0.9}
      friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}
simulation: {end: 20 ms, step: 10 us}
"""
TWO_LINKS = """freeplay: 1
bodies:
  a: {mass: 3, inertia: 0.03, com: [0.15, 0], frames: {end: [0.3, 0]}, pose: {angle: 60 deg}}
  b: {mass: 2, inertia: 0.015, com: [0.125, 0], frames: {end: [0.25, 0]}, pose: {angle: -30 deg}}
joints: {A: {type: revolute, between: [ground, a]}, B: {type: revolute, between: [a/end, b]}}
drivers: {path: {inverse_kinematics: {frame: b/end, path: {x: 0.35 m + 0.25 m/s*t, y: 0.1 m}, joints: [A, B]}}}
simulation: {end: 1 s, accuracy: 1 um}
"""
DRIVEN = PENDULUM.replace("initial: {joints: {pivot: 0 deg}}", "drivers: {motor: {joint: pivot, kind: angle, value: t}}")
SHORT_ROD = DRIVEN.replace("bodies:", "bodies:\n  slider: {mass: 1 kg, inertia: 1 kg*m^2}").replace("drivers:", """\
  guide: {type: prismatic, between: [ground, slider]}
  link: {type: distance, between: [rod/tip, slider], length: 0.5 m}
drivers:""").replace("value: t", "value: 10*t")
PULSE = """\
freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 1 kg*m^2}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {hit: {type: force, at: m, value: ["1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))", 0]}}
simulation: {end: 2 s, step: 5 ms}
"""
SIGN = """\
freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 1 kg*m^2}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {hold: {type: force, at: m, value: ["-5 N*sign(body.m.vx)", 0]}}
initial: {speeds: {slide: 1 m/s}}
simulation: {end: 2 s, accuracy: 1 um}
"""
# Damped so hard that an explicit method may take steps of some microseconds.
STIFF = """\
freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 1 kg*m^2}}
joints: {slide: {type: prismatic, between: [ground, m]}}
forces: {hold: {type: spring-damper, between: [ground, m], kind: linear, stiffness: 1e6, damping: 1e6, free_length: 1 m}}
initial: {joints: {slide: 1.1 m}}
simulation: {end: 2 s, integrator: bathe, accuracy: 1 um}
"""
# A pin that just touches its hole: the contact begins at no speed, by which the law divides its damping.
TOUCHING = JOURNAL.replace("lankarani-nikravesh, restitution: 0.9", "flores, K: 1e8, restitution: 0.001").replace(
    "      friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}\n", "      initial: {eccentricity: [0 mm, -0.1 mm]}\n").replace(
        "      material: {E: 207 GPa, nu: 0.3}\n", "").replace("end: 20 ms, step: 10 us", "end: 0.1 s, accuracy: 1 um")
NO_STEP = PENDULUM.replace("{pivot: 0 deg}", "{pivot: 0 deg}, speeds: {pivot: 1e7 rad/s}").replace(
    "mass: 1 kg, inertia: 1 kg*m^2 / 12, com: [0.5 m, 0], frames: {tip: [1 m, 0]}", "mass: 1 g, inertia: 0.1 g*mm^2, com: [5 mm, 0]")
PUSHED = """freeplay: 1
bodies: {puck: {mass: 1 kg, inertia: 0.01, velocity: {linear: [1 m/s, 0]}}}
forces: {push: {type: force, at: puck, value: ["1e6 N*s/m*body.puck.vx", 0]}}
simulation: {end: 1 s, accuracy: 1 um}
"""
IN_LINE = SHORT_ROD.replace("drivers: {motor: {joint: pivot, kind: angle, value: 10*t}}", "initial: {joints: {guide: 1.2 m}}").replace(
    "frames: {tip: [1 m, 0]}", "frames: {tip: [1 m, 0]}, pose: {angle: 0}")
with open(os.path.join(ROOT, "mechanisms", "validation", "a02-chain.yaml"), encoding="utf-8") as chain:
    PARALLELOGRAMS = chain.read()
FLAT = """freeplay: 1
bodies:
  crank: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  coupler: {mass: 0.9, inertia: 6.75e-3, com: [0.15, 0], frames: {tip: [0.4, 0]}}
  rocker: {mass: 0.8, inertia: 4.5e-3, com: [0.125, 0], frames: {tip: [0.1, 0]}}
frames: {ground/D: [0.4, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {motor: {joint: A, kind: torque, value: 1}}
initial: {joints: {A: 0}}
simulation: {end: 2 s, step: 1 ms}
"""
LOCKED = """freeplay: 1
bodies:
  crank: {mass: 0.3, inertia: 1e-4, frames: {tip: [50 mm, 0]}, pose: {angle: 70 deg}}
  coupler: {mass: 0.21, inertia: 2.5e-4, frames: {tip: [120 mm, 0]}}
frames: {ground/wrist: [120 mm, 0]}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  wrist:
    type: revolute
    bearing: coupler/tip
    journal: ground/wrist
    clearance:
      {bearing_radius: 10 mm, radial_clearance: 0.1 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: hertz}}
drivers: {motor: {joint: main, kind: velocity, value: 10 rpm}}
simulation: {end: 0.1 s, step: 10 us}
"""
LIBRARIES = {"TEMPLATE": os.path.join(BUILD, "plugins", "template", "template_integrator.so"),
             "PROBE": os.path.join(BUILD, "plugins", "probes", "probe_throws_in_apply.so"),
             "ENDLESS": os.path.join(BUILD, "plugins", "tests", "endless_events.so")}
TORQUE = "{type: torque, on: rod, value: 1 N*m}"
SPRING = "{type: spring-damper, kind: rotational, between: [ground, rod], stiffness: 10}"
RUN = ["run", "model.yaml", "--force"]


def pendulum(old, new, text=PENDULUM):
    assert old in text
    return text.replace(old, new)


def journal(old, new):
    return pendulum(old, new, JOURNAL)


def driven(old, new):
    return pendulum(old, new, DRIVEN)


# Heading: exit code, model, words of the command.
CASES = {
    # What the model file says
    "unknown key '...' in '...' [unknown-key]": (3, pendulum("com:", "con:"), RUN),
    "missing key '...' in '...' [missing-key]": (3, pendulum("mass: 1 kg, ", ""), RUN),
    "the key '...' is given twice [duplicate-key]": (3, pendulum("mass: 1 kg,", "mass: 1 kg, mass: 2 kg,"), RUN),
    "unknown type '...' in '...' [unknown-type]": (3, pendulum("type: revolute", "type: revolut"), RUN),
    "unknown body '...' [unknown-name]": (3, pendulum("[ground, rod]", "[ground, rodd]"), RUN),
    "body '...' has no frame '...' [unknown-name]": (3, pendulum("[ground, rod]", "[ground, rod/tp]"), RUN),
    "unknown parameter '...' [unknown-name]": (3, pendulum("mass: 1 kg", "mass: $m"), RUN),
    "expected ..., but this is ... [dimension-mismatch]": (3, pendulum("mass: 1 kg", "mass: 1 m"), RUN),
    "'...' is not a unit [bad-unit]": (3, pendulum("1 kg,", "1 gramm,"), RUN),
    "'...' must be ..., not ... [out-of-range]": (3, journal("restitution: 0.9", "restitution: 1.2"), RUN),
    "'v1' must be above 'v0' [out-of-range]": (3, journal("v0: 1e-4", "v0: 1e-2"), RUN),
    "'...' must be a list of 2, not ... [wrong-type]": (3, pendulum("[0.5 m, 0]", "0.5 m"), RUN),
    "'...' must have 2 items, not 3 [wrong-length]": (3, pendulum("[0.5 m, 0]", "[0.5 m, 0, 0]"), RUN),
    "a ',' cannot stand inside a number [bad-expression]": (3, pendulum("[0.5 m", "['0,5 m'"), RUN),
    "'t' is not allowed here: the value must be constant [time-not-allowed]": (3, pendulum("1 kg,", "1 + t,"), RUN),
    "'...' is a value of the motion, which is not allowed here [state-not-allowed]":
        (3, pendulum("1 kg,", "body.rod.x,"), RUN),
    "unknown channel '...' [unknown-name]":
        (3, pendulum("initial:", "forces: {f: {type: torque, on: rod, value: 1 N*m*s*body.rod.spin}}\ninitial:"), RUN),
    "'...' is an acceleration: a force that depends on the acceleration it makes is defined by itself [algebraic-loop]":
        (3, pendulum("initial:", "forces: {f: {type: torque, on: rod, value: 1 N*m*s^2*body.rod.alpha}}\ninitial:"), RUN),
    "'...' follows from the forces: one that depends on it is defined by itself [algebraic-loop]":
        (3, pendulum("initial:", "forces: {f: {type: torque, on: rod, value: 1 m*joint.pivot.fx}}\ninitial:"), RUN),
    "the curve is not closed: ... [bad-curve]":
        (3, pendulum("  pivot: {type: revolute, between: [ground, rod]}",
                     "  pivot: {type: point-on-curve, form: polar, between: [ground, rod], curve: 1 m + 0.1 m*x}"), RUN),
    "not valid YAML: ... [yaml-syntax]": (3, pendulum("[0.5 m, 0]", "[0.5 m, 0"), RUN),
    "'radial_clearance' is not 'bearing_radius' minus 'journal_radius' [conflicting-keys]":
        (3, journal("length: 10 mm", "journal_radius: 5 mm"), RUN),
    "'K' is required, as it cannot be computed without ... [missing-key]":
        (3, journal("      material: {E: 207 GPa, nu: 0.3}\n", ""), RUN),
    "a driver moves joint '...'; it has no start value of its own [conflicting-keys]":
        (3, driven("simulation:", "initial: {joints: {pivot: 0}}\nsimulation:"), RUN),
    "cannot read '...': there is no such file [file-not-found]": (3, PENDULUM, ["run", "modell.yaml"]),
    # Before the first step
    "two positions are equally near to what the file gives: ... [ambiguous-start]":
        (0, IN_LINE, ["validate", "model.yaml"]),
    "the mechanism cannot be put together: ... [assembly-failed]":
        (3, pendulum("initial:", "  far: {type: revolute, between: [ground/far, rod/tip]}\n"
                                 "frames: {ground/far: [5 m, 0]}\ninitial:"), RUN),
    "drivers and start speeds contradict each other: ... [assembly-failed]":
        (3, pendulum("{pivot: 0 deg}}", "{pivot: 0 deg}, speeds: {pivot: 1 rad/s, twin: 2 rad/s}}").replace(
            "initial:", "  twin: {type: revolute, between: [ground, rod]}\ninitial:"), RUN),
    "driver '...' cannot move its joint from here: ... it; ... [assembly-failed]":
        (3, driven("drivers:", "  again: {type: revolute, between: [ground/far, rod/tip]}\nframes: {ground/far: [1 m, 0]}\ndrivers:"), RUN),
    "driver '...' moves nothing: ... [locked]":
        (0, driven("drivers:", "  held: {type: fixed, between: [ground, rod]}\ndrivers:").replace("kind: angle, value: t", "kind: torque, value: 1"), ["validate", "model.yaml"]),
    "driver '...' starts joint '...' at a dead point...: ... [dead-point]":
        (0, SHORT_ROD.replace("value: 10*t", "value: 0").replace("joint: pivot, kind: angle, value: 0", "joint: guide, kind: position, value: 1.5 m"), ["validate", "model.yaml"]),
    "'...' starts at rest in an unstable equilibrium: ... [unstable-start]": (0, pendulum("0 deg", "-90 deg").replace("-9.81", "9.81").replace("0.1 s", "2 s"), RUN),
    "a step may err by ... m, but positions of a model of ... m are rounded to ... m [out-of-range]":
        (3, PENDULUM, RUN + ["--accuracy", "1e-17 m"]),
    "integrator '...' gives no error estimate: it takes fixed steps only":
        (2, PENDULUM, RUN + ["--accuracy", "1 um", "--integrator", "my-type", "--plugin", "TEMPLATE"]),
    "--integrator ...: there is no such integrator": (2, PENDULUM, RUN + ["--integrator", "rk4"]),
    "... '...': it has corners at ... s and ... s, closer than the step of ... s, ...": (0, PULSE, RUN),
    "... '...': it changes at t = ... s for some ... s, which the step of ... s goes over; ...":
        (0, driven("value: t", "value: exp(-((t - 0.05)/1e-4)^2)"), RUN),
    "... '...': it changes at t = ... s for some ... s, less than a millionth of the run, which steps may go over; ...":
        (0, PULSE.replace("1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))", "1/(1 + ((t - 0.7)/1e-8)^2)").replace("step: 5 ms", "accuracy: 1 um"), RUN),
    "steps of ... s at t = ... s, of which the whole run would take ...; joint '...' limits the last of them to ... s: its ... is damped ...":
        (0, TOUCHING, RUN),
    "--verify: THE RUNS DISAGREE: ...": (7, PULSE, RUN + ["--verify"]),
    "--verify: the second run was given up at ... s after ... steps": (0, STIFF, RUN + ["--verify"]),
    # Doubted, and run all the same
    "'...' is ... rad, ... turns: write '... deg' if degrees are meant, else '... rad' [doubtful-angle]":
        (0, pendulum("0 deg", "60"), RUN),
    "'...' is ... m all the way round, though it changes with '...', which is in radians: ... [doubtful-angle]":
        (0, pendulum("initial:", "  rider: {type: point-on-curve, form: polar, between: [ground, puck], curve: '1 m + 0.1 m*smooth(x, 60, 120)'}\ninitial:").replace(
            "bodies:", "bodies:\n  puck: {mass: 1 kg, inertia: 1, pose: {position: [1, 0]}}"), RUN),
    "'...' is ... rad/s, that is ... rpm: write '... rpm' if revolutions per minute are meant, else '... rad/s' [doubtful-speed]":
        (0, driven("value: t", "value: 3000*t"), RUN + ["--step", "10 us"]),
    "'...' is ... m/s^2, ... times that of the earth: write the unit after the number, as in '... mm/s^2' [doubtful-value]":
        (0, pendulum("-9.81", "-9810"), RUN),
    "'...' is ... s in a run of ... s: write '... ms' if milliseconds are meant, else '... s' [doubtful-time]":
        (0, pendulum("step: 1 ms", "step: 0.01"), RUN),
    "'...' is ... m from the origin of its body, but the lengths around it are about ... m: write the unit after the numbers, "
    "as in '... mm' [doubtful-length]":
        (0, pendulum("joints:\n", "  arm: {mass: 1 kg, inertia: 1, frames: {hand: [500, 0]}}\njoints:\n"
                                "  hinge: {type: revolute, between: [rod/tip, arm]}\n").replace("step: 1 ms", "step: 1 ms, output: {frames: [arm/hand]}"), RUN),
    "the inertia of '...' is ... kg*m^2 for a mass of ... kg: its radius of gyration would be ... m, but ...: ... [doubtful-inertia]":
        (0, pendulum("1 kg*m^2 / 12", "250"), RUN),
    "the mass of '...' is ... kg at a radius of gyration of ... m: its density would be ... kg/m^3, ... [doubtful-mass]":
        (0, pendulum("mass: 1 kg, inertia: 1 kg*m^2 / 12", "mass: 1e6, inertia: 1"), RUN),
    "the centre of mass of '...' is ... m away from its frames, which extend over ... m, ... [doubtful-com]":
        (0, pendulum("com: [0.5 m, 0]", "com: [1.8 m, 0]"), RUN),
    "'...' comes to ... on ... kg in a mechanism of ... m, more than any machine has: ... [doubtful-value]":
        (0, driven("kind: angle, value: t", "kind: torque, value: 1e6"), ["validate", "model.yaml"]),
    "the clearance of joint '...' is ... m, ... [doubtful-clearance]": (0, journal("0.1 mm", "0.1 nm"), RUN),
    "frame '...' is not used": (0, PENDULUM, RUN),
    "joints '...' and '...' hold '...' at one place, '...', so that its turning moves nothing: ... [same-frame]":
        (0, pendulum("initial:", "  arm: {type: revolute, between: [rod, arm]}\ninitial:").replace("bodies:", "bodies:\n  arm: {mass: 1 kg, inertia: 0.1}"), RUN),
    "no joint or force holds body '...', which ...: connect it, or delete it [not-connected]":
        (0, pendulum("joints:\n", "  spare: {mass: 1 kg, inertia: 0.1}\njoints:\n"), RUN),
    "no joint or force ties '...' and '...' to the others, which ...: connect them, or delete them [not-connected]":
        (0, pendulum("joints:\n", "  one: {mass: 1 kg, inertia: 0.1}\n  two: {mass: 1 kg, inertia: 0.1}\njoints:\n  tie: {type: revolute, between: [one, two]}\n"), RUN),
    "joint '...' holds nothing that '...' does not hold between the same two bodies: ... [duplicate-joint]":
        (0, pendulum("initial:", "  twin: {type: revolute, between: [ground, rod]}\ninitial:"), RUN),
    "'...' has the same frames and numbers as '...', so that both act as one twice as strong: ... [duplicate-force]":
        (0, pendulum("initial:", "forces:\n  one: %s\n  two: %s\ninitial:" % (SPRING, SPRING)), RUN),
    "'...' is the same ... at the same place as '...', so that both act as one twice as large: ... [duplicate-force]":
        (0, pendulum("initial:", "forces:\n  one: %s\n  two: %s\ninitial:" % (TORQUE, TORQUE)), RUN),
    "'...' moves nothing: joint '...' keeps '...' from ... against '...'; ... [idle-force]":
        (0, pendulum("initial:", "forces: {rub: {type: joint-friction, between: [ground, rod], friction: 1}}\ninitial:"), RUN),
    "joint '...' cannot move: with ... it closes a loop in which nothing can; ... [locked]":
        (0, driven("drivers:", "  pin: {type: revolute, between: [rod/tip, bar]}\n  hand: {type: revolute, between: [bar/tip, sled]}\n"
                               "  guide: {type: prismatic, between: [rod, sled]}\ndrivers:")
         .replace("joints:", "  bar: {mass: 1 kg, inertia: 0.1, frames: {tip: [0.5, 0]}, pose: {angle: 2}}\n  sled: {mass: 1 kg, inertia: 0.1}\njoints:"), RUN),
    "body '...' cannot move, though the mechanism can: ...; check at which frames they stand, and their axes [locked]":
        (0, driven("drivers:", "  foot: {type: revolute, between: [ground, stay]}\n  head: {type: revolute, between: [stay/tip, ground/far]}\ndrivers:")
         .replace("joints:", "  stay: {mass: 1 kg, inertia: 0.1, frames: {tip: [0.5, 0]}, pose: {angle: 40 deg}}\nframes: {ground/far: [0.5, 0]}\njoints:"), RUN),
    "'...' does nothing: none of its numbers that make a force is given; ...":
        (0, pendulum("initial:", "forces:\n  one: %s\ninitial:" % SPRING.replace(", stiffness: 10", "")), RUN),
    "'...' never moves: it turns in its bearing on ground alone, and no gear, driver, force or start turns it; ... [left-free]":
        (0, driven("joints:", "  wheel: {mass: 1 kg, inertia: 0.1}\njoints:\n  axle: {type: revolute, between: [ground, wheel]}"), RUN),
    "no driver moves '...': no joint, gear or force ties it to what drivers move; ... [left-free]":
        (0, driven("joints:", "  load: {mass: 1 kg, inertia: 0.1, com: [0.1, 0]}\njoints:\n  eye: {type: revolute, between: [ground, load]}")
         .replace("drivers:", "initial: {joints: {eye: 1 rad}}\ndrivers:"), RUN),
    "the play of joint '...' is bypassed by ... [play-bypassed]":
        (0, journal("simulation:", "  pin: {type: revolute, between: [ground, ball]}\nsimulation:"), RUN),
    "what force '...' lets touch starts ... m deep in each other, ... and is thrown apart: ... [starts-inside]":
        (0, PUSHED.replace("forces: {", "forces: {c: {type: curve-contact, between: [ground, puck], first: 30 mm, second: 20 mm, contact: {law: hertz, K: 1e6}}, ")
         .replace("velocity:", "pose: {position: [45 mm, 0]}, velocity:").replace("1e6 N*s", "-1 N*s"), RUN),
    "... left over with all drivers at rest, ... [left-free]":
        (0, driven("joints:", "  load: {mass: 1 kg, inertia: 0.1, com: [0.1, 0]}\njoints:\n  eye: {type: revolute, between: [rod/tip, load]}"), RUN),
    # While it runs
    "a step below ... s is needed, the smallest allowed; joint '...' asks for it":
        (4, journal("step: 10 us", "step: {adaptive: true, size: 1 ms, min: 1 ms}"), RUN),
    "a step below ... s is needed, the smallest allowed; the error is largest in body '...' (...)":
        (4, pendulum("step: 1 ms", "step: {adaptive: true, size: 50 ms, min: 50 ms, tolerance: 1e-9}"), RUN),
    "the mechanism comes to a singular position, as of links in line: it cannot go on, or rounding hides how; ...":
        (4, PARALLELOGRAMS, RUN + ["--set", "windows=10", "--accuracy", "1e-12"]),
    "the mechanism ... a singular position, where ... hold links in line: ... [dead-point]": (4, FLAT, RUN),
    "the mechanism cannot follow the path at t = ..., where ...: a singular place, ... [ik-unreachable]": (4, TWO_LINKS, RUN),
    "driver '...' asks for a position that the mechanism cannot take: ... [dead-point]":
        (4, SHORT_ROD, RUN),
    "driver '...' cannot move joint '...' beyond the play: ... hold it at ...; ... [locked]": (4, LOCKED, RUN),
    "joint '...' at t = ... s: its surfaces are ... m deep in each other, more than ...; likely cause: ...":
        (4, journal("E: 207 GPa", "E: 1 Pa").replace("lankarani-nikravesh, restitution: 0.9", "hertz, K: 1e-3").replace("end: 20 ms", "end: 1 s"), RUN),
    "joint '...' at t = ... s: a force of ... N presses with more than a tenth of the elastic modulus ...":
        (4, journal("E: 207 GPa", "E: 207 Pa").replace("end: 20 ms", "end: 1 s"), RUN),
    "body '...' at t = ... s: it turns with ... m/s at its radius of gyration, more than twice the speed of sound in steel; likely cause: ...":
        (4, driven("kind: angle, value: t", "kind: torque, value: 1e9"), RUN),
    "body '...' at t = ... s: it moves with ... m/s, faster than light...":
        (4, PUSHED, RUN),
    "energy would grow by ... J in a step of ... s, more than everything that acts could put in; ...":
        (4, journal("E: 207 GPa", "E: 207e22 GPa").replace("lankarani-nikravesh, restitution: 0.9", "hertz"), RUN),
    "forces and speeds grow beyond all bounds, ...":
        (4, journal("E: 207 GPa", "E: 207e200 GPa"), RUN + ["--step", "1 ms"]),
    "no step of ... s or longer could be made: ...; try a smaller step":
        (4, NO_STEP, RUN),
    "driver '...': the prescribed position jumps; no motion follows it":
        (4, driven("value: t", "table: {points: [[0, 0], [0.05, 1]], interpolation: linear, outside: repeat}"),
         RUN + ["--accuracy", "1 um"]),
    "driver '...' at t = ...: the speed that it prescribes jumps from ... to ...: ...":
        (0, driven("value: t", "value: abs(t - 0.05)"), RUN),
    "driver '...': a negative number to a power that is not an integer [bad-expression]": (4, driven("value: t", "value: (0.0501 - t)^2.5"), RUN),
    "joint '...': contact law of type '...': ... [law-range]":
        (4, journal("lankarani-nikravesh, restitution: 0.9", "johnson").replace("ball: {mass: 1 kg", "ball: {mass: 1e6 kg"), RUN),
    "joint '...' of ... failed: ... [plugin-failed]":
        (5, pendulum("initial: {joints: {pivot: 0 deg}}", "").replace("type: revolute", "type: probe"), RUN + ["--plugin", "PROBE"]),
    "The penetration passes a tenth of the radial clearance: ...":
        (0, journal("mass: 1 kg", "mass: 100 kg"), RUN),
    "The law of ... rebounds faster than asked for a restitution below ...":
        (0, journal("restitution: 0.9", "restitution: 0.3"), RUN),
    "the events of joint '...' do not end: ... within ... s, the last '...'; ... [event-storm]":
        (4, pendulum("  pivot: {type: revolute, between: [ground, rod]}", "  stop: {type: endless-stop, between: [ground, rod], gap: 0.5 m}").replace("initial: {joints: {pivot: 0 deg}}\n", "").replace("gravity: [0, -9.81]", "gravity: [9.81, 0]")
         .replace("end: 0.1 s", "end: 1 s"), RUN + ["--plugin", "ENDLESS"]),
    "the formula of force '...' changes its form without end: ... times within ... s; ... [event-storm]": (4, SIGN, RUN),
    # After a run
    "statistics begin at ... s, but the run ends at ... s: ... [no-statistics]":
        (0, pendulum("step: 1 ms", "step: 1 ms, output: {discard: 0.1 s}"), RUN),
    "rows ... s apart miss peaks between them: they show ... N of the ... N in ...":
        (0, journal("step: 10 us", "step: 10 us, output: {interval: 5 ms}"), RUN),
    "steps per impact: ... or more; ... of ... impacts took fewer than 20: --step ..., or an accuracy in its place, would do":
        (0, journal("step: 10 us", "step: 500 us"), RUN),
    "trust: doubtful (...)": (0, journal("mass: 1 kg", "mass: 100 kg"), RUN),
    "'...' holds other files than a result": (6, PENDULUM, ["run", "model.yaml", "--out", "."]),
    "the run would write about ... (... rows of ... columns) into '...', more than half of the ... that are free there [too-large]":
        (6, PENDULUM, RUN + ["--end", "1e9 s", "--interval", "1 us"]),
    "'...' exists already": (6, PENDULUM, ["convert", "model.yaml", "model.yaml"]),
    "plugin '...' cannot be loaded: ... [plugin-refused]": (5, PENDULUM, RUN + ["--plugin", "./model.so"]),
    "the plugin '...' (SHA-256 ...) lies outside of the folders for plugins, ... [plugin-not-allowed]":
        (5, PENDULUM.replace("freeplay: 1", "freeplay: 1\nplugins: [./model.so]"), ["validate", "model.yaml"]),
    "there is no plugin '...' in ...": (5, PENDULUM, RUN + ["--plugin", "mine"]),
}


def headings():
    with open(os.path.join(ROOT, "docs", "trouble-shooting.md"), encoding="utf-8") as file:
        return re.findall(r"^### `(.*)`$", file.read(), re.M)


def pattern(heading):
    return ".+".join(re.escape(part) for part in heading.split("..."))


class TroubleShooting(ProgramTest):
    def test_every_heading_is_provoked_here_once(self):
        self.assertEqual(sorted(CASES), sorted(headings()))

    def test_every_heading_is_what_the_program_prints(self):
        self.write("model.so", "no library")
        for heading, (code, model, words) in CASES.items():
            with self.subTest(heading):
                self.write("model.yaml", model)
                words = [LIBRARIES.get(word, word) for word in words]
                done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, timeout=60)
                said = done.stdout + done.stderr
                self.assertEqual(code, done.returncode, said)
                self.assertRegex(said, pattern(heading))


if __name__ == "__main__":
    unittest.main()
