"""Belts pull as statics says, keep the ratio of their radii, swing, and go slack."""
import json
import math
import unittest

from model_cases import EXACT, ModelTest


class Belts(ModelTest):
    TEXT = """
bodies: {small: {mass: 1, inertia: 0.01}, large: {mass: 3, inertia: 0.04}}
frames: {ground/l: [0.5, 0]}
joints: {s: {type: revolute, between: [ground, small]}, l: {type: revolute, between: [ground/l, large]}}
forces:
  belt: {type: belt, between: [small, large], first_radius: 50 mm, second_radius: 120 mm, stiffness: 2e5 N/m,
         pretension: 400 N, damping: %s, strands: %s}
  load: {type: torque, on: large, value: "%s"}
drivers: {motor: {joint: s, kind: angle, value: "%s"}}
simulation: {end: %s, output: {interval: 10 ms}, %s}
"""

    def test_tensions_and_bearings_are_those_of_statics(self):
        for strands, across in (("open", 0.12 - 0.05), ("crossed", 0.12 + 0.05)):
            for torque in (36, -36):
                columns = self.run_model(self.TEXT % (400, strands, "%s N*m" % torque, "0", 1, "step: 1 ms"))
                sense = 1 if strands == "open" else -1
                # A load that turns the large pulley on stretches the strand that holds it.
                left, right = (columns["force.belt.%s_tension" % side][-1] for side in ("left", "right"))
                self.assertAlmostEqual(400 - sense * torque / 0.24, left, delta=1e-7)
                self.assertAlmostEqual(400 + sense * torque / 0.24, right, delta=1e-7)
                sine = across / 0.5
                self.assertAlmostEqual(800 * math.sqrt(1 - sine ** 2), columns["joint.l.fx"][-1], delta=1e-6)
                self.assertAlmostEqual(sense * (left - right) * sine, columns["joint.l.fy"][-1], delta=1e-6)

    def test_one_that_cannot_lie_on_its_pulleys_is_refused(self):
        text = self.TEXT % (400, "%s", "0 N*m", "0", 1, "step: 1 ms")
        for strands, distance, words in (("crossed", "0.169", "more than 0.17 m, the sum of their radii, as they overlap; move them apart, or take open strands"),
                                         ("open", "0.069", "more than 0.07 m, the difference of their radii, as one stands inside the other; move them apart")):
            message = self.refusal((text % strands).replace("[0.5, 0]", "[%s, 0]" % distance), id="starts-inside", line=7)[0]
            self.assertIn(words, message["message"])
            self.facts((text % strands).replace("[0.5, 0]", "[%s + 0.0011, 0]" % distance))

    def test_a_radius_in_millimetres_is_doubted_besides(self):
        text = (self.TEXT % (400, "open", "0 N*m", "0", 1, "step: 1 ms")).replace("first_radius: 50 mm", "first_radius: 50")
        out, _ = self.freeplay("validate", self.model(text, "freeplay: 1\n"), "--json", code=3)
        found = {message["id"]: message["message"] for message in json.loads(out)["messages"]}
        self.assertEqual({"starts-inside", "doubtful-length"}, set(found))
        self.assertIn("'50 mm'", found["doubtful-length"])

    # Straight, by an idler, and with the second pulley the other way round in its joint.
    GEARS = (("  g: {type: gear, of: [s, l], ratio: %s}\n", "", ""),
             ("  i: {type: revolute, between: [ground, idler]}\n  g: {type: gear, of: [s, i], ratio: -2}\n  h: {type: gear, of: [i, l], ratio: -%s/2}\n",
              ", idler: {mass: 1, inertia: 0.01}", ""),
             ("  g: {type: gear, of: [s, l], ratio: -%s}\n", "", "[large, ground/l]"))

    def test_one_against_a_gear_is_doubted(self):
        for gears, bodies, ends in self.GEARS:
            for strands, ratio, found in (("open", "(5/12)", 0), ("crossed", "(-5/12)", 0), ("open", "(-5/12)", 0.05 * 4 * math.pi),
                                          ("crossed", "(5/12)", 0.05 * 4 * math.pi), ("open", "0.5", 2 * math.pi * 0.01)):
                for drive in ("kind: angle, value: '%s'", "kind: torque, value: '%s'"):
                    with self.subTest(gears=gears, strands=strands, ratio=ratio, drive=drive):
                        text = (self.TEXT % (400, strands, "0 N*m", "0", 1, "step: 1 ms")).replace("kind: angle, value: \"0\"", drive % "0")
                        text = text.replace("}}\nforces:", "}\n%s\nforces:" % (gears % ratio)).replace("joints: {s:", "joints:\n  s:")
                        text = text.replace("}, l: {", "}\n  l: {").replace("inertia: 0.04}", "inertia: 0.04}" + bodies)
                        text = text.replace("[ground/l, large]", ends or "[ground/l, large]")
                        out, _ = self.freeplay("validate", self.model(text, "freeplay: 1\n"), "--json")
                        said = [m for m in json.loads(out)["messages"] if "'belt' turns" in m["message"]]
                        self.assertEqual(bool(found), bool(said), said)
                        if said:
                            self.assertEqual("doubtful-value", said[0]["id"])
                            self.assertIn("which stretches its strands by %.3g m in each turn" % found, said[0]["message"])

    def test_one_that_turns_a_hand_on_an_arm_is_against_no_gear(self):
        out, _ = self.freeplay("validate", self.model("""
bodies: {arm: {mass: 1, inertia: 0.01, com: [0.25, 0], frames: {tip: [0.5, 0]}}, hand: {mass: 1, inertia: 0.01}, shaft: {mass: 1, inertia: 0.01}}
joints:
  a: {type: revolute, between: [ground, arm]}
  s: {type: revolute, between: [ground, shaft]}
  h: {type: revolute, between: [arm/tip, hand]}
  g: {type: gear, of: [a, s], ratio: 3}
forces: {belt: {type: belt, between: [shaft, hand], first_radius: 50 mm, second_radius: 50 mm, stiffness: 2e5, pretension: 100}}
drivers: {m: {joint: a, kind: angle, value: 1 rad*sin(t)}}
simulation: {end: 1, step: 1 ms}
"""), "--json")
        self.assertEqual([], json.loads(out)["messages"])

    def test_one_between_two_drivers_of_another_ratio_is_doubted(self):
        """Over the run the strands are stretched by the integral of |r1 w1 - s r2 w2|, s = 1 of open ones."""
        for gears, bodies, ends in (self.GEARS[0], ("", "", "")):
            for strands, sense in (("open", 1), ("crossed", -1)):
                for rate, found in ((5 / 12, 0), (-5 / 12, 1.0), (5 / 12 + 0.2, 0.24), (5 / 12 + 0.01, 0)):
                    with self.subTest(gears=gears, strands=strands, rate=rate):
                        text = self.TEXT % (400, strands, "0 N*m", "10*t", 1, "step: 1 ms")
                        if gears:  # the second driver turns a gear beside the pulley
                            text = text.replace("}}\nforces:", "}\n  c: {type: revolute, between: [ground, wheel]}\n"
                                                "  g: {type: gear, of: [l, c], ratio: 2}\nforces:").replace("joints: {s:", "joints:\n  s:")
                            text = text.replace("}, l: {", "}\n  l: {").replace("inertia: 0.04}", "inertia: 0.04}, wheel: {mass: 1, inertia: 0.01}")
                        text = text.replace("\nsimulation", "\n  more: {joint: %s, kind: velocity, value: %r}\nsimulation" % (
                            "c" if gears else "l", 10 * sense * rate * (2 if gears else 1))).replace("drivers: {motor", "drivers:\n  motor").replace(
                                'value: "10*t"}}', 'value: "10*t"}')
                        out, _ = self.freeplay("validate", self.model(text, "freeplay: 1\n"), "--json")
                        said = [m["message"] for m in json.loads(out)["messages"]]
                        self.assertEqual(1 if found else 0, len(said), said)
                        if found:
                            self.assertIn("but 'motor' and 'more' turn them otherwise, which stretches its strands by up to %.3g m of 0.5 m" % found, said[0])

    def test_the_ratio_is_that_of_the_radii(self):
        for strands, ratio in (("open", 5 / 12), ("crossed", -5 / 12)):
            columns = self.run_model(self.TEXT % (400, strands, "0 N*m", "10 rad*smooth(t, 0 s, 0.5 s)", 1,
                                                  "step: 1 ms"))
            self.assertAlmostEqual(10 * ratio, columns["joint.l.angle"][-1], delta=1e-8)

    def test_a_pulley_swings_on_both_strands(self):
        columns = self.run_model((self.TEXT % (0, "open", "0 N*m", "0", 0.5, EXACT))
                                 + "initial: {speeds: {l: 1 rad/s}}\n")
        w = math.sqrt(2 * 2e5 * 0.12 ** 2 / 0.04)
        self.assert_column(columns, "joint.l.angle", lambda t: math.sin(w * t) / w, 1e-9)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-9)

    def test_a_slack_strand_does_not_push(self):
        columns = self.run_model(self.TEXT % (400, "open", "150 N*m*smooth(t, 0 s, 0.5 s)", "0", 1, "step: 1 ms"))
        self.assertEqual(0, columns["force.belt.left_tension"][-1])
        self.assertAlmostEqual(150 / 0.12, columns["force.belt.right_tension"][-1], delta=1e-4)
        self.assertLess(max(map(abs, columns["energy.residual"])), 1e-3)

    def test_pulleys_that_reach_into_each_other_are_said(self):
        for radius, words in (("460 mm", "The pulleys reach into each other"), ("120 mm", None)):
            self.write("m.yaml", "freeplay: 1" + (self.TEXT % (400, "open", "0 N*m", "1 rad*t", "10 ms", "step: 1 ms")).replace("120 mm", radius))
            err = self.freeplay("run", "m.yaml", "--out", "r", "--force")[1]
            self.assertEqual(words is not None, "warning" in err, err)
            self.assertIn(words or "", err)


if __name__ == "__main__":
    unittest.main()
