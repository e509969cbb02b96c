"""Numbers whose unit was forgotten, of guides, teeth, screws, springs and angles: `validate` says so, and of what is meant nothing."""
import json
import unittest

from program import ProgramTest

AXIS = """freeplay: 1
gravity: [0, -9.81]
bodies:
  table: {mass: 12, inertia: 0.15, frames: {nut: [0.1, 0]}}
  ram: {mass: 1.5, inertia: 2e-3}
joints:
  guide: {type: prismatic, between: [ground, table], clearance: {width: 40 mm, gap: 30 um, length: 160 mm, contact: {law: hertz, K: 2e9}}}
  slide: {type: prismatic, between: [ground, ram]}
forces:
  screw: {type: spring-damper, between: [ram, table/nut], stiffness: 5e6, damping: 3000, free_length: 0.1}
drivers: {servo: {joint: slide, kind: position, value: "0.1*smooth(t, 0, 0.5)"}}
initial: {joints: {guide: 0}}
simulation: {end: 1, step: 1e-4}
"""
TEETH = """freeplay: 1
bodies: {ground: {frames: {two: [0.15, 0]}}, one: {mass: 5, inertia: 0.012}, two: {mass: 14, inertia: 0.07}}
joints:
  a: {type: revolute, between: [ground, one]}
  b: {type: revolute, between: [ground/two, two]}
  mesh: {type: gear, of: [a, b], ratio: -1/2, clearance: {pitch_radius: 0.1, gap: 0.1 mm, contact: {law: hertz, K: 1e9}}}
forces: {load: {type: torque, on: two, value: 6}}
drivers: {motor: {joint: a, kind: velocity, value: 15}}
simulation: {end: 0.4, accuracy: 1e-6}
"""
DECK = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {l: [-0.8, 0], r: [0.8, 0]}}
  deck: {mass: 420, inertia: 160, frames: {l: [-0.8, -0.2], r: [0.8, -0.2], shaft: [0, 0.1]}, pose: {position: [0, 0.2]}}
  rotor: {mass: 18, inertia: 0.12, com: [6 mm, 0]}
joints: {shaft: {type: revolute, between: [deck/shaft, rotor]}}
forces:
  left: {type: bushing, between: [ground/l, deck/l], stiffness: {x: 60e3, y: 150e3}, damping: {x: 300, y: 600}}
  right: {type: bushing, between: [ground/r, deck/r], stiffness: {x: 60e3, y: 150e3}, damping: {x: 300, y: 600}}
drivers: {motor: {joint: shaft, kind: velocity, value: "100*smooth(t, 0, 1)"}}
simulation: {end: 3, step: 0.2 ms}
"""
WHEEL = """freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {up: {position: [0, 0], angle: 90 deg}}}
  wheel: {mass: 40, inertia: 0.5, frames: {up: {angle: 90 deg}}}
joints: {guide: {type: prismatic, between: [ground/up, wheel/up]}}
frames: {ground/road: [0, -0.3]}
forces: {tyre: {type: spring-damper, between: [ground/road, wheel], stiffness: 190e3, damping: 250, free_length: 0.302}}
initial: {joints: {guide: 0}}
simulation: {end: 0.5, step: 1e-4}
"""
JACK = """freeplay: 1
space: spatial
bodies:
  spindle: {mass: 2, inertia: [2e-3, 2e-3, 1e-3]}
  table: {mass: 5, inertia: [0.05, 0.05, 0.05], pose: {position: [0, 0, 0.2]}}
joints:
  bearing: {type: revolute, between: [ground, spindle]}
  thread: {type: screw, between: [spindle, table], lead: 8 mm, offset: 0.2}
  guide: {type: point-on-plane, between: [ground/side, table/arm]}
frames: {ground/side: {position: [0.1, 0, 0], rpy: [0, 90 deg, 0]}, table/arm: [0.1, 0.1, 0]}
drivers: {motor: {joint: bearing, kind: velocity, value: 10}}
simulation: {end: 0.2, step: 1e-3}
"""
ARM = """freeplay: 1
parameters: {at: 120 deg}
bodies: {arm: {mass: 3, inertia: 0.03, com: [0.1*cos($at), 0.1*sin($at)], frames: {tip: [0.2*cos($at), 0.2*sin($at)]}}}
joints: {pin: {type: revolute, between: [ground, arm]}, end: {type: fixed, between: [arm/tip, ball]}}
drivers: {motor: {joint: pin, kind: angle, value: "0.02*sin(90 deg*t/(1 s))"}}
simulation: {end: 1, step: 1e-3}
""".replace("bodies: {", "bodies: {ball: {mass: 1, inertia: 1e-3}, ")

SLOT = """freeplay: 1
bodies:
  crank: {mass: 0.8, inertia: 5e-4, frames: {pin: [0.03, 0]}}
  yoke: {mass: 1.2, inertia: 2e-3, frames: {slot: {angle: 90 deg}}}
