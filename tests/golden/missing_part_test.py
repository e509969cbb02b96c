"""Mechanisms that miss a part, or have one too many: `validate` names what is wrong, and says nothing of the sound one."""
import json
import unittest

from doubtful_models import shipped
from program import ProgramTest

# The poses close the loop, so that nothing moves far where a part is missing.
PUNCH = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {down: {angle: -90 deg}}}
  wheel: {mass: 90 kg, inertia: 6, frames: {pin: [30 mm, 0]}}
  pitman: {mass: 8 kg, inertia: 0.12, com: [150 mm, 0], frames: {ball: [350 mm, 0]}, pose: {position: [30 mm, 0], angle: -95 deg}}
  ram: {mass: 40 kg, inertia: 0.8, pose: {position: [0, -0.35 m], angle: -90 deg}}
joints:
  main: {type: revolute, between: [ground, wheel]}
  pin: {type: revolute, between: [wheel/pin, pitman]}
  ball: {type: revolute, between: [pitman/ball, ram]}
  guide: {type: prismatic, between: [ground/down, ram]}
drivers: {motor: {joint: main, kind: velocity, value: 60 rpm}}
forces: {rub: {type: joint-friction, between: [ground/down, ram], friction: 50 N}}
simulation: {end: 1 s, accuracy: 1 um}
"""

WINCH = """freeplay: 1
gravity: [0, -9.81]
bodies:
  rotor: {mass: 3 kg, inertia: 4e-3}
  drum: {mass: 20 kg, inertia: 0.2}
  hook: {mass: 300 kg, inertia: 5}
frames: {ground/drum: [0.3 m, 0], ground/rope: {position: [0.4 m, -1 m], angle: 90 deg}}
joints:
  motor: {type: revolute, between: [ground, rotor]}
  axle: {type: revolute, between: [ground/drum, drum]}
  rope: {type: prismatic, between: [ground/rope, hook]}
  box: {type: gear, of: [motor, axle], ratio: 20}
  wind: {type: gear, of: [axle, rope], ratio: 0.1 m}
drivers: {motor: {joint: motor, kind: velocity, value: 150 rad/s}}
forces: {air: {type: force, at: hook, value: [0, "-2 N*s/m*body.hook.vy"]}}
initial: {joints: {rope: 0}}
simulation: {end: 0.2 s, accuracy: 1 um}
"""

PLAY = "clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e10}}"
FOUR_BAR = """freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 1, inertia: 1e-3, frames: {tip: [70 mm, 0]}, pose: {angle: 90 deg}}
  coupler: {mass: 2, inertia: 0.02, com: [0.15, 0], frames: {tip: [0.3, 0]}, pose: {position: [0, 70 mm], angle: 24 deg}}
  rocker: {mass: 1.5, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}, pose: {position: [0.3, 0], angle: 98 deg}}
frames: {ground/D: [0.3, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, coupler]}
  C: {type: revolute, between: [%s], PLAY}
  D: {type: revolute, between: [ground/D, rocker]}
drivers: {motor: {joint: A, kind: velocity, value: 5 rad/s}}
initial: {joints: {A: 90 deg}}
simulation: {end: 0.1 s, accuracy: 1 um}
""".replace("PLAY", PLAY)

ARM = """freeplay: 1
bodies:
  arm: {mass: 2, inertia: 0.05, com: [0.2, 0], frames: {wrist: [0.4, 0]}}
  hand: {mass: 1, inertia: 0.01, com: [0.1, 0]}
joints:
  shoulder: {type: revolute, between: [ground, arm]}
  wrist: {type: revolute, between: [arm/wrist, hand]}
drivers:
  lift: {joint: shoulder, kind: angle, value: "-70 deg - 40 deg*smooth(t, 0.2 s, 1 s)"}
  turn: {joint: wrist, kind: angle, value: 20 deg}
