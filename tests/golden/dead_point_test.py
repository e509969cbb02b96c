"""Drivers that ask for a position that the mechanism cannot take: the message names it, and advises nothing in vain."""
import csv
import itertools
import json
import math
import re
import unittest

from program import ProgramTest, mechanism

FOUR_BAR = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 0.01, frames: {tip: [%g, 0]}}
  coupler: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}, pose: {angle: -10 deg}}
  rocker: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}, pose: {angle: 120 deg}}
frames: {ground/D: [0.4, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]%s}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {motor: {joint: A, kind: %s}}
initial: {joints: {%s}}
simulation: {end: 1 s, %s}
"""
PLAY = (", clearance: {bearing_radius: 10 mm, radial_clearance: 0.5 mm, material: {E: 207 GPa, nu: 0.3}, "
        "contact: {law: flores, restitution: 0.9}}")
SPEED = "velocity, value: 60 rpm"

EQUAL_ARMS = """freeplay: 1
bodies:
  crank: {mass: 0.3 kg, inertia: 1e-4, com: [25 mm, 0], frames: {tip: [50 mm, 0]}}
  coupler: {mass: 0.21 kg, inertia: 2.5e-4, com: [25 mm, 0], frames: {tip: [50 mm, 0]}}
  slider: {mass: 0.14 kg, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  wrist: {type: revolute, between: [coupler/tip, slider]}
  guide: {type: prismatic, between: [ground, slider]}
drivers: {motor: {joint: main, kind: velocity, value: 31.41592653589793 rad/s}}
initial: {joints: {main: 0 deg}}
simulation: {end: 0.4 s, accuracy: 1e-5}
"""

SLIDE = """freeplay: 1
bodies:
  slider: {mass: 1, inertia: 0.01}
  rod: {mass: 1, inertia: 0.01, frames: {tip: [0.5, 0]}, pose: {angle: 60 deg}}
  follower: {mass: 1, inertia: 0.01}
frames: {ground/up: {angle: 90 deg}}
joints:
  guide: {type: prismatic, between: [ground, slider]}
  foot: {type: revolute, between: [slider, rod]}
  head: {type: revolute, between: [rod/tip, follower]}
  rail: {type: prismatic, between: [ground/up, follower]}
drivers: {push: {joint: guide, kind: position, value: "-0.3 m - 1 m/s*t"}}
simulation: {end: 1 s, step: 1 ms}
"""

# A parallelogram that lies flat, under a torque.
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
drivers: {motor: {joint: %s, kind: torque, value: 1}}
initial: {joints: {A: 0}}
simulation: {end: 2 s, step: 1 ms}
"""

# Let go beside the flat position through which it swings: a parallelogram, a rhombus.
FOLDS = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 1e-3, com: [0.05, 0], frames: {tip: [%(crank)g, 0]}, pose: {angle: %(start)g deg}}
  bar: {mass: 1, inertia: 5e-3, com: [0.1, 0], frames: {tip: [%(bar)g, 0]}}
  rocker: {mass: 1, inertia: 1e-3, com: [0.05, 0], frames: {tip: [%(rocker)g, 0]}, pose: {angle: %(end)g deg}}
