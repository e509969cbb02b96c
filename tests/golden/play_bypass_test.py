"""A play that an ideal joint takes, in all directions or in one, beside it or by way of what is fixed to its bodies."""
import json
import unittest

from program import ProgramTest

# A rotor in a journal bearing with play, to which a test adds a joint; a cap is fixed to ground.
SHAFT = """freeplay: 1
space: spatial
bodies:
  rotor: {mass: 2, inertia: [1e-3, 1e-3, 2e-3], com: [0, 0, 0.1], frames: {near: [0, 0, 0], far: [0, 0, 0.2], rim: [0.1, 0, 0.2]}}
  cap: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], frames: {far: [0, 0, 0.2]}}
frames: {ground/far: [0, 0, 0.2], ground/side: [0.2, 0, 0]}
joints:
  one: {type: %s, between: [ground, rotor], clearance: {bearing_radius: 8 mm, radial_clearance: 0.05 mm, %scontact: {law: hertz, K: 1e9}}}
  glue: {type: fixed, between: [ground, cap]}
  more: {%s}
simulation: {end: 0.1, accuracy: 1 um}
"""
PIN, BALL, SLEEVE = ("revolute", "length: 10 mm, "), ("spherical", ""), ("cylindrical", "length: 10 mm, ")
ALL, SOME, ONE = "without play", "without play in some of its directions", "without play in one of its directions"
BY = "the play of joint 'one' is bypassed by joint 'more', which holds %s %s: delete one of the two joints%s"
SAME, FIXED = "the same two bodies", "what is fixed to the same two bodies"