simulation: {end: 2 s, accuracy: 1 um}
"""

class MissingPart(ProgramTest):
    def doubts(self, text, code=0):
        verdict = json.loads(self.freeplay("validate", self.write("m.yaml", text), "--json", code=code)[0])
        return [(m["id"], m["message"]) for m in verdict["messages"]]

    def assert_doubted(self, text, wanted, words):
        found = [message for name, message in self.doubts(text) if name == wanted]
        self.assertTrue(any(words in message for message in found), (wanted, words, found))

    def without(self, model, *names):
        lines = model.splitlines(True)
        kept = [line for line in lines if not line.startswith(tuple("  %s: {type" % name for name in names))]
        self.assertEqual(len(lines) - len(names), len(kept))
        return "".join(kept)

    def test_sound_mechanisms_are_not_doubted(self):
        for model in (PUNCH, WINCH, ARM, FOUR_BAR % "coupler/tip, rocker/tip", FOUR_BAR % "rocker/tip, coupler/tip"):
            self.assertEqual([], self.doubts(model))

    def test_friction_on_a_guide_does_not_stand_in_for_it(self):
        self.assert_doubted(self.without(PUNCH, "guide"), "left-free", "no start is given for 'pitman', 'ram'")

    def test_poses_say_nothing_beside_a_frame_that_nothing_uses(self):
        model = self.without(FOUR_BAR % "coupler/tip, rocker/tip", "D")
        self.assert_doubted(model, "unused", "frame 'ground/D' is not used")
        self.assert_doubted(model, "left-free", "no start is given for 'coupler', 'rocker'")
        self.assert_doubted(model, "left-free", "(a 'pose' counts as a guess while nothing stands on frame 'ground/D')")

    def test_what_no_gear_ties_to_a_driver_is_named(self):
        self.assert_doubted(self.without(WINCH, "wind"), "left-free", "no driver moves 'hook'")
        self.assert_doubted(self.without(WINCH, "box"), "left-free", "no driver moves 'drum', 'hook': no joint, gear or force ties any to")

    def test_only_two_joints_at_one_place_may_be_one_too_many_there(self):
        rods = "".join("  %s: {mass: 1, inertia: 0.01, com: [0.1, 0]}\n" % name for name in "abc")
        pins = "".join("  p%s: {type: revolute, between: [hub/eye, %s]}\n" % (name, name) for name in "abc")
        star = ("freeplay: 1\nbodies:\n  hub: {mass: 1, inertia: 0.01, frames: {eye: [0.1, 0], spare: [0.2, 0]}}\n" + rods +
                "joints:\n  axle: {type: revolute, between: [ground, hub]}\n" + pins + "simulation: {end: 1 s, step: 1 ms}\n")
        self.assertIn(("unused", "frame 'spare' is not used"), self.doubts(star))
        two = star.replace("  pc: {type: revolute, between: [hub/eye, c]}", "  pc: {type: revolute, between: [a, c]}")
        self.assert_doubted(two, "unused", "'pa' and 'pb' both hold 'hub/eye': is one of them meant here?")

    def test_a_drag_turns_nothing(self):
        fan = (WINCH.replace("frames:", "  fan: {mass: 1 kg, inertia: 0.01}\nframes:", 1)
               .replace("drivers:", "  hub: {type: revolute, between: [ground, fan]}\n  step: {type: gear, of: [motor, hub], ratio: 2}\ndrivers:")
               .replace("forces: {", "forces: {drag: {type: torque, on: fan, value: \"-1e-3 N*m*s^2*body.fan.omega*abs(body.fan.omega)\"}, "))
        self.assertEqual([], self.doubts(fan))
        self.assert_doubted(self.without(fan, "step"), "left-free", "'fan' never moves: it turns in its bearing on ground alone")
        self.assertEqual([], self.doubts(self.without(fan, "step").replace("-1e-3 N", "1 N*m - 1e-3 N")))
        rubbed = "forces: {rub: {type: joint-friction, between: [%s, fan], kind: rotational, friction: 0.1 N*m}, "
        self.assert_doubted(self.without(fan, "step").replace("forces: {", rubbed % "ground"), "left-free", "'fan' never moves")
        self.assertEqual([], self.doubts(self.without(fan, "step").replace("forces: {", rubbed % "rotor")))  # a clutch

    def test_a_formula_ties_what_it_acts_on_to_what_it_reads(self):
        pulled = self.without(WINCH, "wind").replace("-2 N*s/m*body.hook.vy", "100 N*s*body.drum.omega")
        self.assertEqual([], self.doubts(pulled))

    def test_a_rod_from_where_a_link_is_pinned_to_ground_bypasses_the_play_at_its_other_end(self):
        for ends in ("coupler/tip, rocker/tip", "rocker/tip, coupler/tip"):
            for rod, length in (("ground/D, coupler/tip", "0.2 m"), ("coupler/tip, ground/D", "0.2 m")):
                model = (FOUR_BAR % ends).replace("drivers:", "  rod: {type: distance, between: [%s], length: %s}\ndrivers:" % (rod, length))
                self.assert_doubted(model, "play-bypassed", "the play of joint 'C' is bypassed by joint 'rod'")

    def test_degrees_of_one_term_are_not_those_of_another(self):
        self.assert_doubted(ARM.replace("40 deg*", "40*"), "doubtful-angle", "write '40 deg' if degrees are meant")
        self.assertEqual([], self.doubts(ARM.replace("40 deg*", "40 rad*")))

    def test_the_angle_of_a_path_in_degrees_without_a_unit_is_doubted(self):
        robot = shipped("3-rrr.yaml")
        self.assertEqual(1, robot.count("angle: 0}"))
        self.assert_doubted(robot.replace("angle: 0}", "angle: 30}"), "doubtful-angle", "write '30 deg' if degrees are meant")


if __name__ == "__main__":
    unittest.main()
