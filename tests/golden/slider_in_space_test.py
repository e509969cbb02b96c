"""Sliders with play in space: eight corners before four walls; in the plane they are the slider of the plane."""
import csv
import json
import math
import unittest

from model_cases import ModelTest

BLOCK = """
space: spatial
gravity: [%s]
bodies: {block: {mass: 2, inertia: [2e-3, 3e-3, 4e-3], pose: {position: [%s]}%s}}
joints: {G: {type: prismatic, between: [ground, block], axis: [%s], clearance: {%s, contact: {law: hertz, K: 1e9}%s}}}
simulation: {end: %s, %s, output: {interval: 0.5 ms}}
"""
KEYS = "width: 40 mm, height: 30 mm, length: 100 mm, gap: 0.2 mm"
FINE = "integrator: dopri5, accuracy: 0.01 nm"


def block(gravity="0, -9.81, 0", position="0, 0, 0", velocity="", axis="1, 0, 0", keys=KEYS, rest="", end="20 ms", simulation=FINE):
    return BLOCK % (gravity, position, velocity, axis, keys, rest, end, simulation)


class BlockInSpace(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_facts_with_and_without_play(self):
        self.facts(block(), clearance_joints=1, constraints=0, dof=6)
        self.facts(block(), "--ideal", "G", clearance_joints=0, constraints=5, dof=1)

    def test_its_ideal_twin_has_the_bytes_of_the_joint_without_the_block(self):
        text = block(velocity=", velocity: {linear: [0.3, 0, 0]}", gravity="1, -9.81, 2")
        begin, end = text.index(", clearance:"), text.index("}}}\nsimulation") + 1
        for model, options in ((text, ("--ideal", "all")), (text[:begin] + text[end:], ())):
            self.freeplay("run", self.model(model), "--out", "ideal" + str(len(options)), "--quiet", *options)
        self.assertEqual(self.read("ideal2", "results.csv"), self.read("ideal0", "results.csv"))

    def test_in_the_plane_it_moves_as_the_slider_of_the_plane(self):
        """Two opposite corners, then a side, with friction: bounces, slides and rocks; both are the same to rounding."""
        for law in ("law: coulomb-tanh, mu: 0.1, vs: 1 mm/s", "law: lugre, mu_s: 0.2, mu_k: 0.1, v_stribeck: 10 mm/s, sigma0: 1e4, sigma1: 10"):
            friction = ", friction: {%s}" % law
            deep = self.run_model(block(velocity=", velocity: {linear: [0.4, -0.02, 0], angular: [0, 0, 0.5]}", rest=friction))
            flat = self.run_model(block(velocity=", velocity: {linear: [0.4, -0.02], angular: 0.5}", rest=friction, gravity="0, -9.81",
                                        position="0, 0", keys=KEYS.replace("height: 30 mm, ", "")).replace(", axis: [1, 0, 0]", "").replace(
                                            "space: spatial\n", "").replace("inertia: [2e-3, 3e-3, 4e-3]", "inertia: 4e-3"))
            self.assertGreater(max(flat["joint.G.fn"]), 10.0)
            for one, other, tolerance in (("body.block.x", "body.block.x", 1e-12), ("body.block.y", "body.block.y", 1e-12),
                                          ("joint.G.shift", "joint.G.shift_y", 1e-12), ("joint.G.tilt", "joint.G.tilt_z", 1e-11),
                                          ("joint.G.fn", "joint.G.fn", 1e-6), ("joint.G.ft", "joint.G.ft", 1e-6)):
                for x, y in zip(flat[one], deep[other], strict=True):
                    self.assertAlmostEqual(x, y, delta=tolerance, msg=one)
            for name in ("shift_z", "tilt_x", "tilt_y", "front_upper_right_z_fn"):
                self.assertLess(max(map(abs, deep["joint.G." + name])), 1e-12, name)

    def test_it_rests_where_statics_puts_it_and_its_gap_closes_to_the_ideal_slider(self):
        """Four corners of each side carry half of the law each; y and z by themselves."""
        for gap in (4e-4, 2e-4, 1e-4):
            columns = self.run_model(block(gravity="0, -6, 8", rest=", initial: loaded", end="5 ms",
                                           keys="width: 40 mm, height: 30 mm, length: 100 mm, gap: %r" % gap))
            for name, force in (("y", -12.0), ("z", 16.0)):
                place = math.copysign(gap + (abs(force) / 2e9) ** (2 / 3), force)
                self.assert_column(columns, "body.block." + name, lambda t: place, 1e-12)
            self.assert_column(columns, "joint.G.fn", lambda t: 28.0, 1e-6)
            self.assert_column(columns, "joint.G.rear_lower_left_y_fn", lambda t: 3.0, 1e-6)

    def test_energy_is_kept_as_it_tumbles_between_its_walls(self):
        columns = self.run_model(block(gravity="0, 0, 0", end="40 ms", axis="0, 0.6, 0.8",
                                       velocity=", velocity: {linear: [20 mm/s, 10 mm/s, 0.1], angular: [3, 0.4, 0.3]}"))
        begins = {event["kind"] for event in self.events() if event["kind"].endswith("contact_begin")}
        self.assertGreater(len(begins), 8)
        self.assertLess(max(abs(x) for x in columns["energy.residual"]), 1e-9)
        self.assertLess(max(columns["joint.G.delta"]), 1e-4)

    def test_it_turns_about_its_guide_until_its_edges_touch(self):
        """hypot(B, B_z) cos(atan(B/B_z) - angle) = B_z + g: the sides across z are met first, front and rear at once."""
        self.run_model(block(gravity="0, 0, 0", velocity=", velocity: {angular: [2, 0, 0]}", end="8 ms"))
        begins = [event for event in self.events() if event["kind"].endswith("contact_begin")]
        angle = math.atan2(0.02, 0.015) - math.acos(0.0152 / math.hypot(0.02, 0.015))
        self.assertEqual({"front_upper_right_z_contact_begin", "rear_upper_right_z_contact_begin", "front_lower_left_z_contact_begin",
                          "rear_lower_left_z_contact_begin"}, {event["kind"] for event in begins[:4]})
        for event in begins[:4]:
            self.assertAlmostEqual(angle / 2.0, float(event["time"]), delta=1e-10)
            self.assertAlmostEqual(2.0 * (0.02 * math.cos(angle) - 0.015 * math.sin(angle)), float(event["speed"]), delta=1e-8)

    def test_it_starts_where_its_block_says_in_the_axes_of_the_guide(self):
        """Axis x of the guide is y of the world; its y is -x then."""
        rest = ', initial: {eccentricity: [0, "0.1 mm", "-0.15 mm"], velocity: [0, 3 mm/s, 0]}'
        columns = self.run_model(block(gravity="0, 0, 0", axis="0, 1, 0", rest=rest, end="5 ms"))
        self.assert_column(columns, "joint.G.shift_y", lambda t: 1e-4 + 3e-3 * t, 1e-12)
        self.assert_column(columns, "joint.G.shift_z", lambda t: -1.5e-4, 1e-12)
        self.assert_column(columns, "body.block.x", lambda t: -1e-4 - 3e-3 * t, 1e-12)

    def test_a_driver_moves_it_along_while_the_rest_floats(self):
        text = block(gravity="0, 0, 0").replace("simulation:", "drivers: {push: {joint: G, kind: position, value: 2*t^2}}\nsimulation:")
        columns = self.run_model(text)
        self.assert_column(columns, "joint.G.position", lambda t: 2 * t * t, 1e-10)
        self.assertEqual(0.0, max(columns["joint.G.contact"]))

    def test_errors_of_a_platform_are_those_of_its_corners(self):
        """|y| + l |rz| + h |rx| <= g and |z| + l |ry| + b |rx| <= g_z, with half sizes: what is linear is largest at a corner of that, with
        t = |rx| at 0 or where the first of both is used up."""
        keys, tip = KEYS + ", gap_height: 0.5 mm", (0.3, 0.05, -0.04)
        text = block(keys=keys).replace("simulation:", "drivers: {push: {joint: G, kind: position, value: 0}}\nsimulation:").replace(
            "block: {", "block: {frames: {tip: [%r, %r, %r]}, " % tip)
        self.model(text)
        out, _ = self.freeplay("analyze", "error", "m.yaml", "--frame", "block/tip", "--input", "G=0", "--samples", "400")
        row = {name: float(value) for name, value in next(csv.DictReader(out.splitlines())).items()}
        half_length, half_width, half_height, gap, gap_height = 0.05, 0.02, 0.015, 2e-4, 5e-4

        corners, farthest = [], 0.0
        for turn in (0.0, min(gap / half_height, gap_height / half_width)):
            first, second = gap - half_height * turn, gap_height - half_width * turn
            for y, rz in ((first, 0.0), (-first, 0.0), (0.0, first / half_length), (0.0, -first / half_length)):
                for z, ry in ((second, 0.0), (-second, 0.0), (0.0, second / half_length), (0.0, -second / half_length)):
                    for rx in (turn, -turn):
                        corners.append((ry * tip[2] - rz * tip[1], y + rz * tip[0] - rx * tip[2], z + rx * tip[1] - ry * tip[0], rx, ry, rz))
        for i, name in enumerate(("dx", "dy", "dz", "drx", "dry", "drz")):
            self.assertAlmostEqual(1.0, row[name] / max(abs(corner[i]) for corner in corners), delta=1e-9, msg=name)
        farthest = max(math.hypot(*corner[:3]) for corner in corners)
        self.assertAlmostEqual(1.0, row["position"] / farthest, delta=1e-7)
        self.assertAlmostEqual(1.0, row["ls_position"] / farthest, delta=1e-7)
        self.assertAlmostEqual(1.0, row["dangle"] / max(math.hypot(*corner[3:]) for corner in corners), delta=1e-7)
        self.assertLess(row["sample_max_position"], farthest)
        self.assertGreater(row["sample_max_position"], 0.4 * farthest)

    def test_errors_grow_with_either_gap(self):
        """Which joint has how much of the error, by the play of each."""
        text = block(keys=KEYS + ", gap_height: 0.5 mm").replace("simulation:", "drivers: {push: {joint: G, kind: position, value: 0}}\nsimulation:")
        self.model(text)
        out, _ = self.freeplay("analyze", "error", "m.yaml", "--frame", "block", "--input", "G=0", "--json")
        worst = json.loads(out)["summary"]["worst"]
        self.assertAlmostEqual(math.hypot(2e-4, 5e-4), worst["share"]["joint.G"], delta=1e-10)

    def test_mistakes_have_place_and_remedy(self):
        for keys, expected in (
                ("width: 40 mm, length: 100 mm, gap: 1 mm", {"id": "missing-key", "line": 6}),
                ("gap: 1 mm, length: 100 mm", {"id": "missing-key", "line": 6}),
                ("gap: 1 mm, width: 4 cm, height: 3 cm", {"id": "missing-key", "line": 6}),
                (KEYS + ", gap_heigth: 1 mm", {"id": "unknown-key", "suggestion": "gap_height"}),
                (KEYS + ", guide_height: 32 mm, gap_height: 2 mm", {"id": "conflicting-keys"}),
                (KEYS + ", gap_height: 31 mm", {"id": "out-of-range"}),
                ("gap: 40 mm, width: 40 mm, height: 90 mm, length: 100 mm", {"id": "out-of-range"}),
                ("gap: 2 mm, width: 40 mm, height: 30 mm, length: 4 mm", {"id": "out-of-range"}),
                ("gap: 2 mm, width: 40 mm, guide_height: 4 mm, length: 100 mm", {"id": "out-of-range"}),
                (KEYS + ", initial: {angle: 1 mrad}", {"id": "type-space"}),
                (KEYS + ", initial: {eccentricity: [0, 0, 0.21 mm]}", {"id": "out-of-range"}),
                (KEYS + ", initial: {eccentricity: [1 mm, 0, 0]}", {"id": "out-of-range"})):
            with self.subTest(keys):
                self.refusal(block(keys=keys), **expected)

    def test_a_planar_slider_has_no_height(self):
        text = block(gravity="0, -9.81", position="0, 0").replace("space: spatial\n", "").replace("[2e-3, 3e-3, 4e-3]", "4e-3").replace(", axis: [1, 0, 0]", "")
        self.refusal(text, id="type-space")


if __name__ == "__main__":
    unittest.main()
