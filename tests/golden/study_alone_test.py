"""A study's folder needs nothing outside: plugins, edited copies, results kept afterwards, pages that were moved."""
import csv
import json
import os
import shlex
import shutil
import unittest

from plugins_test import probe
from program import ProgramTest
from study_command_test import BALL, GRID
from study_places_test import EXAMPLE, TWISTED

NAMED = "plugins: [lib/mine.so]\n"
# The probe ends after 0.05 s, where the run goes on for so long.
ENDING = """freeplay: 1
name: ending
plugins: [mine.so]
parameters: {T: 0.1 s}
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  probe: {type: probe, between: [ground, disc]}
simulation: {end: $T, step: 1 ms, output: {interval: 1 ms}}
study:
  axes: {T: [0.02 s, 0.1 s, 0.03 s]}
  reducers: {angle: {channel: joint.pin.angle, reduce: final}}
"""


class StudyAlone(ProgramTest):
    def study(self, *words, code=0, **options):
        return self.freeplay("study", *words, code=code, **options)

    def rows(self, folder):
        with open(self.path(folder, "study.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def twisted(self, named=NAMED):
        """A model whose plugin stands beside it; its plots have an axis."""
        os.makedirs(self.path("far", "lib"), exist_ok=True)
        shutil.copy(EXAMPLE, self.path("far", "lib", "mine.so"))
        text = TWISTED.replace("name: twisted\n", "name: twisted\n" + named)
        return self.write(os.path.join("far", "twisted.yaml"), text + "  plots: {a: {kind: line, x: bodies.disc.mass, y: angle}}\n")

    # --- plugins

    def test_a_plugin_that_a_model_names_by_a_relative_path_goes_with_the_study(self):
        self.study("run", self.twisted(), "--out", "t", "--allow-plugins", "--only", "0")
        os.rename(self.path("far"), self.path("gone"))
        os.rename(self.path("t"), self.path("moved"))
        self.assertIn("plugin-not-allowed", self.study("run", "moved", code=5)[1])
        self.study("run", "moved", "--allow-plugins", "--shard", "2/2")
        self.study("merge", "moved")
        self.assertEqual(["", ""], [row["error"] for row in self.rows("moved")])
        self.assertIn("2 points: same", self.study("verify", "moved", "--allow-plugins")[0])
        self.assertIn("same bytes", self.freeplay("reproduce", "moved", "--allow-plugins")[0])
        self.assertIn("2 points: same", self.study("verify", "moved", "--plugin", os.path.join("gone", "lib", "mine.so"))[0])

    def test_the_command_of_a_point_names_the_plugins_that_the_study_was_made_with(self):
        for named, words in ((NAMED, ("--allow-plugins",)), ("", ("--plugin", os.path.join("far", "lib", "mine.so")))):
            shutil.rmtree(self.path("t"), ignore_errors=True)
            self.study("run", self.twisted(named), "--out", "t", *words)
            shutil.rmtree(self.path("far"))
            command = shlex.split(self.study("point", "t", "1")[0])
            self.assertEqual(self.path("t", "inputs", "0", "plugins", "mine.so"), command[command.index("--plugin") + 1])
            self.freeplay(*command[1:], "--out", "r", "--quiet")
            last = list(csv.DictReader(self.read("r", "results.csv").splitlines()))[-1]
            self.assertEqual(self.rows("t")[1]["angle"], last["joint.pin.angle"])
            # Who says --run has not seen what code the folder names.
            self.assertIn("plugin-not-allowed", self.study("point", "t", "1", "--run", "--out", "r", code=5)[1])
            self.study("point", "t", "1", "--run", "--out", "r", "--allow-plugins")

    def test_another_plugin_of_the_name_is_another_program(self):
        self.study("run", self.twisted(), "--out", "t", "--allow-plugins")
        shutil.copy(probe("throws_in_apply"), self.path("mine.so"))
        self.study("verify", "t", "--plugin", "mine.so", code=3)

    def test_a_plugin_that_is_installed_is_loaded_from_there(self):
        self.study("run", self.twisted(), "--out", "t", "--allow-plugins")
        os.rename(self.path("far", "lib"), self.path("installed"))
        environment = {"FREEPLAY_PLUGIN_PATH": self.path("installed")}
        self.assertEqual("2 points: same\n", self.study("verify", "t", environment=environment)[0])
        # A path into such a folder leads there from the copy of the model, too.
        os.makedirs(self.path("far"), exist_ok=True)
        self.write(os.path.join("far", "twisted.yaml"), self.read("far", "twisted.yaml").replace("lib/", "../installed/"))
        self.study("run", "far/twisted.yaml", "--out", "u", environment=environment)
        self.assertFalse(os.path.exists(self.path("u", "inputs", "0", "plugins")))
        self.assertEqual("2 points: same\n", self.study("verify", "u", environment=environment)[0])

    def test_why_points_failed_is_the_same_wherever_the_plugin_lies(self):
        reasons = []
        for place in ("a", os.path.join("b", "c")):
            os.makedirs(self.path(place))
            shutil.copy(probe("throws_in_apply"), self.path(place, "mine.so"))
            self.write(os.path.join(place, "ending.yaml"), ENDING)
            self.study("run", os.path.join(place, "ending.yaml"), "--out", os.path.join(place, "r"), "--allow-plugins", code=4)
            reasons.append(self.read(place, "r", "failures.jsonl"))
        self.assertEqual(reasons[0], reasons[1])
        self.assertIn("tired", reasons[0])
        self.assertNotIn(self.folder, reasons[0])

    def test_a_plugin_that_ends_the_program_costs_one_point_and_is_reported(self):
        shutil.copy(probe("exits"), self.path("mine.so"))
        self.write("ending.yaml", ENDING)
        answer = json.loads(self.study("run", "ending.yaml", "--out", "r", "--allow-plugins", "--json", code=4)[0])
        self.assertEqual(3, answer["ran"])  # not tried again
        self.assertEqual([("0", ""), ("5", "crash-exit"), ("0", "")], [(row["exit_code"], row["error"]) for row in self.rows("r")])
        self.assertIn("code of a plugin ended its process", self.read("r", "failures.jsonl"))

    # --- copies

    def test_an_edited_copy_is_named(self):
        self.write("ball.yaml", BALL + GRID)
        self.study("run", "ball.yaml", "--out", "r", "--allow-failed", "--quiet")
        text = self.read("r", "inputs", "0", "model.yaml")
        self.write(os.path.join("r", "inputs", "0", "model.yaml"), text.replace("inertia: 0.1", "inertia: 0.2"))
        for words in (("study", "run", "r"), ("study", "status", "r"), ("study", "point", "r", "1"), ("study", "merge", "r"),
                      ("study", "verify", "r"), ("report", "r"), ("study", "script", "r", "--engine", "slurm")):
            _, err = self.freeplay(*words, code=3)
            self.assertIn("its copy inputs/0/model.yaml was edited", err)
            self.assertIn("study-changed", err)
            self.assertNotIn("command line", err)
        self.study("run", "r", "--extend", "--quiet", code=4)
        self.assertIn("inertia: 0.2", self.read("r", "inputs", "0", "model.yaml"))
        self.study("status", "r")

    # --- kept results

    def test_results_of_a_study_that_is_done_are_kept_afterwards(self):
        self.write("ball.yaml", BALL + GRID.replace("40", "3"))
        self.study("run", "ball.yaml", "--out", "r", "--allow-failed", "--quiet")
        table = self.read("r", "study.csv")
        self.assertIn("kept       1 of 1 in r/kept", self.study("run", "r", "--keep", "all", "--allow-failed", "--only", "1")[0])
        self.assertEqual(["1"], os.listdir(self.path("r", "kept", "0000")))
        out, _ = self.study("run", "r", "--keep", "all", "--allow-failed")
        self.assertIn("kept       3 of 6 in r/kept; 3 fail before there is a result", out)
        self.assertEqual(["1", "3", "5"], sorted(os.listdir(self.path("r", "kept", "0000"))))
        self.assertEqual(table, self.read("r", "study.csv"))
        for row in self.rows("r"):
            if row["exit_code"] == "0":
                last = list(csv.DictReader(self.read("r", "kept", "0000", row["index"], "results.csv").splitlines()))[-1]
                self.assertEqual(row["y"], last["body.ball.y"])
        stamp = os.stat(self.path("r", "kept", "0000", "3", "results.csv")).st_mtime_ns
        self.study("run", "r", "--keep", "all", "--allow-failed")
        self.assertEqual(stamp, os.stat(self.path("r", "kept", "0000", "3", "results.csv")).st_mtime_ns)

    # --- pages

    def test_the_page_of_a_study_that_was_moved_is_the_same(self):
        self.study("run", self.twisted(), "--out", "t", "--allow-plugins")
        self.freeplay("report", "t")
        page = self.read("t", "report.html")
        self.assertNotIn(self.folder, page)
        os.makedirs(self.path("else where"))
        os.rename(self.path("t"), self.path("else where", "u"))
        self.assertIn("same bytes", self.freeplay("reproduce", os.path.join("else where", "u", "report.html"))[0])
        self.freeplay("report", os.path.join("else where", "u"), "--force")
        self.assertEqual(page, self.read("else where", "u", "report.html"))
        self.freeplay("report", os.path.join("else where", "u"), "--out", "p.html")
        self.assertIn('"folder":"else where/u"', self.read("p.html"))
        command = "run DIR/inputs/0/model.yaml --set 'bodies.disc.mass=1 kg' --plugin DIR/inputs/0/plugins/mine.so"
        self.assertIn('"command":"freeplay %s"' % command, page)


if __name__ == "__main__":
    unittest.main()
