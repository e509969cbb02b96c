"""freeplay validate: facts of the mechanisms, messages of broken files."""
import json
import os
import re
import shutil
import unittest

from program import ROOT, ProgramTest, mechanism

NAMES = ["space", "bodies", "joints", "clearance_joints", "drivers", "coordinates", "velocities", "constraints",
         "driver_constraints", "rank", "redundant", "dof", "dof_driven", "driver_redundant"]
IDEAL = ["constraints", "rank", "redundant", "dof", "dof_driven", "driver_redundant"]

# Counted by hand: n legs have 2n + 1 bodies, 3n pins of 2 rows; a closed four-bar has 4 pins on 3 bodies.
FACTS = {
    "pendulum": (["planar", 1, 1, 0, 0, 3, 3, 2, 0, 2, 0, 1, 1, 0], None),
    "four-bar": (["planar", 3, 4, 0, 1, 9, 9, 8, 1, 8, 0, 1, 0, 0], None),
    "slider-crank": (["planar", 3, 4, 1, 1, 9, 9, 6, 1, 6, 0, 3, 2, 0], [8, 8, 0, 1, 0, 0]),
    "3-rrr": (["planar", 7, 9, 6, 3, 21, 21, 6, 3, 6, 0, 15, 12, 0], [18, 18, 0, 3, 0, 0]),
    "4-rrr": (["planar", 9, 12, 8, 4, 27, 27, 8, 4, 8, 0, 19, 15, 0], [24, 24, 0, 3, 0, 1]),
}

BAD = """freeplay: 1
name: bad
bodies:
  rod: {mass: 1 kg, inertia: 1, intertia: 2}
joints:
  pivot: {type: revolut, between: [ground, rod]}
"""


def text_of(file, facts, ideal):
    lines = ["%s: ok" % file]
    lines += ["  %-18s  %s" % pair for pair in zip(NAMES, facts) if pair != ("driver_redundant", 0)]
    if ideal:
        parts = ["%s %s" % pair for pair in zip(IDEAL, ideal) if pair != ("driver_redundant", 0)]
        lines.append("  %-18s  %s" % ("ideal", "  ".join(parts)))
    return "\n".join(lines) + "\n"


