"""The verdict at the end of a run: every mistake ends with the right word, and sound models are good."""
import json
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest, mechanism

with open(mechanism("slider-crank"), encoding="utf-8") as file:
    SLIDER_CRANK = file.read()

PARALLELOGRAM = """freeplay: 1
name: parallelogram
bodies:
  ground: {frames: {A: [0, 0], D: [0.4, 0]}}
  crank: {mass: 0.3 kg, inertia: 1.0e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  coupler: {mass: 0.9 kg, inertia: 6.75e-3, com: [0.2, 0], frames: {tip: [0.4, 0]}}
  rocker: {mass: 0.3 kg, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}, pose: {angle: 60 deg}}
joints:
  A: {type: revolute, between: [ground/A, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
initial: {joints: {A: 60 deg}, speeds: {A: 10}}
simulation: {end: 1 s, step: 1 ms}
"""

# A ball between two walls of a bearing, without anything else.
BALL = """freeplay: 1
name: ball
gravity: [0, -9.81]
bodies: {ball: {mass: 1 kg, inertia: 1e-4 kg*m^2, frames: {rim: [20 mm, 0]}}}
joints:
  B:
    type: revolute
    between: [ground, ball]
    clearance:
      bearing_radius: 20 mm
      radial_clearance: 0.5 mm
      material: {E: 207 GPa, nu: 0.3}
      contact: {law: lankarani-nikravesh, restitution: 0.9}
simulation: {end: 0.1 s, accuracy: 1 um, output: {interval: 1 ms%s}}
"""


# A mass on a guide, driven.
DRIVEN = """freeplay: 1
bodies: {m: {mass: 2, inertia: 1e-3}}
joints: {g: {type: prismatic, between: [ground, m]}}
drivers: {d: {joint: g, kind: %s}}
simulation: {end: %s, %s}
"""

# A mass on a spring, shaken by next to nothing.
OSCILLATION = """freeplay: 1
bodies: {m: {mass: 1 kg, inertia: 0.01}, ground: {frames: {w: [0.3, 0]}}}
joints: {rail: {type: prismatic, between: [ground, m]}}
forces:
  s: {type: spring-damper, between: [m, ground/w], stiffness: 1e4, free_length: 0.3}
  h: {type: force, at: m, value: ["%g*1e4*sin(60*t)", 0]}
simulation: {end: 2 s, accuracy: 1 um}
"""


def slider_crank(*changes):
    text = SLIDER_CRANK
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


