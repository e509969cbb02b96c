"""Joints with clearance: what their block says is what the journal does."""
import csv
import math
import unittest

from model_cases import ModelTest

BLOCK = "{radial_clearance: 0.2 mm, contact: {law: hertz, K: 1e9 N/m^1.5}%s}"


class Clearance(ModelTest):
    def pin(self, block, rest="", body="mass: 2, inertia: 0.01"):
        return """
gravity: [0, -9.81]
bodies: {pin: {%s}}
joints: {B: {type: revolute, between: [ground, pin], clearance: %s}}
simulation: {end: 20 ms, step: 5 us, output: {interval: 0.1 ms}%s}
""" % (body, block, rest)

    def test_facts_with_and_without_play(self):
        text = self.pin(BLOCK % "")
        verdict = self.facts(text, clearance_joints=1, constraints=0, dof=3)
        self.assertEqual({"constraints": 2, "rank": 2, "redundant": 0, "dof": 1, "dof_driven": 1,
                          "driver_redundant": 0}, verdict["facts"]["ideal"])
        self.facts(text, "--ideal", "B", clearance_joints=0, constraints=2, dof=1)
        other = text.replace("type: revolute,", "type: revolute-clearance,")
        self.facts(other, clearance_joints=1, dof=3)
        self.refusal(other[:other.index(", clearance")] + "}}\n", id="missing-key", line=5, column=10)

    def test_a_journal_rests_where_statics_puts_it(self):
        columns = self.run_model(self.pin(BLOCK % ", initial: loaded"))
        depth = (2 * 9.81 / 1e9) ** (2 / 3)
        self.assert_column(columns, "joint.B.ey", lambda t: -(2e-4 + depth), 1e-12)
        self.assert_column(columns, "joint.B.delta", lambda t: depth, 1e-12)
        self.assert_column(columns, "joint.B.fn", lambda t: 2 * 9.81, 1e-6)

    def test_a_journal_starts_where_the_model_puts_it_and_falls(self):
        block = BLOCK % ', initial: {eccentricity: [50 um, "0.1 mm"], velocity: [2 mm/s, 0]}'
        columns = self.run_model(self.pin(block, ", stop: [{channel: joint.B.delta, above: 0}]"))
        self.assert_column(columns, "joint.B.ex", lambda t: 5e-5 + 2e-3 * t, 1e-12)
        self.assert_column({k: v[:-1] for k, v in columns.items()}, "joint.B.ey", lambda t: 1e-4 - 9.81 / 2 * t * t,
                           1e-10)
        self.assertLess(0, columns["joint.B.delta"][-1])

    def test_a_linear_contact_bounces_after_half_a_period(self):
        block = "{radial_clearance: 1 mm, contact: {law: kelvin-voigt, K: 8e5 N/m, D: 0 N*s/m}, " \
                "initial: {eccentricity: [0, -1 mm], velocity: [0, -0.1 m/s]}}"
        text = self.pin(block).replace("gravity: [0, -9.81]\n", "")
        columns = self.run_model(text)
        w = math.sqrt(8e5 / 2)
        inside = [t for t, on in zip(columns["time"], columns["joint.B.contact"]) if on]
        self.assertAlmostEqual(math.pi / w, max(inside), delta=1.1e-4)
        first = {k: v[:40] for k, v in columns.items()}
        self.assert_column(first, "joint.B.delta", lambda t: 0.1 / w * math.sin(w * t), 1e-8)
        self.assertAlmostEqual(0.1, columns["body.pin.vy"][-1], places=6)

    def test_radii_agree_or_are_refused(self):
        self.facts(self.pin("{bearing_radius: 10 mm, journal_radius: 9.8 mm, contact: {law: hertz, K: 1e9}}"))
        self.facts(self.pin("{bearing_radius: 10 mm, journal_radius: 9.8 mm, radial_clearance: 0.2 mm, "
                            "contact: {law: hertz, K: 1e9}}"))
        self.refusal(self.pin("{bearing_radius: 10 mm, journal_radius: 9.8 mm, radial_clearance: 0.3 mm, "
                              "contact: {law: hertz, K: 1e9}}"), id="conflicting-keys", line=5)
        self.refusal(self.pin("{radial_clearance: 0.3 mm, contact: hertz}"), id="missing-key", line=5)
        self.refusal(self.pin("{bearing_radius: 1 mm, contact: {law: hertz, K: 1e9}}"), id="missing-key", line=5)
        self.refusal(self.pin("{radial_clearance: 0.3 mm, contact: {law: hertz, K: 1e9}, friction: {law: "
                              "coulomb-tanh, mu: 0.1}}"), id="missing-key", line=5)
        self.refusal(self.pin("{radial_clearance: 0.3 mm, contact: {law: hertz, K: 1e9, exponent: 4}}"),
                     id="out-of-range", line=5)
        self.refusal(self.pin("{bearing_radius: 10 mm, radial_clearance: 0.3 mm, contact: {law: hertz, exponent: 2}, "
                              "material: {E: 200 GPa, nu: 0.3}}"), id="missing-key", line=5)
        self.refusal(self.pin("{bearing_radius: 10 mm, radial_clearance: 0.3 mm, contact: {law: herz}, "
                              "material: {E: 200 GPa, nu: 0.3}}"), id="unknown-type", line=5, suggestion="hertz")
        self.refusal(self.pin("{bearing_radius: 10 mm, radial_clearance: 0.3 mm, contact: {law: hertz}, "
                              "material: {E: 200 GPa, nu: 0.5}}"), id="out-of-range", line=5)
        self.refusal(self.pin("{bearing_radius: 10 mm, radial_clearance: 0.3 mm, contact: {law: hertz}, "
                              "material: {bearing: {E: 200 GPa, nu: 0.3}}}"), id="missing-key", line=5)


