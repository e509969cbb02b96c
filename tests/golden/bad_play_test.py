"""Blocks `clearance` that cannot be: every type with play refuses them, or doubts them, at the place and with a remedy."""
import unittest

from model_cases import ModelTest

PLANE = """gravity: [0, -9.81]
bodies: {block: {mass: 1 kg, inertia: 1e-3}}
joints:
  j: {type: %s, between: [ground, block], clearance: {contact: {law: flores, K: 1e8, restitution: 0.8}, %s}}
"""
SPACE = PLANE.replace("gravity: [0, -9.81]", "space: spatial\ngravity: [0, 0, -9.81]").replace("1e-3", "[1e-3, 1e-3, 1e-3]")
GEAR = """frames: {ground/right: [60 mm, 0]}
bodies: {one: {mass: 1 kg, inertia: 1e-3}, other: {mass: 1 kg, inertia: 1e-3}}
joints:
  j: {type: %s, of: [a, b], ratio: -1, pressure_angle: 20 deg,
      clearance: {contact: {law: flores, K: 1e8, restitution: 0.8}, %s}}
  a: {type: revolute, between: [ground, one]}
  b: {type: revolute, between: [ground/right, other]}
"""
END = "simulation: {end: 1 ms, step: 0.1 ms}\n"

SLIDER = "gap: 0.1 mm, length: 50 mm, width: 20 mm"
BAR = SLIDER + ", height: 20 mm"
PIN = "radial_clearance: 0.1 mm, bearing_radius: 10 mm"
LONG_PIN = PIN + ", length: 20 mm"
CROSS = "cross: {mass: 0.1 kg, inertia: [1e-5, 1e-5, 1e-5]}, "
TOOTH = "pitch_radius: 30 mm, gap: 0.1 mm"
SLOT = "gap: 0.1 mm, pin_radius: 5 mm"


def short_crank(space, axial, length, gap):
    """A crank that drives a rod by a pin with play."""
    tip = "[%s, 0]" % length if axial is None else "[%s, 0, %g]" % (length, axial)
    inertia = "1e-4" if axial is None else "[1e-4, 1e-4, 1e-4]"
    return """space: %s
bodies:
  crank: {mass: 0.1 kg, inertia: %s, frames: {tip: %s}}
  rod: {mass: 0.1 kg, inertia: %s, frames: {tip: [%s]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  pin: {type: revolute, between: [crank/tip, rod], clearance: {bearing_radius: 10 mm, radial_clearance: %s, length: 20 mm,
        material: {E: 207 GPa, nu: 0.3}, contact: {law: flores, restitution: 0.8}}}
drivers: {m: {joint: main, kind: velocity, value: 10 rad/s}}
simulation: {end: 1 ms, step: 10 us}
""" % (space, inertia, tip, inertia, "0.1, 0" if axial is None else "0.1, 0, 0", gap)


def change(block, key, value):
    return ", ".join("%s: %s" % (key, value) if part.startswith(key + ":") else part for part in block.split(", "))


