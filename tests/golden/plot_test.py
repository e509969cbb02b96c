"""Channels of a result as pictures and as characters."""
import cmath
import errno
import json
import math
import os
import pty
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ET

from program import PROGRAM, ProgramTest, mechanism

SVG = "{http://www.w3.org/2000/svg}"
BARS = "▁▂▃▄▅▆▇█"


class Panel:
    """Lines of a panel in the values of its axes."""

    def __init__(self, group):
        self.channel = group.get("data-channel")
        at = {key: float(group.get("data-" + key)) for key in (
            "left", "right", "top", "bottom", "x-from", "x-until", "y-from", "y-until")}
        self.pixel = ((at["x-until"] - at["x-from"]) / (at["right"] - at["left"]),
                      (at["y-until"] - at["y-from"]) / (at["bottom"] - at["top"]))
        self.from_, self.until = at["x-from"], at["x-until"]
        self.lines = []
        for path in group.iter(SVG + "path"):
            if path.get("class") != "line":
                continue
            self.lines.append([(at["x-from"] + (x - at["left"]) * self.pixel[0], at["y-from"] + (at["bottom"] - y) * self.pixel[1])
                               for x, y in (map(float, pair.split()) for pair in re.findall(r"[ML]([^ML]+)", path.get("d")))])
        self.shades = len([rect for rect in group.iter(SVG + "rect") if rect.get("fill") == "#e9e9e9"])
        self.circles = [float(circle.get("r")) * self.pixel[0] for circle in group.iter(SVG + "circle")]


def panels(text):
    return [Panel(group) for group in ET.fromstring(text).iter(SVG + "g") if group.get("class") == "panel"]


