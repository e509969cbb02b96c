"""`freeplay reproduce`: results, tables and pictures made again from their record, and what was changed in them."""
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from program import BUILD, PROGRAM, ROOT, ProgramTest, mechanism

with open(mechanism("slider-crank"), encoding="utf-8") as source:
    CRANK = source.read().replace(", discard: 12 ms", "")
SPRING = os.path.join(BUILD, "plugins", "example", "torsional_spring_damper.so")

# Its name is that of the file, and it reads a table.
DRIVEN = """freeplay: 1
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints: {pin: {type: revolute, between: [ground, disc]}}
drivers: {motor: {joint: pin, kind: velocity, table: {file: ../tables/speed.csv}}}
simulation: {end: 0.1 s, step: 1 ms, output: {interval: 1 ms}}
"""

TWISTED = """freeplay: 1
name: twisted
%sbodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  spring: {type: torsional-spring-damper, between: [ground, disc], stiffness: 5 N*m, free_angle: 20 deg}
initial: {joints: {pin: 0.1}}
simulation: {end: 0.1 s, step: 0.5 ms, output: {interval: 10 ms}}
"""


class Reproduce(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("crank.yaml", CRANK)

    def run_model(self, name, *options, model="crank.yaml"):
        self.freeplay("run", model, "--quiet", "--out", name, *options)

    def bytes_of(self, *names):
        with open(self.path(*names), "rb") as file:
            return file.read()

    def change(self, place, edit):
        """Edits a file of a copy of the folder `r` or of a file; returns the copy."""
        shutil.rmtree(self.path("copy"), ignore_errors=True)
        shutil.copytree(self.path("r"), self.path("copy"))
        self.edit(edit, "copy", place)
        return "copy"

    def edit(self, edit, *names):
        data = self.bytes_of(*names)
        changed = edit(data)
        self.assertNotEqual(data, changed)
        with open(self.path(*names), "wb") as file:
            file.write(changed)

    def assert_same(self, name, *options, environment=None):
        out, err = self.freeplay("reproduce", name, *options, environment=environment)
        self.assertEqual("", err)
        self.assertIn(": made by freeplay ", out)
        self.assertEqual("same bytes", out.splitlines()[-1])
        return out

    def assert_different(self, name, *words):
        out, _ = self.freeplay("reproduce", name, code=7)
        self.assertEqual("different", out.splitlines()[-1])
        for word in words:
            self.assertRegex(out, word)

    def test_a_result_is_made_again_to_the_same_bytes(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms", "--set", "c=0.4 mm")
        out = self.assert_same("r")
        lines = out.splitlines()
        self.assertRegex(lines[0], r"^r: made by freeplay \S+ \(\S+ .+, \w+\), rerun by freeplay \S+ \(\S+ .+, \w+\)$")
        self.assertRegex(lines[1], r"^  rows +41 x \d+ +same bytes$")
        self.assertRegex(lines[2], r"^  events +\d+ +same bytes$")
        self.assertRegex(lines[3], r"^  summary +\d+ numbers +same$")
        answer = json.loads(self.freeplay("reproduce", "r", "--json")[0])
        self.assertTrue(answer["same"])
        self.assertEqual(["record", "rows", "events", "summary", "results.h5"], [c["what"] for c in answer["checks"]])
        self.assertTrue(all(c["same"] and c["first_difference"] is None for c in answer["checks"]))
        summary = json.loads(self.read("r", "summary.json"))
        self.assertEqual(summary["provenance"], answer["record"])
        self.assertEqual(summary["hashes"], answer["rerun"]["hashes"])
        # Nothing but a few lines is left of it.
        self.assertEqual(["crank.yaml", "r"], sorted(os.listdir(self.folder)))

    def test_the_page_shows_what_is_printed(self):
        with open(os.path.join(ROOT, "docs", "results.md"), encoding="utf-8") as file:
            page = file.read()
        section = page[page.index("## Made again"):]
        commands, printed = re.search(r"```sh\n(.*?)```\n\n```\n(.*?)```", section, re.S).groups()
        os.symlink(os.path.dirname(mechanism("x")), self.path("mechanisms"))
        out = ""
        for line in commands.splitlines():
            out = self.freeplay(*line.split()[1:])[0]

        def plain(text):  # another compiler has other words and digits
            return re.sub(r" +", " ", re.sub(r"\d+(\.\d+)*", "#", re.sub(r"\(.*?\)", "()", text)))
        self.assertEqual(plain(printed), plain(out))

    def test_every_format_and_every_kind_of_run_is_made_again(self):
        for options in (("--format", "csv"), ("--format", "hdf5"), ("--twin",), ("--accuracy", "1um"),
                        ("--repeat", "2", "--seed", "7"), ("--ideal", "all"), ("--integrator", "hht"),
                        ("--channels", "joint.*", "--channels", "energy.*"), ("--verify",)):
            with self.subTest(options):
                self.run_model("r", "--end", "2 ms", "--interval", "0.1 ms", *options)
                self.assert_same("r")
        self.assert_same("r/summary.json")

    def test_a_changed_digit_in_each_file_is_found(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms", "--twin")

        def other_digit(place):
            def edit(data):
                at = re.search(place, data).start(1)
                return data[:at] + (b"1" if data[at:at + 1] != b"1" else b"2") + data[at + 1:]
            return edit

        tenth = rb"(?:[^\n]*\n){10}[^,]*,[^,]*(\d),"
        cases = [
            ("results.csv", tenth, [r"rows .*first difference: row 9, t = 0\.0009\d* s, body\.\S+: \S+ recorded, \S+ now",
                                    "results.csv was changed afterwards: SHA-256"]),
            ("results.csv", rb"(?:[^\n]*\n){10}[^,]*(\d),", ["row 9, .*time: "]),
            ("events.csv", rb"[^\n]*\n[^,]*,[^,]*,[^,]*,-?\d\.(\d)", ["events .*first difference: event 0, t = .* speed"]),
            ("summary.json", rb'"max_force": \d*\.?(\d)', ["summary .*first difference: /.*/max_force: "]),
            ("summary.json", rb'"steps": (\d)', ["/counts/steps"]),
            ("model.yaml", rb"inertia: (\d)", ["the model was changed afterwards: SHA-256"]),
            ("twin/results.csv", tenth, ["twin/rows .*row 9"]),
            ("twin/summary.json", rb'"steps": (\d)', ["twin/summary .*/counts/steps"]),
        ]
        for file, place, words in cases:
            with self.subTest(file=file, place=place):
                self.assert_different(self.change(file, other_digit(place)), *words)
        with self.subTest("a row less"):
            copy = self.change("results.csv", lambda data: data[:data.rindex(b"\n", 0, -1) + 1])
            self.assert_different(copy, "rows .*first difference: row 40: none recorded, one now")
        # Nothing is made again of a model that is another.
        answer = json.loads(self.freeplay("reproduce", self.change("model.yaml", lambda data: data + b"# more\n"), "--json",
                                          code=7)[0])
        self.assertEqual((False, None, ["record"]),
                         (answer["same"], answer["rerun"], [c["what"] for c in answer["checks"]]))

    def test_part_of_a_line_after_the_last_is_found(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms")
        for name in ("results.csv", "events.csv"):
            with self.subTest(name):
                whole = self.bytes_of("r", name)
                self.edit(lambda data: data + b"0.0041,1,2", "r", name)
                self.assert_different("r", "%s' was changed: it ends in part of a line" % name)
                self.edit(lambda _: whole, "r", name)
        self.assert_same("r")

    def test_a_changed_number_of_results_h5_is_found(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("h5py is not installed")
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms")
        shutil.copy(self.path("r", "results.h5"), self.path("alone.h5"))
        self.assertIn("summary", self.assert_same("alone.h5"))
        for dataset, place, words in (("body.slider.x", 20, r"row 20, t = 0\.002 s, body\.slider\.x: "),
                                      ("events/speed", 0, r"event 0, t = \S+ s, speed"),
                                      ("bearing/work", (0, 3), "bearing/work, number 3")):
            for name in ("alone.h5", "copy"):
                with self.subTest(dataset=dataset, name=name):
                    shutil.rmtree(self.path("copy"), ignore_errors=True)
                    shutil.copytree(self.path("r"), self.path("copy"))
                    shutil.copy(self.path("r", "results.h5"), self.path("alone.h5"))
                    with h5py.File(self.path(name if name == "alone.h5" else "copy/results.h5"), "r+") as file:
                        file[dataset][place] += 1e-9
                    self.assert_different(name, words)

    def test_tables_of_export_are_made_again(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms")
        tables = [("t.csv", "csv", ()), ("t.csv", "csv", ("--channels", "body.*", "--from", "1 ms", "--every", "3")),
                  ("e.csv", "csv", ("--table", "events")), ("b.csv", "csv", ("--table", "bearing")),
                  ("s.csv", "csv", ("--table", "spectra", "--channels", "body.slider.x")),
                  ("t.json", "json", ("--table", "impacts")), ("t.h5", "hdf5", ("--channels", "joint.*")),
                  ("t.mat", "mat", ("--channels", "energy.*", "--every", "2"))]
        for file, form, options in tables:
            with self.subTest(file=file, options=options):
                self.freeplay("export", "r", "--to", form, "--out", file, "--force", *options)
                self.assert_same(file)
        # A table of a table.
        self.freeplay("export", "t.h5", "--to", "csv", "--every", "2", "--out", "u.csv")
        self.assert_same("u.csv")
        for file, place in (("u.csv", rb"\n[^\n]*\d\.\d(\d)"), ("t.json", rb'"rows": \[\s*\[[^\]]*\d\.\d(\d)'),
                            ("b.csv", rb"\d\.\d(\d)")):
            with self.subTest(file):
                self.edit(lambda data: data[:(at := re.search(place, data).start(1))] +
                          (b"1" if data[at:at + 1] != b"1" else b"2") + data[at + 1:], file)
                self.assert_different(file, "first difference")
        data = self.bytes_of("t.mat")
        place = data.index(b"data") + 400
        self.edit(lambda data: data[:place] + bytes([data[place] ^ 1]) + data[place + 1:], "t.mat")
        self.assert_different("t.mat", r"rows .*first difference: row \d+, t = ")
        os.remove(self.path("u.csv.provenance.json"))
        _, err = self.freeplay("reproduce", "u.csv", code=6)
        self.assertIn("[no-provenance]", err)
        self.assertIn("u.csv.provenance.json", err)

    def test_analyses_are_made_again(self):
        words = ("analyze", "error", mechanism("3-rrr"), "--grid", "x=-0.1:0.1:5", "--grid", "y=-0.1:0.1:5")
        self.freeplay(*words, "--out", "a.csv", "--svg", "a.svg")
        self.write("a.json", self.freeplay(*words, "--samples", "10", "--seed", "3", "--json")[0])
        self.assertEqual(3, json.loads(self.read("a.json"))["provenance"]["seed"])
        for name in ("a.csv", "a.svg", "a.json"):
            with self.subTest(name):
                self.assert_same(name)
                self.edit(lambda data: data.replace(b"0.1", b"0.2", 1) if name != "a.svg" else
                          data.replace(b"</metadata>", b"</metadata> ", 1), name)
                self.assert_different(name, "first difference")

    def test_pictures_of_results_are_made_again(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms")
        self.run_model("again", "--end", "4 ms", "--interval", "0.1 ms")
        self.run_model("s", "--end", "4 ms", "--interval", "0.1 ms", "--set", "c=0.3 mm")
        for name, words in (("one.svg", ("joint.wrist.fn", "body.slider.x", "--from", "1 ms")), ("orbit.svg", ("--orbit", "wrist")),
                            ("over.svg", ("joint.wrist.fn", "--x", "body.slider.x", "--width", "84 mm")),
                            ("xy.svg", ("body.slider.x", "body.slider.y", "--xy")), ("polar.svg", ("--polar", "wrist")),
                            ("fft.svg", ("driver.motor.torque", "--fft")), ("parts.svg", ("joint.wrist.fn", "--histogram")),
                            ("two.svg", ("joint.wrist.fn", "--against", "s")),
                            ("three.svg", ("body.slider.x", "--against", "again", "--against", "s"))):
            with self.subTest(name):
                self.freeplay("plot", "r", *words, "--out", name)
                self.assert_same(name)
        self.edit(lambda data: data[:(at := re.search(rb'class="line"[^>]*[ML][^>]*\d', data).end() - 1)] +
                  (b"1" if data[at:at + 1] != b"1" else b"2") + data[at + 1:], "two.svg")
        self.assert_different("two.svg", r"data .*first difference: byte \d+, line \d+: ")

    def test_pages_are_made_again(self):
        self.run_model("r", "--end", "4 ms", "--interval", "0.1 ms")
        os.mkdir(self.path("tables"))
        os.mkdir(self.path("models"))
        self.write("tables/speed.csv", "t,w\n0,1\n0.05,3\n0.1,2\n")
        self.write("models/turning.yaml", DRIVEN)
        self.run_model("t", model="models/turning.yaml")
        self.freeplay("report", "r", "--out", "one.html")
        self.freeplay("report", "r", "t", "--out", "two.html", "--title", "a <b> & c", "--from", "1 ms")
        for name in ("one.html", "two.html"):
            with self.subTest(name):
                self.assertRegex(self.assert_same(name), r"data +\d+ bytes +same bytes")

        def other_value(data):
            at = re.search(rb'"values": ?"[A-Za-z0-9+/]{40}', data).end()
            return data[:at] + (b"A" if data[at:at + 1] != b"A" else b"B") + data[at + 1:]

        self.edit(other_value, "two.html")
        self.assert_different("two.html", "its data was changed afterwards: SHA-256 ", "data .*first difference: /.*/values: ")
        # The text of the model in it, and that of an input.
        for old, new in ((b"inertia: 1e-4", b"inertia: 2e-4"), (b"0.05,3", b"0.05,4")):
            self.freeplay("report", "r", "t", "--out", "again.html", "--force")
            self.edit(lambda data: data.replace(old, new), "again.html")
            self.assert_different("again.html", "the (model|input .*) was changed afterwards")

    def test_what_a_killed_run_left_is_compared_as_far_as_it_goes(self):
        rows = self.path("k", "results.csv")
        with subprocess.Popen([PROGRAM, "run", "crank.yaml", "--quiet", "--out", "k", "--end", "0.6 s"], cwd=self.folder,
                              stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and not (os.path.exists(rows) and os.path.getsize(rows) > 500_000):
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
        self.assertEqual(-signal.SIGKILL, process.returncode)
        self.assertFalse(os.path.exists(self.path("k", "summary.json")))
        out = self.assert_same("k")
        self.assertIn("its run had not ended: compared as far as it goes", out)
        self.assertRegex(out, r"rows +\d+ of \d+ x \d+ ")
        self.freeplay("seal", "k")
        self.assertIn("as far as it goes", self.assert_same("k"))
        self.edit(lambda data: data.replace(b",", b",1", 40), "k", "results.csv")
        self.assert_different("k", "rows .*first difference: ")

    def test_an_interrupt_ends_it_and_leaves_nothing(self):
        self.run_model("r", "--end", "1 ms", "--format", "csv")
        os.mkdir(self.path("scratch"))

        def longer(data):
            summary = json.loads(data)
            summary["provenance"]["arguments"] = ["--end", "1000 s", "--interval", "1 s"]
            return json.dumps(summary).encode()

        self.change("summary.json", longer)
        with subprocess.Popen([PROGRAM, "reproduce", "copy"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env={**os.environ, "TMPDIR": self.path("scratch")}) as process:
            while not any("run.log" in files for _, _, files in os.walk(self.path("scratch"))):
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=60)
        self.assertEqual((130, b""), (process.returncode, out))
        self.assertEqual([], os.listdir(self.path("scratch")))

    def test_what_has_no_record_is_refused(self):
        self.write("none.html", "<!doctype html><title>x</title>")
        self.write("none.csv", "time,x\n0,1\n")
        self.write("none.json", "{}")
        self.write("none.svg", "<svg></svg>")
        os.mkdir(self.path("empty"))
        for name in ("none.html", "none.csv", "none.json", "none.svg", "empty"):
            with self.subTest(name):
                _, err = self.freeplay("reproduce", name, code=6)
                self.assertIn("[no-provenance]", err)
        _, err = self.freeplay("reproduce", "nowhere", code=6)
        self.assertIn("[unreadable-result]", err)
        self.freeplay("reproduce", code=2)
        out, _ = self.freeplay("reproduce", "nowhere", "--json", code=6)
        self.assertEqual(6, json.loads(out)["error"]["exit_code"])

    def test_a_record_from_elsewhere_is_followed_within_limits(self):
        self.run_model("r", "--end", "1 ms", "--format", "csv")
        for arguments in (["--end", "1 ms", "--out", "stolen"], ["--resume=r"], ["--allow-plugins"], [1], "--end"):
            with self.subTest(arguments):
                def edit(data, words=arguments):
                    summary = json.loads(data)
                    summary["provenance"]["arguments"] = words
                    return json.dumps(summary).encode()
                _, err = self.freeplay("reproduce", self.change("summary.json", edit), code=6)
                self.assertIn("[no-provenance]", err)

        def by_init(data):
            summary = json.loads(data)
            summary["provenance"]["made"] = "init"
            return json.dumps(summary).encode()

        _, err = self.freeplay("reproduce", self.change("summary.json", by_init), code=6)
        self.assertIn("makes nothing by 'init'", err)
        self.assertFalse(os.path.exists(self.path("stolen")))

    def test_another_version_is_named_and_does_not_stop_it(self):
        self.run_model("r", "--end", "1 ms", "--format", "csv")

        def edit(data):
            summary = json.loads(data)
            summary["provenance"]["freeplay"] = "0.0.9"
            summary["provenance"]["build"] = "Debug"
            return json.dumps(summary).encode()

        out = self.assert_same(self.change("summary.json", edit))
        self.assertRegex(out.splitlines()[0], r"made by freeplay 0\.0\.9 \(.*, debug\), rerun by freeplay ")
        self.assertIn('another freeplay: "0.0.9" recorded, ', out)
        self.assertIn('another build: "Debug" recorded, ', out)

    def test_what_was_made_again_can_be_kept(self):
        self.run_model("r", "--end", "1 ms")
        self.assert_same("r", "--out", "again")
        self.assertEqual(self.bytes_of("r", "results.csv"), self.bytes_of("again", "results.csv"))
        _, err = self.freeplay("reproduce", "r", "--out", "again", code=6)
        self.assertIn("'again' is there already", err)
        self.freeplay("export", "r", "--to", "csv", "--out", "t.csv")
        self.assert_same("t.csv", "--out", "table")
        self.assertEqual(["run-0", "t.csv", "t.csv.provenance.json"], sorted(os.listdir(self.path("table"))))

    def test_inputs_are_those_of_the_record(self):
        for folder in ("models", "tables"):
            os.mkdir(self.path(folder))
        self.write("tables/speed.csv", "t,w\n0,1\n0.05,3\n0.1,2\n")
        self.write("models/turning.yaml", DRIVEN.replace("../tables", self.path("tables")))
        self.run_model("r", model="models/turning.yaml")
        self.freeplay("export", "r", "--to", "csv", "--out", "t.csv")
        self.write("tables/speed.csv", "t,w\n0,1\n0.05,9\n0.1,2\n")
        self.assert_same("r")
        self.assert_same("t.csv")
        self.assertEqual("turning", json.loads(self.read("r", "summary.json"))["model"]["name"])
        self.assert_different(self.change("inputs/speed.csv", lambda data: data.replace(b"3", b"4")),
                              "the input 'speed.csv' was changed afterwards")

    def test_plugins_are_found_named_and_not_run_unasked(self):
        shutil.copy(SPRING, self.path("spring.so"))
        model = self.write("twisted.yaml", TWISTED % "plugins: [spring.so]\n")
        self.run_model("r", "--allow-plugins", model=model)
        _, err = self.freeplay("reproduce", "r", code=5)
        self.assertIn("[plugin-not-allowed]", err)
        self.assertIn(self.path("spring.so"), err)
        self.assert_same("r", "--allow-plugins")
        self.assert_same("r", "--plugin", "spring.so")
        os.mkdir(self.path("moved"))
        os.rename(self.path("spring.so"), self.path("moved", "spring.so"))
        _, err = self.freeplay("reproduce", "r", "--allow-plugins", code=5)
        self.assertIn("[plugin-not-found]", err)
        with open(self.path("moved", "spring.so"), "ab") as file:
            file.write(b" ")
        out = self.assert_same("r", "--plugin", "moved/spring.so")
        self.assertRegex(out, r"the plugin '\S+' is another: SHA-256 \w{12} recorded, \w{12} now")
        # The one of the same bytes goes before the one of the same name.
        shutil.copy(SPRING, self.path("spring.so"))
        environment = {**os.environ, "FREEPLAY_PLUGIN_PATH": self.path("moved")}
        self.assertNotIn("another", self.assert_same("r", "--allow-plugins", environment=environment))
        _, err = self.freeplay("reproduce", "r", code=5, environment=environment)
        self.assertIn("[plugin-not-allowed]", err)
        os.rename(self.path("spring.so"), self.path("renamed.so"))
        self.assertIn("is another", self.assert_same("r", environment=environment))
        self.assertNotIn("another", self.assert_same("r", "--plugin", "renamed.so"))  # its bytes say what it is
        # By an option that the record holds, too.
        self.run_model("r", "--plugin", "moved/spring.so", model=self.write("twisted.yaml", TWISTED % ""))
        self.freeplay("reproduce", "r", code=5)
        self.assert_same("r", "--allow-plugins")

    def test_a_failed_run_fails_again_in_the_same_way(self):
        model = self.write("stuck.yaml", DRIVEN.replace("{file: ../tables/speed.csv}",
                                                        "{points: [[0, 1], [0.02, 2], [0.05, 1]], outside: error}"))
        self.freeplay("run", model, "--quiet", "--out", "r", code=4)
        self.assert_same("r")


if __name__ == "__main__":
    unittest.main()