# Of each type: its model, a sound block, and what is wrong with its gap, length and start.
WRONG = {
    "prismatic": (PLANE, SLIDER, (
        ("gap", "30 mm", "'gap' must be below 'width'"), ("gap", "0 mm", "must be > 0 m"),
        ("length", "0 mm", "must be > 0 m"), ("length", "0.1 mm", "must be below half of 'length'"),
        ("width", "0 mm", "must be > 0 m"),
        ("initial", "{eccentricity: [0, 0.2 mm]}", "a corner would start in the wall"),
        ("initial", "{eccentricity: [0, 0.09 mm], angle: 1 mrad}", "must stay within 'gap' together"))),
    "prismatic in space": (SPACE, BAR, (
        ("gap", "30 mm", "'gap' must be below 'width'"), ("gap_height", "30 mm", "'gap_height' must be below 'height'"),
        ("length", "0 mm", "must be > 0 m"), ("length", "0.1 mm", "must be below half of 'length'"),
        ("initial", "{eccentricity: [0, 0, 0.2 mm]}", "a corner of the slider would start in the wall"),
        ("initial", "{tilt: [0.1, 0, 0]}", "within the gap to each side together"))),
    "revolute": (PLANE, PIN, (
        ("radial_clearance", "12 mm", "must be below 'bearing_radius'"), ("radial_clearance", "0 mm", "must be > 0 m"),
        ("length", "0 mm", "must be > 0 m"))),
    "revolute in space": (SPACE, LONG_PIN, (
        ("radial_clearance", "12 mm", "must be below 'bearing_radius'"), ("length", "0 mm", "must be > 0 m"),
        ("initial", "{tilt: [50 mrad, 0, 0]}", "half the length times the tilt must stay within the clearance"),
        ("axial_clearance", "1 mm, initial: {eccentricity: [0, 0, 2 mm]}", "must stay within 'axial_clearance'"))),
    "cylindrical in space": (SPACE, LONG_PIN, (
        ("radial_clearance", "12 mm", "must be below 'bearing_radius'"), ("length", "0 mm", "must be > 0 m"),
        ("initial", "{tilt: [50 mrad, 0, 0]}", "half the length times the tilt must stay within the clearance"))),
    "universal in space": (SPACE, CROSS + LONG_PIN, (
        ("radial_clearance", "12 mm", "must be below 'bearing_radius'"), ("length", "0 mm", "must be > 0 m"),
        ("initial", "{tilt: [50 mrad, 0, 0]}", "half the length times the tilt must stay within the clearance"))),
    "spherical in space": (SPACE, PIN, (
        ("radial_clearance", "12 mm", "must be below 'bearing_radius'"), ("radial_clearance", "0 mm", "must be > 0 m"))),
    "gear": (GEAR, TOOTH, (
        ("gap", "40 mm", "must be below 'pitch_radius'"), ("gap", "0 mm", "must be > 0 m"),
        ("pitch_radius", "0 mm", "must be > 0 m"), ("pitch_radius", "20 mm", "the pitch circles touch at 0.04 m"))),
    "point-on-line": (PLANE, SLOT, (
        ("gap", "10 mm", "'gap' must be below twice 'pin_radius'"), ("gap", "0 mm", "must be > 0 m"),
        ("pin_radius", "0 mm", "must be > 0 m"), ("slot", "[5 mm, 5 mm]", "must lie beyond the first"),
        ("initial", "{eccentricity: [0, 0.2 mm]}", "the pin would start in the wall"))),
}
# A coordinate that play leaves undefined, or that a joint does not have.
UNDRIVEN = (
    ("prismatic", PLANE, SLIDER, "angle", "is driven by position, velocity or force"),
    ("prismatic", SPACE, BAR, "angle", "is driven by position, velocity or force"),
    ("revolute", PLANE, PIN, "position", "is driven by angle, velocity or torque"),
    ("revolute", SPACE, LONG_PIN, "position", "is driven by angle, velocity or torque"),
    ("point-on-line", PLANE, SLOT, "angle", "is driven by position, velocity or force"),
    ("cylindrical", SPACE, LONG_PIN, "angle", "write 'coordinate: angle' or 'coordinate: position' at the joint"),
    ("spherical", SPACE, PIN, "angle", "write 'coordinate: angle' at the joint"),
    ("gear", GEAR, TOOTH, "angle", "drive 'a' or 'b', which it ties"),
    ("universal", SPACE, CROSS + LONG_PIN, "angle", "name 'j.first' or 'j.second'"),
)
# In a wall, but not so that the run could not begin.
DOUBTED = (
    ("revolute", PLANE, PIN, "{eccentricity: [0.2 mm, 0]}", "0.0001 m deep in its wall"),
    ("revolute", SPACE, LONG_PIN, "{eccentricity: [0.2 mm, 0, 0]}", "0.0001 m deep in its wall"),
    ("cylindrical", SPACE, LONG_PIN, "{eccentricity: [0.2 mm, 0, 0]}", "0.0001 m deep in its wall"),
    ("universal", SPACE, CROSS + LONG_PIN, "{eccentricity: [0, 0, 0.2 mm]}", "0.0001 m deep in its wall"),
    ("spherical", SPACE, PIN, "{eccentricity: [0.2 mm, 0, 0]}", "0.0001 m deep in its wall"),
)


