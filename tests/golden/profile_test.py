"""freeplay run --profile: phases with time, share and count; the counts are those of the result files."""
import filecmp
import json
import re
import unittest

from program import ProgramTest, mechanism

PHASES = ["start", "assembly", "joints and contact", "factorization", "solution", "integrator", "events", "statistics", "output",
          "rest", "all"]


class Profile(ProgramTest):
    def run_model(self, name, folder, *options):
        return self.freeplay("run", mechanism(name), "--end", "12 ms", "--out", folder, *options)

    def table(self, text):
        """Seconds and counts by phase, and the counts below."""
        lines = text[text.index("  profile "):].splitlines()[1:]
        seconds, counts, numbers = {}, {}, {}
        for line in lines[:-2]:
            phase = re.fullmatch(r"  (\S.*?) {2,}([\d.]+) +([\d.]+) %(?: +(\d+)  \w+)?", line)
            if phase:
                seconds[phase[1]], counts[phase[1]] = float(phase[2]), int(phase[4] or 0)
            else:
                name, number = line.split()
                numbers[name] = int(number)
        first = re.fullmatch(r"  the first step ended after ([\d.]+) s of processor time of the program", lines[-2])
        self.assertGreater(float(first[1]), 0.0)
        self.assertRegex(lines[-1], r"^  rows became text beside the run in [\d.]+ s of another thread$")
        return seconds, counts, numbers

    def test_phases_add_up_and_counts_are_those_of_the_files(self):
        for options in ([], ["--accuracy", "1um"]):
            out, _ = self.run_model("3-rrr", "r", "--profile", *options)
            seconds, counts, numbers = self.table(out)
            summary = json.loads(self.read("r", "summary.json"))
            self.assertEqual(PHASES, list(seconds))
            self.assertAlmostEqual(seconds["all"], sum(seconds[phase] for phase in PHASES[:-1]), delta=1e-5)
            self.assertAlmostEqual(seconds["all"], summary["performance"]["wall_seconds"], delta=1e-3)
            for phase in PHASES:
                self.assertGreater(seconds[phase], 0.0, phase)
            for name in ("steps", "rejected", "iterations", "factorizations", "rows"):
                self.assertEqual(summary["counts"][name], numbers[name], name)
            self.assertEqual(len(self.read("r", "events.csv").splitlines()) - 1, numbers["events"])
            self.assertGreater(numbers["events"], 0)
            self.assertEqual(numbers["evaluations"], counts["assembly"])
            self.assertGreaterEqual(counts["statistics"], numbers["steps"] + 1)  # and once more where a step ends in a jump
            self.assertLessEqual(counts["statistics"], numbers["steps"] + 1 + 2 * numbers["events"])
            self.assertEqual(numbers["rows"], counts["output"])
            self.assertGreaterEqual(counts["integrator"], numbers["steps"] + numbers["rejected"])

    def test_most_steps_to_an_event_are_taken_once(self):
        out, _ = self.freeplay("run", mechanism("slider-crank"), "--end", "8 ms", "--integrator", "verner7", "--accuracy", "0.3 mm",
                               "--profile", "--out", "r")
        _, counts, numbers = self.table(out)
        self.assertGreater(numbers["events"], 30)
        self.assertLess(counts["integrator"] - numbers["steps"], numbers["events"])

    def test_what_positions_are_off_by_rounding_starts_no_iteration(self):
        out, _ = self.freeplay("run", mechanism("slider-crank"), "--end", "0.5 ms", "--integrator", "bathe", "--step", "0.1 us",
                               "--profile", "--out", "r")
        _, _, numbers = self.table(out)
        self.assertLess(numbers["iterations"], 2.2 * numbers["steps"])

    def test_results_do_not_depend_on_it(self):
        self.run_model("3-rrr", "a")
        self.run_model("3-rrr", "b", "--profile")
        for name in ("results.csv", "events.csv", "model.yaml"):
            self.assertTrue(filecmp.cmp(self.path("a", name), self.path("b", name), shallow=False), name)
        first, second = (json.loads(self.read(folder, "summary.json")) for folder in "ab")
        for summary in (first, second):
            del summary["performance"], summary["provenance"]["command"]
        self.assertEqual(first, second)

    def test_json_stays_alone_on_stdout(self):
        out, err = self.run_model("four-bar", "r", "--profile", "--json")
        self.assertEqual(json.loads(self.read("r", "summary.json")), json.loads(out))
        self.table(err)

    def test_it_is_printed_though_quiet_and_only_on_request(self):
        out, _ = self.run_model("four-bar", "r", "--profile", "--quiet")
        self.assertTrue(out.startswith("  profile "), out)
        self.assertNotIn("profile", self.run_model("four-bar", "r")[0])


if __name__ == "__main__":
    unittest.main()
