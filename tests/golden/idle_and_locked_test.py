"""What the joints of a model let do nothing, lock, or stop at once, and turns, ends and springs of the wrong size: doubted in one sentence."""
import json
import unittest

from doubtful_models import BOX, CART, COUPLED, CRANK, ECCENTRIC, GUIDED, HAMMER, HANGER, HOURS, RACK, ROD, SHAKER, TRAIN
from program import ProgramTest

LOOSE = CRANK[CRANK.index("  wrist:\n"):CRANK.index("forces:\n")]
IDEAL = CRANK.replace(LOOSE, "  wrist: {type: revolute, between: [coupler/tip, slider]}\n")
GUIDE = "between: [ground, slider]"
MOTOR = "kind: velocity, value: 100}}"
SPRING = "type: spring-damper, between: [ground/wall, slider], stiffness: 200, free_length: 0.15"
# A disc on a spring, that nothing else holds.
DISC = """freeplay: 1
bodies: {disc: {mass: 2, inertia: 1e-2, pose: {position: [0.15, 0]}, velocity: {linear: [0.1, 0]}}}
frames: {ground/left: [0, 0]}
forces: {spring: {type: spring-damper, between: [ground/left, disc], stiffness: 500, free_length: 0.15}}
simulation: {end: 0.3, step: 1e-4}
"""
TORSION = TRAIN.replace("drivers: {motor: {joint: a, kind: velocity, value: 10}}",
                        "forces: {brake: {type: spring-damper, kind: rotational, between: [ground, two], damping: 0.1}}\ninitial: {speeds: {a: 10}}")
# A crank and a bar that hold each other, with a slide in between that has no way to go.
STUCK = """freeplay: 1
bodies:
  crank: {mass: 0.3, inertia: 1e-4, com: [0.025, 0], frames: {tip: [0.05, 0]}}
  slider: {mass: 0.14, inertia: 1e-4}
frames: {ground/a: {position: [0.05, 0.01], angle: 90 deg}, ground/b: {position: [0.05, 0]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  pin: {type: revolute, between: [crank/tip, slider]}
  guide: {type: prismatic, between: [ground/b, slider]}
initial: {joints: {main: 0}}
simulation: {end: 0.02, step: 1e-5}
"""


def element(words, model=IDEAL):
    return model, "forces:\n", "forces:\n  rub: {%s}\n" % words


