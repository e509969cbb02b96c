"""Freedoms that drivers leave: loads on ropes and what springs carry are meant, a missing guide or spring is not."""
import json
import unittest

from program import ProgramTest

CRANE = """freeplay: 1
gravity: [0, -9.81]
bodies:
  trolley: {mass: 400 kg, inertia: 20}
  hook: {mass: 1500 kg, inertia: 100, pose: {position: [%s]}}
frames: {ground/rail: [0, 5]}
joints:
  rail: {type: prismatic, between: [ground/rail, trolley]}
  rope: {type: distance, between: [trolley, hook], length: 4 m}
drivers: {drive: {joint: rail, kind: position, value: "6 m*smooth(t, 1 s, 8 s)"}}
simulation: {end: 15 s, accuracy: 0.1 mm}
"""
# A double wishbone on a wheel that a plate shakes.
SUSPENSION = """freeplay: 1
gravity: [0, -9.81]
bodies:
  car: {mass: 320, inertia: 60, frames: {v: {angle: 90 deg}, lo: [0.35, 0.05], up: [0.4, 0.25], top: [0.45, 0.55]}, pose: {position: [0, 0.25]}}
  lower: {mass: 5, inertia: 0.06, com: [0.17, 0], frames: {ball: [0.36, 0], shock: [0.22, 0]}, pose: {position: [0.35, 0.3]}}
  upper: {mass: 3, inertia: 0.03, com: [0.12, 0], frames: {ball: [0.28, 0]}, pose: {position: [0.4, 0.5]}}
  knuckle: {mass: 38, inertia: 0.8, frames: {lo: [-0.06, -0.1], up: [-0.07, 0.1]}, pose: {position: [0.77, 0.4]}}
  plate: {mass: 10, inertia: 1, frames: {v: {angle: 90 deg}}, pose: {position: [0.77, 0]}}
frames: {ground/v: {angle: 90 deg}, ground/p: {position: [0.77, 0], angle: 90 deg}}
joints:
  body: {type: prismatic, between: [ground/v, car/v]}
  li: {type: revolute, between: [car/lo, lower]}
  ui: {type: revolute, between: [car/up, upper]}
  lo: {type: revolute, between: [lower/ball, knuckle/lo]}
  uo: {type: revolute, between: [upper/ball, knuckle/up]}
  road: {type: prismatic, between: [ground/p, plate/v]}
drivers: {road: {joint: road, kind: position, value: "40 mm*smooth(t, 0.5, 0.6)"}}
forces:
  shock: {type: spring-damper, between: [car/top, lower/shock], stiffness: 45 kN/m, free_length: 0.56}
  tyre: {type: spring-damper, between: [plate, knuckle], stiffness: 200 kN/m, free_length: 0.42}
simulation: {end: 2 s, accuracy: 10 um}
"""

# A rotor out of balance on a plate that slides on a table between four springs.
SHAKER = """freeplay: 1
space: spatial
gravity: [0, 0, -9.81]
bodies:
  plate: {mass: 3, inertia: [0.02, 0.02, 0.04], frames: {e: [0.2, 0, 0], w: [-0.2, 0, 0], n: [0.1, 0.2, 0], s: [0.1, -0.2, 0]}}
  rotor: {mass: 0.4, inertia: [1e-4, 1e-4, 2e-4], com: [8 mm, 0, 0]}
frames: {ground/e: [0.3, 0.1, 0], ground/w: [-0.3, 0.1, 0], ground/n: [0.1, 0.3, 0], ground/s: [0.1, -0.3, 0]}
joints:
  table: {type: planar, between: [ground, plate]}
  axle: {type: revolute, between: [plate, rotor]}
drivers: {motor: {joint: axle, kind: velocity, value: 100 rad/s}}
forces:
  e: {type: spring-damper, between: [ground/e, plate/e], stiffness: 2 kN/m, free_length: 0.1}
  w: {type: spring-damper, between: [ground/w, plate/w], stiffness: 2 kN/m, free_length: 0.1}
  n: {type: spring-damper, between: [ground/n, plate/n], stiffness: 2 kN/m, free_length: 0.1}
  s: {type: spring-damper, between: [ground/s, plate/s], stiffness: 2 kN/m, free_length: 0.1}
simulation: {end: 1, accuracy: 1 um}
"""