# A weight that presses its pin into a bearing of given stiffness [N/m].
HANGING = """freeplay: 1
gravity: [0, -10]
bodies: {weight: {mass: 100, inertia: 1}}
joints:
  j: {type: revolute, between: [ground, weight], clearance: {bearing_radius: 20 mm, radial_clearance: 0.05 mm, initial: loaded,
      contact: {law: expression, force: "%s N/m*delta"}}}
simulation: {end: 0.01, step: 1e-5}
"""


class BadPlay(ModelTest):
    def test_each_type_runs_with_a_sound_block(self):
        for name, (model, block, _) in WRONG.items():
            with self.subTest(name):
                self.facts(model % (name.split()[0], block) + END)

    def test_what_cannot_be_is_refused_at_the_joint(self):
        for name, (model, block, mistakes) in WRONG.items():
            for key, value, words in mistakes:
                with self.subTest(name, key=key, value=value):
                    wrong = change(block, key, value) if key + ":" in block else "%s, %s: %s" % (block, key, value)
                    error = self.refusal(model % (name.split()[0], wrong) + END)[0]
                    self.assertIn(words, error["message"])
                    self.assertRegex(self.read("m.yaml").splitlines()[error["line"] - 1], "^  (j:|    clearance:)")

    # 1 kN on 25 kN/mm and on 10 kN/mm: 40 and 100 um, of a clearance of 50 um.
    def test_a_start_under_load_is_doubted_where_the_load_presses_deeper_than_the_clearance(self):
        self.assertNotIn("doubtful-clearance", self.freeplay("validate", self.write("m.yaml", HANGING % "25e6"))[1])
        words = "0.0001 m deep in its wall, as the clearance is 5e-05 m: check the load, the stiffness of the contact and the clearance"
        self.assertIn(words, self.freeplay("validate", self.write("m.yaml", HANGING % "10e6"))[1])

    def test_a_driver_on_what_play_leaves_undefined_is_refused_at_the_driver(self):
        for kind, model, block, what, words in UNDRIVEN:
            with self.subTest(kind, model=model.splitlines()[0]):
                driver = "drivers:\n  m: {joint: j, kind: %s, value: 0}\n" % what
                _, err = self.freeplay("validate", self.model(model % (kind, block) + driver + END), code=3)
                self.assertIn(words, err)
                line = self.read("m.yaml").splitlines().index("drivers:") + 2
                self.assertTrue(err.startswith("m.yaml:%d:" % line), err)

    def test_a_journal_that_starts_in_its_wall_is_doubted(self):
        for kind, model, block, start, words in DOUBTED:
            with self.subTest(kind, model=model.splitlines()[0]):
                _, err = self.freeplay("validate", self.model(model % (kind, block + ", initial: " + start) + END))
                self.assertIn(words, err)
                self.assertIn("[doubtful-clearance]", err)
                self.assertIn("check 'initial'", err)

    def test_a_link_that_is_shorter_than_its_play_is_doubted(self):
        for space, axial in (("planar", None), ("spatial", 0.0), ("spatial", 0.03)):
            for length, gap, doubted in (("50 um", "0.5 mm", True), ("0.49 mm", "0.5 mm", True), ("0.51 mm", "0.5 mm", False),
                                         ("0", "0.5 mm", False), ("50 um", "20 um", False)):
                with self.subTest(space=space, axial=axial, length=length, gap=gap):
                    _, err = self.freeplay("validate", self.model(short_crank(space, axial, length, gap)))
                    said = [line for line in err.splitlines() if "can go round in it" in line]
                    self.assertEqual(1 if doubted else 0, len(said), err)
                    for line in said:
                        self.assertIn("the clearance of joint 'pin' is 0.0005 m", line)
                        self.assertIn("of body 'crank'", line)
                        self.assertIn("[doubtful-clearance]", line)


if __name__ == "__main__":
    unittest.main()