class Validate(ProgramTest):
    def test_facts_as_text(self):
        for name, (facts, ideal) in FACTS.items():
            file = mechanism(name)
            self.assertEqual((text_of(file, facts, ideal), ""), self.freeplay("validate", file))

    def test_facts_as_json(self):
        for name, (facts, ideal) in FACTS.items():
            file = mechanism(name)
            verdict = json.loads(self.freeplay("validate", file, "--json")[0])
            self.assertEqual(["file", "ok", "facts", "start", "start_changes", "messages"], list(verdict))
            self.assertEqual((file, True, []), (verdict["file"], verdict["ok"], verdict["messages"]))
            expected = dict(zip(NAMES, facts), ideal=dict(zip(IDEAL, ideal)) if ideal else None, left_free=[], undetermined=[])
            self.assertEqual(list(expected.items()), list(verdict["facts"].items()))
            self.assertEqual(facts[1], len(verdict["start"]))

    def test_start_holds_centres_of_mass(self):
        start = json.loads(self.freeplay("validate", mechanism("pendulum"), "--json")[0])["start"]["rod"]
        for quantity, expected in (("x", 0.5), ("y", 0.0), ("angle", 0.0)):
            self.assertAlmostEqual(expected, start[quantity], places=12)

    def test_several_files(self):
        files = [mechanism("pendulum"), mechanism("four-bar")]
        self.assertEqual("".join(text_of(f, *FACTS[n]) for f, n in zip(files, ("pendulum", "four-bar"))),
                         self.freeplay("validate", *files)[0])
        verdicts = json.loads(self.freeplay("validate", *files, "none.yaml", "--json", code=3)[0])
        self.assertEqual([True, True, False], [verdict["ok"] for verdict in verdicts])

    def test_without_assembly_ranks_are_unknown(self):
        out, _ = self.freeplay("validate", mechanism("3-rrr"), "--no-assemble", "--json")
        verdict = json.loads(out)
        facts = verdict["facts"]
        self.assertEqual([None] * 4, [facts[name] for name in ("rank", "redundant", "dof", "dof_driven")])
        self.assertEqual((6, 18, None), (facts["constraints"], facts["ideal"]["constraints"], verdict["start"]))

    def test_ideal_closes_clearance(self):
        out, _ = self.freeplay("validate", mechanism("3-rrr"), "--ideal", "all", "--json")
        facts = json.loads(out)["facts"]
        self.assertEqual((18, 0, None), (facts["constraints"], facts["dof_driven"], facts["ideal"]))

    def test_set_replaces_a_parameter(self):
        out, _ = self.freeplay("validate", mechanism("pendulum"), "--set", "l=3 m", "--set", "l=200 cm", "--json")
        self.assertAlmostEqual(1.0, json.loads(out)["start"]["rod"]["x"], places=12)

    def test_a_study_is_checked_with_its_models(self):
        for name in ("3-rrr", "4-rrr"):
            shutil.copy(mechanism(name), self.folder)
        with open(os.path.join(ROOT, "docs", "studies.md"), encoding="utf-8") as file:
            page = re.search(r"^```yaml\n(.*?)^```", file.read(), re.M | re.S)[1]
        self.assertEqual("page.yaml: ok\n  study of 4000 points\n", self.freeplay("validate", self.write("page.yaml", page))[0])
        verdict = json.loads(self.freeplay("validate", "page.yaml", "--json")[0])
        self.assertEqual((True, None, {"points": 4000}), (verdict["ok"], verdict["facts"], verdict["study"]))
        self.write("page.yaml", page.replace("radial_clearance", "radial_clearence"))
        self.assertIn("page.yaml:7:5: error: nothing in the models fits 'joints.leg*.clearance.radial_clearence' [unknown-name]",
                      self.freeplay("validate", "page.yaml", code=3)[1])
        self.write("page.yaml", page.replace("T: [0.5 s, 1 s]", "T: [0.5 s, 1 kg]"))
        self.assertIn("page.yaml:6:16: error: expected time, but this is mass [dimension-mismatch]",
                      self.freeplay("validate", "page.yaml", code=3)[1])

    def test_reducers_of_a_study_are_checked(self):
        with open(mechanism("pendulum"), encoding="utf-8") as file:
            text = file.read()
        self.write("m.yaml", text + "study: {reducers: {x: {value: '[body.rod.xx]', reduce: final}}}\n")
        self.assertIn("unknown channel 'body.rod.xx' [unknown-name]", self.freeplay("validate", "m.yaml", code=3)[1])

    def test_a_model_with_a_study_has_its_own_facts_too(self):
        with open(mechanism("pendulum"), encoding="utf-8") as file:
            text = file.read()
        self.write("m.yaml", text + "study: {axes: {bodies.rod.mass: {linspace: [1 kg, 2 kg, 5]}}}\n")
        out, _ = self.freeplay("validate", "m.yaml")
        self.assertIn("  study of 5 points\n  space ", out)
        self.write("m.yaml", text + "study: {axes: {bodies.rod.mas: [1 kg]}}\n")
        self.assertIn("did you mean 'bodies.rod.mass'?", self.freeplay("validate", "m.yaml", code=3)[1])

    def test_messages_have_a_place_and_a_remedy(self):
        out, err = self.freeplay("validate", self.write("bad.yaml", BAD), code=3)
        self.assertEqual("bad.yaml: not ok\n", out)
        self.assertEqual("""bad.yaml:4:33: error: unknown key 'intertia' in 'bodies.rod' [unknown-key]
    4 |   rod: {mass: 1 kg, inertia: 1, intertia: 2}
      |                                 ^~~~~~~~
      = did you mean 'inertia'?
""", err[:err.index("bad.yaml:6")])
        self.assertIn("""
    6 |   pivot: {type: revolut, between: [ground, rod]}
      |                 ^~~~~~~
      = did you mean 'revolute'?
""", err)

    def test_messages_as_json(self):
        out, _ = self.freeplay("validate", self.write("bad.yaml", BAD), "--json", code=3)
        verdict = json.loads(out)
        self.assertEqual((False, None), (verdict["ok"], verdict["facts"]))
        first = verdict["messages"][0]
        self.assertEqual(("bad.yaml", 4, 33, "error", "unknown-key", "inertia"),
                         tuple(first[k] for k in ("file", "line", "column", "severity", "id", "suggestion")))
        self.assertEqual("unknown-type", verdict["messages"][1]["id"])

    def test_max_errors_limits_the_messages(self):
        self.write("bad.yaml", BAD)
        _, err = self.freeplay("validate", "bad.yaml", "--max-errors", "1", code=3)
        self.assertNotIn("revolut", err)

    def test_missing_file(self):
        out, err = self.freeplay("validate", "none.yaml", code=3)
        self.assertTrue(err.startswith("none.yaml: error: ") and err.endswith("[file-not-found]\n"), err)

    def test_quiet_says_only_what_is_wrong(self):
        self.assertEqual(("", ""), self.freeplay("validate", mechanism("pendulum"), "--quiet"))
        out, err = self.freeplay("validate", "none.yaml", "--quiet", code=3)
        self.assertEqual("", out)
        self.assertIn("[file-not-found]", err)

    def test_warnings_and_strict(self):
        text = "freeplay: 1\nname: w\nparameters: {spare: 1}\nbodies: {b: {mass: 1, inertia: 1}}\n"
        self.write("w.yaml", text)
        _, err = self.freeplay("validate", "w.yaml")
        self.assertIn("warning: ", err)
        self.assertIn("[unused]", err)
        _, err = self.freeplay("validate", "w.yaml", "--strict", code=3)
        self.assertIn("error: ", err)

    def test_a_model_that_cannot_be_assembled(self):
        text = """freeplay: 1
name: apart
bodies:
  a: {mass: 1, inertia: 1}
joints:
  p: {type: revolute, between: [ground, a]}
  q: {type: revolute, between: [ground/far, a/end]}
frames:
  ground/far: [5 m, 0]
  a/end: [1 m, 0]
"""
        out, err = self.freeplay("validate", self.write("apart.yaml", text), code=3)
        self.assertRegex(err, r"^apart\.yaml(:\d+:\d+)?: error: .*\[assembly-failed\]\n")