# Model, text, what stands in its place, id of the warning, text that stands where it points, words of the message.
MISTAKES = {
    "a round direction of more than half a turn": [
        (CRANK, "ground/wall: [0.3, 0]}", "ground/wall: [0.3, 0], ground/g: {angle: 5}}", "doubtful-angle", "5}", "the direction of -74 deg",
         {GUIDE: "between: [ground/g, slider]"}),
        (CRANK, "tip: [0.05, 0]", "tip: {polar: [0.05, -4.5]}", "doubtful-angle", "-4.5", "write '-4.5 deg'"),
        (CRANK, "slider: {", "slider: {pose: {angle: 4}, ", "doubtful-angle", "4}", "the direction of -131 deg"),
        (ROD, "bob: {", "bob: {pose: {rpy: [0, 0, 5]}, ", "doubtful-angle", "5]", "deg"),
    ],
    "a pin that outruns those of all engines": [
        (ECCENTRIC, "[0.015, 0]", "[0.25, 0]", "doubtful-speed", "300}", "the joint at 'wheel/pin' would go round at 75 m/s",
         {"value: 80 rpm": "value: 300", "end: [0.3, 0]": "end: [0.6, 0]"}),
        (ECCENTRIC, "[0.015, 0]", "[0.25, 0]", "doubtful-speed", "300*t", "that is 2865 rpm",
         {"kind: velocity, value: 80 rpm": "kind: angle, value: 300*t", "initial: {joints: {main: 0.5}}\n": "", "end: [0.3, 0]": "end: [0.6, 0]"}),
        (ECCENTRIC, "[0.015, 0]", "[0.25, 0]", "doubtful-speed", "{points", "write 'unit: rpm'",
         {"value: 80 rpm": "table: {points: [[0, 0], [0.05, 300], [0.1, 300]]}"}),
    ],
    "an end that takes thousands of turns": [
        (CRANK, "end: 0.02", "end: 400", "doubtful-time", "400", "4e+07 steps of 1e-05 s and 6.37e+03 turns or swings of driver 'motor'"),
        (CRANK, "end: 0.02, step: 1e-5", "end: 400, accuracy: 1 um", "doubtful-time", "400", "write '400 ms'"),
        (CART, "end: 1, step: 1e-3", "end: 5000, step: 1e-3", "doubtful-time", "5000", "2.39e+03 turns or swings"),
        (BOX, "end: 0.1, step: 1e-3", "end: 20000, step: 1e-3", "doubtful-time", "20000", "2e+07 steps"),
        (BOX, "end: 0.1, step: 1e-3", "end: 2e4 s, step: 1e-5", "doubtful-time", "2e4 s", "2e+09 steps of 1e-05 s: check it"),
    ],
    "a spring that a weight presses through itself": [
        (BOX, "stiffness: 2e4", "stiffness: 2e3", "doubtful-value", "foot", "would press it by 0.981 m, more than its 0.4 m,"),
        (BOX, "stiffness: 2e4", "stiffness: 2e3", "doubtful-value", "foot", "would press it by",
         {GUIDED: "", ", frames: {up: {angle: 90 deg}}": "", "ground/up: {angle: 90 deg}, ": ""}),
        (BOX, "stiffness: 2e4", "stiffness: 200", "doubtful-value", "foot", "would stretch it by 9.81 m", {"[0, -0.3]": "[0, 0.3]"}),
    ],
    "a spring that hardly acts in the run": [
        (DISC, "stiffness: 500", "stiffness: 0.5", "doubtful-value", "spring", "with a period of 12.6 s, 42 times the run of 0.3 s"),
        (CART, "rail, kind: position, value: 0.1*sin(3*t)", "hinge, kind: torque, value: 0", "doubtful-value", "soft", "hardly acts",
         {"drivers:": "forces: {soft: {type: spring-damper, between: [ground, cart], stiffness: 1e-3}}\ndrivers:",
          "  pole: {mass: 0.2, inertia: 0.002, com: [0.15, 0], frames: {tip: [0.3, 0]}}\n": "",
          "  hinge: {type: revolute, between: [cart, pole]}\n": "", "gravity: [0, -9.81]\n": "",
          "drivers: {motor: {joint: hinge, kind: torque, value: 0}}\n": "", "hinge: -1.2": "rail: 0",
          ", output: {frames: [pole/tip]}": ""}),
    ],
    "an element on an axis that cannot move": [
        (*element("type: joint-friction, kind: rotational, between: [ground, slider], friction: 2"), "idle-force", "rub",
         "joint 'guide' keeps 'slider' from turning against 'ground'; write 'kind: linear'"),
        (*element("type: joint-friction, between: [slider, ground], kind: rotational, friction: 2"), "idle-force", "rub", "keeps 'ground' from turning"),
        (*element("type: joint-friction, between: [ground, crank], friction: 2"), "idle-force", "rub",
         "joint 'main' keeps 'crank' from moving along x of 'ground/origin' against 'ground'; write 'kind: rotational'"),
        (*element("type: joint-stop, kind: rotational, between: [ground, slider], lower: -1, upper: 1, stiffness: 100"), "idle-force", "rub", "turning"),
        (*element("type: spring-damper, kind: rotational, between: [ground, slider], stiffness: 100"), "idle-force", "rub", "turning"),
        (*element("type: spring-damper, between: [ground, crank], damping: 100"), "idle-force", "rub", "'main' holds its two ends at one place"),
        (*element("type: spring-damper, between: [ground/wall, crank], stiffness: 100"), "idle-force", "rub",
         "joint 'main' holds its end 'crank/origin' in place, so that its length stays the same"),
        (IDEAL, "forces:\n", "forces:\n  rub: {type: joint-friction, between: [ground/g, slider], friction: 2}\n", "idle-force", "rub", "moving along x",
         {"ground/wall: [0.3, 0]}": "ground/wall: [0.3, 0], ground/g: {angle: 90 deg}}"}),
        (ROD, "  held:", "  slide: {type: prismatic, between: [ground, sled]}\n  held:", "idle-force", "rub", "keeps 'sled' from turning",
         {"  bob:": "  sled: {mass: 1, inertia: [1, 1, 1]}\n  bob:",
          "simulation:": "forces: {rub: {type: joint-friction, kind: rotational, between: [ground, sled], friction: 2}}\nsimulation:"}),
    ],
    "a guide that locks its loop": [
        (IDEAL, GUIDE, "between: [crank, slider]", "locked", "guide", "with joints 'crankpin', 'wrist' it closes a loop in which nothing can"),
        (CRANK, GUIDE, "between: [crank, slider]", "locked", "guide", "turn its axis"),
        (STUCK, "initial: {joints: {main: 0}}", "initial: {joints: {main: 0}}\ndrivers: {motor: {joint: main, kind: torque, value: 1}}", "locked", "more", "the mechanism has no freedom",
         {"  pin: {type: revolute, between: [crank/tip, slider]}": "  pin: {type: revolute, between: [crank/tip, slider]}\n"
          "  more: {type: prismatic, between: [ground/a, slider/up]}", "inertia: 1e-4}": "inertia: 1e-4, frames: {up: {position: [0, 0.01], angle: 90 deg}}}"}),
    ],
    "a stop that starts far beyond an end": [
        (*element("type: joint-stop, between: [ground, slider], lower: 0.3, upper: 0.5, stiffness: 1e5"), "doubtful-value", "rub",
         "starts at 0.1394 m, 0.161 m beyond its ends of 0.3 and 0.5 m"),
        (*element("type: joint-stop, kind: rotational, between: [ground, crank], lower: 2, upper: 3, stiffness: 1e2"), "doubtful-value", "rub",
         "starts at 1 rad, 1 rad beyond"),
    ],
    "a damper that stops a body at once": [
        (BOX, "stiffness: 2e4, damping: 100, free_length: 0.4", "damping: 1e9", "doubtful-value", "foot", "stops the 200 kg that it works on in 2e-07 s"),
        (TORSION, "damping: 0.1", "damping: 1e6", "doubtful-value", "brake", "stops the 0.00125 kg*m^2"),
        (CRANK, "stiffness: 200, free_length: 0.15", "damping: 1e9", "doubtful-value", "buffer", "stops the 0.14 kg"),
    ],
}
# What looks like these but is meant: no warning at all.
SOUND = [
    (IDEAL, "", ""),
    (*element("type: bushing, between: [ground, crank], stiffness: {turn_z: 30}, damping: {turn_z: 0.1}"),),
    (*element("type: spring-damper, between: [ground/wall, crank/tip], stiffness: 100, free_length: 0.25"),),
    (DISC, "", ""),
    (TORSION, "", ""),
    (CRANK, "ground/wall: [0.3, 0]}", "ground/wall: [0.3, 0], ground/g: {angle: 5 rad}}", {GUIDE: "between: [ground/g, slider]"}),
    (CRANK, "ground/wall: [0.3, 0]}", "ground/wall: [0.3, 0], ground/g: {angle: 4.712389}}", {GUIDE: "between: [ground/g, slider]"}),
    (CRANK, "tip: [0.05, 0]", "tip: {polar: [0.05, 3*pi/2]}"),
    (CRANK, "tip: [0.05, 0]", "tip: {polar: [0.05, 3]}"),
    (ECCENTRIC, "[0.015, 0]", "[0.25, 0]", {"value: 80 rpm": "value: 300 rad/s", "end: [0.3, 0]": "end: [0.6, 0]"}),
    (CRANK, MOTOR, "kind: velocity, value: 300}}"),
    (CRANK, "end: 0.02", "end: 400 s"),
    (CRANK, "end: 0.02, step: 1e-5", "end: 20, step: 1e-4"),
    (HOURS, "", ""),
    (HANGER, "", ""),
    (HAMMER, "", ""),
    (BOX, "stiffness: 2e4", "stiffness: 8e3"),
    (BOX, "stiffness: 2e4", "stiffness: 2e3", {"[0, -0.3]": "[0, 0.3]"}),
    (DISC, "stiffness: 500", "stiffness: 5"),
    (DISC, "stiffness: 500", "stiffness: 0.5, preload: 10"),
    element("type: joint-friction, kind: rotational, between: [ground, crank], friction: 2"),
    element("type: joint-friction, between: [ground, slider], friction: 2"),
    element("type: joint-stop, between: [ground, slider], lower: 0.05, upper: 0.2, stiffness: 1e6"),
    element("type: joint-stop, between: [ground, slider], lower: 0.14, upper: 0.2, stiffness: 1e6"),
    element("type: spring-damper, kind: rotational, between: [ground, coupler], stiffness: 1"),
    element("type: spring-damper, kind: rotational, between: [crank, slider], damping: 0.01"),
    (BOX, "damping: 100", "damping: 1e5"),
    (TORSION, "damping: 0.1", "damping: 10"),
    (IDEAL, "{main: 1}", "{main: 0}"),
    (IDEAL, "{main: 1}", "{main: pi}"),
    (RACK, "", ""),
    (SHAKER, "", ""),
    (COUPLED, "", ""),
]


