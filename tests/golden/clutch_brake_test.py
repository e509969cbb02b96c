"""Brakes that hold and slip, clutches that run free one way, in the plane and in space, against formulas."""
import csv
import json
import math
import unittest

from joint_limits_models_test import SPACES
from model_cases import EXACT, ModelTest


def swing(start, speed, damping, frequency):
    """Place and speed of a damped oscillator, x'' = -frequency^2 x - 2 damping x', damping below frequency."""
    wd = math.sqrt(frequency ** 2 - damping ** 2)

    def at(t):
        c, s, fall = math.cos(wd * t), math.sin(wd * t), math.exp(-damping * t)
        x = fall * (start * c + (speed + damping * start) / wd * s)
        return x, fall * (speed * c - (damping * speed + frequency ** 2 * start) / wd * s)
    return at


def release(damping, frequency):
    """When the pull of an oscillator that begins at x = 0 is back at zero: frequency^2 x + 2 damping x' = 0."""
    wd = math.sqrt(frequency ** 2 - damping ** 2)
    return (math.pi - math.atan2(2 * damping * wd, frequency ** 2 - 2 * damping ** 2)) / wd


class Couplings(ModelTest):
    def columns_of(self, linear, rotational, more, end="0.5 s", steps=EXACT):
        for space, (model, ground) in SPACES.items():
            with self.subTest(space=space):
                yield self.run_model("""%s
forces:
  a: {kind: linear, between: [%s, block], %s}
  b: {between: [%s, wheel], %s}
%s
simulation: {end: %s, output: {interval: 10 ms}, %s}
""" % (model, ground, linear, ground, rotational, more, end, steps))

    def events(self):
        with open(self.path("out", "events.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_brake_takes_speed_evenly_and_holds_from_rest_on(self):
        # m = 2 kg, 5 N; I = 0.5 kg m^2, 1.5 N m
        at_rest = {"slide": (1.2, swing(5 / 2000, 0, 2.5, math.sqrt(1000)), 1),
                   "pin": (4 / 3, swing(1.5 / 300, 0, 3, math.sqrt(600)), -1)}
        for columns in self.columns_of("type: brake, limit: 5 N, stiffness: 2000 N/m, relaxation: 5 ms",
                                       "type: brake, limit: 1.5 N*m, stiffness: 300 N*m/rad, relaxation: 10 ms",
                                       "initial: {speeds: {slide: 3, pin: -4}}", "2 s"):
            for name, rate in (("slide", 3 - 2.5j), ("pin", -4 + 3j)):
                stop, after, sense = at_rest[name]
                self.assert_column(columns, "joint.%s.speed" % name, lambda t: rate.real + rate.imag * t if t < stop
                                   else sense * after(t - stop)[1], 1e-7)
            for name, stop in (("a", 1.2), ("b", 4 / 3)):
                for t, slips in zip(columns["time"], columns["force.%s.slipping" % name]):
                    self.assertTrue(abs(t - stop) < 1e-6 or (slips == 1) == (t < stop), t)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)
            times = {event["joint"]: float(event["time"]) for event in self.events() if event["kind"].startswith("stick")}
            self.assertAlmostEqual(1.2, times["a"], delta=1e-6)
            self.assertAlmostEqual(4 / 3, times["b"], delta=1e-6)

    def test_a_brake_holds_a_load_without_creep_until_its_limit_falls_below_it(self):
        # Critical damping, so that all is at rest after a second: 4 N and 1 N m are held; slip begins at 1.2 s.
        critical = 2 / math.sqrt(1000)
        for space, (model, ground) in SPACES.items():
            columns = self.run_model("""%s
forces:
  a: {type: brake, kind: linear, between: [%s, block], limit: 10 N - 5 N/s*t, stiffness: 2000, relaxation: %r s}
  b: {type: brake, between: [%s, wheel], limit: 2.5 N*m - 1.25 N*m/s*t, stiffness: 500, relaxation: %r s}
drivers:
  pull: {joint: slide, kind: force, value: 4}
  turn: {joint: pin, kind: torque, value: 1}
simulation: {end: 1.8 s, output: {interval: 10 ms}, %s}
""" % (model, ground, critical, ground, critical, EXACT))
            for k, t in enumerate(columns["time"]):
                if 1 < t < 1.2:
                    self.assertAlmostEqual(4 / 2000, columns["joint.slide.position"][k], delta=1e-10)
                    self.assertAlmostEqual(1 / 500, columns["joint.pin.angle"][k], delta=1e-10)
                if t > 1:
                    slip = max(0.0, t - 1.2)
                    self.assertAlmostEqual(1.25 * slip ** 2, columns["joint.slide.speed"][k], delta=1e-8)
                    self.assertAlmostEqual(1.25 * slip ** 2, columns["joint.pin.speed"][k], delta=1e-8)
            self.assertLess(max(map(abs, columns["energy.residual"])), 1e-8)

    def test_a_clutch_runs_free_one_way_and_throws_back_what_comes_the_other_way(self):
        # The wheel: I = 0.5 kg m^2, frequency 40 rad/s, 4 rad/s of damping.
        after = swing(0, -3, 4, 40)
        back = release(4, 40)
        for columns in self.columns_of("type: one-way-clutch, stiffness: 100 N/m",
                                       "type: one-way-clutch, locks: negative, stiffness: 800 N*m/rad, relaxation: 5 ms",
                                       "initial: {speeds: {slide: -2, pin: -3}}"):
            self.assert_column(columns, "joint.slide.speed", lambda t: -2, 1e-12)
            self.assert_column(columns, "joint.pin.speed", lambda t: after(min(t, back))[1], 1e-8)
            self.assertLess(max(map(abs, columns["energy.residual"])), 2e-8)
            kinds = [(event["joint"], event["kind"]) for event in self.events()]
            self.assertEqual(1, kinds.count(("b", "release")))
            self.assertFalse([kind for kind in kinds if kind[0] == "a"])
            time = next(float(event["time"]) for event in self.events() if event["kind"] == "release")
            self.assertAlmostEqual(back, time, delta=1e-6)

    def test_a_clutch_between_two_wheels_keeps_their_momentum(self):
        text = """
bodies: {motor: {mass: 1, inertia: 0.2}, drum: {mass: 1, inertia: 0.3}}
joints:
  m: {type: revolute, between: [ground, motor]}
  d: {type: revolute, between: [ground, drum]}
forces: {c: {type: one-way-clutch, locks: %s, between: [%s], stiffness: 192 N*m/rad, relaxation: 5 ms}}
initial: {speeds: {m: 5, d: 1}}
simulation: {end: 0.3 s, output: {interval: 10 ms}, %s}
"""
        # 0.12 kg m^2 between them: 40 rad/s, 4 rad/s of damping
        speed = swing(0, 4, 4, 40)(release(4, 40))[1]
        for locks, pair in (("positive", "drum, motor"), ("negative", "motor, drum")):
            columns = self.run_model(text % (locks, pair, EXACT))
            self.assert_column({"time": columns["time"], "sum": [
                0.2 * m + 0.3 * d for m, d in zip(columns["joint.m.speed"], columns["joint.d.speed"])]},
                "sum", lambda t: 1.3, 1e-10)
            self.assertAlmostEqual(speed, columns["joint.m.speed"][-1] - columns["joint.d.speed"][-1], delta=1e-8)
        columns = self.run_model(text % ("negative", "drum, motor", EXACT))
        self.assert_column(columns, "joint.m.speed", lambda t: 5, 1e-12)

    def test_a_clutch_with_a_limit_slips_at_it(self):
        for columns in self.columns_of("type: one-way-clutch, stiffness: 1e5, limit: 3 N",
                                       "type: one-way-clutch, locks: negative, stiffness: 1e4, limit: 1 N*m + 1 N*m/s*t",
                                       "initial: {speeds: {slide: 2, pin: -3}}"):
            self.assert_column(columns, "joint.slide.speed", lambda t: 2 - 1.5 * t, 1e-9)
            self.assert_column(columns, "joint.pin.speed", lambda t: -3 + 2 * t + t * t, 1e-9)
            self.assert_column(columns, "force.a.slipping", lambda t: 1.0)

    def test_a_limit_that_rises_from_nothing_is_taken_up_by_every_integrator(self):
        # The wheel of 0.5 kg m^2 loses what the limit takes: 12 N m smooth(t, 0.1 s, 0.2 s), 0.6 N m s up to 0.2 s.
        for integrator in ("bathe", "newmark", "hht", "generalized-alpha", "dopri5"):
            with self.subTest(integrator=integrator):
                run = self.run_model("""bodies: {wheel: {mass: 1, inertia: 0.5}}
joints: {axle: {type: revolute, between: [ground, wheel]}}
forces: {brake: {type: brake, between: [ground, wheel], limit: "12 N*m*smooth(t, 0.1 s, 0.2 s)", stiffness: 3e4, relaxation: 1 ms}}
initial: {speeds: {axle: 10 rad/s}}
simulation: {end: 0.2 s, integrator: %s, accuracy: 1e-6, output: {interval: 10 ms}}
""" % integrator)
                self.assertLess(abs(run["body.wheel.omega"][-1] - (10 - 0.6 / 0.5)), 1e-4)

    def test_where_a_brake_comes_to_hold_keeps_the_accuracy_of_every_integrator(self):
        # I = 0.02 kg m^2 from 1.5 rad/s, slipping at 0.7 N m; held with 38.7 rad/s and 15 rad/s of damping. The strain
        # moves nothing while it slips, and is what holds from then on.
        inertia, limit, stiffness, relaxation = 0.02, 0.7, 30, 0.02
        slipping = lambda t: (limit / stiffness * (1 - math.exp(-t / relaxation)), 1.5 - limit / inertia * t)
        early, late = 0.0, 1.5 * inertia / limit
        for _ in range(100):
            stick = 0.5 * (early + late)
            strain, speed = slipping(stick)
            early, late = (stick, late) if strain + relaxation * speed > limit / stiffness else (early, stick)
        held = swing(strain, speed, stiffness * relaxation / (2 * inertia), math.sqrt(stiffness / inertia))
        angle = lambda t: (1.5 * t - 0.5 * limit / inertia * t * t if t < stick else
                           1.5 * stick - 0.5 * limit / inertia * stick ** 2 - strain + held(t - stick)[0])
        names = [one["name"] for one in json.loads(self.freeplay("list", "integrators", "--json")[0])]
        self.assertLessEqual({"bathe", "newmark", "hht", "generalized-alpha", "dopri5", "verner6", "verner7"}, set(names))
        for integrator in names:
            for accuracy in (1e-4, 1e-6, 1e-8, 1e-9):
                with self.subTest(integrator=integrator, accuracy=accuracy):
                    run = self.run_model("""bodies: {wheel: {mass: 1, inertia: 0.02}}
joints: {axle: {type: revolute, between: [ground, wheel]}}
forces: {brake: {type: brake, between: [ground, wheel], limit: 0.7 N*m, stiffness: 30, relaxation: 20 ms}}
initial: {speeds: {axle: 1.5 rad/s}}
simulation: {end: 0.5 s, integrator: %s, accuracy: %r, output: {interval: 5 ms}}
""" % (integrator, accuracy))
                    self.assert_column(run, "body.wheel.angle", angle, accuracy)
                    self.assert_column(run, "force.brake.strain",
                                       lambda t: slipping(t)[0] if t < stick else held(t - stick)[0], 2 * accuracy)

    def test_a_clutch_that_runs_free_from_rest_on_starts_with_every_integrator(self):
        # 0.5 kg, whose strain stays zero: x'' = 24 t
        for integrator in ("bathe", "newmark", "hht", "generalized-alpha", "dopri5", "verner7"):
            for steps in ("accuracy: 1e-8", "accuracy: 1e-4", "step: 1 ms"):
                with self.subTest(integrator=integrator, steps=steps):
                    run = self.run_model("""bodies: {block: {mass: 0.5, inertia: 1e-4}}
joints: {slide: {type: prismatic, between: [ground, block]}}
forces: {c: {type: one-way-clutch, kind: linear, locks: negative, between: [ground, block], stiffness: 1e5, relaxation: 0.3 ms}}
drivers: {pull: {joint: slide, kind: force, value: 12*t}}
simulation: {end: 0.5 s, integrator: %s, %s, output: {interval: 10 ms}}
""" % (integrator, steps))
                    self.assert_column(run, "joint.slide.position", lambda t: 4 * t ** 3, 1e-5)
                    self.assert_column(run, "force.c.strain", lambda t: 0.0, 1e-12)

    def test_what_no_coupling_can_be_is_refused_where_it_stands(self):
        text = SPACES["plane"][0] + "forces:\n  a: {type: %s, between: [ground, wheel], %s}\n"
        for name, keys, id in (("brake", "limit: 3, stiffness: 0", "out-of-range"), ("brake", "stiffness: 5", "missing-key"),
                               ("brake", "limit: 3 N, stiffness: 5", "dimension-mismatch"),
                               ("brake", "limit: 3, stiffness: 5, relaxation: 0", "out-of-range"),
                               ("one-way-clutch", "stiffness: 5, locks: postive", "wrong-type")):
            self.refusal(text % (name, keys), id=id, line=6)


if __name__ == "__main__":
    unittest.main()