joints:
  main: {type: revolute, between: [ground, crank]}
  guide: {type: prismatic, between: [ground, yoke]}
  slot: {type: point-on-line, between: [yoke/slot, crank/pin], clearance: {pin_radius: 8 mm, gap: 0.1 mm, slot: [-60 mm, 60 mm],
         contact: {law: hertz, K: 1e9}}}
drivers: {motor: {joint: main, kind: velocity, value: 40}}
initial: {joints: {main: 0}}
simulation: {end: 0.5, step: 1e-5}
"""

SLIPS = [  # model, text, what stands in its place, id, words
    (AXIS, "gap: 30 um", "gap: 30 mm", "doubtful-clearance", "0.75 times the smallest radius or width beside it (0.04 m)"),
    (TEETH, "gap: 0.1 mm", "gap: 0.05", "doubtful-clearance", "'joints.mesh.clearance.gap' is 0.05 m, 0.5 times the smallest"),
    (TEETH, "gap: 0.1 mm", "gap: 5 mm", "doubtful-clearance", "check the number and its unit"),
    (TEETH, "gap: 0.1 mm", "backlash: 0.5", "doubtful-angle", "28.6 deg, which teeth do not have: write '0.5 deg'"),
    (DECK, "y: 150e3", "y: 150", "doubtful-value", "'left' is so soft that the weight of 'deck' would press it by 14.3 m"),
    (WHEEL, ", free_length: 0.302", "", "doubtful-length", "'tyre' has no 'free_length', so that it pulls its ends together with 5.7e+04 N"),
    (JACK, "lead: 8 mm", "lead: 8", "doubtful-length", "write the unit after the number, as in '8 mm'"),
    (ARM, "at: 120 deg", "at: 120", "doubtful-angle", "takes a sine, cosine or tangent of 120 rad: write '120 deg'"),
    (ARM, "90 deg*t/(1 s)", "360*t", "doubtful-angle", "takes a sine, cosine or tangent of 360 rad/s times t: write '360 deg/s'"),
    (DECK, "com: [6 mm, 0]", "com: [60, 0]", "doubtful-length", "the centre of mass of 'rotor' is 60 m away from its joint"),
    (SLOT, "[-60 mm, 60 mm]", "[-60, 60]", "doubtful-length", "write the unit after the number, as in '60 mm'"),
    (DECK, "100*smooth(t, 0, 1)", "100*(smooth(t, 0, 1000) - smooth(t, 4000, 5000))", "doubtful-time", "goes on to 5000 s"),
]
SOUND = [
    *[(model, "", "") for model in (AXIS, TEETH, DECK, WHEEL, JACK, ARM, SLOT)],
    (AXIS, "gap: 30 um", "gap: 7 mm"),
    (TEETH, "gap: 0.1 mm", "backlash: 2 deg"),
    (DECK, "y: 150e3", "y: 8e3"),
    (WHEEL, "stiffness: 190e3, damping: 250, free_length: 0.302", "stiffness: 2e3, damping: 250"),
    (JACK, "lead: 8 mm", "lead: 150 mm"),
    (ARM, "90 deg*t/(1 s)", "100*t"),
    (ARM, "90 deg*t/(1 s)", "360 rad/s*t"),
    (ARM, "90 deg*t/(1 s)", "2*pi*180*t"),
    (DECK, "100*smooth(t, 0, 1)", "100*(smooth(t, 0, 1) - smooth(t, 2, 2.5))"),
]


class UnitSlips(ProgramTest):
    def messages(self, model, old, new):
        self.assertIn(old, model)
        out, _ = self.freeplay("validate", self.write("m.yaml", model.replace(old, new)), "--json")
        return [(m["id"], m["message"]) for m in json.loads(out)["messages"]]

    def test_each_is_said_once(self):
        for model, old, new, wanted, words in SLIPS:
            with self.subTest(new or old):
                found = set(self.messages(model, old, new))
                self.assertEqual([wanted], sorted({one for one, _ in found if one == wanted}), found)
                self.assertTrue(any(words in message for _, message in found), found)

    def test_what_is_meant_is_not_doubted(self):
        for model, old, new in SOUND:
            with self.subTest(new or model[:400]):
                self.assertEqual([], self.messages(model, old, new))

    def test_a_spring_that_is_pulled_out_is_doubted_by_the_run(self):
        hanging = WHEEL.replace("[0, -0.3]", "[0, 0.3]").replace("190e3", "90").replace("end: 0.5", "end: 4")
        out, _ = self.freeplay("run", self.write("m.yaml", hanging), "--out", "r")
        self.assertIn("more than ten times its free length", out)

    def test_a_pin_that_is_driven_through_the_end_of_its_slot_ends_the_run(self):
        text = SLOT.replace("60 mm", "6 mm")
        _, err = self.freeplay("run", self.write("m.yaml", text), "--out", "r", code=4)
        self.assertIn("more than clearance and smaller radius together", err)


if __name__ == "__main__":
    unittest.main()