MOVED_WALL = """%s
bodies:
  carrier: {mass: 0.25, inertia: %s, frames: {F: %s}}
  wall: {mass: 1e30, inertia: %s, frames: {F: %s}}
joints:
  rail: {type: prismatic, between: [ground, carrier]%s}
  B: {type: %s, between: [carrier/F, wall/F], clearance: {%s, initial: %s, contact: {law: hertz, K: 1e9}}}
drivers:
  motor: {joint: rail, kind: position, value: 0.9765625 mm + 64 m/s^2 * (t - 1.953125 ms) * (3.90625 ms - t)}
simulation: {end: 7.8125 ms, %s, output: {interval: 0.9765625 ms}}
"""
PLAY = "0.9765625 mm"
AHEAD = "{eccentricity: [-0.48828125 mm, 0], velocity: [-0.375 m/s, 0]}"
ACROSS = "{eccentricity: [0, -0.48828125 mm], velocity: [0, -0.375 m/s]}"
IN_SPACE = "{eccentricity: [-0.48828125 mm, 0, 0], velocity: [-0.375 m/s, 0, 0]}"


class EventsAtTheEndsOfSteps(ModelTest):
    """Bodies that are moved through their play: all numbers are sums of few powers of two, so that penetrations are
    zero, and not nearly so, at 8 and 16 steps."""

    def moved(self, kind, play, initial, simulation, frame="[0, 0]", spatial=False):
        light, heavy = ("[1e-5, 1e-5, 1e-5]", "[1e30, 1e30, 1e30]") if spatial else ("1e-5", "1e30")
        return MOVED_WALL % ("space: spatial" if spatial else "", light, frame, heavy, frame,
                             ", axis: [1, 0, 0]" if spatial else "", kind, play, initial, simulation)

    def test_every_contact_has_one_begin_and_one_end(self):
        pin = ("revolute", "radial_clearance: " + PLAY, AHEAD)
        slide = ("prismatic", "length: 40 mm, gap: " + PLAY, ACROSS)
        steps = "step: 0.244140625 ms, integrator: "
        cases = [(*pin, steps + method) for method in ("bathe", "newmark", "hht", "generalized-alpha")]
        cases += [(*pin, "accuracy: 1 nm, integrator: " + method)
                  for method in ("bathe", "newmark", "hht", "generalized-alpha", "dopri5", "verner6", "verner7", "arkode")]
        cases += [(*slide, steps + "bathe", "{angle: -90 deg}"), (*slide, "accuracy: 1 nm", "{angle: -90 deg}")]
        ball = ("spherical", "radial_clearance: " + PLAY, IN_SPACE)
        bearing = ("revolute, axis: [0, 0, 1]", "length: 20 mm, bearing_radius: 10 mm, radial_clearance: " + PLAY, IN_SPACE)
        cases += [(*joint, simulation, "[0, 0, 0]", True) for joint in (ball, bearing)
                  for simulation in (steps + "bathe", "accuracy: 1 nm")]
        # The penetration ends at its zero to rounding, or rises from there and back within one step.
        for frame, simulation in (("[1.0, 0.0625, 0.375]", "accuracy: 1 um, integrator: generalized-alpha"),
                                  ("[0, -0.5, 1.0]", "accuracy: 0.1 nm, integrator: verner7"),
                                  ("[-0.5, 0.125, 0.125]", "accuracy: 0.1 nm, integrator: verner6")):
            cases.append((*ball, simulation, frame, True))
        for case in cases:
            with self.subTest(case=case):
                self.run_model(self.moved(*case))
                events = list(csv.DictReader(self.read("out", "events.csv").splitlines()))
                contacts = 2 if "length" in case[1] else 1
                self.assertEqual(["contact_begin"] * contacts + ["contact_end"] * contacts,
                                 [event["kind"][event["kind"].index("contact"):] for event in events])
                for event, time in zip(events, [1.953125e-3] * contacts + [3.90625e-3] * contacts):
                    self.assertAlmostEqual(time, float(event["time"]), delta=1e-9)
                    self.assertAlmostEqual(0.125, float(event["speed"]), delta=1e-6)


if __name__ == "__main__":
    unittest.main()
