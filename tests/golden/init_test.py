"""`freeplay init` writes starters that work as they are, and never over anything."""
import json
import os
import unittest

from program import ROOT, ProgramTest


class ModelStarters(ProgramTest):
    def test_a_starter_runs_under_its_new_name(self):
        out, _ = self.freeplay("init", "my-linkage")
        self.assertIn("run my-linkage.yaml", out)
        self.freeplay("run", "my-linkage.yaml", "--end", "10 ms")
        self.assertTrue(os.path.exists(self.path("results", "my-linkage", "results.csv")))

    def test_every_mechanism_is_a_starter(self):
        names = self.freeplay("init", "--from", "list")[0].split()
        files = sorted(name[:-5] for name in os.listdir(os.path.join(ROOT, "mechanisms")) if name.endswith(".yaml"))
        self.assertEqual(files, names)
        self.assertEqual(names, json.loads(self.freeplay("init", "--from", "list", "--json")[0]))
        for name in names:
            self.freeplay("init", "copy-of-" + name, "--from", name)
            self.freeplay("validate", "copy-of-%s.yaml" % name)
            comments = [line for line in self.read("copy-of-%s.yaml" % name).splitlines() if "# " in line]
            self.assertGreater(len(comments), 3, name)

    def test_names_with_blanks_and_quotes_are_kept(self):
        self.freeplay("init", "a 'b'", "--from", "pendulum")
        facts = json.loads(self.freeplay("validate", "a 'b'.yaml", "--json")[0])
        self.assertTrue(facts["ok"])
        self.freeplay("run", "a 'b'.yaml", "--end", "1 ms", "--out", "r")
        self.assertEqual("a 'b'", json.loads(self.read("r", "summary.json"))["model"]["name"])

    def test_nothing_is_overwritten(self):
        self.write("four-bar.yaml", "mine\n")
        _, err = self.freeplay("init", code=6)
        self.assertIn("'four-bar.yaml': it is there already", err)
        self.assertEqual("mine\n", self.read("four-bar.yaml"))

    def test_misspelt_words_are_refused_with_a_suggestion(self):
        for words, meant in ((["--from", "four-bra"], "four-bar"), (["--kind", "plugn"], "plugin"),
                             (["--kind", "plugin", "--type", "frictoin"], "friction")):
            _, err = self.freeplay("init", "x", *words, code=2)
            self.assertIn("did you mean '%s'?" % meant, err)
        self.freeplay("init", "x", "--kind", "plugin", code=2)
        self.freeplay("init", "x", "--type", "joint", code=2)
        self.assertEqual([], os.listdir(self.folder))


class PluginStarters(ProgramTest):
    """That a starter builds and passes its tests is shown in write_a_joint_test.py."""

    def test_a_project_bears_its_name_everywhere(self):
        for kind in ("joint", "contact", "friction", "integrator"):
            answer = json.loads(self.freeplay("init", "soft-" + kind, "--kind", "plugin", "--type", kind, "--json")[0])
            self.assertEqual(["soft-%s/%s" % (kind, name) for name in ("CMakeLists.txt", "soft_%s.cpp" % kind,
                                                                      "example.yaml")], answer["files"])
            for file in answer["files"]:
                text = self.read(file)
                for word in ("my-type", "my_type", "MyType"):
                    self.assertNotIn(word, text)
            self.assertIn('.name = "soft-%s"' % kind, self.read("soft-%s" % kind, "soft_%s.cpp" % kind))
            self.assertIn("class Soft%sType final" % kind.capitalize(), self.read("soft-%s" % kind, "soft_%s.cpp" % kind))

    def test_a_folder_that_holds_something_is_refused(self):
        os.mkdir(self.path("mine"))
        self.write("mine/notes.txt", "")
        self.freeplay("init", "mine", "--kind", "plugin", "--type", "joint", code=6)
        self.assertEqual(["notes.txt"], os.listdir(self.path("mine")))

    def test_names_that_no_type_may_bear_are_refused(self):
        for name in ("Spring", "2nd", "a b", "test", "revolute", "gear", "force"):
            self.freeplay("init", name, "--kind", "plugin", "--type", "joint", code=2)
        # Names are unique within a kind only.
        self.freeplay("init", "revolute", "--kind", "plugin", "--type", "friction")


if __name__ == "__main__":
    unittest.main()
