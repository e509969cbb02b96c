"""./dev bench: its parts run, mistyped words are reported, the page has a table for each part. No time is judged."""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

from program import PROGRAM, ROOT, ProgramTest

FOLDER = os.path.join(ROOT, "tests", "bench")
REPEATED = ["--repeated", os.path.join(os.environ["FREEPLAY_BUILD"], "tests", "repeated_run")]
sys.path.insert(0, FOLDER)


class Bench(ProgramTest):
    def bench(self, *words, code=0, lower_bound=None):
        environment = {name: value for name, value in os.environ.items() if name != "FREEPLAY_LOWER_BOUND"}
        if lower_bound:
            environment["FREEPLAY_LOWER_BOUND"] = lower_bound
        done = subprocess.run([sys.executable, "-B", os.path.join(FOLDER, "bench.py"), *words, "--program", PROGRAM, *REPEATED,
                               "--build", self.path("bench")], capture_output=True, text=True, env=environment)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout, done.stderr

    def test_small_parts_leave_numbers(self):
        out, _ = self.bench("--quick", "four-bar-5", "startup")
        for heading in ("error [m]", "cheapest runs with an error of at most 0.0001 m", "process with one step"):
            self.assertIn(heading, out)
        found = json.loads(self.read("bench", "results.json"))
        runs = found["four-bar-5"]["runs"]
        integrators = json.loads(self.freeplay("list", "integrators", "--json")[0])
        self.assertEqual({entry["name"] for entry in integrators}, {run["integrator"] for run in runs})
        for run in runs:
            self.assertNotIn("failure", run)
            # A step of half the size errs by less; a chain of one degree of freedom is no surprise.
            self.assertLess(run["error"], 2e-2)
            self.assertGreater(run["rate"], 0.0)
        for integrator in ("bathe", "newmark", "hht", "generalized-alpha"):
            coarse, fine = [run["error"] for run in runs if run["integrator"] == integrator and run["kind"] == "step"]
            self.assertAlmostEqual(4.0, coarse / fine, delta=0.6)  # second order
        self.assertLess(0.0, found["startup"]["3-rrr, rows as CSV"]["median"])

    def test_the_engine_of_studies_is_measured(self):
        out, _ = self.bench("--quick", "studies")
        self.assertIn("all but stepping [ms a point]", out)
        found = json.loads(self.read("bench", "results.json"))["studies"]
        self.assertTrue(0.0 < found["engine"]["overhead"] < 0.1, found)
        self.assertTrue(0.0 < found["engine"]["efficiency"] <= 1.0, found)
        self.assertEqual([200, 2000], [own["points"] for own in found["large"]])
        for own in found["large"]:
            self.assertTrue(1e6 < own["parent_bytes"] < 1e9 and own["merge_seconds"] > 0.0, own)

    def test_loose_pin_and_loose_slider_do_the_same_beside_each_other(self):
        import loose_slider
        for name, joint in loose_slider.MODELS:
            for label, options in loose_slider.RUNS:
                self.freeplay("run", os.path.join(FOLDER, name + ".yaml"), *options, "--force", "--out", self.path(name))
                own = json.loads(self.read(name, "summary.json"))
                contact = own["joints"][joint]["contact_fraction"]
                if label == "in flight":
                    self.assertEqual(("completed", 0.0), (own["status"], contact))
                else:
                    self.assertEqual(("completed", "good", []), (own["status"], own["trust"]["verdict"], own["warnings"]))
                    self.assertGreater(contact, 0.95, (name, options))

    def test_mistyped_words_get_the_nearest(self):
        for words, answer in ((["slider-crnk"], "did you mean 'slider-crank'?"), (["3-RRR"], "did you mean '3-rrr'?"), (["--quik"], "did you mean '--quick'?"),
                              (["--vs", "HEAD", "growth"], "--vs compares"), (["--page", "--quick"], "none of --quick")):
            for more in ([], ["--only-words"]):  # as ./dev asks, before it builds anything
                out, err = self.bench(*words, *more, code=2)
                self.assertEqual("", out)
                self.assertIn(answer, err)
        self.assertEqual(("", ""), self.bench("slider-crank", "--vs", "HEAD", "--only-words"))
        _, err = self.bench("startup", "--quick", code=1, lower_bound=self.folder)
        self.assertIn("FREEPLAY_LOWER_BOUND: no Makefile", err)
        _, err = self.bench("--vs", "no-such-revision", "squeezer", code=1)
        self.assertIn("there is no revision 'no-such-revision' here", err)

    def test_help_lists_the_parts_and_the_page_has_a_table_of_each(self):
        out, _ = self.bench("--help")
        parts = re.findall(r"^  ([a-z0-9-]+)  +\S", out[out.index("\nparts:\n"):], re.M)
        with open(os.path.join(ROOT, "docs", "performance.md"), encoding="utf-8") as file:
            text = file.read()
        self.assertEqual(sorted(parts), sorted(re.findall(r"^<!-- bench (\S+) -->$", text, re.M)))
        for part in re.findall(r"`\./dev bench ([a-z0-9][a-z0-9-]*)`", text):
            self.assertIn(part, parts)

    def test_tables_of_the_page_are_replaced_and_the_rest_stays(self):
        import page
        text = "# a\n<!-- bench load -->\nold\n<!-- end -->\nb\n<!-- bench growth -->\nkept\n<!-- end -->\n"
        results = {"machine": {"cores": 2, "processor": "x"}, "date": "2026-01-02", "load": {"3-rrr": 0.25}}
        new = page.rewritten(text, results)
        self.assertIn("| 3-rrr | 0.25 |", new)
        self.assertNotIn("old", new)
        self.assertTrue(new.endswith("\nb\n<!-- bench growth -->\nkept\n<!-- end -->\n"))

    def test_peak_memory_is_that_of_the_program(self):
        import timing
        ballast = bytearray(b"x" * 100_000_000)  # of who measures
        seconds, _, peak = timing.measured([PROGRAM, "--version"])
        self.assertLess(peak, 0.5 * len(ballast))
        self.assertGreater(peak, 1e6)
        self.assertGreater(seconds, 1e-4)
        with self.assertRaisesRegex(timing.Failed, "exit code 2: .*no-such-word"):
            timing.measured([PROGRAM, "no-such-word"])

    def test_the_cheapest_that_is_good_enough_is_chosen_of_those_measured_twice(self):
        import pareto
        first = [("bad", 1e-5, 1.0)] + [(i, 1e-7, 2.0 + i) for i in range(pareto.FINALISTS)] + [("late", 1e-9, 50.0)]
        records = [{"name": name, "error": error, "rate": rate} for name, error, rate in first] + [{"failure": "no", "rate": 0.0}]
        again = {"late": 0.1, **{i: 3.4 if i == 1 else 3.5 + i for i in range(pareto.FINALISTS)}}
        self.assertEqual(1, pareto.choose(records, 1e-6, lambda record: again[record["name"]])["name"])
        self.assertIsNone(pareto.choose(records, 1e-12, lambda record: 0.0))

    def test_the_series_is_printed_and_drawn(self):
        out, _ = self.bench("--series")
        with open(os.path.join(FOLDER, "series.csv"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        for line in lines[1:]:
            release, date, revision, machine, *ratios = line.split(",")
            self.assertRegex(date, r"^\d{4}-\d{2}-\d{2}$")
            self.assertTrue(machine)
            for word in (release, revision, *ratios):
                self.assertIn(word, out)
            for ratio in ratios:
                self.assertLess(1.0, float(ratio))
        self.assertEqual(1 + lines[0].count(","), 4 + len(ratios))
        self.assertIn("<svg", self.read("bench", "series.svg"))
        _, err = self.bench("--series", "--quick", code=2)
        self.assertIn("--series takes no part", err)

    def test_a_release_takes_the_ratios_of_the_page(self):
        import series
        with open(os.path.join(ROOT, "docs", "performance.md"), encoding="utf-8") as file:
            row = series.of_page(file.read(), "9.9", "abc")
        self.assertEqual(set(series.COLUMNS), set(row))
        self.assertLess(1.0, float(row["4-rrr bathe"]))

    def test_a_release_has_the_revision_that_measured_not_that_of_later_words(self):
        import series
        with tempfile.TemporaryDirectory() as root:
            git = ["git", "-C", root, "-c", "user.name=a", "-c", "user.email=a@b"]
            subprocess.run(git + ["init", "-q"], check=True)
            os.mkdir(os.path.join(root, "docs"))
            revisions = []
            for text in ("words\n4.1\n4.2\n", "words\n4.3\n4.2\n", "other words\n4.3\n4.2\n"):
                with open(os.path.join(root, "docs", "performance.md"), "w", encoding="utf-8") as file:
                    file.write(text)
                subprocess.run(git + ["add", "docs"], check=True)
                subprocess.run(git + ["commit", "-q", "-m", text], check=True)
                done = subprocess.run(git + ["log", "-1", "--format=%h"], check=True, capture_output=True, text=True)
                revisions.append(done.stdout.strip())
            self.assertEqual(revisions[1], series.revision_of("4.3\n4.2", root))

    def test_numbers_of_the_tables(self):
        import timing
        self.assertEqual((2.0, 2.5), (timing.median([3.0, 1.0, 2.0]), timing.median([1.0, 2.0, 3.0, 4.0])))
        self.assertEqual(2.0, timing.ratio([2.0, 8.0, 3.0], [1.0, 2.0, 3.0]))
        whole, slope, steepest = timing.growth([(1.0, 3.0), (10.0, 30.0), (100.0, 3000.0), (1000.0, 300000.0)])
        self.assertAlmostEqual(5.0 / 3.0, whole)
        self.assertAlmostEqual(1.7, slope)
        self.assertAlmostEqual(2.0, steepest)
        self.assertEqual(5.0, timing.largest_distance([[0.0, 0.0], [3.0, 4.0]], [[0.0, 1.0], [0.0, 0.0]]))


if __name__ == "__main__":
    unittest.main()