class Trust(ProgramTest):
    def run_model(self, text, *words, code=0):
        self.write("model.yaml", text)
        out, err = self.freeplay("run", "model.yaml", "--force", "--out", "r", *words, code=code)
        summary = json.loads(self.read("r", "summary.json"))
        self.summary, self.trust = summary, summary["trust"]
        line = re.search(r"^  trust: (\w+)", out, re.M)
        self.assertEqual(self.trust["verdict"], line[1])
        return out, err

    def test_residual_is_judged_by_the_work_exchanged(self):
        for driver, end in (("velocity, value: 'max(0,sin(2*pi*100*t)-0.99)^2'", "20 s"),
                            ("velocity, table: {points: [[0,0],[0.001,1],[0.002,0],[0.1,0]], interpolation: cubic, "
                             "outside: repeat}", "10 s")):
            self.run_model(DRIVEN % (driver, end, "accuracy: 1 um"))
            self.assertNotIn("energy-residual", self.ids(), (driver, self.trust))

    def test_oscillations_far_below_the_accuracy_are_no_growth_of_energy(self):
        for amplitude in (1e-7, 1e-8, 1e-9):
            for integrator in ("dopri5", "verner7", "bathe"):
                self.run_model(OSCILLATION % amplitude, "--integrator", integrator)
                self.assertEqual("good", self.trust["verdict"], (amplitude, integrator, self.trust))

    def test_jumps_of_forces_are_no_residual_in_fixed_steps(self):
        self.run_model(DRIVEN % ("velocity, table: {points: [[0,0],[1,0],[1.01,1],[2,1],[2.01,0],[3,0]], "
                                 "interpolation: linear}", "3 s", "step: 1 ms"))
        self.assertEqual("good", self.trust["verdict"], self.trust)
        self.assertLess(self.summary["residuals"]["energy_max"], 1e-6)

    def ids(self):
        return [reason["id"] for reason in self.trust["reasons"]]

    def assert_ends(self, text, *parts, words=(), reasons=("penetration", "material-strength")):
        """The run ends with exit code 4, and its message holds these parts."""
        _, err = self.run_model(text, *words, code=4)
        self.assertEqual("bad", self.trust["verdict"])
        self.assertIn(self.trust["reasons"][0]["id"], reasons)
        for part in parts:
            self.assertIn(part, err)

    def test_an_ideal_mechanism_is_good(self):
        with open(mechanism("four-bar"), encoding="utf-8") as file:
            out, _ = self.run_model(file.read())
        self.assertEqual({"verdict": "good", "reasons": []}, self.trust)
        self.assertIn("\n  trust: good\n", out)

    def test_an_inertia_in_the_wrong_unit_ends_the_run(self):
        self.assert_ends(slider_crank(("inertia: 2.5e-4", "inertia: 250")), "joint 'wrist' at t = ",
                         "likely cause: inertia of 'coupler' is 250 kg m^2 for a mass of 0.21 kg: its radius of gyration "
                         "would be 35 m")

    def test_a_length_in_the_wrong_unit_ends_the_run_or_is_doubted(self):
        # Rounding decides whether the contact of a tip that is so light blows up, in depth or in energy.
        ended = 0
        for length in (119, 120, 150, 1200):
            model = slider_crank(("tip: [120 mm, 0]", "tip: [%d m, 0]" % length))
            self.write("model.yaml", model)
            tried = subprocess.run([PROGRAM, "run", "model.yaml", "--quiet", "--force", "--out", "r"], cwd=self.folder, check=False,
                                   capture_output=True)
            if tried.returncode == 0:
                self.run_model(model)
                self.assertNotEqual("good", self.trust["verdict"])
                self.assertTrue(any("'coupler/tip' is %.4g m away: check" % (length - 0.06) in reason["message"]
                                    for reason in self.trust["reasons"]), self.trust)
                continue
            ended += 1
            self.assert_ends(model, "likely cause: 'coupler' measures %d m, while bodies of this model measure 0.05 m" % length,
                             reasons=("penetration", "material-strength", "run-failed"))
        self.assertGreater(ended, 0)

    def test_a_modulus_without_its_prefix_ends_the_run(self):
        self.assert_ends(slider_crank(("207 GPa", "207 Pa")), "joint 'wrist'", "likely cause: E and nu of joint 'wrist'",
                         "softer than rubber")

    def test_a_modulus_with_a_unit_twice_ends_the_run(self):
        self.assert_ends(slider_crank(("207 GPa", "207e9 GPa")), "joint 'wrist'", "stiffer than diamond",
                         reasons=("run-failed",))

    def test_a_soft_law_without_material_ends_the_run_by_its_depth(self):
        self.assert_ends(slider_crank(("restitution: 0.9}", "restitution: 0.9, K: 100}"),
                                      ("      material: {E: 207 GPa, nu: 0.3}\n", "")),
                         "more than clearance and smaller radius together (0.01 m)", reasons=("penetration",))

    def test_a_speed_a_thousand_times_too_large_ends_the_run(self):
        self.write("model.yaml", slider_crank(("speed: 5000 rpm", "speed: 5000000 rpm")))
        _, err = self.freeplay("run", "model.yaml", code=4)
        self.assertIn("likely cause: driver 'motor' turns with 5.24e+05 rad/s", err)

    def assert_cause(self, *parts, changes=(), words=()):
        """The run ends with exit code 4, and a cause with these parts, in the message and in the verdict."""
        _, err = self.run_model(slider_crank(*changes), *words, code=4)
        cause = re.search("; likely cause: (.*)", err)
        self.assertIsNotNone(cause, err)
        for part in parts:
            self.assertIn(part, cause[1])
        for advice in ("step is too long", "smaller", "accuracy"):
            self.assertNotIn(advice, cause[1])

    JOHNSON = ("law: lankarani-nikravesh", "law: johnson, damping: flores"), ("      material:", "      length: 12 mm\n      material:")

    def test_the_end_of_the_range_of_a_law_is_reported_with_its_cause(self):
        for steps in ((), ("--accuracy", "1um")):
            self.assert_cause("inertia of 'coupler' is 90 kg m^2", words=steps,
                              changes=(("inertia: 2.5e-4", "inertia: 90"), *self.JOHNSON))
            self.assertNotIn("plugin", self.trust["reasons"][0]["message"])
        self.assert_cause("softer than rubber", changes=(("207 GPa", "207 kPa"), *self.JOHNSON))

    def test_a_dead_point_is_found_where_a_law_ends_first(self):
        text = slider_crank(("tip: [50 mm, 0]", "tip: [450 mm, 0]"), ("speed: 5000 rpm, c: 0.5 mm", "speed: 600 rpm, c: 0.1 mm"), ("step: 1 us", "step: 10 us"),
                            *self.JOHNSON)
        _, err = self.run_model(text, code=4)
        self.assertIn("[dead-point]", err)

    def test_a_verdict_blames_a_dead_point_and_not_the_step(self):
        text = slider_crank(("tip: [50 mm, 0]", "tip: [450 mm, 0]"), ("speed: 5000 rpm, c: 0.5 mm", "speed: 600 rpm, c: 0.1 mm"), ("step: 1 us", "step: 10 us"))
        out, err = self.run_model(text, code=4)
        self.assertIn("[dead-point]", err)
        self.assertNotIn("the step is too long", out + json.dumps(self.trust))

    def test_loads_springs_and_stiffnesses_of_another_unit_are_causes(self):
        motor = "kind: velocity, value: $speed"
        spring = "drivers:", "forces: {s: {type: spring-damper, between: [ground/w, slider], %s, free_length: 0.13}}\nframes: {ground/w: [0.3, 0]}\ndrivers:"
        for wrong, part in [((motor, "kind: torque, value: 8000"), "driver 'motor' gives 8e+03 N m"),
                            ((spring[0], spring[1] % "stiffness: 5e8"), "'s' acts with"),
                            ((spring[0], spring[1] % "stiffness: 10, damping: 1e9"), "'s' acts with"),
                            (("drivers:", "forces: {p: {type: force, at: slider, value: [3e6, 0]}}\ndrivers:"), "force 'p' is 3e+06 N"),
                            (("restitution: 0.9", "restitution: 0.9, K: 5e3"), "K of joint 'wrist' is 5e+03 N/m^1.5: softer than rubber; is it meant in N/mm^1.5")]:
            with self.subTest(part):
                self.assert_cause(part, changes=(wrong,))

    def test_a_jump_of_a_motion_is_a_cause(self):
        table = "kind: angle, table: {points: [[0, 0], [10 ms, 0], [10.05 ms, 5], [20 ms, 5]], interpolation: linear}"
        for steps in ((), ("--accuracy", "1um")):
            self.assert_cause("driver 'motor' jumps at t = 0.010", words=steps,
                              changes=(("kind: velocity, value: $speed", table), ("initial: {joints: {main: 0 deg}}", "")))

    def test_a_journal_that_starts_in_the_wall_is_reported_in_spite_of_a_discard(self):
        text = slider_crank(("radial_clearance: $c", "radial_clearance: $c\n      initial: {eccentricity: [1.2 mm, 0]}"),
                            ("speed: 5000 rpm", "speed: 10 rpm"))
        self.run_model(text)
        self.assertIn("penetration", self.ids())

    def test_lasting_contact_needs_no_impacts(self):
        text = (BALL % ", discard: 90 ms").replace("restitution: 0.9", "restitution: 0.05, exponent: 1.5").replace("end: 0.1 s", "end: 0.2 s").replace("discard: 90 ms", "discard: 150 ms")
        text = text.replace("lankarani-nikravesh", "flores")
        self.run_model(text)
        summary = json.loads(self.read("r", "summary.json"))
        self.assertGreater(summary["joints"]["B"]["contact_fraction"], 0.9)
        self.assertNotIn("statistics-window", self.ids())

    def test_a_turn_of_some_degrees_has_no_period(self):
        self.run_model("""freeplay: 1
bodies: {jib: {mass: 500 kg, inertia: 2000, com: [4 m, 0], frames: {tip: [12 m, 0]}}}
joints: {slew: {type: revolute, between: [ground, jib]}}
drivers: {motor: {joint: slew, kind: velocity, value: 3 deg/s}}
initial: {joints: {slew: 0}}
simulation: {end: 10, accuracy: 1 mm, output: {frames: [jib/tip]}}
""")
        self.assertEqual("good", self.trust["verdict"])

    def test_a_balanced_rotor_without_load_is_not_bypassed(self):
        self.run_model("""freeplay: 1
bodies: {rotor: {mass: 2, inertia: 3e-3}}
joints: {seat: {type: revolute, bearing: ground, journal: rotor, clearance: {bearing_radius: 12 mm,
         radial_clearance: 0.1 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.6}}}}
forces: {push: {type: torque, on: rotor, value: 0.1}}
simulation: {end: 0.1, accuracy: 1 um}
""")
        self.assertEqual("good", self.trust["verdict"])

    def test_a_clearance_as_large_as_the_mechanism_is_doubtful(self):
        self.run_model(slider_crank(("c: 0.5 mm", "c: 0.5 m"), ("bearing_radius: 10 mm", "bearing_radius: 10 m")))
        self.assertEqual("doubtful", self.trust["verdict"])
        self.assertIn("clearance-size", self.ids())

    def test_a_step_too_long_for_impacts_is_doubtful_and_exits_with_0(self):
        self.run_model(slider_crank(), "--step", "20us")
        reason = next(r for r in self.trust["reasons"] if r["id"] == "impact-steps")
        self.assertEqual(("doubtful", 10.0), (reason["level"], reason["limit"]))
        self.assertLess(reason["value"], 10.0)

    def test_impacts_before_the_statistics_count_for_their_steps(self):
        self.run_model("""freeplay: 1
bodies: {weight: {mass: 1, inertia: 1e-3}}
forces: {load: {type: force, at: weight, value: [0, -200 N]}}
joints: {j: {type: revolute, between: [ground, weight], clearance: {bearing_radius: 20 mm, radial_clearance: 0.1 mm,
             contact: {law: expression, force: "1e7 N/m*delta + 5e2 N*s/m*rate"}}}}
simulation: {end: 60 ms, step: 0.2 ms, output: {discard: 40 ms, interval: 0.2 ms}}
""")
        self.assertTrue([r for r in self.trust["reasons"] if r["message"].startswith("a hard impact took")], self.trust)

    def test_a_window_shorter_than_a_turn_is_doubtful(self):
        self.run_model(slider_crank(("discard: 12 ms", "discard: 13 ms")))
        self.assertIn("statistics-window", self.ids())
        self.run_model(slider_crank(("discard: 12 ms", "discard: 11 ms")))
        self.assertNotIn("statistics-window", self.ids())

    def test_a_window_of_an_oscillating_driver_is_its_period(self):
        with open(mechanism("four-bar"), encoding="utf-8") as file:
            text = file.read().replace("kind: velocity, value: $speed", "kind: angle, value: 60 deg + 0.2*sin(2*pi*t)").replace(
                "initial: {joints: {A: 60 deg}}\n", "")
        self.run_model(text, "--end", "0.9 s")
        self.assertEqual(["statistics-window"], self.ids())
        self.assertAlmostEqual(1.0, self.trust["reasons"][0]["limit"], 6)
        self.run_model(text, "--end", "1.1 s")
        self.assertEqual("good", self.trust["verdict"])

    def test_a_motion_from_point_to_point_has_no_period(self):
        with open(mechanism("four-bar"), encoding="utf-8") as file:
            text = file.read().replace("kind: velocity, value: $speed", "kind: angle, value: '60 deg + smooth(t, 0, 1)'").replace("initial: {joints: {A: 60 deg}}\n", "")
        self.run_model(text)
        self.assertEqual("good", self.trust["verdict"])

    def test_what_discard_leaves_out_is_judged_too(self):
        drop = """freeplay: 1
name: drop
gravity: [0, -9.81]
bodies: {rod: {mass: 2 kg, inertia: 0.02, com: [0.1, 0], velocity: {linear: [0, -5]}}}
joints:
  pin:
    type: revolute
    bearing: ground
    journal: rod
    clearance: {bearing_radius: 2 mm, radial_clearance: 0.4 mm, length: 5 mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.2}}
simulation: {end: 0.4 s, accuracy: 1 um, output: {interval: 1 ms, discard: %s}}
"""
        self.run_model(drop % "0 s")
        whole = self.trust
        peak = self.summary["joints"]["pin"]["max_force"]
        out, _ = self.run_model(drop % "0.1 s")
        self.assertEqual("bad", whole["verdict"])
        self.assertEqual("bad", self.trust["verdict"])
        self.assertLess(self.summary["joints"]["pin"]["max_force"], 0.1 * peak)
        reached = float(re.search(r"before that pin reached (\S+) N", out)[1])
        self.assertAlmostEqual(1.0, reached / peak, delta=0.03)

    def test_statistics_of_an_instant_are_doubtful(self):
        swing = """freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 1/12, com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
simulation: {end: 1 s, step: 1 ms, output: {interval: 10 ms, discard: %s}}
"""
        self.run_model(swing % "0.9995 s")
        self.assertEqual(["statistics-window"], self.ids())
        self.run_model(swing % "0.01 s")  # by then the rod is on the other side, after 0.967 s
        self.assertEqual([], self.ids())

    def test_forces_at_a_singular_position_are_doubtful(self):
        # A driven parallelogram lies flat twice in each turn, where nothing decides which way the other crank goes on.
        flat = """freeplay: 1
name: flat
gravity: [0, -9.81]
bodies:
  ground: {frames: {D: [0.4, 0]}}
  crank: {mass: 1, inertia: 2e-3, com: [0.06, 0], frames: {tip: [0.12, 0]}, pose: {angle: 50 deg}}
  coupler: {mass: 2, inertia: 0.02, com: [0.2, 0], frames: {tip: [0.4, 0]}, pose: {angle: 0}}
  rocker: {mass: 1, inertia: 2e-3, com: [0.06, 0], frames: {tip: [0.12, 0]}, pose: {angle: 50 deg}}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [coupler/tip, rocker/tip]}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {m: {joint: A, kind: velocity, value: 8}}
initial: {joints: {A: 50 deg}}
simulation: {end: 2 s, step: 1 ms}
"""
        for words in (("--step", "0.7 ms"), ("--step", "2 ms"), ("--accuracy", "1um")):
            self.run_model(flat, *words)
            self.assertIn("singular-position", self.ids(), words)
        # Wherever steps end: weights give these forces a pole there.
        heavy = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {c: [0.3, 0]}}
  crank: {mass: 1, inertia: 2e-3, com: [0.04, 0], frames: {tip: [0.1, 0]}}
  bar: {mass: 1, inertia: 5e-3, com: [0.1, 0], frames: {tip: [0.3, 0]}}
  rocker: {mass: 1, inertia: 5e-3, com: [0.1, 0], frames: {tip: [0.1, 0]}, pose: {angle: 60 deg}}
