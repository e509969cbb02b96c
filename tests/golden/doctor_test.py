"""freeplay doctor: what is installed, found and writable."""
import json
import os
import unittest

from program import ProgramTest


class Doctor(ProgramTest):
    def test_a_sound_installation_has_no_problem(self):
        out, err = self.freeplay("doctor")
        self.assertEqual("", err)
        for line in out.splitlines():
            self.assertRegex(line, r"^(ok|note) +\S.*: \S")
        self.assertIn("plugin ABI", out)
        self.assertEqual([], os.listdir(self.folder))

    def test_json_has_the_same_findings(self):
        answer = json.loads(self.freeplay("doctor", "--json")[0])
        self.assertTrue(answer["ok"])
        self.assertEqual(len(self.freeplay("doctor")[0].splitlines()), len(answer["findings"]))

    def test_counts_the_joints_that_list_shows(self):
        shown = len(self.freeplay("list", "joints")[0].splitlines()) - 1
        self.assertIn(f" {shown} joints,", self.freeplay("doctor")[0])

    def test_the_reference_integrator_is_there_if_it_is_listed(self):
        listed = "arkode" in [line.split()[0] for line in self.freeplay("list", "integrators")[0].splitlines()]
        line = [line for line in self.freeplay("doctor")[0].splitlines() if "reference integrator" in line]
        self.assertEqual(1, len(line))
        self.assertEqual(listed, line[0].startswith("ok"))
        self.assertEqual(not listed, "not in this build" in line[0])

    def test_a_plugin_that_is_refused_is_a_problem(self):
        self.write("libbroken.so", "no library")
        out, _ = self.freeplay("doctor", environment={"FREEPLAY_PLUGIN_PATH": self.folder}, code=1)
        self.assertRegex(out, r"(?m)^problem +plugin: .*libbroken\.so")
        out, _ = self.freeplay("doctor", environment={"FREEPLAY_PLUGIN_PATH": self.path("none")})
        self.assertRegex(out, r"(?m)^note +plugin folder: .*none is not there")

    def test_a_bad_number_of_threads_is_a_problem(self):
        out, _ = self.freeplay("doctor", environment={"FREEPLAY_THREADS": "two"}, code=1)
        self.assertIn("'two'", out)
        self.freeplay("doctor", environment={"FREEPLAY_THREADS": "2"})


if __name__ == "__main__":
    unittest.main()
