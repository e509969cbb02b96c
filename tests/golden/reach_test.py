"""What a workspace counts: the grid of the file, stops, slots and limits of joints, against closed forms."""
import csv
import io
import json
import math
import unittest

from analyze_spatial_test import stewart, leg_lengths, ROD
from program import ProgramTest

# A slide along x, and on it one along y: every point of the plane, up to where something ends the way.
TABLE = """freeplay: 1
bodies: {long: {mass: 1, inertia: 1}, cross: {mass: 1, inertia: 1}}
frames: {ground/x: {angle: 0}, long/y: {angle: 90 deg}, cross/y: {angle: 90 deg}}
joints:
  X: {type: prismatic, between: [ground/x, long]}
  Y: {type: prismatic, between: [long/y, cross/y]}
%s
analysis: {frame: cross, joints: [X, Y], %s}
"""
GRID = "grid: {x: {linspace: [-1, 1, 41]}, y: {linspace: [-1, 1, 41]}}"
# A crank of 0.3 m and a coupler of 0.2 m, driven at both pins.
ARM = """freeplay: 1
%sbodies:
  upper: {mass: 1, inertia: %s, frames: {end: [0.3, 0%s]}}
  lower: {mass: 1, inertia: %s, frames: {tip: [0.2, 0%s]}}
joints:
  lift: {type: revolute, between: [ground, upper]}
  bend: {type: revolute, between: [upper/end, lower]}
forces:
  stop: {type: joint-stop, kind: rotational, between: [upper/end, lower], lower: 30 deg, upper: 120 deg, %s}
initial: {joints: {lift: 0, bend: 60 deg}}
analysis: {frame: lower/tip, joints: [lift, bend], grid: {x: {linspace: [-0.6, 0.6, 61]}, y: {linspace: [-0.6, 0.6, 61]}%s}}
"""


