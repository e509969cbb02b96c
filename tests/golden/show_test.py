"""freeplay show: text, JSON, graph, drawing."""
import json
import math
import os
import re
import unittest
import xml.etree.ElementTree as xml

from program import ROOT, ProgramTest, drawing, mechanism

SVG = "{http://www.w3.org/2000/svg}"


class Show(ProgramTest):
    def test_json_is_the_expanded_model(self):
        model = json.loads(self.freeplay("show", mechanism("3-rrr"), "--format", "json")[0])
        self.assertEqual(7, len(model["bodies"]))
        self.assertEqual(["leg%d.%s" % (i, j) for i in (1, 2, 3) for j in "ABC"], list(model["joints"]))
        joint = model["joints"]["leg2.B"]
        self.assertEqual(["leg2.crank/B", "leg2.coupler/B"], joint["between"])
        self.assertEqual({"law": "lankarani-nikravesh", "exponent": 1.5, "restitution": 0.9},
                         {k: joint["clearance"]["contact"][k] for k in ("law", "exponent", "restitution")})
        self.assertEqual(model, json.loads(self.freeplay("show", mechanism("3-rrr"), "--json")[0]))

    def test_parameters_are_numbers_in_si_units(self):
        out, _ = self.freeplay("show", mechanism("pendulum"), "--json", "--set", "l=50 cm")
        rod = json.loads(out)["bodies"]["rod"]
        self.assertEqual([0.25, 0], rod["com"])

    def test_a_result_directory_is_its_model_as_it_ran(self):
        crank = mechanism("slider-crank")
        changes = ["--set", "c=0.2 mm", "--end", "1 ms", "--step", "2 us"]
        self.freeplay("run", crank, *changes, "--integrator", "newmark", "--out", "r", "--quiet")
        shown = json.loads(self.freeplay("show", "r", "--json")[0])
        self.assertEqual((1e-3, 2e-6, "newmark"), (shown["simulation"]["end"], shown["simulation"]["step"],
                                                    shown["simulation"]["integrator"]["type"]))
        self.assertEqual("slider-crank", shown["name"])
        self.assertEqual(json.loads(self.freeplay("show", crank, "--json", "--set", "c=0.2 mm")[0])["joints"],
                         shown["joints"])
        self.assertEqual(json.loads(self.freeplay("show", crank, "--json", "--set", "c=0.1 mm")[0])["joints"],
                         json.loads(self.freeplay("show", "r", "--json", "--set", "c=0.1 mm")[0])["joints"])
        self.freeplay("run", crank, "--ideal", "all", "--end", "20 us", "--out", "i", "--quiet")
        self.assertEqual(self.joints_of(self.freeplay("show", crank, "--ideal", "all", "--format", "svg")[0]),
                         self.joints_of(self.freeplay("show", "i", "--format", "svg", "--at", "0 s")[0]))

    def joints_of(self, text):
        return [(e.get("cx"), e.get("cy")) for e in xml.fromstring(text).iter(SVG + "circle")]

    def test_a_result_is_drawn_at_its_end(self):
        crank = mechanism("slider-crank")
        self.freeplay("run", crank, "--end", "5 ms", "--out", "r", "--quiet")
        out, _ = self.freeplay("show", "r", "--format", "svg")
        self.assertIn("t = 5 ms", out)
        self.assertEqual(drawing(self.freeplay("show", "r", "--format", "svg", "--at", "5 ms")[0]), drawing(out))
        self.assertNotEqual(self.joints_of(self.freeplay("show", crank, "--format", "svg")[0]), self.joints_of(out))
        # Without poses there is the start, which says so.
        self.freeplay("run", crank, "--end", "1 ms", "--out", "few", "--channels", "joint.*", "--quiet")
        out, _ = self.freeplay("show", "few", "--format", "svg")
        self.assertRegex(out, ">start: .*few/results.h5.* has no channel .*body.crank.x")
        self.assertEqual(self.joints_of(self.freeplay("show", crank, "--format", "svg")[0]), self.joints_of(out))

    def test_a_result_directory_has_the_inputs_of_its_model(self):
        os.makedirs(self.path("models", "data"))
        self.write("models/data/push.csv", "t,force\n0,1\n1,2\n")
        self.write("models/m.yaml", """freeplay: 1
bodies: {b: {mass: 1, inertia: 1}}
joints: {s: {type: prismatic, between: [ground, b]}}
drivers: {m: {joint: s, kind: force, table: data/push.csv}}
simulation: {end: 10 ms, step: 1 ms}
""")
        self.freeplay("run", "models/m.yaml", "--out", "r", "--quiet")
        os.remove(self.path("models", "data", "push.csv"))
        self.assertIn("push.csv", self.freeplay("show", "r")[0])
        self.freeplay("run", "r/model.yaml", "--out", "again", "--quiet")
        self.assertEqual(self.read("r", "results.csv"), self.read("again", "results.csv"))

    def test_a_directory_that_is_no_result(self):
        os.mkdir(self.path("empty"))
        _, err = self.freeplay("show", "empty", code=3)
        self.assertIn("'empty' is a directory without a result", err)
        self.freeplay("run", mechanism("pendulum"), "--end", "1 ms", "--out", "r", "--quiet")
        _, err = self.freeplay("validate", "r", code=3)
        self.assertIn("r: error: cannot read 'r': it is a directory [file-not-found]", err)
        self.assertIn("its model is 'r/model.yaml'", err)

    def test_text_has_units(self):
        out, err = self.freeplay("show", mechanism("four-bar"))
        self.assertIn("  crank: mass 0.3 kg  inertia 0.001 kg*m^2  com (0.05, 0) m\n    frame tip  (0.1, 0) m\n", out)
        self.assertIn("  B  revolute  crank/tip - coupler/origin\n", out)
        self.assertEqual("", err)

    def test_everything_that_the_file_says_is_shown_with_its_unit(self):
        self.write("motor.csv", "t,force\n0,1\n1,2\n")
        self.write("m.yaml", """freeplay: 1
bodies: {a: {mass: 1, inertia: 1, pose: {angle: 0.5}}, b: {mass: 1, inertia: 1}, c: {mass: 1, inertia: 1}}
joints:
  A: {type: revolute, between: [ground, a], clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm,
      contact: {law: hertz, K: 1e8}}}
  D: {type: distance, between: [a, b], length: 300 mm}
  P: {type: prismatic, between: [ground, b]}
  R: {type: revolute, between: [ground, c]}
  G: {type: gear, of: [P, R], ratio: 20}
drivers:
  m: {joint: P, kind: force, table: {points: [[0, 1], [100 ms, 2 kN]], outside: repeat}}
  n: {joint: R, kind: torque, table: {file: motor.csv, value: force, unit: Nmm, interpolation: linear}}
forces:
  g: {type: gravity, on: [a], value: [0, 1]}
  s: {type: spring-damper, kind: rotational, between: [ground, c], stiffness: 2}
  h: {type: gravity, on: [b], value: [0, 2]}
initial: {joints: {R: 90 deg}}
simulation: {end: 1, accuracy: 1 um, stop: [{channel: body.a.x, above: 1 mm}], output: {frames: [a], channels: [body.*]}}
""")
        out, _ = self.freeplay("show", "m.yaml")
        for text in ("angle 0.5 rad\n", "bearing_radius 0.01 m  ", "K 1e+08 N/m^1.5", "length 0.3 m\n",
                     "G  gear  P - R  ratio 20 rad/m", "points ((0 s, 1 N), (0.1 s, 2000 N))  interpolation cubic",
                     "file motor.csv  value force  time_unit s  unit Nmm  interpolation linear", "stiffness 2 N*m/rad",
                     "value (0, 1) m/s^2", "joints 1.5707963267948966 rad of R", "0 s to 1 s in steps for an accuracy of 1e-06 m",
                     "interval 0.001 s  channels (body.*)  frames (a/origin)", "stop  channel body.a.x  above 0.001 m"):
            self.assertIn(text, out)
        model = json.loads(self.freeplay("show", "m.yaml", "--json")[0])
        self.assertEqual(["g", "s", "h"], list(model["forces"]))
        self.assertEqual([[0, 1], [0.1, 2000]], model["drivers"]["m"]["table"]["points"])
        self.assertEqual(("motor.csv", "Nmm"), tuple(model["drivers"]["n"]["table"][k] for k in ("file", "unit")))
        self.assertEqual(0.3, model["joints"]["D"]["length"])
        simulation = model["simulation"]
        self.assertEqual(1e-6, simulation["accuracy"])
        self.assertNotIn("step", simulation)
        self.assertEqual([{"channel": "body.a.x", "above": 0.001, "after": 0}], simulation["stop"])
        self.assertEqual(["body.*"], simulation["output"]["channels"])

    def test_a_path_and_steps_are_shown(self):
        out, _ = self.freeplay("show", mechanism("3-rrr"))
        self.assertRegex(out, r"paths\n  circle +frame platform/origin  path \{x .*y .*angle ")
        self.assertIn("0 s to 0.6 s in steps of 2e-06 s\n", out)
        self.write("m.yaml", "freeplay: 1\nbodies: {a: {mass: 1, inertia: 1}}\n"
                   "simulation: {step: {size: 1 ms, adaptive: true, min: 1 us}}\n")
        out, _ = self.freeplay("show", "m.yaml")
        self.assertIn("in adaptive steps, the first of 0.001 s  tolerance 1e-06  min 1e-06 s  max 0.01 s", out)

    def test_graph_has_an_edge_for_each_joint(self):
        out, _ = self.freeplay("show", mechanism("four-bar"), "--format", "dot")
        self.assertEqual([("ground", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("ground", "rocker")],
                         re.findall(r'"([^"]+)" -- "([^"]+)"', out))

    def test_drawing_names_everything_and_is_the_same_each_time(self):
        self.assertEqual(("", ""), self.freeplay("show", mechanism("3-rrr"), "--format", "svg", "--out", "a.svg"))
        out, _ = self.freeplay("show", mechanism("3-rrr"), "--format", "svg")
        self.assertEqual(self.read("a.svg"), out)
        labels = [e.text for e in xml.fromstring(out).iter("{http://www.w3.org/2000/svg}text")]
        for name in ("platform", "leg1.crank", "leg3.C", "leg2.coupler/B", "100 mm"):
            self.assertIn(name, labels)
        self.assertEqual(6, out.count("#cc3311\" stroke-width=\"1.5\""))  # rings: six joints have clearance
        texts = re.findall(r'<text x="([-0-9.]+)" y="([-0-9.]+)"', out)
        self.assertTrue(all(0 <= float(x) <= 900 and 0 <= float(y) <= 1400 for x, y in texts))

    def test_a_result_is_drawn_at_an_instant_with_what_came_before(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "10 ms", "--interval", "0.1 ms", "--out", "r")
        rows = [dict(zip(*pair)) for pair in self.rows("r")]
        out, _ = self.freeplay("show", "r", "--format", "svg", "--at", "5.04 ms", "--every", "45 deg", "--trace", "crank/tip",
                               "--magnify", "wrist=60")
        picture = xml.fromstring(out)
        texts = [e.text for e in picture.iter(SVG + "text")]
        self.assertIn("t = 5 ms", texts)
        self.assertIn("wrist, 60 times", texts)
        bodies = 3
        passed = 1 + int(float(rows[50]["joint.main.angle"]) / (math.pi / 4))
        self.assertEqual(passed * bodies, len(self.kind(picture, "path", "other")))
        # All in one scale: the crank's tip goes about its pin at 50 mm, the clearance is 0.5 mm sixty times larger.
        clearance = float(self.kind(picture, "circle", "clearance")[0].get("r"))
        trace = self.points(self.kind(picture, "path", "trace")[0])
        width = max(x for x, _ in trace) - min(x for x, _ in trace)
        turned = 0.05 * (1 - math.cos(float(rows[50]["joint.main.angle"])))
        self.assertAlmostEqual(60 * 0.5e-3 / turned, clearance / width, delta=1e-3)
        journal = self.kind(picture, "circle", "journal")[0]
        middle = self.kind(picture, "circle", "clearance")[0]
        scale = clearance / 0.5e-3
        angle = float(rows[50]["body.coupler.angle"])
        tip = (float(rows[50]["body.coupler.x"]) + 0.06 * math.cos(angle), float(rows[50]["body.coupler.y"]) + 0.06 * math.sin(angle))
        journal_at = (float(rows[50]["body.slider.x"]), float(rows[50]["body.slider.y"]))
        self.assertAlmostEqual(journal_at[0] - tip[0], (float(journal.get("cx")) - float(middle.get("cx"))) / scale, delta=0.2 / scale)
        self.assertAlmostEqual(journal_at[1] - tip[1], (float(middle.get("cy")) - float(journal.get("cy"))) / scale, delta=0.2 / scale)

    def test_a_clearance_that_is_larger_than_its_box_says_so(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--out", "r")
        words = lambda factor: re.findall(r"its clearance is larger: up to (\S+) times", self.freeplay("show", "r", "--format", "svg", "--magnify", "wrist=%g" % factor)[0])
        self.assertEqual([], words(60))
        (most,) = words(500)
        self.assertEqual([], words(float(most)))
        self.assertEqual([most], words(1.6 * float(most)))

    def test_a_spatial_result_is_drawn_where_its_rows_put_it(self):
        self.freeplay("run", mechanism("spatial/bennett"), "--quiet", "--out", "r")
        start, _ = self.freeplay("show", "r", "--format", "svg", "--at", "0 s")
        drawn, _ = self.freeplay("show", mechanism("spatial/bennett"), "--format", "svg")
        # Things as near as each other may be drawn in another order, by rounding.
        points = [[(float(e.get("cx")), float(e.get("cy"))) for e in xml.fromstring(text).iter(SVG + "circle")]
                  for text in (start, drawn)]
        self.assertGreater(len(points[0]), 12)
        for some, others in (points, points[::-1]):
            self.assertLess(max(min(math.dist(a, b) for b in others) for a in some), 0.3)
        later, _ = self.freeplay("show", "r", "--format", "svg", "--every", "100 ms")
        self.assertGreater(len(self.kind(xml.fromstring(later), "path", "other")), 3)

    def rows(self, folder):
        lines = [line.split(",") for line in self.read(folder, "results.csv").splitlines()]
        return [(lines[0], line) for line in lines[1:]]

    @staticmethod
    def kind(picture, shape, name):
        return [e for e in picture.iter(SVG + shape) if e.get("class") == name]

    @staticmethod
    def points(path):
        return [tuple(map(float, pair.split())) for pair in re.findall(r"[ML]([-\d. ]+)", path.get("d"))]

    def test_a_run_that_was_killed_is_shown_as_far_as_it_went(self):
        for form in ("hdf5", "csv"):
            self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "2 ms", "--set", "c=0.4 mm", "--format", form, "--out", form)
            whole = self.freeplay("show", form, "--json")[0]
            drawn = self.freeplay("show", form, "--format", "svg", "--at", "1 ms")[0]
            os.remove(self.path(form, "summary.json"))
            self.assertEqual(whole, self.freeplay("show", form, "--json")[0])
            killed = self.freeplay("show", form, "--format", "svg", "--at", "1 ms")[0]
            self.assertIn("t = 1 ms (the run goes on, or was killed)", killed)
            self.assertEqual(drawing(drawn), drawing(killed).replace(" (the run goes on, or was killed)", ""))

    def test_poses_that_are_no_numbers_are_left_out(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "2 ms", "--interval", "0.1 ms", "--format", "csv", "--out", "r")
        header, *rows = [line.split(",") for line in self.read("r", "results.csv").splitlines()]
        for k, row in enumerate(rows):
            if k % 3 == 1 or k > 17:
                row[header.index("body.slider.x")] = "nan" if k % 2 else "inf"
        self.write("r/results.csv", "\n".join(map(",".join, [header, *rows])) + "\n")
        out, _ = self.freeplay("show", "r", "--format", "svg", "--every", "0.3 ms", "--trace", "slider/com", "--magnify", "wrist=60")
        self.assertIsNone(re.search("nan|inf[^o]", drawing(out)))
        self.assertIn("t = 1.7 ms", out)
        for row in rows:
            row[header.index("body.slider.x")] = "nan"
        self.write("r/results.csv", "\n".join(map(",".join, [header, *rows])) + "\n")
        self.assertIn("no row in which all poses are finite", self.freeplay("show", "r", "--format", "svg", "--at", "1 ms", code=2)[1])

    def test_a_picture_says_what_it_was_made_from(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--out", "r")
        summary = json.loads(self.read("r", "summary.json"))
        for what, options in (("r", ["--at", "0.5 ms", "--trace", "crank/tip"]), ("r", []), (mechanism("slider-crank"), ["--set", "c=0.1 mm"])):
            self.assertEqual({"file": "p.svg"}, json.loads(self.freeplay("show", what, "--format", "svg", *options, "--out", "p.svg", "--json")[0]))
            record = json.loads(xml.fromstring(self.read("p.svg")).find(SVG + "metadata").text)
            self.assertEqual(("show", ["--format", "svg", *options]), (record["made"], record["arguments"]))
            self.assertEqual((summary["model"]["sha256"], what == "r"), (record["model"]["sha256"], "run" in record))
            self.assertIn("freeplay: 1", record["model"]["text"])
            self.assertEqual("same bytes", self.freeplay("reproduce", "p.svg")[0].splitlines()[-1])

    def test_an_instant_that_is_not_there_is_refused(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--interval", "1 us", "--out", "r")
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--out", "few", "--channels", "joint.*")
        svg = ("--format", "svg")
        for arguments, words in ((("r", *svg, "--at", "2 ms"), "the last row is at 0.001 s"),
                                 (("r", *svg, "--at", "-1 s"), "the result has no row so early"),
                                 (("r", *svg, "--every", "1 kg"), "a time (\"1 ms\") or an angle (\"30 deg\") is needed"),
                                 (("r", *svg, "--every", "1 ns"), "more than 200 instants cover each other"),
                                 (("r", *svg, "--trace", "coupler/tp"), "did you mean 'coupler/tip'?"),
                                 (("r", *svg, "--magnify", "main=3"), "joint 'main' has no clearance"),
                                 (("r", *svg, "--magnify", "wrst=3"), "did you mean 'wrist'?"),
                                 (("r", *svg, "--magnify", "wrist"), "JOINT=FACTOR is needed"),
                                 (("few", *svg, "--at", "0 s"), "has no channel 'body.crank.x'"),
                                 (("r", "--at", "0 s"), "need --format svg"),
                                 ((mechanism("slider-crank"), *svg, "--at", "0 s"), "need a result directory")):
            with self.subTest(arguments):
                self.assertIn(words, self.freeplay("show", *arguments, code=2)[1])

    def test_gears_are_drawn_by_their_pitch_circles(self):
        model = """freeplay: 1
bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [%s]}
  mesh: {type: gear, of: [A, B], ratio: %s}
frames: {ground/far: [1, 0]}
"""
        plain, turned = "ground/far, b", "b, ground/far"  # where the wheel is the first body, its angle counts the other way
        for ratio, first, between in ((-2, 2 / 3, plain), (-0.25, 0.2, plain), (2, 2, plain), (0.6, 1.5, plain),
                                      (2, 2 / 3, turned), (-2, 2, turned)):
            out, _ = self.freeplay("show", self.write("m.yaml", model % (between, ratio)), "--format", "svg")
            a, b = self.kind(xml.fromstring(out), "circle", "pitch")
            apart = float(b.get("cx")) - float(a.get("cx"))
            self.assertAlmostEqual(first, float(a.get("r")) / apart, delta=1e-3)
            self.assertAlmostEqual(first / abs(ratio), float(b.get("r")) / apart, delta=1e-3)
            width, height = map(float, xml.fromstring(out).get("viewBox").split()[2:])
            for wheel in (a, b):
                x, y, r = (float(wheel.get(name)) for name in ("cx", "cy", "r"))
                self.assertTrue(r <= x <= width - r and r <= y <= height - r, (ratio, x, y, r, width, height))

    def test_belts_are_drawn_with_their_wraps_and_tangents(self):
        model = """freeplay: 1
bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/far, b]}
frames: {ground/far: [300 mm, 0]}
forces:
  run: {type: belt, between: [a, b], first_radius: 50 mm, second_radius: 100 mm, stiffness: 1e5, pretension: 1, strands: %s}
"""
        for strands, sense in (("open", 1), ("crossed", -1)):
            out, _ = self.freeplay("show", self.write("m.yaml", model % strands), "--format", "svg")
            line, = map(self.points, self.kind(xml.fromstring(out), "path", "strands"))
            # All of it lies between circles and tangents: its length is that of the textbook.
            scale = (max(x for x, y in line) - min(x for x, y in line)) / 0.45
            length = sum(math.dist(p, q) for p, q in zip(line, line[1:])) / scale
            angle = math.asin((0.1 - sense * 0.05) / 0.3)
            wraps = 0.1 * (math.pi + 2 * angle) + 0.05 * (math.pi - 2 * sense * angle)
            self.assertAlmostEqual(wraps + 2 * 0.3 * math.cos(angle), length, delta=2e-3)
            self.assertAlmostEqual(0.2, (max(y for x, y in line) - min(y for x, y in line)) / scale, delta=1e-3)

    def test_cams_and_grooves_are_drawn_to_scale(self):
        model = """freeplay: 1
bodies: {cam: {mass: 1, inertia: 1}, roller: {mass: 1, inertia: 1, pose: {position: [0, 40 mm]}}}
joints:
  A: {type: revolute, between: [ground, cam]}
  G: {type: prismatic, between: [ground/up, roller/up]}
  C: {type: point-on-curve, between: [cam, roller], %s}
frames: {ground/up: {angle: 90 deg}, roller/up: {angle: 90 deg}}
"""
        out, _ = self.freeplay("show", self.write("m.yaml", model % "form: polar, curve: {arcs: [[10 mm, 0, 30 mm]]}"),
                               "--format", "svg")
        line, = map(self.points, self.kind(xml.fromstring(out), "path", "curve"))
        xs, ys = zip(*line)
        middle, radius = ((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2), (max(xs) - min(xs)) / 2
        for point in line:
            self.assertAlmostEqual(1.0, math.dist(point, middle) / radius, delta=5e-3)
        out, _ = self.freeplay("show", self.write("m.yaml", model % 'curve: "40 mm + 0.5*x"'), "--format", "svg")
        (x0, y0), *_, (x1, y1) = self.points(self.kind(xml.fromstring(out), "path", "curve")[0])
        self.assertAlmostEqual(0.5, (y0 - y1) / (x1 - x0), delta=5e-3)

    def test_stops_are_bars_at_the_ends_of_a_way(self):
        model = """freeplay: 1
%sbodies: {a: {mass: 1, inertia: %s}, b: {mass: 1, inertia: %s, pose: {position: %s}}}
joints:
  A: {type: revolute, between: [ground, a]}
  P: {type: prismatic, between: [ground, b]}
  turn: {type: joint-stop, kind: rotational, between: [ground, a], lower: -30 deg, upper: 90 deg, stiffness: 1}
  way: {type: joint-stop, kind: linear, between: [ground, b], lower: 100 mm, upper: 300 mm, stiffness: 1}
"""
        for space, inertia, place in (("", 1, [0.2, 0]), ("space: spatial\n", [1, 1, 1], [0.2, 0, 0])):
            out, _ = self.freeplay("show", self.write("m.yaml", model % (space, inertia, inertia, place)), "--format", "svg")
            picture = xml.fromstring(out)
            view = next((g for g in picture.iter(SVG + "g") if g.get("id") == "top"), picture)
            bars = [[float(bar.get(k)) for k in ("x1", "y1", "x2", "y2")] for bar in self.kind(view, "line", "stop")]
            angles = sorted(round(math.degrees(math.atan2(y1 - y2, x2 - x1))) for x1, y1, x2, y2 in bars[:2])
            self.assertEqual([-30, 90], angles)
            (x, y, *_), (far, *_) = bars[2:]
            self.assertAlmostEqual(bars[2][0], bars[2][2], delta=0.1)
            origin = float(next(c for c in picture.iter(SVG + "circle") if space == "").get("cx")) if not space else None
            if origin is not None:
                self.assertAlmostEqual(2, (far - x) / (x - origin), delta=0.01)

    def test_gears_in_space_are_drawn_by_their_pitch_circles(self):
        self.write("m.yaml", """freeplay: 1
space: spatial
bodies: {a: {mass: 1, inertia: [1, 1, 1]}, b: {mass: 1, inertia: [1, 1, 1]}, c: {mass: 1, inertia: [1, 1, 1]}}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/far, b]}
  C: {type: revolute, between: [ground/wide, c]}
  mesh: {type: gear, of: [A, B], ratio: -2}
frames: {ground/far: [1, 0, 0], ground/wide: [7, 0, 0]}
""")
        out, _ = self.freeplay("show", "m.yaml", "--format", "svg")
        (top,) = [g for g in xml.fromstring(out).iter(SVG + "g") if g.get("id") == "top"]
        wide = [max(x for x, _ in points) - min(x for x, _ in points)
                for points in map(self.points, self.kind(top, "path", "pitch"))]
        self.assertAlmostEqual(2, wide[0] / wide[1], delta=0.05)

    def test_drawing_shows_gears_with_their_names(self):
        self.write("m.yaml", """freeplay: 1
bodies:
  a: {mass: 1, inertia: 1}
  b: {mass: 1, inertia: 1}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground/far, b]}
  mesh: {type: gear, of: [A, B], ratio: -2}
frames: {ground/far: [1, 0]}
""")
        out, _ = self.freeplay("show", "m.yaml", "--format", "svg")
        labels = [e.text for e in xml.fromstring(out).iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn("mesh", labels)
        self.assertEqual(2, out.count('class="pitch"'))

    def test_drawing_in_the_readme_is_the_program_s(self):
        with open(os.path.join(ROOT, "docs", "images", "3-rrr.svg"), encoding="utf-8") as file:
            self.assertEqual(file.read(), drawing(self.freeplay("show", mechanism("3-rrr"), "--format", "svg")[0]))

    def test_drawing_puts_a_point_where_it_is(self):
        # A rod of 1 m hangs horizontally from the origin: its pin, its middle and its end are on one level.
        out, _ = self.freeplay("show", mechanism("pendulum"), "--format", "svg")
        circles = re.findall(r'<circle cx="([0-9.]+)" cy="([0-9.]+)" r="([0-9.]+)"', out)
        self.assertEqual(2, len(circles))
        self.assertEqual(circles[0][1], circles[1][1])
        self.assertGreater(float(circles[1][0]), float(circles[0][0]) + 100)

    def test_no_assembly_is_needed_but_for_the_drawing(self):
        self.write("apart.yaml", """freeplay: 1
bodies: {a: {mass: 1, inertia: 1}}
joints:
  p: {type: revolute, between: [ground, a]}
  q: {type: revolute, between: [ground/far, a]}
frames: {ground/far: [5, 0]}
""")
        for format in ("text", "json", "dot"):
            self.freeplay("show", "apart.yaml", "--format", format)
        _, err = self.freeplay("show", "apart.yaml", "--format", "svg", code=3)
        self.assertIn("[assembly-failed]", err)

    def test_gravity_of_some_bodies_is_a_force_like_others(self):
        self.write("m.yaml", "freeplay: 1\ngravity: [0, -9.81]\nbodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}\n"
                   "forces: {moon: {type: gravity, on: ['b*', b], value: [0, -1.62]}}\n"
                   "templates: {t: {bodies: {c: {mass: 1, inertia: 1}},\n"
                   "                forces: {up: {type: gravity, on: [c], value: [0, 1]}}}}\n"
                   "instances: {i: {template: t}}\n")
        forces = json.loads(self.freeplay("show", "m.yaml", "--json")[0])["forces"]
        self.assertEqual({"moon": {"type": "gravity", "on": ["b"], "value": [0, -1.62]},
                          "i.up": {"type": "gravity", "on": ["i.c"], "value": [0, 1]}}, forces)
        out, _ = self.freeplay("show", "m.yaml")
        self.assertIn("  moon  gravity  on (b)  value (0, -1.62) m/s^2\n", out)
        self.freeplay("show", "m.yaml", "--format", "dot")

    def test_control_characters_of_a_name_reach_no_terminal(self):
        self.write("m.yaml", 'freeplay: 1\nname: "a\\e[31mred\\u009b1m\\nb"\nbodies: {a: {mass: 1, inertia: 1}}\n'
                   "simulation: {end: 1 ms, step: 1 ms}\n")
        os.rename(self.path("m.yaml"), self.path("m\x1b[31m.yaml"))
        name = "m\x1b[31m.yaml"
        for command in (["show", name], ["show", name, "--format", "dot"], ["show", name, "--format", "svg"],
                        ["validate", name], ["run", name, "--dry-run"], ["run", name, "--out", "r"]):
            out, err = self.freeplay(*command)
            self.assertNotRegex(out + err, r"[\x00-\x09\x0b-\x1f\x7f-\x9f]", command)
        xml.fromstring(self.freeplay("show", name, "--format", "svg")[0])
        self.assertEqual("a\x1b[31mred\x9b1m\nb", json.loads(self.freeplay("show", name, "--json")[0])["name"])

    def test_wrong_usage(self):
        self.assertIn("did you mean 'svg'?", self.freeplay("show", mechanism("pendulum"), "--format", "svgg", code=2)[1])
        self.freeplay("show", code=2)
        self.freeplay("show", mechanism("pendulum"), "--out", "", code=2)
        self.freeplay("show", "none.yaml", code=3)


if __name__ == "__main__":
    unittest.main()