frames: {ground/D: [%(base)g, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, bar]}
  C: {type: revolute, between: [bar/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
DRIVER
initial: {joints: {A: %(start)g deg}}
simulation: {end: 1.3 s, accuracy: 1 um}
"""
EXACT = re.sub(r"\((crank|bar|rocker|base)\)g", r"(\1).12g", FOLDS)
PARALLELOGRAM = FOLDS % {"crank": 0.1, "bar": 0.3, "rocker": 0.1, "base": 0.3, "start": 60, "end": 60}
RHOMBUS = FOLDS % {"crank": 0.2, "bar": 0.2, "rocker": 0.2, "base": 0.2, "start": 50, "end": 50}

# At rest with crank and coupler in line.
CRANK = """freeplay: 1
bodies:
  crank: {mass: 0.3 kg, inertia: 1e-4, frames: {tip: [50 mm, 0]}}
  coupler: {mass: 0.2 kg, inertia: 2.5e-4, frames: {tip: [120 mm, 0]}}
  slider: {mass: 0.1 kg, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  guide: {type: prismatic, between: [ground, slider]}
  wrist: {type: revolute, between: [coupler/tip, slider]}
forces: {p: {type: force, at: slider, value: FORCE}}
initial: {joints: {main: 0}}
simulation: {end: 0.5 s, STEPS}
"""
ROD = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.01, com: [0.2, 0], frames: {tip: [0.4, 0]}}}
joints: {a: {type: revolute, between: [ground, rod]}}
LOAD
initial: {joints: {a: 90 deg}}
simulation: {end: 2 s, output: {frames: [rod/tip]}, STEPS}
"""
PUSH_ON_ROD = "forces: {p: {type: force, at: rod/tip, value: [0, -10]}}"
STACK = ROD.replace("bodies: {", "bodies: {upper: {mass: 1, inertia: 0.01, com: [0.2, 0]}, ").replace(
    "{a: {type", "{b: {type: revolute, between: [rod/tip, upper]}, a: {type").replace("{a: 90 deg}", "{a: 90 deg, b: 0}")
BALL = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies: {rod: {mass: 1, inertia: [0.01, 0.01, 0.001], com: [0, 0, 0.2]}}
joints: {a: {type: spherical, between: [ground, rod]}}
simulation: {end: 2 s, STEPS}
"""

# A slider-crank whose links lie in line with what pushes its slider.
IN_LINE = """freeplay: 1
bodies:
  crank: {mass: 0.3, inertia: 1e-4, com: [25 mm, 0], frames: {tip: [50 mm, 0]}}
  coupler: {mass: 0.21, inertia: 2.5e-4, com: [60 mm, 0], frames: {tip: [120 mm, 0]}}
  slider: {mass: 0.14, inertia: 1e-4}
frames: {ground/wall: [0.3, 0]}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  guide: {type: prismatic, between: [ground, slider]}
  wrist: {type: revolute, between: [coupler/tip, slider]}
%s
initial: {joints: {main: 0 deg}}
simulation: {end: 20 ms, %s}
"""
PUSHES = ["drivers: {gas: {joint: guide, kind: force, value: -100}}",
          "drivers: {gas: {joint: guide, kind: force, value: \"-100*smooth(t, 0, 10 ms)\"}}",
          "forces: {gas: {type: force, at: slider, value: [-100, 0]}}",
          "forces: {gas: {type: spring-damper, between: [ground/wall, slider], stiffness: 1000, free_length: 0.5}}"]


class DeadPoint(ProgramTest):
    def reason(self, text, *more):
        _, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force", "--quiet", *more, code=4)
        line, = [line for line in err.splitlines() if "error" in line]
        self.assertIn("[dead-point]", line)
        self.assertNotIn("smaller", line)
        self.assertNotIn("try", line)
        return line

    def assert_names(self, line, limit, gap):
        self.assertIn("joint 'A' comes to a dead point at %.4g deg" % limit, line)
        self.assertIn("turn from -%.4g deg to %.4g deg" % (limit, limit), line)
        said = re.search(r"at (\S+) deg joint '[BCD]' would stay open by (\S+) m", line)
        self.assertAlmostEqual(180, float(said.group(1)), delta=0.1)
        self.assertAlmostEqual(gap, float(said.group(2)), delta=1e-3 * gap)

    def test_peaks_that_roundings_make_beside_the_flat_position_are_doubted(self):
        # Nothing but its own inertia acts: by omega^2 and the centre of mass in the middle the bar pulls each pin with 5 N.
        text = FOLDS % {"crank": 0.1, "bar": 0.3, "rocker": 0.1, "base": 0.3, "start": 60, "end": 60}
        text = text.replace("com: [0.1, 0]", "com: [0.15, 0]").replace("DRIVER\n", "").replace(
            "initial: {", "initial: {speeds: {A: -10 rad/s}, ").replace("end: 1.3 s, ", "end: 1 s, output: {interval: 1 ms}, ")
        doubted, high = 0, 0
        for integrator, accuracy in itertools.product(("bathe", "dopri5", "verner7", "hht"), ("10 um", "1 um", "100 nm", "10 nm")):
            self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force", "--quiet", "--integrator", integrator,
                          "--accuracy", accuracy)
            summary = json.loads(self.read("r", "summary.json"))
            doubts = [reason for reason in summary["trust"]["reasons"] if reason["id"] == "singular-position"]
            worst = max(summary["joints"][pin]["max_force"] for pin in "BC")
            with self.subTest(integrator=integrator, accuracy=accuracy, worst=worst):
                if worst > 1.04 * 5.0:
                    self.assertEqual(1, len(doubts))
                if worst < 1.015 * 5.0:
                    self.assertEqual([], summary["trust"]["reasons"])
            doubted, high = doubted + len(doubts), high + (worst > 1.04 * 5.0)
        self.assertGreater(high, 0)
        self.assertLess(doubted, 12)

    def test_the_verdict_names_the_dead_point_before_what_it_leads_to(self):
        for text in (SLIDE.replace("step: 1 ms", "accuracy: 1 um"), FOUR_BAR % (0.3, PLAY, SPEED, "A: 20 deg", "accuracy: 1 um")):
            self.reason(text)
            first, second, *_ = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
            self.assertEqual("run-failed", first["id"])
            self.assertRegex(first["message"], r"^the run failed: t = .* comes to a dead point at .*\[dead-point\]$")
            self.assertRegex(second["message"], r"^the mechanism comes to a dead point: (body|joint) '\w+' at t = [^;]+$")

    def test_ideal_joints_in_steps_of_every_kind(self):
        limit = math.degrees(math.acos((0.2**2 + 0.4**2 - 0.4**2) / (2 * 0.2 * 0.4)))
        for steps in ("step: 1 ms", "accuracy: 1 um", "step: {size: 0.1 ms, adaptive: true}"):
            for integrator in ("bathe", "newmark", "hht", "generalized-alpha", "dopri5"):
                if integrator == "dopri5" and steps == "step: 1 ms":
                    continue
                line = self.reason(FOUR_BAR % (0.2, "", SPEED, "A: 60 deg", steps), "--integrator", integrator)
                self.assert_names(line, limit, 0.2)
                # It turns by 360 deg/s from 60 deg on.
                time = float(re.search(r"t = (\S+) s", line).group(1))
                self.assertAlmostEqual((limit - 60) / 360, time, delta=1e-3)

    def test_play_is_not_torn_apart_first(self):
        for crank in (0.2, 0.35):
            cosine = (crank**2 + 0.4**2 - 0.4**2) / (2 * crank * 0.4)
            for steps in ("step: 20 us", "accuracy: 1 um"):
                line = self.reason(FOUR_BAR % (crank, PLAY, SPEED, "A: 40 deg", steps))
                self.assert_names(line, math.degrees(math.acos(cosine)), crank)

    def test_links_that_are_nearly_long_enough_are_named(self):
        """Parallelograms but for 0.01 mm or less: the way that is missing is as short as a step, and is not leapt over."""
        links = {"crank": 0.1, "bar": 0.25, "rocker": 0.1, "base": 0.25}
        for name, by in (("bar", 1e-5), ("bar", -1e-5), ("rocker", -1e-5), ("crank", 1e-5), ("base", 1e-5), ("bar", -1e-7)):
            a, b, c, d = [links[link] + by * (link == name) for link in links]
            cosine, at, gap = (a**2 + d**2 - (b + c)**2) / (2 * a * d), 180, a + d - b - c
            if not gap > 1e-12:
                cosine, at, gap = (a**2 + d**2 - (b - c)**2) / (2 * a * d), 360, b - c - d + a
            limit = math.degrees(math.acos(cosine)) if at == 180 else 360 - math.degrees(math.acos(cosine))
            text = EXACT % {"crank": a, "bar": b, "rocker": c, "base": d, "start": 60, "end": 60}
            text = text.replace("DRIVER", "drivers: {m: {joint: A, kind: velocity, value: 10}}")
            for steps in ("accuracy: 1 um", "step: 1 ms"):
                with self.subTest(f"{name} {by} {steps}"):
                    line = self.reason(text.replace("accuracy: 1 um", steps))
                    self.assertAlmostEqual(limit, float(re.search(r"comes to a dead point at ([0-9.]+) deg", line)[1]), delta=0.06)
                    said = re.search(r"and at (\S+) deg joint '[BCD]' would stay open by (\S+) m", line)
                    self.assertAlmostEqual(at, float(said[1]), delta=0.6)
                    self.assertAlmostEqual(gap, float(said[2]), delta=0.02 * gap)

    def test_both_ends_of_a_way_with_narrow_gaps_are_named(self):
        """A connecting rod that is 0.01 mm or 0.1 um too short for its crank to go through upright."""
        for short in (1e-5, 1e-7):
            text = CRANK.replace("[50 mm, 0]", "[100 mm, 0]").replace("[120 mm, 0]", "[%.12g, 0]" % (0.1 - short))
            text = text.replace("forces: {p: {type: force, at: slider, value: FORCE}}", "drivers: {m: {joint: main, kind: velocity, value: 10}}")
            line = self.reason(text.replace("main: 0", "main: 30 deg").replace("STEPS", "accuracy: 1 um"))
            limit = math.degrees(math.asin(1 - short / 0.1))
            self.assertIn("joint 'main' comes to a dead point at %.4g deg, and at 90 deg" % limit, line)
            self.assertIn("would stay open by %.4g m; it can turn from -%.4g deg to %.4g deg" % (short, limit, limit), line)

    def test_a_position_that_is_nearly_singular_is_passed(self):
        """A crank-rocker that is a parallelogram but for 0.01 mm or 0.1 um, twice a turn, by the closed form."""
        for by in (1e-5, 1e-7):
            a, b, c, d = 0.1, 0.25, 0.1 + by, 0.25
            text = EXACT % {"crank": a, "bar": b, "rocker": c, "base": d, "start": 60, "end": 60}
            text = text.replace("DRIVER", "drivers: {m: {joint: A, kind: velocity, value: 10}}")
            out, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force")
            self.assertNotIn("smaller step", out + err)
            worst = 0.0
            with open(self.path("r", "results.csv"), encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    x, y = a * math.cos(float(row["body.crank.angle"])) - d, a * math.sin(float(row["body.crank.angle"]))
                    far = math.hypot(x, y)
                    rocker = math.atan2(y, x) - math.acos((c**2 + far**2 - b**2) / (2 * c * far))
                    worst = max(worst, abs(math.remainder(float(row["body.rocker.angle"]) - rocker, 2 * math.pi)))
            self.assertLess(worst, 1e-9)

    def test_a_motion_that_turns_back_in_time_is_left_alone(self):
        value = "angle, value: 60 deg + 10 deg*sin(2*pi*t)"
        self.freeplay("run", self.write("m.yaml", FOUR_BAR % (0.2, "", value, "", "step: 1 ms")), "--out", "r")
        value = "angle, value: 60 deg + 16 deg*sin(2*pi*t)"
        line = self.reason(FOUR_BAR % (0.2, "", value, "", "step: 1 ms"))
        self.assertIn("at 75.52 deg", line)

    def test_a_slide(self):
        line = self.reason(SLIDE)
        self.assertIn("joint 'guide' comes to a dead point at -0.5 m", line)
        self.assertIn("move from -0.5 m to 0.5 m", line)
        self.assertIn("at -1.3 m", line)
        self.assertIn("would stay open by 0.8 m", line)

    def test_a_start_at_a_dead_point_is_named(self):
        # The follower is driven up from where the rod lies flat.
        flat = SLIDE.replace("pose: {angle: 60 deg}", "pose: {angle: 0}").replace("joint: guide, kind: position, value: \"-0.3 m - 1 m/s*t\"", "joint: guide, kind: %s")
        flat = flat.replace("simulation:", "initial: {joints: {rail: 0}}\nsimulation:")
        text = flat % "position, value: \"-0.5 m + 0.2 m*smooth(t, 0, 1)\""
        out, _ = self.freeplay("validate", self.write("m.yaml", text.replace("initial: {joints: {rail: 0}}\n", "")))
        self.assertNotIn("left over", out)
        line = self.reason(text.replace("initial: {joints: {rail: 0}}\n", ""))
        self.assertIn("driver 'push' starts joint 'guide' at a dead point", line)
        self.assertIn("'head'", line)
        _, err = self.freeplay("validate", self.write("m.yaml", flat.replace("initial: {joints: {rail: 0}}", "initial: {joints: {guide: -0.5}}") % "velocity, value: 0.1"), code=3)
        self.assertRegex(err, r"error: driver 'push' starts joint 'guide' at a dead point, where joints .*\[dead-point\]")

    def test_a_flat_parallelogram_that_nothing_leads_is_named(self):
        for joint in "AB":
            with self.subTest(joint):
                line = self.reason(FLAT % joint)
                self.assertRegex(line, "(stands in|comes to) a singular position, where joints 'A', 'B', 'C', 'D' hold links in line")
                self.assertRegex(line, r"are \de-\d+ times as independent as a little beside it, where joint '\w' has moved")

    def test_links_in_line_with_a_load_stay(self):
        for push in PUSHES:
            for steps in ("step: 10 us", "accuracy: 1 um"):
                with self.subTest(push + steps):
                    out, err = self.freeplay("run", self.write("m.yaml", IN_LINE % (push, steps)), "--out", "r", "--force")
                    self.assertIn("completed", out)
                    self.assertNotIn("left-free", err)
                    with open(self.path("r", "results.csv"), encoding="utf-8") as file:
                        last = list(csv.DictReader(file))[-1]
                    self.assertAlmostEqual(0.17, float(last["body.slider.x"]), delta=1e-9)

    def test_a_start_in_an_unstable_equilibrium_is_named(self):
        push = CRANK.replace("FORCE", "[-100, 0]")
        for text, body in ((push, "coupler"), (ROD, "rod"), (ROD.replace("LOAD", PUSH_ON_ROD).replace("-9.81", "0"), "rod"), (STACK, "upper"), (BALL, "rod")):
            for steps in ("step: 100 us", "accuracy: 1 um"):
                with self.subTest(body + steps):
                    file = self.write("m.yaml", text.replace("LOAD", "").replace("STEPS", steps))
                    _, err = self.freeplay("validate", file)
                    self.assertRegex(err, fr"warning: '{body}' starts at rest in an unstable equilibrium: .*\[unstable-start\]")
                    out, _ = self.freeplay("run", file, "--out", "r", "--force")
                    self.assertIn(f"trust: doubtful ('{body}' starts at rest", out)

    def test_a_start_beside_an_unstable_equilibrium_is_named_where_its_accuracy_does_not_tell_them_apart(self):
        beside = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1, inertia: 0.01, com: [0.3, 0]}}
joints: {A: {type: revolute, between: [ground, rod]}}
initial: {joints: {A: %s deg}}
simulation: {end: 8 s, accuracy: %s}
"""
        for angle, accuracy, named in (("90.0000001", "1 um", True), ("90.01", "100 um", True), ("90.0000001", "0.1 nm", False),
                                       ("90.01", "10 um", False), ("89", "100 um", False), ("-90.0000001", "1 um", False)):
            with self.subTest(angle + " " + accuracy):
                _, err = self.freeplay("validate", self.write("m.yaml", beside % (angle, accuracy)))
                (self.assertRegex if named else self.assertNotRegex)(
                    err, r"'rod' starts at rest in an unstable equilibrium: it is \S+ m beside it, less than the accuracy")

    def test_a_start_with_links_just_long_enough_is_named(self):
        model = FOUR_BAR % (0.1, "", "%s", "", "accuracy: 1 um")
        model = model.replace("[0.4, 0]", "[0.5, 0]").replace("-10 deg", "0").replace("120 deg", "180 deg").replace("initial: {joints: {}}\n", "")
        _, err = self.freeplay("validate", self.write("m.yaml", model % "angle, value: 0.5*sin(t)"))
        self.assertRegex(err, r"driver 'motor' starts joint 'A' at a dead point that it cannot leave either way: "
                              r"joints 'A', 'B', 'C', 'D' hold links in line, with none to spare; .*\[dead-point\]")
        _, err = self.freeplay("validate", self.write("m.yaml", model % "angle, value: 0"))
        self.assertNotIn("dead-point", err)

    def test_a_torque_through_a_flat_position_is_doubted_in_the_right_words(self):
        for model in (PARALLELOGRAM, RHOMBUS):
            driven = self.write("m.yaml", model.replace("DRIVER", "drivers: {m: {joint: A, kind: torque, value: 0.5}}"))
            for accuracy in ("2um", "1um", "0.7um", "0.3um"):
                out, err = self.freeplay("run", driven, "--accuracy", accuracy, "--out", "r", "--force")
                said = re.search(r"trust: doubtful \(the mechanism went through a singular position of its constraints, "
                                 r"first at t = \S+ s: beside one, forces hang on where steps and rows end, whatever "
                                 r"their length; joint '(\w)' has (\S+) N(?: at t = \S+ s)?\)", out)
                self.assertTrue(said, out)
                # It is what stands in the table, but for a row beside the end of a step.
                self.assertGreater(float(said[2]), 0.6 * float(re.search(r"^  %s +(\S+) N " % said[1], out, re.M)[1]))
                self.assertNotIn("smaller step", out + err)
            free = model.replace("DRIVER\n", "").replace(" deg}}\nsim", " deg}, speeds: {A: 6}}\nsim")
            out, _ = self.freeplay("run", self.write("m.yaml", free), "--out", "r", "--force")
            self.assertIn("trust: good", out)  # nothing turns it: its forces pass smoothly

    def test_a_row_beside_a_singular_position_that_cannot_be_made_is_said_so(self):
        """A slider-crank with equal arms: at a right angle the rod may as well turn about the slide."""
        for integrator in ("bathe", "dopri5", "verner7"):
            text = EQUAL_ARMS.replace("accuracy: 1e-5", "accuracy: 1e-5, integrator: " + integrator)
            out, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", "--force", code=4)
            self.assertIn("the mechanism comes to a singular position", err)
            self.assertIn("first to depend on the other constraints is joint 'guide'", err)
            self.assertIn("trust: bad", out)

    def test_a_formula_that_ends_is_named_before_what_it_makes_race(self):
        for accuracy in ("0.1 mm", "1 um"):
            _, err = self.freeplay("run", mechanism("spatial/delta"), "--set", "reach=0.62", "--accuracy", accuracy, "--out", "r",
                                   "--force", code=4)
            self.assertIn("driver 'leg3.motor': acos of a number beyond -1 to 1 [bad-expression]", err)

    def test_forces_that_go_on_smoothly_through_a_fold_are_not_doubted(self):
        """A kite under a speed: beside its folds forces rise, step by step, to the same peak however long the steps are."""
        kite = FOLDS % {"crank": 0.1, "bar": 0.1, "rocker": 0.3, "base": 0.3, "start": 40, "end": 60}
        kite = kite.replace("DRIVER", "drivers: {m: {joint: A, kind: velocity, value: 3}}").replace("end: 1.3 s", "end: 1.9 s")
        peaks = []
        for steps in ("step: 1 ms", "step: 0.7 ms", "accuracy: 1 um"):
            out, _ = self.freeplay("run", self.write("m.yaml", kite.replace("accuracy: 1 um", steps)), "--out", "r", "--force")
            self.assertIn("trust: good", out, steps)
            peaks.append(float(re.search(r"^  B +(\S+) N", out, re.M)[1]))
        self.assertLess(max(peaks) - min(peaks), 1e-3 * max(peaks), peaks)
        # Steps that end on a fold make a force out of roundings.
        out, _ = self.freeplay("run", self.write("m.yaml", kite.replace("accuracy: 1 um", "step: 0.1 ms")), "--out", "r", "--force")
        self.assertIn("trust: doubtful (the mechanism went through a singular position", out)

    def test_other_starts_at_rest_are_no_unstable_equilibrium(self):
        for text in (CRANK.replace("FORCE", "[100, 0]"),                      # the links are pulled
                     CRANK.replace("FORCE", "[0, 0]"),
                     CRANK.replace("FORCE", "[-100, 0]").replace("main: 0", "main: 1 deg"),
                     CRANK.replace("FORCE", "[-100, 0]").replace("main: 0}", "main: 0}, speeds: {main: 1}"),
                     CRANK.replace("FORCE", "[-100, '10*smooth(t, 0.1, 0.2)']").replace("at: slider", "at: crank/tip"),
                     ROD.replace("90 deg", "-90 deg"), ROD.replace("90 deg", "0 deg"),
                     ROD.replace("LOAD", "frames: {ground/up: [0, 1]}\nforces: {s: {type: spring-damper, between: [ground/up, rod/tip], stiffness: 500, free_length: 0.1}}"),
                     ROD.replace("LOAD", "drivers: {m: {joint: a, kind: angle, value: 90 deg}}").replace("initial: {joints: {a: 90 deg}}", "")):
            with self.subTest(text):
                _, err = self.freeplay("validate", self.write("m.yaml", text.replace("LOAD", "").replace("STEPS", "step: 1 ms")))
                self.assertNotIn("unstable", err)

    def test_what_holds_a_driven_joint_is_named(self):
        text = FOUR_BAR % (0.1, "", SPEED, "A: 60 deg", "step: 1 ms")
        text = text.replace("drivers:", "drivers:").replace("between: [ground/D, rocker]}", "between: [ground/D, rocker]}\n  stay: {type: gear, of: [A, D], ratio: 3}")
        _, err = self.freeplay("validate", self.write("m.yaml", text), code=3)
        self.assertRegex(err, "driver 'motor' cannot move its joint from here: joints .*'stay' hold it")
        self.assertNotIn("start speeds", err)

    def test_what_locks_a_loose_mechanism_is_named(self):
        text = FOUR_BAR % (0.1, PLAY, SPEED, "", "step: 10 us")
        text = text.replace("coupler/tip, rocker/tip", "coupler/tip, ground/D").replace("tip: [0.2, 0]}, pose: {angle: -10", "tip: [0.35, 0]}, pose: {angle: -10")
        text = text.replace("  rocker: {mass: 1, inertia: 0.01, frames: {tip: [0.2, 0]}, pose: {angle: 120 deg}}\n", "")
        text = text.replace("  D: {type: revolute, between: [ground/D, rocker]}\n", "").replace("initial: {joints: {}}\n", "")
        _, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", code=4)
        self.assertRegex(err, r"driver 'motor' cannot move joint 'A' beyond the play: joints 'B', 'C' hold it at \S+ deg; .*\[locked\]")
        self.assertNotIn("dead", err)

    def test_a_mechanism_that_closes_in_one_place_alone_says_where_nearest_to_the_start(self):
        """A triangle of 3, 4 and 5: it closes with the crank at 53.13 degrees to either side, and is locked there."""
        text = """freeplay: 1
bodies:
  crank: {mass: 1, inertia: 0.01, com: [0.15, 0], frames: {tip: [0.3, 0]}}
  strut: {mass: 1, inertia: 0.01, com: [-0.2, 0], frames: {foot: [-0.4, 0]}}
frames: {ground/D: [0.5, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, strut]}
  D: {type: revolute, between: [ground/D, strut/foot]}
drivers: {motor: {joint: A, kind: angle, value: START deg}}
"""
        for start, place in ((60, "53.13"), (-60, "-53.13"), (20, "53.13"), (-75, "-53.13")):
            _, err = self.freeplay("validate", self.write("m.yaml", text.replace("START", str(start))), code=3)
            self.assertIn("it closes with joint 'A' at %s deg, where it is locked" % place, err)
            self.assertNotIn("can turn", err)

    def test_two_drivers(self):
        text = FOUR_BAR % (0.2, "", SPEED, "A: 40 deg", "step: 1 ms")
        text = text.replace("  D: {type: revolute, between: [ground/D, rocker]}",
                            "  D: {type: revolute, between: [cart/D, rocker]}\n  rail: {type: prismatic, between: [ground, cart]}")
        text = text.replace("frames: {ground/D: [0.4, 0]}\n", "")
        text = text.replace("  crank:", "  cart: {mass: 1, inertia: 0.01, frames: {D: [0.4, 0]}}\n  crank:")
        text = text.replace("drivers: {", "drivers: {feed: {joint: rail, kind: position, value: 0.1 m/s*t}, ")
        line = self.reason(text)
        self.assertRegex(line, "driver '(motor|feed)' asks for a position that the mechanism cannot take")


if __name__ == "__main__":
    unittest.main()
