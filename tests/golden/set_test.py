"""--set puts values in the place of others: parameters, and anything in the model by its path."""
import json
import os
import unittest

from program import ProgramTest, mechanism

CRANK = mechanism("slider-crank")
LEGS = """freeplay: 1
parameters: {c: 0.1 mm}
gravity: [0, -9.81]
presets:
  loose: {bearing_radius: 10 mm, radial_clearance: $c, length: 10 mm, material: {E: 200 GPa, nu: 0.3}, contact: {law: hertz}}
bodies: {frame: {mass: 1 kg, inertia: 0.1, com: [0.1, 0.2]}}
templates:
  leg:
    parameters: {m: 2 kg}
    bodies: {rod: {mass: $m, inertia: 0.1}}
    joints: {pin: {type: revolute, between: [ground, rod], clearance: {use: loose}}}
instances: {leg: {template: leg, count: 2}, arm: {template: leg, with: {m: 3 kg}}}
simulation: {end: 1 ms, step: 1 us}
"""


class Set(ProgramTest):
    def model(self, *pairs, file="legs.yaml"):
        self.write("legs.yaml", LEGS)
        out, _ = self.freeplay("show", file, "--json", *[word for pair in pairs for word in ("--set", pair)])
        return json.loads(out)

    def test_a_path_stands_for_one_value_of_the_expanded_model(self):
        model = self.model("bodies.leg2.rod.mass=7 kg", "joints.arm.pin.clearance.radial_clearance=0.3 mm", "bodies.frame.com.1=0.5 m",
                           "gravity.1=-1.62")
        self.assertEqual([2, 7, 3], [model["bodies"][name]["mass"] for name in ("leg1.rod", "leg2.rod", "arm.rod")])
        self.assertEqual([1e-4, 1e-4, 3e-4], [model["joints"][name]["clearance"]["radial_clearance"]
                                              for name in ("leg1.pin", "leg2.pin", "arm.pin")])
        self.assertEqual([0.1, 0.5], model["bodies"]["frame"]["com"])
        self.assertEqual([0, -1.62], model["gravity"][:2])

    def test_a_star_stands_for_all_that_have_the_key(self):
        model = self.model("joints.leg*.clearance.radial_clearance=2*$c", "bodies.*.mass=4 kg")
        self.assertEqual([2e-4, 2e-4, 1e-4], [model["joints"][name]["clearance"]["radial_clearance"]
                                              for name in ("leg1.pin", "leg2.pin", "arm.pin")])
        self.assertEqual({4}, {body["mass"] for body in model["bodies"].values()})

    def test_a_map_or_list_takes_the_place_of_what_stood_there(self):
        model = self.model("joints.arm.pin.clearance.contact={law: lankarani-nikravesh, restitution: 0.8}", "gravity=[0, -3]")
        self.assertEqual((0.8, "lankarani-nikravesh"), tuple(model["joints"]["arm.pin"]["clearance"]["contact"][key]
                                                             for key in ("restitution", "law")))
        self.assertEqual([0, -3], model["gravity"][:2])

    def test_the_last_value_of_a_path_counts(self):
        self.assertEqual(6, self.model("bodies.frame.mass=5 kg", "bodies.frame.mass=6 kg")["bodies"]["frame"]["mass"])

    def test_a_path_gives_the_bytes_of_its_parameter(self):
        for name, target in (("a", "c"), ("b", "joints.wrist.clearance.radial_clearance")):
            self.freeplay("run", CRANK, "--set", target + "=0.2 mm", "--quiet", "--end", "3 ms", "--out", name)
        self.assertEqual(self.read("a", "results.csv"), self.read("b", "results.csv"))
        self.assertEqual({"joints.wrist.clearance.radial_clearance": "0.2 mm"},
                         json.loads(self.read("b", "summary.json"))["settings"]["set"])
        out, _ = self.freeplay("show", "b", "--json")
        self.assertEqual(2e-4, json.loads(out)["joints"]["wrist"]["clearance"]["radial_clearance"])

    def test_settings_of_the_run_act_as_its_options(self):
        sets = ["--set", "simulation.end=1 ms", "--set", "simulation.accuracy=1 um", "--set", "ideal=[wrist]"]
        self.freeplay("run", CRANK, *sets, "--quiet", "--out", "a")
        self.freeplay("run", CRANK, "--end", "1 ms", "--accuracy", "1 um", "--ideal", "wrist", "--quiet", "--out", "b")
        self.assertEqual(self.read("a", "results.csv"), self.read("b", "results.csv"))
        self.freeplay("run", CRANK, *sets, "--end", "2 ms", "--quiet", "--out", "c")
        self.assertEqual(0.002, json.loads(self.read("c", "summary.json"))["settings"]["end"])
        self.freeplay("run", CRANK, "--set", "simulation.integrator=dopri5", "--end", "1 ms", "--quiet", "--out", "d")
        self.assertEqual("dopri5", json.loads(self.read("d", "summary.json"))["settings"]["integrator"]["type"])

    def test_a_path_that_leads_nowhere_names_the_part_that_fails(self):
        self.write("legs.yaml", LEGS)
        for target, words in (
                ("joints.arm.pin.clearence.radial_clearance", "did you mean 'joints.arm.pin.clearance.radial_clearance'?"),
                ("joints.arms.pin.clearance.radial_clearance", "did you mean 'joints.arm.pin.clearance.radial_clearance'?"),
                ("bodies.frame.com.2", "'bodies.frame.com' has no '2'"),
                ("body.frame.mass", "did you mean 'bodies.frame.mass'?"),
                ("simulation.acuracy", "did you mean 'simulation.accuracy'?"),
                ("joints.*.stiffness", "nothing in the model has a path of this form"),
                ("templates.leg.bodies.rod.mass", "what stands in 'templates' is no part of the model until it is used"),
                ("presets.loose.length", "what stands in 'presets' is no part of the model until it is used")):
            with self.subTest(target):
                self.assertIn(words, self.freeplay("validate", "legs.yaml", "--set", target + "=1", code=2)[1])

    def test_keys_that_the_file_leaves_out_stand_in_the_model(self):
        model = self.model("joints.arm.pin.clearance.friction={law: coulomb-tanh, mu: 0.2}", "bodies.leg1.rod.velocity.angular=3 rad/s",
                           "joints.leg2.pin.clearance.initial=loaded", "initial.speeds.arm.pin=2 rad/s", "bodies.frame.frames.tip=[1 m, 0]",
                           "forces.push={type: torque, on: frame, value: 2 N*m}", "simulation.output.interval=10 us",
                           "simulation.output.columns.lag=body.frame.x - 1 m", "analysis.error.clearance.leg1.pin=0.1 mm")
        friction = model["joints"]["arm.pin"]["clearance"]["friction"]
        self.assertEqual(("coulomb-tanh", 0.2), (friction["law"], friction["mu"]))
        self.assertEqual("none", model["joints"]["leg1.pin"]["clearance"]["friction"]["law"])
        self.assertEqual("loaded", model["joints"]["leg2.pin"]["clearance"]["initial"])
        self.assertEqual(3, model["bodies"]["leg1.rod"]["velocity"]["angular"])
        self.assertEqual([1, 0], model["bodies"]["frame"]["frames"]["tip"])
        self.assertEqual("torque", model["forces"]["push"]["type"])
        self.assertAlmostEqual(1e-5, model["simulation"]["output"]["interval"], delta=1e-18)
        self.assertEqual(["lag"], list(model["simulation"]["output"]["columns"]))

    def test_a_key_that_is_added_gives_the_bytes_of_one_that_is_written(self):
        self.write("bare.yaml", LEGS)
        self.write("full.yaml", LEGS.replace("step: 1 us}", "step: 1 us, integrator: {type: bathe, split: 0.4}}")
                   .replace("contact: {law: hertz}}", "contact: {law: hertz}, friction: {law: coulomb-tanh, mu: 0.1}}"))
        frictions = ["joints.%s.pin.clearance.friction={law: coulomb-tanh, mu: 0.1}" % leg for leg in ("leg1", "leg2", "arm")]
        sets = [word for pair in (*frictions, "simulation.integrator={type: bathe, split: 0.4}") for word in ("--set", pair)]
        self.freeplay("run", "bare.yaml", "--quiet", "--out", "a", *sets)
        self.freeplay("run", "full.yaml", "--quiet", "--out", "b")
        self.assertEqual(self.read("a", "results.csv"), self.read("b", "results.csv"))
        self.assertEqual(0.4, json.loads(self.read("a", "summary.json"))["settings"]["integrator"]["split"])

    def test_steps_and_integrators_by_maps_stand_before_what_the_file_says(self):
        accurate = LEGS.replace("step: 1 us", "accuracy: 1 um")
        for text, sets, size, adaptive, integrator in (
                (accurate, ["simulation.step={size: 2 us, adaptive: true}"], 2e-6, True, "bathe"),
                (accurate, ["simulation.step.size=2 us"], 2e-6, False, "bathe"),
                (accurate, ["simulation.integrator={type: bathe, split: 0.4}"], 1e-8, True, "bathe"),
                (LEGS, ["simulation.integrator={type: bathe}", "simulation.accuracy=1 um"], 1e-8, True, "bathe"),
                (LEGS, ["simulation.integrator={type: bathe}", "simulation.integrator=newmark"], 1e-6, False, "newmark"),
                (LEGS, ["simulation.step={size: 2 us}", "simulation.step=3 us"], 3e-6, False, "bathe"),
                (LEGS, ["simulation.accuracy=1 um", "simulation.step={size: 2 us}"], 2e-6, False, "bathe")):
            with self.subTest(sets):
                self.write("legs.yaml", text)
                self.freeplay("run", "legs.yaml", "--quiet", "--end", "1 ms", "--out", "a", "--force",
                              *[word for pair in sets for word in ("--set", pair)])
                settings = json.loads(self.read("a", "summary.json"))["settings"]
                self.assertAlmostEqual(size, settings["step"]["size"], delta=1e-3 * size)
                self.assertEqual((adaptive, integrator), (settings["step"]["adaptive"], settings["integrator"]["type"]))

    def test_a_key_that_may_not_stand_there_is_refused_with_what_may(self):
        self.write("legs.yaml", LEGS)
        for target, words in (
                ("bodies.frame.com.7", "its items have the numbers 0 to 1"),
                ("bodies.leg1.rod.com.0", "give it as a whole, --set 'bodies.leg1.rod.com=...'"),
                ("bodies.frame.damping", "here may stand mass, inertia, com, pose, velocity or frames"),
                ("joints.arm.pin.clearence", "did you mean 'joints.arm.pin.clearance'?"),
                ("joints.arm.pin.clearance.frction.law", "did you mean 'joints.arm.pin.clearance.friction.law'?"),
                ("joints.arm.pin.clearance.contact.mu", "here may stand law"),
                ("simulation.step.adaptive", "it is the value '1 us' and no map: give it as a whole, --set 'simulation.step={...}'"),
                ("bodies.fram", "did you mean 'bodies.frame'?"),
                ("bodies.other.mass", "here may stand frame")):
            with self.subTest(target):
                self.assertIn(words, self.freeplay("validate", "legs.yaml", "--set", target + "=1", code=2)[1])
        self.assertIn("did you mean 'arm.pin'?", self.freeplay("validate", "legs.yaml", "--set", "initial.joints.arm.pn=1", code=3)[1])

    def test_studies_vary_keys_that_the_file_leaves_out(self):
        self.write("legs.yaml", LEGS + """study:
  set: {simulation.step: {size: 2 us}, initial.joints.arm.pin: 10 deg}
  axes:
    friction: {target: joints.arm.pin.clearance.friction, list: [none, {law: coulomb-tanh, mu: 0.1}]}
    speed: {target: bodies.frame.velocity.angular, list: [0, 1 rad/s]}
  reducers: {turn: {channel: body.frame.angle, reduce: final}}
""")
        self.freeplay("study", "run", "legs.yaml", "--out", "s", "--quiet")
        rows = [row for row in self.read("s", "study.csv").splitlines() if not row.startswith("#")]
        self.assertEqual(5, len(rows))
        self.write("bad.yaml", LEGS + "study: {axes: {f: {target: bodies.frame.velocty.angular, list: [0, 1]}}, "
                                      "reducers: {turn: {channel: body.frame.angle, reduce: final}}}\n")
        self.assertIn("did you mean 'bodies.frame.velocity.angular'?", self.freeplay("study", "run", "bad.yaml", "--out", "t", code=3)[1])

    def test_a_bad_value_is_shown_at_its_option(self):
        self.write("legs.yaml", LEGS)
        for text, code, words in (("joints.arm.pin.clearance.contact.law=herz", 3, "did you mean 'hertz'?"),
                                  ("bodies.frame.mass=1 m", 3, "--set bodies.frame.mass:1:1: error: expected mass"),
                                  ("bodies.frame.mass=-1 kg", 3, "[out-of-range]"),
                                  ("joints.arm.pin.clearance.contact={law: hertz", 2, "is no list or map"),
                                  ("simulation.end=1 kg", 2, "expected time, but this is mass"),
                                  ("simulation.step=0 s", 2, "it must be > 0"),
                                  ("bodies.frame.mass", 2, "NAME=VALUE is needed")):
            with self.subTest(text):
                self.assertIn(words, self.freeplay("validate", "legs.yaml", "--set", text, code=code)[1])

    def test_conversion_refuses_what_it_would_not_write(self):
        _, err = self.freeplay("convert", CRANK, "x.yaml", "--set", "bodies.crank.mass=3 kg", code=2)
        self.assertIn("[not-in-this-release]", err)
        self.assertFalse(os.path.exists(self.path("x.yaml")))


if __name__ == "__main__":
    unittest.main()
