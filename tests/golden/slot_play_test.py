"""Pins with play in a slot: walls and round ends, start, friction, and mistakes."""
import csv
import json
import unittest

from model_cases import EXACT, ModelTest

SLOT = """
gravity: [%s]
bodies: {pin: {mass: 2, inertia: 0.01}}
joints: {G: {type: point-on-line, between: [%s, pin], clearance: {%s, contact: {law: hertz, K: 1e9}%s}}}
%s
simulation: {end: %s, %s, output: {interval: 0.1 ms}}
"""
FINE = "integrator: verner7, step: {size: 10 us, adaptive: true, tolerance: 1e-11}"
KEYS = "pin_radius: 5 mm, gap: 0.2 mm"


def slot(gravity="0, -9.81", frame="ground", keys=KEYS, rest="", more="", end="20 ms", simulation=EXACT):
    return SLOT % (gravity, frame, keys, rest, more, end, simulation)


class PinInSlot(ModelTest):
    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_facts_with_and_without_play(self):
        self.facts(slot(), clearance_joints=1, constraints=0, dof=3)
        self.facts(slot(), "--ideal", "G", clearance_joints=0, constraints=1, dof=2)

    def test_its_ideal_twin_has_the_bytes_of_the_joint_without_the_block(self):
        text = slot(gravity="1, -9.81")
        begin, end = text.index(", clearance:"), text.index("}}}}") + 2
        for model, options in ((text, ("--ideal", "all")), (text[:begin] + text[end:], ())):
            self.freeplay("run", self.model(model), "--out", "ideal" + str(len(options)), "--quiet", *options)
        self.assertEqual(self.read("ideal2", "results.csv"), self.read("ideal0", "results.csv"))

    def test_it_rests_where_statics_puts_it(self):
        depth = (2 * 9.81 / 1e9) ** (2 / 3)
        turned = "frames: {ground/wall: {angle: 180 deg}}"
        for text, side in ((slot(rest=", initial: loaded"), -1.0), (slot(rest=", initial: loaded", frame="ground/wall", more=turned), 1.0)):
            columns = self.run_model(text)
            self.assert_column(columns, "joint.G.shift", lambda t: side * (2e-4 + depth), 1e-12)
            self.assert_column(columns, "joint.G.fn", lambda t: 2 * 9.81, 1e-6)

    def test_it_flies_along_the_slot_and_meets_its_round_end(self):
        """From the middle with 1 m/s: the end stands 3 mm away, and the play beyond it."""
        keys = KEYS + ", slot: [-3 mm, 3 mm]"
        more = "initial: {speeds: {G: 1 m/s}}"
        columns = self.run_model(slot(gravity="0, 0", keys=keys, more=more, end="5 ms", simulation=FINE))
        begin = next(event for event in self.events() if event["kind"] == "contact_begin")
        self.assertLess(abs(float(begin["time"]) - 3.2e-3), 1e-9)
        self.assertLess(abs(float(begin["speed"]) - 1.0), 1e-9)
        self.assertLess(abs(float(begin["direction"])), 1e-12)
        self.assertLess(abs(columns["body.pin.vx"][45] + 1.0), 1e-6)
        self.assertAlmostEqual(2e-4, columns["joint.G.beyond"][32], delta=1e-6)

    def test_round_and_straight_parts_meet_smoothly(self):
        """A pin that slides along the wall follows the round end without a jump of its force."""
        keys, more = KEYS + ", slot: [-0.1 m, 1 mm]", "initial: {speeds: {G: 0.02 m/s}}"
        columns = self.run_model(slot(keys=keys, more=more, rest=", initial: loaded", end="60 ms"))
        at = next(i for i, x in enumerate(columns["joint.G.beyond"]) if x > 0.0)
        forces = columns["joint.G.fn"][at - 3:at + 3]
        self.assertLess(max(abs(b - a) for a, b in zip(forces, forces[1:])), 0.2)
        summary = json.loads(self.read("out", "summary.json"))
        self.assertLess(summary["residuals"]["energy_max"], 1e-9)

    def test_friction_turns_the_pin_at_its_surface(self):
        rest = ", initial: loaded, friction: {law: coulomb-tanh, mu: 0.2, vs: 1 mm/s}"
        columns = self.run_model(slot(rest=rest, more="initial: {speeds: {G: 1 m/s}}", end="2 ms"))
        moment = 0.2 * 2 * 9.81 * 5e-3
        self.assertAlmostEqual(-0.2 * 9.81, (columns["body.pin.vx"][-1] - 1.0) / 2e-3, delta=1e-4)
        self.assertAlmostEqual(-moment / 0.01, columns["body.pin.omega"][-1] / 2e-3, delta=1e-2)

    def test_a_start_past_the_end_of_the_slot_is_warned_of(self):
        laws = "contact: {law: hertz, K: 1e9}"
        head, tail = slot().split("clearance: {")[0], "}}}\ninitial: {joints: {G: 30 mm}}\nsimulation: {end: 1 ms}\n"
        text = head + "clearance: {pin_radius: 5 mm, gap: 0.2 mm, slot: [-10 mm, 10 mm], " + laws + tail
        messages = self.facts(text)["messages"]
        self.assertEqual(["doubtful-clearance"], [message["id"] for message in messages if message["id"].startswith("doubtful-c")])

    def test_mistakes_have_place_and_remedy(self):
        laws = "contact: {law: hertz, K: 1e9}"
        head, tail = slot().split("clearance: {")[0], "}}}\nsimulation: {end: 1 ms}\n"
        for keys, expected in (
                ("pin_radius: 5 mm, " + laws, {"id": "missing-key", "line": 5}),
                ("pin_radius: 5 mm, slot_width: 10 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("pin_radius: 5 mm, slot_width: 10.4 mm, gap: 0.3 mm, " + laws, {"id": "conflicting-keys", "line": 5}),
                ("slot_width: 10 mm, gap: 5 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("gap: 0, " + laws, {"id": "out-of-range", "line": 5}),
                ("pin_radius: 1 mm, gap: 2 mm, " + laws, {"id": "out-of-range", "line": 5}),
                ("gap: 1 mm, slot: [2 mm, 1 mm], " + laws, {"id": "out-of-range", "line": 5}),
                ("gap: 1 mm, slott: [1 mm, 2 mm], " + laws, {"id": "unknown-key", "suggestion": "slot"}),
                ("gap: 1 mm, friction: {law: coulomb-tanh, mu: 0.1}, " + laws, {"id": "missing-key"}),
                ("gap: 1 mm, contact: hertz", {"id": "missing-key"}),
                ("gap: 1 mm, initial: {eccentricity: [0, 1.1 mm]}, " + laws, {"id": "out-of-range"}),
                ("gap: 1 mm, initial: {eccentricity: [1 mm, 0]}, " + laws, {"id": "out-of-range"})):
            with self.subTest(keys):
                self.refusal(head + "clearance: {" + keys + tail, **expected)

    def test_a_slot_in_space_has_no_play(self):
        text = slot(gravity="0, 0, -9.81").replace("inertia: 0.01", "inertia: [0.01, 0.01, 0.01]")
        self.refusal(text, head="freeplay: 1\nspace: spatial\n", id="type-space")


if __name__ == "__main__":
    unittest.main()