class SmallMistakes(ProgramTest):
    def messages(self, text, code=3):
        out, _ = self.freeplay("validate", self.write("m.yaml", text), "--no-assemble", "--json", code=code)
        return [(m["line"], m["column"], m["id"], m["suggestion"]) for m in json.loads(out)["messages"]]

    def test_ground_is_suggested_where_a_body_is_meant(self):
        self.assertIn((3, 40, "unknown-name", "ground"), self.messages(
            "freeplay: 1\nbodies: {b: {mass: 1, inertia: 1}}\njoints: {j: {type: revolute, between: [grond, b]}}\n"))
        self.assertIn((3, 10, "unknown-name", "ground"), self.messages(
            "freeplay: 1\nbodies: {b: {mass: 1, inertia: 1}}\nframes: {gruond/a: [0, 0]}\n"))

    def test_a_point_mass_is_a_warning(self):
        self.assertEqual([(2, 32, "zero-inertia", None)], self.messages(
            "freeplay: 1\nbodies: {b: {mass: 1, inertia: 0}}\n", code=0))

    def test_a_stop_limit_has_the_dimension_of_its_channel(self):
        text = "freeplay: 1\nbodies: {b: {mass: 1, inertia: 1}}\nsimulation: {stop: [{channel: body.b.vx, above: 1 %s}]}\n"
        self.assertEqual([(3, 49, "dimension-mismatch", None)], self.messages(text % "mm"))
        self.assertEqual([], self.messages(text % "mm/s", code=0))
        self.assertEqual([], self.messages(text % "", code=0))

    def test_empty_names_are_refused(self):
        self.assertEqual([(2, 7, "wrong-type", None)], self.messages(
            "freeplay: 1\nname: ''\nbodies: {b: {mass: 1, inertia: 1}}\n"))
        self.freeplay("run", mechanism("pendulum"), "--out", "", code=2)

    def test_a_decimal_comma_is_shown_as_a_whole(self):
        self.assertEqual([(2, 21, "bad-expression", None)], [m[:3] + (None,) for m in self.messages(
            "freeplay: 1\nbodies: {b: {mass: \"1,5\", inertia: 1}}\n")][:1])

    def test_summary_names_the_joints_that_are_made_ideal(self):
        self.freeplay("run", mechanism("3-rrr"), "--ideal", "leg2.*", "--end", "4 us", "--out", "r", "--quiet")
        self.assertEqual(["leg2.B", "leg2.C"], json.loads(self.read("r", "summary.json"))["settings"]["ideal"])


class Assembly(ProgramTest):
    def test_links_that_are_given_in_one_line_are_put_together(self):
        # Newton's steps cannot leave the line; 1.8 + 2.6 + 2 > 3.6, so the four-bar closes.
        self.write("line.yaml", """freeplay: 1
bodies:
  a: {mass: 1, inertia: 1, frames: {end: [1.8, 0]}}
  b: {mass: 1, inertia: 1, frames: {end: [3.6, 0]}}
  c: {mass: 1, inertia: 1, frames: {end: [2.6, 0]}}
joints:
  p: {type: revolute, between: [ground/post, a]}
  q: {type: revolute, between: [a/end, b]}
  r: {type: revolute, between: [b/end, c]}
  s: {type: revolute, between: [c/end, ground]}
frames: {ground/post: [2, 0]}
""")
        facts = json.loads(self.freeplay("validate", "line.yaml", "--json")[0])["facts"]
        self.assertEqual((8, 1), (facts["rank"], facts["dof"]))
        self.write("apart.yaml", self.read("line.yaml").replace("3.6", "6.6"))
        self.assertIn("[assembly-failed]", self.freeplay("validate", "apart.yaml", code=3)[1])


class DrivenJointsTest(ProgramTest):
    def test_an_inverse_kinematics_driver_must_drive_a_joint(self):
        with open(mechanism("3-rrr"), encoding="utf-8") as file:
            model = self.write("none.yaml", file.read().replace("joints: leg*.A", "joints: []"))
        _, err = self.freeplay("validate", model, code=3)
        self.assertIn("at least one joint must be driven [wrong-length]", err)


if __name__ == "__main__":
    unittest.main()
