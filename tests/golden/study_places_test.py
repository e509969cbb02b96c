"""freeplay study: many starters of one directory, scripts, and what is said where a study ends without its interval."""
import csv
import json
import os
import re
import subprocess
import unittest

from program import BUILD, PROGRAM, ProgramTest, mechanism
from study_command_test import BALL, GRID

EXAMPLE = os.path.join(BUILD, "plugins", "example", "torsional_spring_damper.so")
TWISTED = """freeplay: 1
name: twisted
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  spring: {type: torsional-spring-damper, between: [ground, disc], stiffness: 5 N*m, free_angle: 20 deg}
initial: {joints: {pin: 0.1}}
simulation: {end: 10 ms, step: 1 ms, output: {interval: 1 ms}}
study:
  axes: {bodies.disc.mass: [1 kg, 2 kg]}
  reducers: {angle: {channel: joint.pin.angle, reduce: final}}
"""


class StudyPlaces(ProgramTest):

    def study(self, *words, code=0):
        return self.freeplay("study", *words, code=code)

    def together(self, commands):
        """Starts all at once; returns their exit codes and what they said."""
        started = [subprocess.Popen([PROGRAM, "study", "run", *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                    text=True) for words in commands]
        said = [process.communicate(timeout=500)[1] for process in started]
        return [process.returncode for process in started], said

    def test_of_many_starters_of_one_directory_one_wins_and_all_do_their_part(self):
        self.write("ball.yaml", BALL + GRID)
        self.study("run", "ball.yaml", "--out", "calm", "--allow-failed")
        for turn in range(4):
            out = "r%d" % turn
            codes, said = self.together([["ball.yaml", "--out", out, "--jobs", "1", "--shard", "%d/6" % (i + 1), "--allow-failed", "--quiet"]
                                         for i in range(6)])
            self.assertEqual([0] * 6, codes, said)
            self.study("merge", out)
            for name in ("study.csv", "study.h5", "study.yaml"):
                with open(self.path(out, name), "rb") as file, open(self.path("calm", name), "rb") as calm:
                    self.assertEqual(calm.read(), file.read(), name)
            self.assertEqual([], [name for name in os.listdir(self.path(out)) if name.startswith(".")])

    def test_whole_runs_of_one_directory_at_once_make_one_table(self):
        self.write("ball.yaml", BALL + GRID)
        codes, said = self.together([["ball.yaml", "--out", "r", "--jobs", "1", "--allow-failed", "--quiet"]] * 4)
        self.assertEqual([0] * 4, codes, said)
        with open(self.path("r", "study.csv"), encoding="utf-8") as file:
            self.assertEqual(list(range(80)), [int(row["index"]) for row in csv.DictReader(file)])

    def test_copies_that_a_killed_starter_left_out_are_made_by_the_next(self):
        self.write("ball.yaml", BALL + GRID)
        self.study("run", "ball.yaml", "--out", "r", "--allow-failed", "--only", "0")
        os.remove(self.path("r", "study.yaml"))
        self.study("run", "ball.yaml", "--out", "r", "--allow-failed")
        self.study("status", "r")
        self.write("other.yaml", BALL.replace("0.1 s", "0.2 s") + GRID)
        self.study("run", "other.yaml", "--out", "other", "--allow-failed")
        _, err = self.study("merge", "other", "--out", "r", code=3)
        self.assertIn("another study was begun in 'r'", err)

    def test_scripts_give_their_tasks_what_loads_the_plugins(self):
        self.write("twisted.yaml", TWISTED.replace("name: twisted\n", "name: twisted\nplugins: ['%s']\n" % EXAMPLE))
        for engine, file in (("gnu-parallel", "run.sh"), ("slurm", "array.sh"), ("slurm", "merge.sh"), ("snakemake", "Snakefile")):
            for words in (("--allow-plugins",), ("--plugin", EXAMPLE)):
                self.study("script", "twisted.yaml", "--out", "s", "--engine", engine, "--probe", "1", *words)
                text = self.read("s", "jobs", file)
                for line in text.splitlines():
                    if "study run" in line or "study merge" in line:
                        self.assertIn(" ".join(words), line)

    def test_scripts_for_slurm_are_submitted_from_any_folder(self):
        queue = self.write("sbatch", "#!/bin/sh\necho 7\n")
        os.chmod(self.path(queue), 0o755)
        self.write("ball.yaml", BALL + GRID)
        folder = self.path("it's $5 of `all` \"good\" 10% \\{}")
        command = self.freeplay("study", "script", "ball.yaml", "--out", folder, "--engine", "slurm", "--probe", "1")[0].splitlines()[-1]
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=dict(os.environ, PATH=self.folder + ":" + os.environ["PATH"]))
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        status = done.stdout.splitlines()[-1].split("what is done: ")[1]
        self.assertIn("0 of", subprocess.run(["bash", "-c", status], capture_output=True, text=True).stdout)

    def test_scripts_that_no_engine_takes_are_refused(self):
        self.write("ball.yaml", BALL + GRID)
        for words, text in ((("slurm", "--tasks", "5000"), "--tasks 5000 is more than --max-array 1000"),
                            (("slurm", "--tasks", "200", "--max-array", "100"), "--tasks 200 is more than --max-array 100"),
                            (("gnu-parallel", "--hosts", "nowhere"), "there is no such file"),
                            (("slurm", "--minutes", "5"), "from 10 to 60"), (("slrm",), "did you mean 'slurm'?")):
            self.assertIn(text, self.study("script", "ball.yaml", "--engine", *words, code=2)[1])
        self.assertFalse(os.path.exists(self.path("results")))

    def test_a_joint_that_a_point_closes_has_no_values(self):
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("crank.yaml", file.read() + """study:
  set: {simulation.end: 2 ms, simulation.output.discard: 0 s}
  axes: {ideal: [[wrist], none]}
  reducers:
    force: {channel: joint.wrist.fn, reduce: max}
    ratio: {value: "[joint.wrist.fn]/(1 N) + 1", reduce: max}
    hits: {events: wrist, reduce: count}
    place: {channel: body.slider.x, reduce: final}
    turns: {channel: body.slider.x, reduce: poincare, when: {channel: joint.wrist.fn, crosses: 1 N}}
""")
        self.study("run", "crank.yaml", "--out", "r")
        with open(self.path("r", "study.csv"), encoding="utf-8") as file:
            closed, loose = csv.DictReader(file)
        self.assertEqual(["", "", ""], [closed[name] for name in ("force", "ratio", "turns")])
        self.assertNotIn("", [loose[name] for name in ("force", "ratio", "place")])
        self.assertNotEqual("", closed["place"])

    def test_a_file_that_a_point_reads_is_looked_for_before_anything_runs(self):
        self.write("disc.yaml", "freeplay: 1\nbodies: {disc: {mass: 1, inertia: 1}}\njoints: {axle: {type: revolute, between: [ground, disc]}}\n"
                   "drivers: {motor: {joint: axle, kind: velocity, table: {file: a.csv}}}\nsimulation: {end: 10 ms}\n"
                   "study:\n  axes: {drivers.motor.table.file: [a.csv, b.csv]}\n  reducers: {w: {channel: joint.axle.speed, reduce: final}}\n")
        for name in ("a.csv", "b.csv"):
            self.write(name, "t,w\n0,0\n1,%d\n" % ord(name[0]))
        self.study("run", "disc.yaml", "--out", "r", "--quiet")
        os.remove(self.path("b.csv"))
        self.assertRegex(self.study("run", "disc.yaml", "--out", "r", code=3)[1], r"disc\.yaml:7:44: error: .*cannot read 'b\.csv'")
        self.write("disc.yaml", self.read("disc.yaml").replace(", b.csv", ""))
        self.assertIn("--extend keeps", self.study("run", "disc.yaml", "--out", "r", code=3)[1])
        self.assertEqual("2 points: same\n", self.study("verify", "r")[0])  # the folder needs nothing outside

    def test_a_model_without_play_has_no_events(self):
        section = ("study:\n  axes: {g: [1, 2]}\n  reducers: {hits: {events: '%s', reduce: count}, "
                   "hardest: {events: '%s', field: speed, reduce: max}}\n")
        self.write("ball.yaml", BALL + section % ("*", "a*"))
        self.study("run", "ball.yaml", "--out", "r")
        with open(self.path("r", "study.csv"), encoding="utf-8") as file:
            self.assertEqual([("0", "")] * 2, [(row["hits"], row["hardest"]) for row in csv.DictReader(file)])
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("crank.yaml", file.read() + section.replace("g: [1, 2]", "c: [0.1 mm, 0.2 mm]") % ("crankpin", "wirst"))
        _, err = self.study("plan", "crank.yaml", code=3)
        self.assertIn("joint 'crankpin' has no events: nothing in it touches", err)
        self.assertIn("there is no joint 'wirst'", err)

    def test_mistakes_of_axes_and_reducers_are_reported_at_once(self):
        self.write("ball.yaml", BALL + "study:\n  axes: {gg: [1, 2]}\n  reducers: {y: {channel: body.bal.y, reduce: final}}\n")
        _, err = self.study("plan", "ball.yaml", code=3)
        for word in ("did you mean 'g'?", "did you mean 'body.ball.y'?"):
            self.assertIn(word, err)
        self.write("ball.yaml", BALL + "study:\n  axis: {g: [1, 2]}\n  reducers: {y: {channel: body.ball.y, reduce: finnal}}\n")
        _, err = self.study("plan", "ball.yaml", code=3)
        for word in ("did you mean 'axes'?", "did you mean 'final'?"):
            self.assertIn(word, err)

    def test_an_axis_that_changes_nothing_is_reported(self):
        warning = "'%s' changes nothing: the model is the same at all its values"
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("crank.yaml", file.read() + "study:\n  axes: {c: [0.1 mm, 0.2 mm], speed: [500 rpm, 600 rpm]}\n"
                       "  reducers: {place: {channel: body.slider.x, reduce: max}}\n")
        self.assertEqual("", self.study("plan", "crank.yaml", "--probe", "0")[1])
        _, err = self.study("plan", "crank.yaml", "--probe", "0", "--ideal", "all")
        self.assertIn(warning % "c", err)
        self.assertNotIn(warning % "speed", err)
        _, err = self.study("plan", "crank.yaml", "--probe", "0", "--set", "joints.wrist.clearance.radial_clearance=0.3 mm")
        self.assertIn(warning % "c", err)
        self.assertIn("have put something else in the place of what it sets", err)
        self.assertIn("'c' is set by", self.study("plan", "crank.yaml", "--probe", "0", "--set", "c=0.3 mm", code=3)[1])

    def test_figures_of_a_summary_have_their_units(self):
        reducers = {"joints.wrist.max_fn": "N", "joints.*.max_torque, over: max": "N*m", "joints.wrist.max_delta": "m", "joints.wrist.dissipated": "J",
                    "joints.wrist.contacts": "1", "joints.wrist.play.max_impulse": "N*s", "bodies.slider.max_speed": "m/s",
                    "drivers.motor.rms": "N*m", "noise.joints.wrist.max_fn": "N", "energy.kinetic": "J", "time.reached": "s"}
        with open(mechanism("slider-crank"), encoding="utf-8") as file:
            self.write("crank.yaml", file.read() + "study:\n  axes: {c: [0.1 mm, 0.2 mm]}\n  reducers:\n" + "".join(
                "    r%d: {summary: %s}\n" % (i, path.replace("joints.*.max_torque", '"joints.*.max_torque"')) for i, path in enumerate(reducers)))
        self.study("script", "crank.yaml", "--out", "r", "--engine", "gnu-parallel", "--set", "simulation.end=1 ms", "--probe", "1")
        record = json.loads(self.read("r", "study.json"))
        self.assertEqual(dict(zip(["r%d" % i for i in range(len(reducers))], reducers.values())),
                         dict(zip(record["columns"], record["units"])))

    def test_an_interval_that_was_not_reached_is_said(self):
        self.write("stop.yaml", BALL + """study:
  sample: {method: random, points: 40, seed: 4}
  axes: {g: {uniform: [1 m/s^2, 2 m/s^2]}}
  reducers: {y: {channel: body.ball.y, reduce: final}}
  stop: {reducer: y, of: mean, half_width: 1 nm, min_points: 20, block: 10}
""")
        for _ in range(2):
            self.assertIn("`stop` is not reached: after all 40 samples 'y'", self.study("run", "stop.yaml", "--out", "r", "--quiet")[1])
        self.assertIn("40 samples, not reached", self.study("status", "r")[0])
        self.write("stop.yaml", self.read("stop.yaml").replace("1 nm", "1 m"))
        self.assertNotIn("not reached", self.study("run", "stop.yaml", "--out", "wide")[1])
        self.assertNotIn("not reached", self.study("status", "wide")[0])

    def test_a_page_of_many_points_has_at_most_three_megabytes(self):
        reducers = "".join("    r%d: {channel: body.ball.x, reduce: final}\n" % i for i in range(200))
        self.write("wide.yaml", BALL + "study:\n  axes: {g: {linspace: [1, 2, 4000]}}\n  reducers:\n" + reducers +
                   "  plots: {a: {kind: line, x: g, y: r0}, b: {kind: histogram, value: r1}}\n")
        self.study("run", "wide.yaml", "--out", "r", "--quiet")
        self.freeplay("report", "r")
        page = self.read("r", "report.html")
        self.assertTrue(2e6 < len(page.encode()) <= 3e6, len(page.encode()))
        self.assertRegex(page, r"4000 points, of which \d+ are not on this page")
        shown = [int(index) for index in re.findall(r'"(\d+)":\{"row"', page)]
        self.assertEqual(list(range(0, 4000, shown[1] - shown[0])), shown)


if __name__ == "__main__":
    unittest.main()
