"""freeplay analyze: columns, sources of poses, maps."""
import json
import math
import os
import pty
import re
import signal
import subprocess
import unittest
import xml.etree.ElementTree as xml

from analyze_cases import FOUR_BAR, KINDS, AnalyzeTest
from program import PROGRAM, let_work, mechanism

ERROR = "x,y,angle,reachable,dx,dy,dangle,position,ls_dx,ls_dy,ls_dangle,ls_position"


class Analyze(AnalyzeTest):
    # --- columns -------------------------------------------------------------------------------------------------

    def test_columns_of_each_kind(self):
        legs = ["leg%d.A" % i for i in (1, 2, 3)]
        joints = ["joint.leg%d.%s.%s" % (i, j, f) for i in (1, 2, 3) for j in "ABC" for f in ("fx", "fy")]
        wanted = {
            "ik": "time,x,y,angle," + ",".join("joint.%s.%s" % (j, q) for j in legs
                                               for q in ("angle", "speed", "acceleration")),
            "workspace": "x,y,angle,reachable,legs,condition",
            "singularity": "x,y,angle,reachable,sigma_min,sigma_max,condition,inverse_min,kind",
            "error": ERROR,
            "inverse-dynamics": "time,x,y,angle," + ",".join(["driver.%s.torque" % j for j in legs] + joints)}
        for kind, columns in wanted.items():
            out, err = self.freeplay("analyze", kind, mechanism("3-rrr"), "--pose", "0.05,0,0")
            self.assertEqual("", err)
            self.assertEqual(columns, out.splitlines()[0])
            self.assertEqual(2, len(out.splitlines()))

    def test_json_holds_the_same_rows(self):
        for kind in KINDS:
            words = (kind, mechanism("4-rrr"), "--pose", "0.05,0,0")
            document = json.loads(self.freeplay("analyze", *words, "--json")[0])
            self.assertEqual(["kind", "columns", "rows", "summary", "provenance"], list(document))
            self.assertEqual(kind, document["kind"])
            for row, cells in zip(self.rows(*words), document["rows"]):
                self.assertEqual(list(row), document["columns"])
                for text, cell in zip(row.values(), cells):
                    self.assertEqual(text, "" if cell is None else cell if isinstance(cell, str) else text)
                    if isinstance(cell, (int, float)):
                        self.assertEqual(float(text), cell)
            summary = document["summary"]
            self.assertEqual((3, 1, 0.11), (summary["freedoms"], summary["redundant_inputs"], summary["length"]))

    def test_both_bounds_agree_without_redundancy_only(self):
        row, = self.rows("error", mechanism("3-rrr"), "--pose", "0.05,0,0")
        # Vertices of the parallelepiped A^-1 {+-D}, D = 0.2 mm.
        self.assertAlmostEqual(300.2786, 1e6 * float(row["position"]), 4)
        for name in ("dx", "dy", "dangle", "position"):
            self.assertEqual(row[name], row["ls_" + name])
        row, = self.rows("error", mechanism("4-rrr"), "--pose", "0.05,0,0")
        self.assertAlmostEqual(264.9860, 1e6 * float(row["position"]), 4)
        self.assertAlmostEqual(285.5591, 1e6 * float(row["ls_position"]), 4)

    def test_causes_of_the_worst_error(self):
        out, _ = self.freeplay("analyze", "error", mechanism("4-rrr"), "--pose", "0.05,0,0", "--json")
        document = json.loads(out)
        worst = document["summary"]["worst"]
        self.assertAlmostEqual(document["rows"][0][7], sum(worst["share"].values()), 15)
        self.assertAlmostEqual(0.000105179478119538, worst["share"]["joint.leg3.B"] + worst["share"]["joint.leg3.C"], 12)
        self.assertAlmostEqual(document["rows"][0][7], math.hypot(*worst["displacement"][:2]), 15)
        row, = self.rows("error", mechanism("4-rrr"), "--pose", "0.05,0,0", "--sensitivity")
        self.assertAlmostEqual(worst["share"]["joint.leg3.B"], 1e-4 * float(row["joint.leg3.B.sensitivity"]), 15)
        self.assertIn("driver.leg4.A.sensitivity", row)

    def test_a_mechanism_that_starts_stretched_can_be_posed(self):
        # Crank of 50 mm, coupler of 120 mm in line with the slide: x = 50 cos a + 120 cos b, 50 sin a = -120 sin b.
        model = mechanism("slider-crank")
        for elbow in (1, -1):
            row, = self.rows("ik", model, "--frame", "slider", "--pose", "x=0.15", "--elbow", str(elbow))
            angle = math.acos((0.15 ** 2 + 0.05 ** 2 - 0.12 ** 2) / (2 * 0.15 * 0.05))
            self.assertAlmostEqual(elbow * angle, float(row["joint.main.angle"]), 9)
        rows = self.rows("workspace", model, "--frame", "slider", "--grid", "x=0.065:0.175:12")
        self.assertEqual([0] + 10 * [1] + [0], [int(row["reachable"]) for row in rows])

    def test_legs_of_a_five_bar_are_counted_and_named(self):
        # Cranks of 150 mm on pins at x = -100 and 100 mm, couplers of 200 mm.
        rows = self.rows("workspace", mechanism("five-bar"), "--grid", "x=-0.36:0.36:10", "--grid", "y=0.05:0.41:7")
        for row in rows:
            x, y = float(row["x"]), float(row["y"])
            reach = [0.05 < math.hypot(x - a, y) < 0.35 for a in (-0.1, 0.1)]
            self.assertEqual((sum(reach), all(reach)), (int(row["legs"]), row["reachable"] == "1"), (x, y))
        self.assertIn("leg of 'A2'", self.message("ik", mechanism("five-bar"), "--pose", "-0.1,0.29", code=4))

    def test_elbow_chooses_the_mode_of_a_leg_with_fewer_freedoms_than_three(self):
        def crank(a, elbow, x, y):
            d = math.hypot(x - a, y)
            return math.atan2(y, x - a) + elbow * math.acos((d * d + 0.15 ** 2 - 0.2 ** 2) / (2 * d * 0.15))

        # The leg of A2 ends with a pin on the body of the frame; that of A1 ends with the body itself and keeps its side.
        for elbow in (1, -1):
            row, = self.rows("ik", mechanism("five-bar"), "--pose", "0.04,0.25", "--elbow", str(elbow))
            on_path, = self.rows("ik", mechanism("five-bar"), "--time", "0:0:1", "--elbow", str(elbow))
            for found in (row, on_path):
                for name, a, side in (("A1", -0.1, 1), ("A2", 0.1, elbow)):
                    gap = float(found["joint.%s.angle" % name]) - crank(a, side, 0.04, 0.25)
                    self.assertAlmostEqual(0, math.remainder(gap, 2 * math.pi), 9)

    def test_an_elbow_without_effect_is_reported(self):
        five_bar = ("ik", mechanism("five-bar"), "--pose", "0.04,0.25")
        for words, wanted in (
                (("ik", mechanism("3-rpr"), "--pose", "0,0.1,0.1", "--elbow", "-1"), "lead from 'leg1.P', 'leg2.P', 'leg3.P' to"),
                ((*five_bar, "--elbow", "-1"), "lead from 'A1' to the platform: the start decides its working mode"),
                ((*five_bar, "--elbow", "1", "--branches"), "chooses nothing with --branches"),
                (("ik", mechanism("five-bar"), "--input", "A1=2,A2=1.1", "--elbow", "1"), "chooses nothing with --input"),
                (five_bar, None), (("ik", mechanism("3-rrr"), "--pose", "0,0,0", "--elbow", "-1"), None)):
            _, err = self.freeplay("analyze", *words)
            if wanted is None:
                self.assertEqual("", err)
            else:
                self.assertIn(wanted, err)
                self.assertRegex(err, r"^\S+\.yaml: warning: --elbow.*\[elbow-ignored\]\n$")
        text = self.text("3-rpr").replace("analysis:\n", "analysis:\n  elbow: -1\n")
        _, err = self.freeplay("analyze", "ik", self.write("m.yaml", text), "--pose", "0,0.1,0.1")
        self.assertIn("'analysis.elbow': no crank and coupler", err)

    def test_outputs_are_those_of_the_pose(self):
        def outputs(*words):
            out, err = self.freeplay("analyze", "singularity", *words, "--json")
            return json.loads(out)["summary"]["outputs"], err

        model = self.write("m.yaml", FOUR_BAR + "analysis: {frame: coupler/P}\n")
        self.assertEqual((["y"], ""), outputs(model, "--pose", "y=0.14"))
        self.assertEqual((["x", "y"], ""), outputs(mechanism("five-bar"), "--input", "A1=2,A2=1.1"))
        names, err = outputs(model, "--input", "A=1.2")
        self.assertEqual(["x"], names)
        self.assertIn("gives the outputs: x is taken", err)
        # Dead centres of a slider-crank: of the slider, not of the crank.
        for frame, component, kind in (("slider", "x", "inverse"), ("crank", "angle", "none")):
            row, = self.rows("singularity", self.write("s.yaml", self.text("slider-crank") + "analysis: {grid: {%s: 0}}\n" % component),
                             "--frame", frame, "--input", "main=0")
            self.assertEqual(kind, row["kind"])

    def test_shares_add_up_where_one_joint_has_play_and_a_driver(self):
        with open(mechanism("3-rrr"), encoding="utf-8") as file:
            text = file.read().split("\nanalysis:")[0]
        self.write("m.yaml", text + "\nanalysis: {error: {clearance: {leg1.A: 0.1 mm, leg2.A: 0.1 mm}, input: 0.05 deg}}\n")
        out, _ = self.freeplay("analyze", "error", "m.yaml", "--pose", "0.05,0,0", "--json")
        document = json.loads(out)
        share = document["summary"]["worst"]["share"]
        self.assertTrue({"joint.leg1.A", "driver.leg1.A"} <= share.keys())
        self.assertAlmostEqual(document["rows"][0][7], sum(share.values()), 15)

    def test_samples_are_feasible_and_repeat(self):
        words = ("error", mechanism("4-rrr"), "--pose", "0.05,0,0", "--samples", "20000")
        row, = self.rows(*words, "--seed", "5")
        self.assertLess(float(row["sample_max_position"]), float(row["position"]))
        self.assertLess(float(row["sample_max_dangle"]), float(row["dangle"]))
        self.assertGreater(float(row["sample_rms_position"]), 5e-5)
        self.assertEqual([row], self.rows(*words, "--seed", "5"))
        self.assertNotEqual([row], self.rows(*words, "--seed", "6"))

    # --- sources of poses ----------------------------------------------------------------------------------------

    def test_ways_to_write_a_pose(self):
        wanted = self.rows("ik", mechanism("3-rrr"), "--pose", "-0.05,0,0.1")
        for pose in ("x=-0.05,y=0,angle=0.1", "angle=0.1 rad, x=-5 cm, y=0", "-50 mm,0,0.1"):
            self.assertEqual(wanted, self.rows("ik", mechanism("3-rrr"), "--pose", pose))
        self.assertEqual(2, len(self.rows("ik", mechanism("3-rrr"), "--pose", "0.05,0", "--pose", "0,0.05")))
        row, = self.rows("ik", mechanism("3-rrr"), "--pose", "0.05,0")  # the angle is 0 then
        self.assertEqual("0", row["angle"])

    def test_grid_rows_run_over_the_angle_first(self):
        rows = self.rows("workspace", mechanism("3-rrr"), "--grid", "x=0:0.1:2", "--grid", "y=-0.1:0:2", "--grid",
                         "angle=0:10 deg:3")
        self.assertEqual(12, len(rows))
        self.assertEqual([("0", "-0.1"), ("0", "-0.1"), ("0", "-0.1"), ("0", "0")],
                         [(r["x"], r["y"]) for r in rows[:4]])
        self.assertAlmostEqual(math.pi / 36, float(rows[1]["angle"]))

    def test_workspace_of_closed_form(self):
        # Cell centres of +-0.4 m in 80 x 80 cells: 1446 are reached by all legs.
        document = json.loads(self.freeplay("analyze", "workspace", mechanism("3-rrr"), "--grid", "x=-0.395:0.395:80",
                                            "--grid", "y=-0.395:0.395:80", "--json")[0])
        self.assertEqual(1446, document["summary"]["reachable"])
        self.assertAlmostEqual(0.1446, document["summary"]["area"], 12)
        self.assertEqual((1, 0), (document["summary"]["regions"], document["summary"]["holes"]))
        for x, y in document["summary"]["boundary"]:  # one of the legs is stretched there
            ends = [math.hypot(x - 0.29 * math.cos(a), y - 0.29 * math.sin(a))
                    for a in (7 * math.pi / 6, 11 * math.pi / 6, math.pi / 2)]
            self.assertAlmostEqual(0.48, max(ends), 9)
        legs = [row[4] for row in document["rows"]]
        self.assertTrue(all(0 <= n <= 3 for n in legs) and 0 < min(legs) + 1)

    def test_path_gives_speeds(self):
        rows = self.rows("ik", mechanism("3-rrr"), "--time", "0:0.5:51")
        self.assertEqual(51, len(rows))
        self.assertAlmostEqual(0.902532239177086, float(rows[0]["joint.leg1.A.speed"]), 11)
        self.assertAlmostEqual(24.7447548749753, float(rows[0]["joint.leg1.A.acceleration"]), 9)
        angles = [float(r["joint.leg2.A.angle"]) for r in rows]
        self.assertTrue(all(abs(b - a) < 0.5 for a, b in zip(angles, angles[1:])))
        for kind in ("workspace", "singularity", "error"):
            self.assertEqual(3, len(self.rows(kind, mechanism("3-rrr"), "--time", "0:0.1:3")))

    def test_without_a_source_the_run_is_looked_at(self):
        rows = self.rows("ik", mechanism("five-bar"))
        self.assertEqual((101, "0", "0.5"), (len(rows), rows[0]["time"], rows[-1]["time"]))

    def test_inputs_give_the_pose(self):
        words = ",".join("leg%d.A=%s" % (i + 1, a) for i, a in enumerate((1.26927570479569, -2.64319355749188,
                                                                          -0.703493261608324)))
        row, = self.rows("ik", mechanism("3-rrr"), "--input", words)
        for name, value in (("x", 0.02), ("y", -0.03), ("angle", 0.1)):
            self.assertAlmostEqual(value, float(row[name]), 10)
        both = self.rows("ik", mechanism("3-rrr"), "--input", words, "--branches")
        self.assertEqual(["1", "2"], [r["branch"] for r in both])
        self.assertIn("-1.37333917577", " ".join(r["angle"] for r in both))
        for kind in ("workspace", "singularity", "error", "inverse-dynamics"):
            self.rows(kind, mechanism("3-rrr"), "--input", words)

    def test_elbows_choose_the_mode(self):
        modes = self.rows("ik", mechanism("3-rrr"), "--pose", "0.02,-0.03,0.1", "--branches")
        self.assertEqual(8, len(modes))
        row, = self.rows("ik", mechanism("3-rrr"), "--pose", "0.02,-0.03,0.1", "--elbow", "1,-1,1")
        self.assertEqual([m["branch"] for m in modes if m["joint.leg2.A.angle"] == row["joint.leg2.A.angle"] and
                          m["joint.leg1.A.angle"] == row["joint.leg1.A.angle"] and
                          m["joint.leg3.A.angle"] == row["joint.leg3.A.angle"]], ["3"])

    def test_other_mechanisms_by_the_same_words(self):
        row, = self.rows("error", mechanism("3-rpr"), "--pose", "0.02,-0.03,0.1")
        self.assertAlmostEqual(329.185054176936, 1e6 * float(row["position"]), 6)
        row, = self.rows("inverse-dynamics", mechanism("3-rpr"), "--time", "0.1:0.1:1")
        self.assertAlmostEqual(-6.16170145591126, float(row["driver.leg1.P.force"]), 7)
        row, = self.rows("error", mechanism("five-bar"), "--input", "A1=1.9,A2=1.1")
        self.assertAlmostEqual(253.479893352514, 1e6 * float(row["position"]), 6)
        for kind in KINDS:
            self.rows(kind, mechanism("five-bar"), "--pose", "0.02,0.25")
            self.rows(kind, mechanism("3-rpr"), "--pose", "0.02,0.05,0.1")

    def test_a_mechanism_of_one_freedom(self):
        model = self.write("m.yaml", FOUR_BAR + "analysis: {error: {clearance: {B: 0.1 mm, C: 0.1 mm, D: 0.1 mm}}}\n")
        row, = self.rows("error", model, "--frame", "coupler/P", "--input", "A=1.0471975511966")
        self.assertAlmostEqual(192.070226025067, 1e6 * float(row["position"]), 6)
        row, = self.rows("ik", model, "--frame", "coupler/P", "--time", "0.25:0.25:1")
        self.assertAlmostEqual(150.0, math.degrees(float(row["joint.A.angle"])), 9)
        self.assertAlmostEqual(2 * math.pi, float(row["joint.A.speed"]), 10)
        self.assertEqual(1, len(self.rows("singularity", model, "--frame", "coupler/P", "--pose", "x=0.14")))

    def test_frame_option_wins(self):
        row, = self.rows("ik", mechanism("3-rrr"), "--pose", "0.05,0,0", "--frame", "platform/leg1.C")
        other, = self.rows("ik", mechanism("3-rrr"), "--pose", "0.05,0,0")
        self.assertNotEqual(row["joint.leg1.A.angle"], other["joint.leg1.A.angle"])

    def test_backlash_of_drivers_counts(self):
        model = self.write("m.yaml", self.text("3-rrr").replace(
            "analysis:\n", "analysis:\n  error: {input: 2e-4}\n"))
        row, = self.rows("error", model, "--pose", "0.05,0,0")
        self.assertAlmostEqual(369.741842095852, 1e6 * float(row["position"]), 6)

    def test_parameters_and_ideal_joints(self):
        row, = self.rows("error", mechanism("3-rrr"), "--pose", "0,0,0", "--set", "c=50 um")
        self.assertAlmostEqual(266.666666667 / 2, 1e6 * float(row["position"]), 6)
        out, err = self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0,0,0", "--ideal", "all")
        self.assertTrue(out.splitlines()[1].endswith(",0,0,0,0,0,0,0,0"))
        self.assertIn("all errors are 0", err)

    def test_preload_adds_inner_tension(self):
        rows = [self.rows("inverse-dynamics", mechanism("4-rrr"), "--time", "0:0:1", "--preload", p)[0]
                for p in ("0", "0.2 N*m")]
        change = [float(rows[1]["driver.leg%d.A.torque" % i]) - float(rows[0]["driver.leg%d.A.torque" % i])
                  for i in (1, 2, 3, 4)]
        self.assertAlmostEqual(0.2, math.sqrt(sum(x * x for x in change)), 10)
        self.assertGreater(max(change), -min(change))
        for i, torque in enumerate((1.319689, 0.415943, -1.731290, 0.000244)):
            self.assertAlmostEqual(torque, float(rows[0]["driver.leg%d.A.torque" % (i + 1)]), 6)

    # --- files ---------------------------------------------------------------------------------------------------

    def test_out_writes_the_table(self):
        wanted, _ = self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0,0,0")
        self.assertEqual(("", ""), self.freeplay("analyze", "error", mechanism("3-rrr"), "--pose", "0,0,0", "--out", "e.csv"))
        self.assertEqual(wanted, self.read("e.csv"))

    def test_maps_are_the_same_for_any_number_of_threads(self):
        for kind in ("error", "workspace", "singularity"):
            texts = set()
            for threads in ("1", "2", "5"):
                self.freeplay("analyze", kind, mechanism("4-rrr"), "--grid", "x=-0.3:0.3:25", "--grid", "y=-0.3:0.3:25",
                              "--svg", "m.svg", "--out", "m.csv", environment={"FREEPLAY_THREADS": threads})
                texts.add(self.read("m.svg") + self.read("m.csv"))
            self.assertEqual(1, len(texts))

    def test_map_shows_what_its_legend_says(self):
        self.freeplay("analyze", "singularity", mechanism("3-rrr"), "--grid", "x=-0.2:0.2:41", "--grid", "y=-0.2:0.2:41",
                      "--grid", "angle=-0.6:-0.6:1", "--svg", "m.svg", "--out", "m.csv")
        text = self.read("m.svg")
        labels = [e.text for e in xml.fromstring(text).iter("{http://www.w3.org/2000/svg}text")]
        for label in ("condition number", "out of reach", "singular (points: x)", "path, from the dot on", "x [mm]"):
            self.assertIn(label, labels)
        self.assertIn("url(#out)", text)
        self.assertRegex(text, r'stroke-dasharray="8,4"/>\n<path')  # singular curves, and the legend's piece
        self.assertFalse(re.search("nan|inf", re.sub("<metadata>.*</metadata>", "", text)))

    def test_interrupts_end_it_and_leave_nothing(self):
        words = [PROGRAM, "analyze", "error", mechanism("4-rrr"), "--pose", "0,0", "--samples", "1000000000", "--json",
                 "--out", "e.csv"]
        for sign in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                let_work(process, 0.5)
                process.send_signal(sign)
                out, err = process.communicate(timeout=60)
            self.assertEqual(130, process.returncode)
            self.assertEqual((130, "interrupted"), (json.loads(out)["error"]["exit_code"], json.loads(out)["error"]["messages"][0]["id"]))
            self.assertEqual([], os.listdir(self.folder))

    def test_long_analyses_show_progress(self):
        def line(*options):
            ours, theirs = pty.openpty()
            words = [PROGRAM, "analyze", "error", mechanism("4-rrr"), "--pose", "0,0", "--samples", "1000000000", *options]
            with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=theirs) as process:
                let_work(process, 3.0)
                process.terminate()
                process.wait(timeout=60)
            os.close(theirs)
            text = os.read(ours, 100000).decode()
            os.close(ours)
            return text

        self.assertRegex(line(), r"\r +0 %  0 / 1 poses analysed  eta --:-- *\r")
        self.assertNotIn("%", line("--quiet"))


if __name__ == "__main__":
    unittest.main()