class PlayBypass(ProgramTest):
    def bypass(self, text):
        found = json.loads(self.freeplay("validate", self.write("m.yaml", text), "--json")[0])["messages"]
        return [m["message"] for m in found if m["id"] == "play-bypassed"]

    def test_in_space_it_is_found_by_direction(self):
        for kind, more, who, much in [
                (PIN, "type: revolute, between: [ground/far, rotor/far]", SAME, ALL),
                (PIN, "type: cylindrical, between: [ground, rotor]", SAME, SOME),  # slides along the axis
                (PIN, "type: spherical, between: [ground, rotor/near]", SAME, SOME),
                (PIN, "type: spherical, between: [cap, rotor/near]", FIXED, SOME),
                (PIN, "type: distance, between: [ground/side, rotor/near], length: 0.2", SAME, ONE),
                (SLEEVE, "type: spherical, between: [ground, rotor/near]", SAME, SOME),
                (BALL, "type: distance, between: [ground/side, rotor/near], length: 0.2", SAME, ONE),
                (BALL, "type: distance, between: [cap/far, rotor/near], length: 0.2", FIXED, ONE),
                (BALL, "type: point-on-plane, between: [ground, rotor/near]", SAME, ONE),
                (BALL, "type: spherical, between: [cap, rotor/near]", FIXED, ALL)]:
            with self.subTest((kind, more)):
                text = (SHAFT % (*kind, more))
                self.assertEqual([BY % (who, much, ", or give both clearance" if much == ALL else "")], self.bypass(text))

    def test_what_leaves_the_journal_its_play_is_sound(self):
        """A thrust bearing, a second bearing at the other end about which the shaft tilts, a rod to another place."""
        for kind, more in [
                (PIN, "type: point-on-plane, between: [ground, rotor/near]"),
                (PIN, "type: distance, between: [ground/far, rotor/near], length: 0.2"),
                (PIN, "type: spherical, between: [ground/far, rotor/far]"),
                (SLEEVE, "type: spherical, between: [ground/far, rotor/far]"),
                (SLEEVE, "type: point-on-plane, between: [cap, rotor/near]"),
                (BALL, "type: spherical, between: [ground/far, rotor/far]"),
                (BALL, "type: distance, between: [ground/side, rotor/rim], length: 0.22360679774997896")]:
            with self.subTest((kind, more)):
                text = (SHAFT % (*kind, more))
                self.assertEqual([], self.bypass(text))

    def test_a_journal_that_starts_off_its_centre_is_judged_as_one_in_it(self):
        for eccentricity in ("[0.02 mm, 0, 0]", "[0, 0.05 mm, 0]", "[0, 0, -0.04 mm]"):
            text = (SHAFT % ("spherical", "initial: {eccentricity: %s}, " % eccentricity,
                             "type: distance, between: [cap/far, rotor/near], length: 0.2"))
            with self.subTest(eccentricity):
                self.assertEqual([BY % (FIXED, ONE, "")], self.bypass(text))

    def test_in_the_plane_bodies_that_are_fixed_count_too(self):
        text = ("freeplay: 1\nbodies:\n  a: {mass: 1, inertia: 1e-2, frames: {tip: [0.2, 0]}}\n"
                "  b: {mass: 1, inertia: 1e-2, pose: {position: [0.2, 0]}}\n  c: {mass: 1, inertia: 1e-2, pose: {position: [0.2, 0]}}\n"
                "joints:\n  main: {type: revolute, between: [ground, a]}\n"
                "  loose: {type: revolute, between: [a/tip, b], clearance: {bearing_radius: 8 mm, radial_clearance: 0.05 mm, "
                "contact: {law: hertz, K: 1e9}}}\n  glue: {type: fixed, between: [b, c]}\n"
                "  rod: {type: distance, between: [a, c], length: 0.2}\nsimulation: {end: 0.1, accuracy: 1 um}\n")
        self.assertEqual(["the play of joint 'loose' is bypassed by joint 'rod', which holds what is fixed to the same two bodies "
                          "without play in one of its directions: delete one of the two joints"], self.bypass(text))
        pinned = text.replace("glue: {type: fixed", "glue: {type: revolute")
        self.assertEqual([BY.replace("'one'", "'loose'").replace("'more'", "'rod'") % (FIXED, ONE, "")], self.bypass(pinned))
        # A pin and a rod that does not go through it hold two bodies together.
        rod = "\n  brace: {type: distance, between: [b/up, c/out], length: 0.14142135623730951}\nsimulation:"
        frames = {"2, 0]}}\n  c:": "2, 0]}, frames: {up: [0, 0.1]}}\n  c:", "2, 0]}}\njoints": "2, 0]}, frames: {out: [0.1, 0]}}\njoints",
                  "\nsimulation:": rod}
        for old, new in frames.items():
            pinned = pinned.replace(old, new)
        self.assertIn("what is fixed to the same two bodies", self.bypass(pinned)[0])

    def test_a_rod_along_a_link_takes_the_play_of_its_pins(self):
        """A four-bar whose rod lies along one link and ends where that is pinned, on the bodies beside it."""
        text = ("freeplay: 1\nbodies:\n  crank: {mass: 1, inertia: 1e-2, frames: {tip: [0.1, 0], off: [0.1, 0.03]}}\n"
                "  coupler: {mass: 1, inertia: 1e-2, frames: {tip: [0.2, 0]}, pose: {position: [0.1, 0], angle: 30 deg}}\n"
                "  rocker: {mass: 1, inertia: 1e-2, frames: {tip: [0.15, 0]}, pose: {position: [0.25, 0], angle: 80 deg}}\n"
                "frames: {ground/D: [0.25, 0]}\njoints:\n  A: {type: revolute, between: [ground, crank]}\n"
                "  D: {type: revolute, between: [ground/D, rocker]}\n  B: {type: revolute, between: [crank/tip, coupler]%s}\n"
                "  C: {type: revolute, between: [coupler/tip, rocker/tip]%s}\n  rod: {type: distance, between: [%s, rocker/tip], length: %s}\n"
                "simulation: {end: 0.1, accuracy: 1 um}\n")
        loose = ", clearance: {bearing_radius: 8 mm, radial_clearance: 0.05 mm, contact: {law: hertz, K: 1e9}}"
        expected = [BY.replace("'more'", "'rod'") % (FIXED, ONE, "")]
        for b, c, end, found in [(loose, "", "crank/tip", "B"), ("", loose, "crank/tip", "C"), (loose, "", "coupler", ""),
                                 (loose, loose, "crank/tip", ""), (loose, "", "crank/off", ""), ("", loose, "crank/off", "")]:
            with self.subTest((bool(b), bool(c), end)):
                model = text % (b, c, end, 0.19 if "off" in end else 0.2)
                self.assertEqual([m.replace("'one'", f"'{found}'") for m in expected] if found else [], self.bypass(model))

    def test_the_same_play_twice_is_doubted(self):
        loose = "clearance: {bearing_radius: 8 mm, radial_clearance: 0.05 mm, %scontact: {law: hertz, K: 1e9}}"
        for (kind, words), more, found in [
                (PIN, "type: revolute, between: [rotor, ground], " + loose % "length: 10 mm, ", 1),
                (BALL, "type: spherical, between: [ground, rotor/near], " + loose % "", 1),
                (SLEEVE, "type: cylindrical, between: [ground/far, rotor/far], " + loose % "length: 10 mm, ", 0),
                (PIN, "type: revolute, between: [ground/far, rotor/far], " + loose % "length: 10 mm, ", 0)]:
            with self.subTest((kind, more)):
                text = SHAFT % (kind, words, more)
                messages = json.loads(self.freeplay("validate", self.write("m.yaml", text), "--json")[0])["messages"]
                self.assertEqual(found, len([m for m in messages if m["id"] == "duplicate-joint" and "'more' has the same play as 'one'" in m["message"]]))


if __name__ == "__main__":
    unittest.main()
