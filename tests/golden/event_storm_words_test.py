"""What a storm of switches is blamed on: the formula that makes it, and no number that has nothing to do with it."""
import unittest

from program import ProgramTest

# A wheel beside it with a crank pin near its middle has a radius of gyration of many times the way to that pin.
MODEL = """freeplay: 1
bodies:
  m: {mass: 1 kg, inertia: 1 kg*m^2}
  wheel: {mass: 2 kg, inertia: 3e-3, frames: {pin: [8 mm, 0]}}
joints:
  slide: {type: prismatic, between: [ground, m]}
  shaft: {type: revolute, between: [ground, wheel]}
forces:
  hold: {type: force, at: m, value: ["-5 N*sign(body.m.vx)", 0]}
  push: {type: force, at: wheel/pin, value: [0, 1 N]}
initial: {speeds: {slide: 1 m/s}}
simulation: {end: 2 s, accuracy: 1 um}
"""


class EventStormWords(ProgramTest):
    def test_a_formula_that_jumps_back_is_all_that_is_blamed(self):
        self.write("m.yaml", MODEL)
        err = self.freeplay("run", "m.yaml", "--out", "r", code=4)[1]
        self.assertIn("the formula of force 'hold' changes its form without end", err)
        self.assertNotIn("likely cause", err)


if __name__ == "__main__":
    unittest.main()