class LeftFree(ProgramTest):
    def doubts(self, text, **changes):
        for old, new in changes.items():
            self.assertIn(old, text)
            text = text.replace(old, new)
        found = json.loads(self.freeplay("validate", self.write("m.yaml", text), "--json")[0])["messages"]
        return [m["message"] for m in found if m["id"] == "left-free"]

    def test_a_load_on_a_rope_hangs_where_it_is_given(self):
        for place in ("0, 1", "2, 1.535898384862245", "-3.4, 2.892869249429452"):
            with self.subTest(place):
                self.assertEqual([], self.doubts(CRANE % place))

    def test_a_run_names_what_moves_although_no_doubt_does(self):
        words = "with all drivers at rest 'hook' still moves: where that is not meant, a joint or a driver is missing"
        text = (CRANE % "0, 1").replace("end: 15 s", "end: 0.1 s")
        self.assertIn(words, self.freeplay("run", self.write("m.yaml", text), "--out", "r")[0])
        for old, new in (("0, 1", "4, 5"), ("drivers: {drive: {joint: rail, kind: position, value: \"6 m*smooth(t, 1 s, 8 s)\"}}\n", "")):
            with self.subTest(new):  # a doubt says it, or there is no driver
                self.assertIn(old, text)
                self.write("m.yaml", text.replace(old, new))
                self.assertNotIn("still move", self.freeplay("run", "m.yaml", "--out", "r", "--force")[0])

    def test_what_springs_hold_on_a_table_starts_where_it_is_given(self):
        self.assertEqual([], self.doubts(SHAKER))
        pinned = self.doubts(SHAKER, **{"type: planar": "type: spherical"})
        self.assertIn("no start is given for 'plate', 'rotor'", pinned[0])

    def test_what_stands_beside_or_on_a_bar_misses_its_guide(self):
        """The coupler of a crank is such a bar, too, and so is a body whose place is not given."""
        for place in ("4, 5", "0, 9"):
            with self.subTest(place):
                found = self.doubts(CRANE % place)
                self.assertEqual(1, len(found))
                self.assertIn("1 freedom is left over with all drivers at rest, and no start is given for 'hook': add the missing guide, joint "
                              "or driver; what is meant to move freely gets a start under 'initial', or a 'pose' with its angle", found[0])
                # That it is meant can be said so.
                self.assertEqual([], self.doubts((CRANE % place).replace("]}}", "], angle: 0}}")))
        self.assertEqual(1, len(self.doubts(CRANE.replace(", pose: {position: [%s]}", ""))))

    def test_as_many_springs_as_freedoms_carry_what_no_driver_is_joined_to(self):
        self.assertEqual([], self.doubts(SUSPENSION))
        for old, new in (("  shock: {type: spring-damper, between: [car/top, lower/shock], stiffness: 45 kN/m, free_length: 0.56}\n", ""),
                         ("  tyre: {type: spring-damper, between: [plate, knuckle], stiffness: 200 kN/m, free_length: 0.42}\n", ""),
                         ("  body: {type: prismatic, between: [ground/v, car/v]}\n", ""),
                         ("  uo: {type: revolute, between: [upper/ball, knuckle/up]}\n", ""),
                         # Both along one line hold one freedom.
                         ("[plate, knuckle]", "[car/top, lower/shock]"),
                         # A driver on a wishbone leads the rest: springs hold less than what is missing then.
                         ("{joint: road, kind: position, value: \"40 mm*smooth(t, 0.5, 0.6)\"}", "{joint: li, kind: angle, value: 0.1*t}")):
            with self.subTest(old):
                self.assertEqual(1, len(self.doubts(SUSPENSION, **{old: new})))

    def test_where_nothing_acts_a_start_speed_says_what_is_meant(self):
        """As of the hammers of a mill without gravity, which may as well have been forgotten."""
        mill = """freeplay: 1
bodies: {rotor: {mass: 50, inertia: 2, frames: {h: [0.25, 0]}}, hammer: {mass: 3, inertia: 0.02, com: [0.08, 0]}}
joints: {axle: {type: revolute, between: [ground, rotor]}, h: {type: revolute, between: [rotor/h, hammer]}}
drivers: {m: {joint: axle, kind: velocity, value: 1000 rpm}}
initial: {joints: {h: 20 deg}}
simulation: {end: 0.1, accuracy: 10 um}
"""
        found = self.doubts(mill)
        self.assertEqual(1, len(found))
        self.assertIn("nothing acts on 'hammer': add the missing gravity, force, guide, joint or driver; what is meant to move freely gets a "
                      "start speed under 'initial', if only 0", found[0])
        self.assertEqual([], self.doubts(mill.replace("20 deg}", "20 deg}, speeds: {h: 0}")))


if __name__ == "__main__":
    unittest.main()