def changed(model, old, new, more):
    for part, instead in {old: new, **more}.items():
        assert part in model, part
        model = model.replace(part, instead, 1)
    return model


class IdleAndLocked(ProgramTest):
    def messages(self, text):
        self.write("m.yaml", text)
        return json.loads(self.freeplay("validate", "m.yaml", "--json")[0])["messages"]

    def expect(self, what):
        for model, old, new, wanted, place, words, *more in MISTAKES[what]:
            with self.subTest(new):
                text = changed(model, old, new, more[0] if more else {})
                found = self.messages(text)
                one = next((m for m in found if m["id"] == wanted and words in m["message"]), None)
                self.assertIsNotNone(one, found)
                self.assertEqual("warning", one["severity"])
                line = text.splitlines()[one["line"] - 1]
                self.assertTrue(line[one["column"] - 1:].startswith(place), (line, one))

    def test_a_round_direction_of_more_than_half_a_turn_is_doubted(self):
        self.expect("a round direction of more than half a turn")

    def test_a_pin_that_outruns_those_of_all_engines_is_doubted(self):
        self.expect("a pin that outruns those of all engines")

    def test_an_end_that_takes_thousands_of_turns_is_doubted_with_their_number(self):
        self.expect("an end that takes thousands of turns")

    def test_an_end_that_the_command_line_gives_is_not_doubted(self):
        self.write("m.yaml", changed(CRANK, "end: 0.02", "end: 400", {}))
        self.assertNotIn("doubtful-time", self.freeplay("run", "m.yaml", "--dry-run", "--end", "0.1")[1])

    def test_a_spring_that_a_weight_presses_through_itself_is_doubted(self):
        self.expect("a spring that a weight presses through itself")

    def test_a_spring_that_hardly_acts_in_the_run_is_doubted(self):
        self.expect("a spring that hardly acts in the run")

    def test_a_spring_pressed_to_nothing_is_in_the_verdict(self):
        self.write("m.yaml", changed(BOX, "stiffness: 2e4", "stiffness: 5e3", {"end: 0.1": "end: 1"}))
        _, err = self.freeplay("run", "m.yaml", "--out", "r", "--force")
        self.assertIn("'foot'", err)
        self.assertIn("pressed together to less than a tenth of its free length", err)
        reasons = json.loads(self.read("r", "summary.json"))["trust"]["reasons"]
        self.assertIn("law-range", [reason["id"] for reason in reasons])

    def test_an_element_on_an_axis_that_cannot_move_is_doubted(self):
        self.expect("an element on an axis that cannot move")

    def test_a_guide_that_locks_its_loop_is_named(self):
        self.expect("a guide that locks its loop")

    def test_a_stop_that_starts_far_beyond_an_end_is_doubted(self):
        self.expect("a stop that starts far beyond an end")

    def test_a_damper_that_stops_a_body_at_once_is_doubted(self):
        self.expect("a damper that stops a body at once")

    def test_what_is_idle_or_locked_makes_the_verdict_doubtful(self):
        for model, old, new, *_ in (MISTAKES["an element on an axis that cannot move"][0], MISTAKES["a guide that locks its loop"][0]):
            self.write("m.yaml", changed(model, old, new, {}))
            self.freeplay("run", "m.yaml", "--out", "r", "--force", "--end", "1 ms")
            trust = json.loads(self.read("r", "summary.json"))["trust"]
            self.assertIn("doubtful-structure", [reason["id"] for reason in trust["reasons"]])

    def test_what_is_meant_is_not_doubted(self):
        for model, old, new, *more in SOUND:
            with self.subTest(new or model[:60]):
                self.assertEqual([], self.messages(changed(model, old, new, more[0] if more else {})))


if __name__ == "__main__":
    unittest.main()