class Plot(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.made = os.path.join(folder.name, "r")
        subprocess.run([PROGRAM, "run", mechanism("slider-crank"), "--quiet", "--end", "14 ms", "--out", cls.made], check=True,
                       capture_output=True)
        with open(os.path.join(cls.made, "results.csv"), encoding="utf-8") as file:
            lines = [line.rstrip("\n").split(",") for line in file]
        cls.columns = {name: [float(line[i]) for line in lines[1:]] for i, name in enumerate(lines[0])}

    def setUp(self):
        super().setUp()
        os.symlink(self.made, self.path("r"))

    def plot(self, *arguments):
        return panels(self.freeplay("plot", "r", *arguments)[0])

    def test_each_channel_has_a_panel_with_the_extremes_of_all_rows_where_they_are(self):
        found = self.plot("joint.wrist.fn", "driver.motor.*")
        self.assertEqual(["joint.wrist.fn", "driver.motor.value", "driver.motor.torque", "driver.motor.power"],
                         [panel.channel for panel in found])
        for panel in found:
            values = self.columns[panel.channel]
            xs, ys = zip(*panel.lines[0])
            self.assertEqual(sorted(xs), list(xs))
            for extreme in (max, min):
                self.assertAlmostEqual(extreme(values), extreme(ys), delta=panel.pixel[1])
            if panel.channel == "joint.wrist.fn":
                when = self.columns["time"][values.index(max(values))]
                self.assertAlmostEqual(when, xs[ys.index(max(ys))], delta=1.5 * panel.pixel[0])
                self.assertGreater(panel.shades, 3)

    def test_a_window_of_time_is_drawn_alone(self):
        panel = self.plot("joint.wrist.fn", "--from", "4 ms", "--until", "6 ms")[0]
        self.assertAlmostEqual(0.004, panel.from_, delta=1e-9)
        self.assertAlmostEqual(0.006, panel.until, delta=1e-9)
        inside = [f for t, f in zip(self.columns["time"], self.columns["joint.wrist.fn"]) if 0.003999 < t < 0.006001]
        self.assertAlmostEqual(max(inside), max(y for _, y in panel.lines[0]), delta=panel.pixel[1])
        _, err = self.freeplay("plot", "r", "joint.wrist.fn", "--from", "1 s", code=2)
        self.assertIn("has no rows in this window", err)
        self.write("empty.csv", "time,a\n")
        self.assertIn("'empty.csv' has no rows [no-rows]", self.freeplay("plot", "empty.csv", "a", code=2)[1])

    def test_an_orbit_lies_in_the_circle_of_its_clearance(self):
        panel = self.plot("--orbit", "wrist")[0]
        self.assertAlmostEqual(panel.pixel[0], panel.pixel[1], delta=1e-6 * panel.pixel[0])
        self.assertAlmostEqual(0.5e-3, panel.circles[0], delta=2 * panel.pixel[0])
        self.assertAlmostEqual(max(self.columns["joint.wrist.ex"]), max(x for x, _ in panel.lines[0]), delta=panel.pixel[0])
        same = self.plot("joint.wrist.ex", "joint.wrist.ey", "--xy")[0]
        self.assertAlmostEqual(min(self.columns["joint.wrist.ey"]), min(y for _, y in same.lines[0]), delta=same.pixel[1])

    def test_each_orbit_has_the_circle_of_its_own_clearance(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--set", "c=1 mm", "--out", "wide")
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--integrator", "newmark", "--out", "same")
        panel = self.plot("--orbit", "wrist", "--against", "wide")[0]
        self.assertEqual(2, len(panel.circles))
        for expected, drawn in zip((0.5e-3, 1e-3), panel.circles):
            self.assertAlmostEqual(expected, drawn, delta=2 * panel.pixel[0])
        out, _ = self.freeplay("plot", "r", "--orbit", "wrist", "--against", "wide")
        colours = [circle.get("stroke") for circle in ET.fromstring(out).iter(SVG + "circle") if circle.get("stroke-dasharray")]
        self.assertEqual(["#0072B2", "#D55E00"], colours)
        self.assertEqual(1, len(self.plot("--orbit", "wrist", "--against", "same")[0].circles))

    def test_the_orbit_of_a_ball_is_seen_from_three_sides(self):
        self.freeplay("run", mechanism("spatial/four-bar"), "--quiet", "--end", "2 ms", "--out", "space")
        found = panels(self.freeplay("plot", "space", "--orbit", "B")[0])
        self.assertEqual(["joint.B.ey", "joint.B.ez", "joint.B.ez"], [panel.channel for panel in found])
        lines = [line.split(",") for line in self.read("space", "results.csv").splitlines()]
        places = [[float(line[lines[0].index("joint.B.e" + axis)]) for line in lines[1:]] for axis in "xyz"]
        for panel, (first, second) in zip(found, ((0, 1), (0, 2), (1, 2))):
            self.assertAlmostEqual(1e-4, panel.circles[0], delta=2 * panel.pixel[0])
            for values, at in ((places[first], 0), (places[second], 1)):
                drawn = [point[at] for point in panel.lines[0]]
                self.assertAlmostEqual(max(values), max(drawn), delta=panel.pixel[0])
                self.assertAlmostEqual(min(values), min(drawn), delta=panel.pixel[0])
        # A pin has its axis along z.
        self.assertEqual(["joint.D.ey"], [panel.channel for panel in panels(self.freeplay("plot", "space", "--orbit", "D")[0])])

    def test_a_channel_is_drawn_over_another_one(self):
        panel = self.plot("joint.wrist.fn", "--x", "joint.main.angle")[0]
        peak = self.columns["joint.wrist.fn"].index(max(self.columns["joint.wrist.fn"]))
        self.assertAlmostEqual(self.columns["joint.main.angle"][peak], max(panel.lines[0], key=lambda p: p[1])[0],
                               delta=panel.pixel[0])

    def test_parts_of_a_histogram_make_the_whole_time(self):
        panel = self.plot("body.slider.x", "--histogram")[0]
        bins = [y for _, y in panel.lines[0][::2]]
        self.assertAlmostEqual(100.0, sum(bins), delta=len(bins) * panel.pixel[1])

    def test_a_spectrum_has_the_amplitudes_of_the_exported_one(self):
        panel = self.plot("driver.motor.torque", "--fft")[0]
        table = json.loads(self.freeplay("export", "r", "--to", "json", "--table", "spectra", "--channels", "driver.motor.torque")[0])
        self.assertAlmostEqual(max(row[1] for row in table["rows"]), max(y for _, y in panel.lines[0]), delta=panel.pixel[1])
        self.assertEqual(table["rows"][-1][0], panel.until)

    def test_a_spectrum_is_that_of_the_window_that_is_given(self):
        start = "2 ms"  # before the time that counts
        panel = self.plot("driver.motor.torque", "--fft", "--from", start, "--until", "6 ms")[0]
        known = [(t, x) for t, x in zip(self.columns["time"], self.columns["driver.motor.torque"]) if 0.002 - 1e-9 < t < 0.006 + 1e-9]
        size = max(2 ** a * 3 ** b * 5 ** c for a in range(9) for b in range(6) for c in range(4) if 2 ** a * 3 ** b * 5 ** c <= len(known))
        rows = [x for _, x in known[-size:]]
        mean, weights = sum(rows) / size, [(1 - math.cos(2 * math.pi * i / size)) / 2 for i in range(size)]
        largest = max(abs(sum(w * (x - mean) * cmath.exp(-2j * math.pi * k * i / size) for i, (w, x) in enumerate(zip(weights, rows))))
                      for k in range(1, size // 2 + 1)) * 2 / sum(weights)
        self.assertAlmostEqual(largest, max(y for _, y in panel.lines[0]), delta=panel.pixel[1])

    def test_a_spectrum_names_the_time_that_it_is_of(self):
        out, _ = self.freeplay("plot", "r", "driver.motor.torque", "--fft", "--from", "2 ms", "--until", "6 ms")
        first, last = map(float, re.search(r">frequency, rows from (\S+) s to (\S+) s", out).groups())
        self.assertLessEqual(0.002, first)
        self.assertAlmostEqual(0.006, last, delta=1e-9)
        step = self.columns["time"][1] - self.columns["time"][0]
        lines = len(json.loads(self.freeplay("export", "r", "--to", "json", "--table", "spectra", "--channels", "driver.motor.torque", "--from", "2 ms", "--until", "6 ms")[0])["rows"])
        self.assertIn(round((last - first) / step) + 1, (2 * lines - 2, 2 * lines - 1))

    def test_tables_by_sector_that_are_empty_say_so(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "20 us", "--out", "short")
        out, _ = self.freeplay("plot", "short", "--polar", "wrist", "work", "impulse")
        self.assertEqual(2, out.count(" of wrist by bearing angle: 0 in all sectors"))
        self.assertNotIn("<circle", out)
        self.assertIn("of the whole time that counts", out)
        out, _ = self.freeplay("plot", "short", "--polar", "wrist", "pv_mean")  # the file gives no length
        self.assertIn("pv_mean of wrist by bearing angle: not known, the bearing has no 'length'", out)

    def test_tables_by_sector_stand_around_their_joint(self):
        panel = self.plot("--polar", "wrist", "work")[0]
        table = json.loads(self.freeplay("export", "r", "--to", "json", "--table", "bearing")[0])
        place = table["columns"].index("work")
        largest = max(table["rows"], key=lambda row: row[place])
        x, y = max(panel.lines[0], key=lambda p: math.hypot(*p))
        self.assertAlmostEqual(largest[place], math.hypot(x, y), delta=2 * panel.pixel[0])
        self.assertLess(abs(math.remainder(math.atan2(y, x) - largest[1], 2 * math.pi)), math.radians(3))

    def test_rings_have_their_labels_where_no_curve_is(self):
        group = next(g for g in ET.fromstring(self.freeplay("plot", "r", "--polar", "wrist", "impulse")[0]).iter(SVG + "g") if g.get("class") == "panel")
        points = [tuple(map(float, pair.split())) for pair in re.findall(r"[ML]([^ML]+)", next(p for p in group.iter(SVG + "path") if p.get("class") == "line").get("d"))]
        labels = [t for t in group.iter(SVG + "text") if "N*s" in (t.text or "") and t.get("paint-order")]
        self.assertGreater(len(labels), 1)
        largest = max(labels, key=lambda label: float(re.match(r"[\d.]+", label.text)[0]))
        self.assertGreater(min(math.dist(p, (float(largest.get("x")), float(largest.get("y")) - 4)) for p in points), 12)

    def test_the_way_of_what_stands_still_has_room(self):
        self.write("still.csv", "time,a,b,c\n0,2,3,2\n1,2,3,4\n")
        for channels, sides in ((("a", "b"), (0.3, 0.3)), (("a", "c"), (0.5, 2.0)), (("c", "b"), (2.0, 0.5))):
            (panel,) = panels(self.freeplay("plot", "still.csv", *channels, "--xy")[0])
            self.assertAlmostEqual(sides[0], panel.until - panel.from_, delta=0.01 + 0.2 * sides[0], msg=channels)
            self.assertAlmostEqual(panel.pixel[0], panel.pixel[1], delta=1e-9)

    def test_words_fit_in_a_narrow_picture(self):
        shutil.copytree(self.made, self.path("other"))
        summary = self.read("other", "summary.json").replace('"name": "slider-crank"', '"name": "a slider-crank with a long name"')
        self.write("other/summary.json", summary)
        for options in (["driver.motor.torque", "--fft"], ["--polar", "wrist"], ["joint.wrist.fn", "--against", "r"]):
            for width in ("53 mm", "60 mm", "84 mm", "100 mm"):
                root = ET.fromstring(self.freeplay("plot", "other", *options, "--width", width)[0])
                right = float(root.get("viewBox").split()[2])
                for text in root.iter(SVG + "text"):
                    whole, words = text.findtext(SVG + "title"), "".join([text.text or ""] + [child.tail for child in text])
                    self.assertTrue(whole is None or len(words) > 2 and words[-1] == "\u2026" and whole.startswith(words[:-1]), words)
                    wide = 0.5 * float(text.get("font-size", 11)) * len(words) * {"middle": 0.5, "end": 0}.get(text.get("text-anchor"), 1)
                    self.assertLessEqual(float(text.get("x")) + wide, right, words)

    def test_another_result_is_drawn_beside(self):
        shutil.copytree(self.made, self.path("other"))
        panel = self.plot("joint.wrist.fn", "--against", "other")[0]
        self.assertEqual(2, len(panel.lines))
        self.assertEqual(panel.lines[0], panel.lines[1])
        names = [e.text for e in ET.fromstring(self.freeplay("plot", "r", "joint.wrist.fn", "--against", "other")[0]).iter(SVG + "text")]
        self.assertIn("2. slider-crank", names)
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--ideal", "all", "--out", "ideal")
        out, _ = self.freeplay("plot", "r", "body.slider.x", "--against", "ideal")
        self.assertIn(">slider-crank, ideal<", out)
        self.freeplay("run", mechanism("pendulum"), "--quiet", "--end", "10 ms", "--out", "pendulum")
        _, err = self.freeplay("plot", "r", "joint.wrist.fn", "--against", "pendulum", code=2)
        self.assertIn("[unknown-channel]", err)
        for channels in (["joint.wrist.fn"], ["joint.wrist.*"]):
            _, err = self.freeplay("plot", "r", *channels, "--against", "ideal", code=2)
            self.assertIn("'ideal/results.h5' has no channel 'joint.wrist.", err)
            self.assertIn("which 'r/results.h5' has", err)
            self.assertIn("joint 'wrist' has no play there", err)
        _, err = self.freeplay("plot", "ideal", "joint.wrist.*", "--against", "r", code=2)
        self.assertIn("'ideal/results.h5' has no channel 'joint.wrist.", err)

    def test_a_result_against_itself_is_named(self):
        for again in ("r", "r/", "./r/results.h5", self.made):
            out, err = self.freeplay("plot", "r", "joint.wrist.fn", "--against", again)
            self.assertIn("warning: '%s' is given twice" % again, err)
            self.assertEqual(2, len(panels(out)[0].lines))

    def test_files_that_are_no_pictures_are_kept(self):
        kept = {"rows.csv": "time,a\n0,1\n1,2\n", "drawn.svg": "<svg xmlns='http://www.w3.org/2000/svg'><metadata id='m'/></svg>\n", "model.yaml": "freeplay: 1\n"}
        draw = (("plot", "r", "joint.wrist.fn"), ("show", "r", "--format", "svg"), ("show", "r", "--format", "json"))
        for name, text in kept.items():
            self.write(name, text)
            for command in draw:
                _, err = self.freeplay(*command, "--out", name, code=6)
                self.assertIn("cannot write '%s': it is there already, and no picture of this program [cannot-write]" % name, err)
                self.assertIn("--force", err)
                self.assertEqual(text, self.read(name))
        for command in draw:
            self.freeplay(*command, "--out", "rows.csv", "--force")
            self.assertNotEqual(kept["rows.csv"], self.read("rows.csv"))
        self.write("p.svg", "")
        for command in draw[:2] * 2 + (("plot", "model.csv", "a"),):
            self.write("model.csv", kept["rows.csv"])
            self.freeplay(*command, "--out", "p.svg")  # empty, or a picture of this program

    def test_a_summary_of_another_schema_is_refused(self):
        shutil.copytree(self.made, self.path("other"))
        summary = json.loads(self.read("other", "summary.json"))
        for schema in (0, 99, "1", None):
            summary["freeplay"]["schema"] = schema
            self.write("other/summary.json", json.dumps(summary))
            for command in (("plot", "other", "joint.wrist.fn"), ("show", "other", "--format", "svg"), ("report", "other")):
                _, err = self.freeplay(*command, code=6)
                self.assertIn("result 'other/summary.json' cannot be read: its schema is %s, and this program reads schema 1" % json.dumps(schema), err)
        self.assertFalse(os.path.exists(self.path("other", "report.html")))

    def test_a_picture_has_the_same_bytes_in_a_file_and_its_provenance(self):
        out, _ = self.freeplay("plot", "r", "joint.wrist.fn", "--width", "84 mm")
        self.freeplay("plot", "r", "joint.wrist.fn", "--width", "84 mm", "--out", "p.svg")
        self.assertEqual(out, self.read("p.svg"))
        root = ET.fromstring(out)
        self.assertEqual("84mm", root.get("width"))
        record = json.loads(root.find(SVG + "metadata").text)
        self.assertEqual(("plot", ["joint.wrist.fn", "--width", "84 mm"]), (record["made"], record["arguments"]))
        self.assertIn("freeplay: 1", record["model"]["text"])

    def test_extremes_as_json(self):
        out, _ = self.freeplay("plot", "r", "joint.wrist.fn", "--json")
        channel = json.loads(out)["channels"][0]
        values = self.columns["joint.wrist.fn"]
        self.assertEqual((max(values), self.columns["time"][values.index(max(values))], len(values), "N"),
                         (channel["max"], channel["max_time"], channel["rows"], channel["unit"]))

    def test_characters_are_braille_or_asterisks_by_the_locale(self):
        out, _ = self.freeplay("plot", "r", "joint.wrist.fn", "--text", environment={"LC_ALL": "C.UTF-8", "TERM": "xterm"})
        self.assertEqual(12, sum(any("\u2800" <= c <= "\u28ff" for c in line) for line in out.splitlines()))
        self.assertRegex(out, r"^joint\.wrist\.fn \[N\]  0 … \S+  \(%d rows\)\n" % len(self.columns["time"]))
        plain, _ = self.freeplay("plot", "r", "joint.wrist.fn", "--text", environment={"LC_ALL": "C"})
        self.assertTrue(plain.isascii())
        self.assertIn("*", plain)

    def test_text_files_alone_are_drawn_the_same(self):
        os.mkdir(self.path("csv"))
        (whole,) = self.plot("joint.wrist.fn")
        for name in ("events.csv", "results.csv", "model.yaml", "summary.json"):
            shutil.copy(os.path.join(self.made, name), self.path("csv"))
            if name == "events.csv":
                continue
            text = self.freeplay("plot", "csv", "joint.wrist.fn")[0]
            (from_text,) = panels(text)
            self.assertEqual(whole.lines, from_text.lines)
            self.assertEqual(whole.shades, from_text.shades)
            self.assertEqual(name != "results.csv", bool(re.search(r">joint\.wrist\.fn \[k?N\]<", text)))  # only the model has units
            self.assertEqual("N" if name != "results.csv" else "", json.loads(self.freeplay("plot", "csv/results.csv", "joint.wrist.fn", "--json")[0])["channels"][0]["unit"])
        times = panels(self.freeplay("plot", "csv", "time", "joint.wrist.fn")[0])
        self.assertEqual(["time", "joint.wrist.fn"], [panel.channel for panel in times])

    def test_numbers_that_are_not_finite_are_gaps(self):
        self.write("a.csv", "time,a,b\n" + "".join("%d,%s,inf\n" % (i, "inf" if i == 3 else i) for i in range(8)))
        finite, nothing = panels(self.freeplay("plot", "a.csv", "a", "b")[0])
        self.assertEqual(7, len(finite.lines[0]))
        self.assertAlmostEqual(7.0, max(y for _, y in finite.lines[0]), delta=finite.pixel[1])
        self.assertEqual([], nothing.lines)
        text = self.freeplay("plot", "a.csv", "a", "b")[0]
        self.assertIn(">1 of 8 rows have no number<", text)
        self.assertIn(">no numbers in 8 rows<", text)
        text = self.freeplay("plot", "a.csv", "a", "b", "--text", environment={"LC_ALL": "C"})[0]
        self.assertIn("a  0 ... 7  (8 rows, 1 of 8 rows have no number)\n", text)
        self.assertIn("b  no numbers  (8 rows)\n", text)
        for option in ("--histogram", "--x=time"):
            self.assertIn(">1 of 8 rows have no number<", self.freeplay("plot", "a.csv", "a", option)[0])

    def test_a_result_that_is_not_complete_says_so(self):
        shutil.copytree(self.made, self.path("part"))
        os.remove(self.path("part", "summary.json"))
        self.assertIn("(the run goes on, or was killed)", self.freeplay("plot", "part", "joint.wrist.fn")[0])
        out, err = self.freeplay("plot", "part", "--orbit", "wrist")
        self.assertEqual("", err)
        (panel,) = panels(out)
        self.assertAlmostEqual(0.5e-3, panel.circles[0], delta=2 * panel.pixel[0])
        os.remove(self.path("part", "model.yaml"))
        out, err = self.freeplay("plot", "part", "--orbit", "wrist")
        self.assertIn("how large the clearance is", err)
        self.assertEqual([], panels(out)[0].circles)

    def test_a_file_that_was_cut_is_drawn_with_a_warning(self):
        text = self.read("r", "results.csv")
        self.write("rows.csv", text[: len(text) // 2].rpartition(",")[0])
        self.assertIn("the last line of 'rows.csv' has no end and is left out", self.freeplay("plot", "rows.csv", "joint.wrist.fn")[1])
        shutil.copytree(self.made, self.path("damaged"))
        with open(self.path("damaged", "results.h5"), "r+b") as file:
            file.truncate(1000)
        out, err = self.freeplay("plot", "damaged", "joint.wrist.fn")
        self.assertIn("; rows are those of 'damaged/results.csv'", err)
        self.assertEqual(1, len(panels(out)))
        page = self.freeplay("report", "damaged")[0]
        self.assertIn("; rows are those of", self.read("damaged", "report.html"), page)

    def test_what_cannot_be_drawn_is_refused(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "1 ms", "--ideal", "all", "--out", "ideal")
        for arguments, code, words in (
                (["ideal", "--orbit", "wrist"], 2, "there is no joint with play ["),
                (["r", "joint.wrist.fn", "body.slider.x", "--xy"], 2,
                 "--xy has equal scales, and 'joint.wrist.fn' is in N, 'body.slider.x' in m"),
                (["r", "joint.wrst.fn"], 2, "did you mean 'joint.wrist.fn'?"),
                (["r", "zz*"], 2, "names of channels begin with body, driver, energy, joint, time"),
                (["nowhere", "x"], 6, "[unreadable-result]"),
                (["r"], 2, "plot needs a channel"),
                ([], 2, "plot needs a result"),
                (["r", "joint.wrist.fn", "--xy"], 2, "--xy draws one channel over another, and 1 are given"),
                (["r", "joint.wrist.fn", "--xy", "--fft"], 2, "--xy and --fft exclude each other"),
                (["r", "joint.wrist.fn", "--x", "joint.*"], 2, "channels, and others are drawn over one"),
                (["r", "--polar", "wirst"], 2, "did you mean 'wrist'?"),
                (["r", "--polar", "wrist", "wrok"], 2, "did you mean 'work'?"),
                (["r", "--orbit", "wrst"], 2, "did you mean 'wrist'?"),
                (["r", "--orbit", "main"], 2, "there is no joint with play 'main'"),
                (["r", "joint.wrist.fn", "--width", "3"], 2, "a picture has 200 to 10000 pixels"),
                (["r", "joint.wrist.fn", "--width", "wide"], 2, "bad value 'wide' of --width"),
                (["r", "joint.wrist.fn", "--from", "2 ms", "--until", "1 ms"], 2, "--from 2 ms is after --until 1 ms"),
                (["r", "joint.wrist.fn", "--out", "r/results.csv/p.svg"], 6, "[cannot-write]")):
            with self.subTest(arguments):
                out, err = self.freeplay("plot", *arguments, code=code)
                self.assertIn(words, err)
                self.assertEqual("", out)

    def dots(self, text):
        """Columns of a curve on the terminal: the rows of its dots from below."""
        lines = [line for line in text.splitlines() if line and all("\u2800" <= c <= "\u28ff" for c in line)]
        self.assertEqual(12, len(lines))
        bits = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
        return [[47 - 4 * i - k for i, line in enumerate(lines) for k in range(4) if (ord(line[x // 2]) - 0x2800) & bits[k][x % 2]]
                for x in range(2 * len(lines[0]))]

    def test_curves_of_characters_are_where_the_values_are(self):
        wave = [math.sin(0.02 * i) if not 150 <= i < 180 else math.nan for i in range(400)]
        self.write("wave.csv", "time,a\n" + "".join("%d,%s\n" % (i, x) for i, x in enumerate(wave)))
        text, _ = self.freeplay("plot", "wave.csv", "a", "--text", environment={"LC_ALL": "C.UTF-8", "TERM": "xterm"})
        columns = self.dots(text)
        known = [x for x in wave if x == x]
        # The axis ends at round numbers, a tenth apart or more.
        low, high = -1.0, 1.0
        self.assertTrue(low - 0.1 < min(known) and max(known) < high + 0.1)
        for x, dots in enumerate(columns):
            begin, end = 399 * x / len(columns), 399 * (x + 1) / len(columns)
            inside = [wave[i] for i in range(400) if begin - 1 <= i <= end + 1]
            if all(math.isnan(value) for value in inside):
                self.assertEqual([], dots)
            elif not any(math.isnan(value) for value in inside):
                self.assertTrue(dots, x)
                wanted = [(value - low) / (high - low) * 47 for value in inside]
                self.assertGreater(min(dots), min(wanted) - 1.6)
                self.assertLess(max(dots), max(wanted) + 1.6)
        plain, _ = self.freeplay("plot", "wave.csv", "a", "--text", environment={"LC_ALL": "C"})
        stars = [line for line in plain.splitlines() if set(line) <= set("* ")]
        self.assertEqual(12, len(stars))
        wide = len(columns) // 2
        self.assertEqual([bool(columns[2 * x] + columns[2 * x + 1]) for x in range(wide)],
                         [any(line[x : x + 1] == "*" for line in stars) for x in range(wide)])

    def on_terminal(self, *arguments, locale="C.UTF-8"):
        main, other = pty.openpty()
        with subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=other, stderr=subprocess.DEVNULL,
                              env={**os.environ, "LC_ALL": locale, "TERM": "xterm"}) as run:
            os.close(other)
            data = b""
            while True:
                try:
                    part = os.read(main, 65536)
                except OSError as error:
                    self.assertEqual(errno.EIO, error.errno)
                    break
                if not part:
                    break
                data += part
        os.close(main)
        self.assertEqual(0, run.returncode)
        return data.decode()

    def test_a_run_on_a_terminal_ends_with_its_main_channels_at_a_glance(self):
        shown = self.on_terminal("run", mechanism("slider-crank"), "--end", "5 ms", "--out", "s")
        lines = [line for line in shown.splitlines() if sum(c in BARS for c in line) == 40]
        self.assertEqual(["motor torque", "wrist fn"], [re.match(r"  (\S+ \S+)", line)[1] for line in lines])
        self.assertTrue(all(len({c for c in line if c in BARS}) > 2 for line in lines))
        piped, _ = self.freeplay("run", mechanism("slider-crank"), "--end", "5 ms", "--out", "s", "--force")
        self.assertFalse(any(c in BARS for c in piped))
        self.assertGreater(sum(map(len, self.dots(self.on_terminal("plot", "s", "joint.wrist.fn").replace("\r", "")))), 50)
        levels = "_.:-=+*#"
        plain = self.on_terminal("run", mechanism("slider-crank"), "--end", "5 ms", "--out", "s", "--force", locale="C")
        self.assertTrue(plain.isascii())
        for line in lines:
            words, bars = re.match(r"  (\S+ \S+) +(\S{40})  ", line).groups()
            self.assertIn(words + " ", plain)
            self.assertIn("  %s  " % "".join(levels[BARS.index(c)] for c in bars), plain)


if __name__ == "__main__":
    unittest.main()
