"""Statistics of a part of a turn of what a driver turns slowly are doubted."""
import unittest

from model_cases import VerdictTest


class GearedWindow(VerdictTest):
    GEARED = """freeplay: 1
gravity: [0, -9.81]
bodies:
  m: {mass: 1 kg, inertia: 1e-4}
  c: {mass: 2 kg, inertia: 5e-3, frames: {p: [50 mm, 0]}}
  r: {mass: 0.5 kg, inertia: 2e-3, com: [0.1, 0], frames: {e: [0.2, 0]}, pose: {position: [50 mm, 0]}}
  s: {mass: 1 kg, inertia: 1e-3, pose: {position: [0.25, 0]}}
frames: {ground/M: [0, 0.4]}
joints:
  M: {type: revolute, between: [ground/M, m]}
  C: {type: revolute, between: [ground, c]}
%s
  P: {type: revolute, between: [c/p, r]}
  E: {type: revolute, between: [r/e, s]}
  G: {type: prismatic, between: [ground, s]}
%s
drivers: {d: {joint: M, kind: velocity, value: 1500 rpm}}
initial: {joints: {C: 0}}
simulation: {end: %s s, accuracy: 1 um, output: {discard: 0.5 s}}
"""

    def test_a_window_shorter_than_a_turn_of_what_a_driver_turns_slowly_is_doubtful(self):
        gear, rod = "  g: {type: gear, of: [%s], ratio: %s}", "forces: {b: {type: belt, between: [m, c], first_radius: 10 mm, second_radius: 100 mm, stiffness: 1e5, pretension: 200}}"
        for joints, forces, turn in ((gear % ("M, C", "1/50"), "", 2.0), (gear % ("C, M", "-50"), "", 2.0), ("", rod, 0.4)):
            with self.subTest(joints=joints, forces=forces):
                self.run_model(self.GEARED % (joints, forces, 0.5 + 0.9 * turn))
                reason = next(r for r in self.trust["reasons"] if r["id"] == "statistics-window")
                self.assertEqual("joint 'C'", reason["element"])
                self.assertAlmostEqual(turn, reason["limit"], places=9)
                self.assertIn("of joint 'C', which driver 'd' turns", reason["message"])
                self.run_model(self.GEARED % (joints, forces, 0.5 + 1.1 * turn))
                self.assertNotIn("statistics-window", self.ids())


if __name__ == "__main__":
    unittest.main()