joints:
  a: {type: revolute, between: [ground, crank]}
  d: {type: revolute, between: [ground/c, rocker]}
  b: {type: revolute, between: [crank/tip, bar]}
  c: {type: revolute, between: [bar/tip, rocker/tip]}
drivers: {m: {joint: a, kind: velocity, value: 60 rpm}}
initial: {joints: {a: 60 deg}}
simulation: {end: 1 s, accuracy: 1 um}
"""
        for accuracy in ("1e-4", "1e-5", "3e-6", "1e-6", "1e-7", "1e-8"):
            self.run_model(heavy, "--accuracy", accuracy)
            self.assertIn("singular-position", self.ids(), accuracy)
        # One that never lies flat is regular, though its cranks are nearly as long.
        self.run_model(flat.replace("tip: [0.12, 0]}, pose: {angle: 50 deg}}\njoints", "tip: [0.2, 0]}, pose: {angle: 50 deg}}\njoints"))
        self.assertNotIn("singular-position", self.ids())

    def test_a_joint_driven_through_its_stop_is_doubtful(self):
        text = ("freeplay: 1\nbodies: {arm: {mass: 1, inertia: 0.01}}\njoints: {axle: {type: revolute, between: [ground, arm]}}\n"
                "forces: {stop: {type: joint-stop, kind: rotational, between: [ground, arm], lower: -10 deg, upper: 90 deg, stiffness: 100}}\n"
                "drivers: {motor: {joint: axle, kind: angle, value: %s}}\nsimulation: {end: 1, accuracy: 1 um}\n")
        self.run_model(text % "2*pi*t")
        reason = next(r for r in self.trust["reasons"] if r["id"] == "law-range")
        self.assertEqual("force 'stop'", reason["element"])
        self.assertIn("through its stop", reason["message"])
        self.run_model(text % "40 deg + 80 deg*sin(2*pi*t)")
        self.assertIn("law-range", self.ids())
        self.run_model(text % "40 deg + 49 deg*sin(2*pi*t)")
        self.assertEqual([], self.ids())

    def test_counts_and_sums_beside_a_peak_with_noise_have_theirs(self):
        out, _ = self.run_model(SLIDER_CRANK)
        self.assertRegex(out, r"\n  wrist +\d+ \+- \d+ kN +\d+ \+- \d+ +\d+ \+- \d+ %")
        self.assertRegex(out, r"\n  wrist( +\S+ \+- \S+ %){3} +\d+ \+- \d+ +\S+ \+- \S+ mm +\S+ \+- \S+ m?J\n")

    def test_no_part_of_the_time_of_a_play_is_below_zero(self):
        """A rotor that never leaves its bearing."""
        rotor = (BALL % "").replace("radial_clearance: 0.5 mm", "radial_clearance: 0.06 mm\n      length: 30 mm\n      initial: loaded\n"
                                    "      friction: {law: ambrosio, mu: 0.05, v0: 1e-4, v1: 1e-3}")
        rotor = rotor.replace("1 kg, inertia: 1e-4 kg*m^2, frames: {rim: [20 mm, 0]}", "3 kg, inertia: 4e-3, com: [20 um, 0], velocity: {angular: 3000 rpm}")
        out, _ = self.run_model(rotor, "--end", "0.3 s")
        self.assertRegex(out, r"\n  B +0.0 % ")
        figures = self.summary["joints"]["B"]["play"]
        self.assertGreaterEqual(min(figures[part] for part in ("flight", "impact", "lasting")), 0.0)

    def test_few_impacts_after_a_discard_are_doubtful(self):
        self.run_model(BALL % "")
        self.assertNotIn("statistics-window", self.ids())
        self.run_model(BALL % ", discard: 99 ms")
        self.assertIn("statistics-window", self.ids())

    def test_play_that_never_moves_is_named(self):
        text = slider_crank(("drivers:", "  pin: {type: revolute, between: [coupler/tip, slider]}\ndrivers:"))
        self.run_model(text)
        reason = next(r for r in self.trust["reasons"] if r["id"] == "play-bypassed")
        self.assertEqual("joint 'wrist'", reason["element"])

    def test_redundant_constraints_are_named(self):
        text = PARALLELOGRAM.replace("joints:\n", "joints:\n  B2: {type: revolute, between: [crank/tip, coupler]}\n", 1)
        self.run_model(text)
        reason = next(r for r in self.trust["reasons"] if r["id"] == "undetermined-forces")
        self.assertEqual(2.0, reason["value"])

    def test_a_parallelogram_is_never_good_with_a_residual(self):
        for step in ("1 ms", "0.7 ms", "0.31 ms"):
            self.write("model.yaml", PARALLELOGRAM)
            self.freeplay("run", "model.yaml", "--step", step, "--out", "r", "--force")
            summary = json.loads(self.read("r", "summary.json"))
            energy, residual = summary["energy"]["kinetic"], summary["residuals"]["energy_max"]
            if residual > 0.1 * energy:
                self.assertEqual("bad", summary["trust"]["verdict"])

    def test_the_page_has_a_section_for_each_reason(self):
        with open(ROOT + "/docs/trust.md", encoding="utf-8") as file:
            page = file.read()
        sections = set(re.findall(r"^### ([a-z-]+)$", page, re.M))
        chapters = {title.lower().replace(":", "").replace(" ", "-") for title in re.findall(r"^## (.*)$", page, re.M)}
        self.assertEqual(sections, set(re.findall(r"\(#([a-z-]+)\)", page)) - chapters)


if __name__ == "__main__":
    unittest.main()
