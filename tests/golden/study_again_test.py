"""A study's directory as other commands take it: compare, export, reproduce; looked at without plugins; starts in the play as an axis."""
import csv
import json
import os
import re
import shutil
import unittest

from program import ProgramTest, mechanism
from study_command_test import BALL, GRID
from study_places_test import EXAMPLE, TWISTED

PLAY = """freeplay: 1
study:
  models: {crank: %s}
  set: {simulation.end: 15 ms, simulation.accuracy: 1 um}
  axes:
    c: [0.1 mm, 0.3 mm]
    repeat: {linspace: [1, 4, 4]}
  reducers: {peak: {summary: joints.wrist.max_force}}
  plots: {scatter: {kind: line, x: c, y: peak}}
"""


class StudyAgain(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.yaml", BALL + GRID)

    def study(self, *words, code=0):
        return self.freeplay("study", *words, code=code)

    def run_ball(self, out, text=BALL + GRID):
        self.write(out + ".yaml", text)
        self.study("run", out + ".yaml", "--out", out, "--allow-failed", "--quiet")

    def rows(self, folder):
        with open(self.path(folder, "study.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def change(self, place, old, new):
        text = self.read(*place)
        self.assertIn(old, text)
        self.write(os.path.join(*place), text.replace(old, new))

    # --- compare

    def test_the_same_points_are_compared_whatever_their_numbers(self):
        self.run_ball("a")
        self.run_ball("b", BALL + GRID.replace("[1, 2, 40]", "[1, 3, 79]").replace("[-2 m/s, 1 m/s]", "[1 m/s, -2 m/s]"))
        out, err = self.freeplay("compare", "a", "b")
        self.assertIn("column,max_abs,max_rel,rms,at_point,ok\n", out)
        rows = {line.split(",")[0]: line.split(",") for line in out.splitlines()[1:] if line[0] != "#"}
        self.assertEqual({"y", "section", "exit_code"}, set(rows))
        self.assertEqual({"0"}, {row[1] for row in rows.values()})  # linspace ends differ, the values in both do not
        self.assertIn("# 3 columns in 80 points: 0 differ", out)
        self.assertIn("78 points of b are not in a", err)
        shutil.copytree(self.path("a"), self.path("c"))
        self.freeplay("compare", "a", "c")
        self.assertIn("# 1 columns in 80 points: 0 differ", self.freeplay("compare", "a", "c", "--channels", "y")[0])

    def test_a_point_that_differs_is_named(self):
        self.run_ball("a")
        shutil.copytree(self.path("a"), self.path("b"))
        good = [row for row in self.rows("a") if row["exit_code"] == "0"]
        self.change(("b", "study.csv"), "," + good[3]["y"] + ",", ",5,")
        out, _ = self.freeplay("compare", "a", "b", code=7)
        self.assertRegex(out, r"(?m)^y,[\d.]+,[\d.]+,[\d.]+,%s,0$" % good[3]["index"])
        self.assertEqual(int(good[3]["index"]), json.loads(self.freeplay("compare", "a", "b", "--json", code=7)[0])[0]["at_point"])
        self.freeplay("compare", "a", "b", "--absolute", "10")
        failed = next(row["index"] for row in self.rows("a") if row["exit_code"] != "0")
        shutil.rmtree(self.path("b"))
        shutil.copytree(self.path("a"), self.path("b"))
        lines = self.read("b", "study.csv").splitlines()
        lines[int(failed) + 1] = lines[int(failed) + 1].replace(",3,", ",0,")
        self.write(os.path.join("b", "study.csv"), "\n".join(lines) + "\n")
        self.assertRegex(self.freeplay("compare", "a", "b", code=7)[0], r"(?m)^exit_code,3,1,.*,%s,0$" % failed)

    def test_what_cannot_be_compared_is_refused(self):
        self.run_ball("a")
        self.run_ball("b", BALL.replace("0.1 s", "0.2 s") + GRID)
        self.assertIn("no point of 'a' is a point of 'b': nothing can be compared", self.freeplay("compare", "a", "b", code=3)[1])
        self.freeplay("run", "ball.yaml", "--out", "run", "--quiet")
        for words, text in ((("a", "run"), "'a' is the directory of a study, and 'run' is none"), (("run", "a"), "'run' is none"),
                            (("a", "a", "--from", "1 ms"), "no times"), (("a", "a", "--channels", "yy"), "did you mean 'y'?")):
            self.assertIn(text, self.freeplay("compare", *words, code=2)[1])

    # --- export

    def test_a_table_is_exported_with_its_record_and_made_again_of_that_alone(self):
        self.run_ball("a")
        self.freeplay("export", "a", "--to", "csv", "--out", "t.csv")
        self.assertEqual(self.read("a", "study.csv"), self.read("t.csv"))
        self.assertEqual(self.read("a", "study.csv"), self.freeplay("export", "a", "--to", "csv")[0])
        self.freeplay("export", "a", "--to", "json", "--channels", "y", "--out", "t.json")
        told = json.loads(self.read("t.json"))
        self.assertEqual((["index", "y"], ["1", "m"]), (told["columns"], told["units"]))
        for row, (index, y) in zip(self.rows("a"), told["rows"], strict=True):
            self.assertEqual((row["index"], row["y"]), (str(index), "" if y is None else repr(y)))
        self.freeplay("export", "a", "--to", "hdf5", "--out", "t.h5")
        with open(self.path("a", "study.h5"), "rb") as file, open(self.path("t.h5"), "rb") as other:
            self.assertEqual(file.read(), other.read())
        shutil.rmtree(self.path("a"))
        for table in ("t.csv", "t.json"):
            self.assertIn("same bytes", self.freeplay("reproduce", table)[0])
        self.change(("t.csv",), ",1,", ",1.5,")
        self.assertIn("first difference", self.freeplay("reproduce", "t.csv", code=7)[0])

    def test_a_record_that_leads_elsewhere_is_not_followed(self):
        self.run_ball("a")
        self.freeplay("export", "a", "--to", "csv", "--out", "t.csv")
        record = json.loads(self.read("t.csv.provenance.json"))
        for change in ({"files": [{"path": "../evil", "text": ""}]}, {"files": 3}, {"study": 1}, {"arguments": ["--to", "csv", "--out", "evil"]}, {"arguments": ["--out=evil"]},
                       {"arguments": [1]}):
            self.write("t.csv.provenance.json", json.dumps({**record, **change}))
            self.assertIn("no-provenance", self.freeplay("reproduce", "t.csv", code=6)[1])
        self.assertFalse(os.path.exists(self.path("evil")))

    def test_options_of_results_say_nothing_of_a_study(self):
        self.run_ball("a")
        for words, text in ((("csv", "--from", "1 ms"), "--from says nothing of it"), (("csv", "--table", "events"), "--table"),
                            (("mat", "--out", "t.mat"), "h5read"), (("hdf5",), "needs --out"), (("csv", "--channels", "yy"), "did you mean 'y'?"),
                            (("hdf5", "--channels", "y", "--out", "t.h5"), "all columns")):
            self.assertIn(text, self.freeplay("export", "a", "--to", *words, code=2)[1])

    # --- reproduce

    def test_all_points_run_again_and_every_byte_is_compared(self):
        self.run_ball("a")
        out, _ = self.freeplay("reproduce", "a")
        for name in ("study.csv", "samples.csv", "failures.jsonl", "study.h5"):
            self.assertRegex(out, name + r" +\d+ bytes +same bytes")
        self.assertTrue(out.endswith("\nsame bytes\n"))
        self.assertEqual(out.split("\n", 1)[1], self.freeplay("reproduce", os.path.join("a", "study.csv"))[0].split("\n", 1)[1])
        good = next(row for row in self.rows("a") if row["exit_code"] == "0")
        self.change(("a", "study.csv"), "," + good["y"] + ",", ",5,")
        out, _ = self.freeplay("reproduce", "a", "--out", "again", code=7)
        self.assertIn("point %s, y: 5 recorded, %s now" % (good["index"], good["y"]), out)
        self.assertTrue(os.path.exists(self.path("again", "study", "study.csv")))
        told = json.loads(self.freeplay("reproduce", "a", "--json", code=7)[0])
        self.assertEqual([False, True, True, True], [check["same"] for check in told["checks"]])

    def test_a_study_that_was_changed_or_has_gaps_is_not_reproduced(self):
        self.run_ball("a")
        self.change(("a", "inputs", "0", "model.yaml"), "inertia: 0.1", "inertia: 0.2")
        self.assertIn("a file in it was changed", self.freeplay("reproduce", "a", code=7)[0])
        self.study("run", "ball.yaml", "--out", "part", "--only", "0-9", "--allow-failed", "--quiet")
        err = self.freeplay("reproduce", "part", code=3)[1]
        self.assertIn("70 of 80 points of 'part' are missing", err)
        self.assertIn("freeplay study run part", err)

    def test_pictures_and_page_are_drawn_again_of_the_table(self):
        self.run_ball("a")
        self.study("plot", "a")
        self.freeplay("report", "a")
        for file in (("plots", "lines.svg"), ("report.html",)):
            self.assertIn("same bytes", self.freeplay("reproduce", os.path.join("a", *file))[0])
        self.change(("a", "plots", "lines.svg"), "</svg>", " </svg>")
        self.assertIn("byte ", self.freeplay("reproduce", os.path.join("a", "plots", "lines.svg"), code=7)[0])
        self.study("plot", "a", "--kind", "histogram", "--value", "y")
        self.assertIn("none of the `plots`", self.freeplay("reproduce", os.path.join("a", "plots", "histogram.svg"), code=6)[1])

    # --- plugins

    def test_who_only_looks_runs_no_code_of_plugins(self):
        # In the folder of the study the plugin lies outside of the folders for plugins.
        shutil.copy(EXAMPLE, self.path("mine.so"))
        self.write("twisted.yaml", TWISTED.replace("name: twisted\n", "name: twisted\nplugins: ['%s']\n" % self.path("mine.so")) +
                   "  plots: {a: {kind: line, x: bodies.disc.mass, y: angle}}\n")
        self.assertIn("plugin-not-allowed", self.study("run", "twisted.yaml", "--out", "t", code=5)[1])
        self.study("run", "twisted.yaml", "--out", "t", "--allow-plugins")
        shutil.copytree(self.path("t"), self.path("u"))
        os.remove(self.path("mine.so"))
        table = self.read("t", "study.csv")
        for words in (("study", "status", "t"), ("study", "merge", "t", "u"), ("study", "plot", "t"), ("study", "point", "t", "1"),
                      ("report", "t"), ("compare", "t", "u"), ("export", "t", "--to", "csv")):
            self.freeplay(*words)
        self.assertEqual(table, self.read("t", "study.csv"))
        self.assertIn("angle [mrad]", self.read("t", "plots", "a.svg"))
        for words in (("study", "verify", "t"), ("study", "run", "t"), ("reproduce", "t")):
            self.assertIn("plugin", self.freeplay(*words, code=5)[1])

    # --- starts in the play

    def test_starts_in_the_play_are_an_axis_and_those_of_repeat(self):
        self.write("play.yaml", PLAY % mechanism("slider-crank"))
        self.study("run", "play.yaml", "--out", "p")
        peaks = [float(row["peak"]) for row in self.rows("p")]
        self.assertEqual(["1", "2", "3", "4"] * 2, [row["repeat"] for row in self.rows("p")])
        words = ("run", mechanism("slider-crank"), "--end", "15 ms", "--accuracy", "1 um", "--set", "c=0.3 mm")
        repeat = json.loads(self.freeplay(*words, "--repeat", "4", "--out", "r", "--json")[0])["repeat"]
        self.assertEqual(repeat["joints"]["wrist"]["max_force"]["values"], peaks[4:])
        self.assertEqual(4, len(set(peaks[4:])))
        third = json.loads(self.freeplay(*words, "--set", "repeat=3", "--out", "three", "--json")[0])
        self.assertEqual(peaks[6], third["joints"]["wrist"]["max_force"])
        self.freeplay("reproduce", "three")
        self.assertIn("--set repeat=3", self.study("point", "p", "6")[0])
        self.freeplay("run", mechanism("slider-crank"), "--end", "15 ms", "--set", "repeat=3", "--set", "seed=2", "--out", "other", "--quiet")
        self.assertNotEqual(self.read("three", "results.csv"), self.read("other", "results.csv"))
        picture = self.study("plot", "p") and self.read("p", "plots", "scatter.svg")
        self.assertEqual(8, len(re.findall(r"data-point=", picture)))

    def test_starts_that_there_are_not_are_refused(self):
        for words, text in ((("repeat=0",), "from 1 to 2^53"), (("repeat=1.5",), "whole number"), (("repeat=many",), "many"),
                            (("seed=-1",), "from 0"), (("repeat=2", "--repeat", "3"), "--set repeat=2 asks for another")):
            self.assertIn(text, self.freeplay("run", mechanism("slider-crank"), "--set", *words, code=2)[1])
        self.write("play.yaml", PLAY % mechanism("four-bar") + "")
        text = self.read("play.yaml").replace("c: [0.1 mm, 0.3 mm]\n", "").replace("wrist.max_force", "*.max_force, over: max").replace("x: c", "x: repeat")
        self.write("play.yaml", text)
        self.assertIn("no joint has play", self.study("plan", "play.yaml", code=3)[1])


if __name__ == "__main__":
    unittest.main()