class Reach(ProgramTest):
    def workspace(self, text, *words):
        self.write("model.yaml", text)
        return json.loads(self.freeplay("analyze", "workspace", "model.yaml", "--json", *words)[0])

    def messages(self, text):
        self.write("model.yaml", text)
        return json.loads(self.freeplay("validate", "model.yaml", "--json", code=3)[0])["messages"]

    def assert_box(self, document, low, high):
        """Points in reach are those of the box, and its sides are where the boundary lies."""
        rows = [dict(zip(document["columns"], row)) for row in document["rows"]]
        for row in rows:
            inside = all(low[k] - 1e-9 <= row[name] <= high[k] + 1e-9 for k, name in enumerate("xy"))
            self.assertEqual(int(inside), row["reachable"], row)
        for x, y in document["summary"]["boundary"]:
            self.assertLess(min(abs(x - low[0]), abs(x - high[0]), abs(y - low[1]), abs(y - high[1])), 1e-9)

    def test_without_ends_everything_is_in_reach(self):
        summary = self.workspace(TABLE % ("", GRID))["summary"]
        self.assertEqual(summary["points"], summary["reachable"])

    def test_stops_bound_the_reach(self):
        stops = """forces:
  ex: {type: joint-stop, between: [ground/x, long], lower: -0.42, upper: 0.33, stiffness: 1e6}
  ey: {type: joint-stop, between: [long/y, cross/y], lower: -0.21, upper: 0.77, contact: {law: hertz, K: 1e8}}"""
        self.assert_box(self.workspace(TABLE % (stops, GRID)), (-0.42, -0.21), (0.33, 0.77))

    def test_limits_of_the_section_bound_it_too(self):
        document = self.workspace(TABLE % ("", GRID + ", limits: {X: [-0.42 m, 33 cm], Y*: [-0.21, 0.77]}"))
        self.assert_box(document, (-0.42, -0.21), (0.33, 0.77))

    def test_a_slot_with_ends_bounds_it(self):
        text = TABLE.replace("X: {type: prismatic, between: [ground/x, long]}", "X: {type: point-on-line, between: [ground/x, long], "
                             "clearance: {gap: 0.1 mm, slot: [-0.42, 0.33], contact: {law: hertz, K: 1e9}}}\n"
                             "  turn: {type: prismatic, between: [ground/x, long]}")
        document = self.workspace(text % ("", GRID + ", limits: {Y: [-0.21, 0.77]}"))
        self.assert_box(document, (-0.42, -0.21), (0.33, 0.77))

    def test_a_stop_of_a_turn_leaves_a_ring_in_the_plane_and_in_space(self):
        # The distance of the tip from the first pin follows from the angle of the second alone.
        far, near = (math.sqrt(0.13 + 0.12 * math.cos(math.radians(a))) for a in (30, 120))
        for space, inertia, zero, z in (("", 1, "", ""), ("space: spatial\n", [1, 1, 1], ", 0", "")):
            for force in ("stiffness: 100", "radius: 0.1, contact: {law: hertz, K: 1e8}"):
                document = self.workspace(ARM % (space, inertia, zero, inertia, zero, force, z))
                rows = [dict(zip(document["columns"], row)) for row in document["rows"]]
                for row in rows:
                    away = math.hypot(row["x"], row["y"])
                    if min(abs(away - far), abs(away - near)) > 1e-9:
                        self.assertEqual(int(near < away < far), row["reachable"], row)
                self.assertGreater(len(document["summary"]["boundary"]), 100)
                for point in document["summary"]["boundary"]:
                    away = math.hypot(point[0], point[1])
                    self.assertLess(min(abs(away - far), abs(away - near)), 2e-6 * 0.02 * 2 if space else 1e-9)

    def test_legs_of_a_platform_in_space_have_ends(self):
        # Six legs between 0.26 m and 0.38 m: the formula says which points these reach.
        section = "analysis: {frame: platform, grid: {x: {linspace: [-0.16, 0.16, 13]}, y: 0, z: {linspace: [0.5, 0.7, 13]}, yaw: 5 deg}, " \
                  "limits: {L*: [0.26, 0.38]}"
        text = stewart(clearance=False).replace("analysis: {frame: platform", section)
        document = self.workspace(text)
        seen = [0, 0]
        for row in (dict(zip(document["columns"], row)) for row in document["rows"]):
            lengths = leg_lengths(*(row[name] for name in ("x", "y", "z")), 0.0, 0.0, math.radians(5))
            inside = all(0.26 <= length - ROD <= 0.38 for length in lengths)
            seen[inside] += 1
            self.assertEqual(int(inside), row["reachable"], row)
        self.assertGreater(min(seen), 10)
        for x, y, z in document["summary"]["boundary"]:
            lengths = [length - ROD for length in leg_lengths(x, y, z, 0.0, 0.0, math.radians(5))]
            self.assertLess(min(min(abs(l - 0.26), abs(l - 0.38)) for l in lengths), 1e-8)

    def test_a_pose_beyond_an_end_says_which(self):
        self.write("model.yaml", TABLE % ("", "limits: {X: [-0.42, 0.33]}"))
        out, err = self.freeplay("analyze", "workspace", "model.yaml", "--pose", "0.35,0")
        row, = csv.DictReader(io.StringIO(out))
        self.assertEqual("0", row["reachable"])
        self.assertIn("joint 'X' would stand at 0.35 m, beyond the end of its way at 0.33 m", err)
        self.freeplay("analyze", "ik", "model.yaml", "--pose", "0.35,0")  # where its drivers must stand is no matter of reach

    def test_options_win_over_the_grid_of_the_file(self):
        summary = self.workspace(TABLE % ("", GRID), "--grid", "x=0:0.5:3")["summary"]
        self.assertEqual((3 * 41, [0, 0.5]), (summary["points"], summary["bounds"]["x"]))

    def test_what_is_wrong_in_the_section_has_its_place(self):
        for key, id_, says in (("limits: {Z: [0, 1]}", "unknown-name", ""), ("limits: {Z*: [0, 1]}", "unknown-name", "no joint matches"),
                               ("limits: {X: [1, 0]}", "out-of-range", "the lowest below the highest"),
                               ("limits: {X: [0 deg, 1]}", "dimension-mismatch", ""), ("limits: {X: 1}", "wrong-type", ""),
                               ("limits: {X: [0, 1, 2]}", "wrong-length", ""), ("grid: {z: 0}", "type-space", "in the plane, which has x, y, angle"),
                               ("grid: {x: 0, yy: 0}", "unknown-key", "")):
            found = self.messages(TABLE % ("", key))[0]
            self.assertEqual((id_, 8), (found["id"], found["line"]), found)
            self.assertIn(says, found["message"])


if __name__ == "__main__":
    unittest.main()
