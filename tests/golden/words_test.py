"""Commands, options and their mistakes."""
import json
import os
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest, mechanism

COMMANDS = ["run", "validate", "analyze", "compare", "show", "convert", "doctor", "list", "describe", "schema", "init", "export",
            "check-plugin"]
COMMON = ["--quiet", "--verbose", "--json", "--no-color", "--plugin", "--max-errors", "--strict"]


class Words(ProgramTest):
    def test_version_is_one_line(self):
        out, err = self.freeplay("--version")
        self.assertRegex(out, r"\Afreeplay \d+\.\d+\.\d+ \(schema 1, plugin ABI 1\)\n\Z")
        self.assertEqual("", err)

    def test_version_as_json(self):
        out, _ = self.freeplay("--version", "--json")
        self.assertEqual(["freeplay", "schema", "plugin_abi", "compiler", "build"], list(json.loads(out)))

    def test_help_lists_commands_and_options(self):
        out, err = self.freeplay("--help")
        for word in ["Usage: freeplay", "run", "validate", "list", "describe", "--version", *COMMON]:
            self.assertIn(word, out)
        self.assertEqual("", err)

    def test_help_of_each_command(self):
        own = {"run": ["MODEL", "--end", "--step", "--integrator", "--out", "--force", "--dry-run", "--set", "--ideal"],
               "validate": ["MODEL", "--no-assemble", "--set", "--ideal"], "list": ["KIND"], "describe": ["NAME"]}
        for command, words in own.items():
            out, _ = self.freeplay(command, "--help")
            self.assertIn("Usage: freeplay " + command, out)
            for word in words + COMMON:
                self.assertIn(word, out, command)

    def test_alone_it_prints_the_help_and_exits_2(self):
        self.assertEqual(self.freeplay("--help")[0], self.freeplay(code=2)[0])

    def test_unknown_command_suggests_the_nearest(self):
        out, err = self.freeplay("vaildate", "x.yaml", code=2)
        self.assertEqual("", out)
        self.assertEqual("freeplay: error: unknown command 'vaildate' [unknown-command]\n"
                         "      = did you mean 'validate'?\n", err)

    def test_unknown_option_suggests_the_nearest(self):
        for arguments in (["run", "x.yaml", "--ende", "3"], ["run", "--ende", "3", "x.yaml"], ["run", "--ende=3"]):
            out, err = self.freeplay(*arguments, code=2)
            self.assertEqual("freeplay: error: unknown option '--ende' [unknown-option]\n"
                             "      = did you mean '--end'?\n", err)
        self.assertIn("did you mean '--json'?", self.freeplay("--jsn", code=2)[1])

    def test_missing_and_extra_arguments(self):
        for arguments in (["run"], ["validate"], ["describe"], ["run", "a.yaml", "b.yaml"], ["run", "a.yaml", "--end"],
                          ["list", "joints", "x"], ["list", "channels"], ["list", "joint"]):
            self.freeplay(*arguments, code=2)

    def test_the_old_name_of_studies_tells_the_new_one(self):
        _, err = self.freeplay("sweep", "run", "x", code=2)
        self.assertEqual("freeplay: error: unknown command 'sweep' [unknown-command]\n      = it is called study\n", err)
        self.assertEqual(("", err), self.freeplay("sweep", "--help", code=2))

    def test_help_of_an_unknown_command(self):
        out, err = self.freeplay("rnu", "--help", code=2)
        self.assertEqual("", out)
        self.assertIn("did you mean 'run'?", err)

    def test_help_and_schema_show_only_what_is_not_refused(self):
        for command in [[], *[[name] for name in COMMANDS]]:
            out, _ = self.freeplay(*command, "--help")
            for word in ("not in this release", "sweep"):
                self.assertNotIn(word, out, command)
        self.assertNotIn("--ideal", self.freeplay("convert", "--help")[0])
        self.assertIn("--resume", self.freeplay("run", "x.yaml", "--resum", code=2)[1])
        self.assertIn("one of model, summary, study", self.freeplay("schema", "sweep", code=2)[1])

    def test_options_without_effect_are_refused(self):
        for arguments in (["run", mechanism("pendulum"), "--dry-run", "--verify"],
                          ["run", mechanism("pendulum"), "--dry-run", "--profile"],
                          ["init", "x", "--kind", "plugin", "--type", "joint", "--from", "four-bar"],
                          ["init", "x", "--from", "list"]):
            self.freeplay(*arguments, code=2)
        self.assertEqual([], os.listdir(self.folder))

    def test_bad_values(self):
        model = mechanism("pendulum")
        for option, value in (("--end", "-1 s"), ("--end", "0"), ("--end", "3 mm"), ("--step", "-2us"),
                              ("--step", "two"), ("--format", "text"), ("--max-errors", "-1"), ("--max-errors", "x"),
                              ("--set", "l"), ("--set", "l=1 parsec"), ("--set", "nothing=1"), ("--ideal", "nothing"),
                              ("--integrator", "nothing")):
            _, err = self.freeplay("run", model, option, value, "--out", "r", code=2)
            self.assertTrue(err.startswith("freeplay: error: "), err)
        self.assertEqual([], os.listdir(self.folder))

    def test_failure_as_json(self):
        for arguments, code in ((["vaildate"], 2), (["run", "none.yaml"], 3), (["show"], 2), (["--ende"], 2), ([], 2),
                                (["run", "--step"], 2), (["describe", "nothing"], 2)):
            out, _ = self.freeplay(*arguments, "--json", code=code)
            error = json.loads(out)["error"]
            self.assertEqual(["exit_code", "message", "messages"], list(error))
            self.assertEqual(code, error["exit_code"])
            for message in error["messages"]:
                self.assertEqual(["file", "line", "column", "severity", "id", "message", "suggestion"], list(message))

    def test_closed_pipe_ends_quietly(self):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([PROGRAM, "list"], stdout=writer, stderr=subprocess.PIPE, cwd=self.folder)
        os.close(writer)
        self.assertEqual((0, b""), (done.returncode, done.stderr))

    def test_full_stdout_is_a_failure_to_write(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "list"], stdout=full, stderr=subprocess.PIPE, cwd=self.folder)
        self.assertEqual(6, done.returncode)


class Types(ProgramTest):
    COLUMNS = ["name", "kind", "space", "source", "summary"]

    def test_list_is_a_table_of_what_its_json_holds(self):
        for kind in ([], ["joints"], ["laws"], ["forces"], ["integrators"], ["plugins"]):
            entries = json.loads(self.freeplay("list", *kind, "--json")[0])
            lines = self.freeplay("list", *kind)[0].splitlines()
            self.assertEqual(self.COLUMNS, lines[0].split())
            starts = [lines[0].index(column) for column in self.COLUMNS] + [None]
            rows = [[line[a:b].strip() for a, b in zip(starts, starts[1:])] for line in lines[1:]]
            self.assertEqual([[entry[column] for column in self.COLUMNS] for entry in entries], rows)

    def test_kinds(self):
        expected = {"joints": {"joint"}, "laws": {"contact", "friction"}, "integrators": {"integrator"}}
        for kind, words in expected.items():
            entries = json.loads(self.freeplay("list", kind, "--json")[0])
            self.assertEqual(words, {entry["kind"] for entry in entries})
            self.assertEqual({"built-in"}, {entry["source"] for entry in entries})

    def test_everything_listed_can_be_described(self):
        for entry in json.loads(self.freeplay("list", "--json")[0]):
            if entry["kind"] == "plugin":
                continue
            described = json.loads(self.freeplay("describe", entry["name"], "--json")[0])
            if isinstance(described, list):  # laws of two kinds may share a name
                described = next(one for one in described if one["kind"] == entry["kind"])
            channels = described.pop("channels") + described.pop("channels_in_space", [])
            self.assertEqual(entry, described)
            self.assertTrue(all(channel["name"].startswith("joint.NAME.") for channel in channels))
            text = self.freeplay("describe", entry["name"])[0]
            self.assertIn("\n\n%s: %s\n" % (entry["name"], entry["summary"]), "\n\n" + text)
            for heading in ("formula", "validity", "references"):
                self.assertEqual(bool(entry[heading]), "\n%s\n" % heading in text)
            for parameter in entry["parameters"]:
                self.assertRegex(text, r"\n  %s +\S" % re.escape(parameter["name"]))

    def test_a_description_names_the_columns_that_a_run_reports(self):
        self.freeplay("run", mechanism("slider-crank"), "--end", "0.1 ms", "--out", "r")
        columns = self.read("r", "results.csv").splitlines()[0].split(",")
        summary = json.loads(self.read("r", "summary.json"))
        for joint, facts in summary["joints"].items():
            described = json.loads(self.freeplay("describe", facts["type"], "--json")[0])
            self.assertEqual([name for name in columns if name.startswith("joint.%s." % joint)],
                             [channel["name"].replace("NAME", joint) for channel in described["channels"]])

    def test_a_description_names_the_columns_in_space(self):
        for name in ("slider-crank", "four-bar", "stewart"):
            self.freeplay("run", os.path.join(ROOT, "mechanisms", "spatial", name + ".yaml"), "--end", "0.1 ms", "--out", name)
            columns = self.read(name, "results.csv").splitlines()[0].split(",")
            for joint, facts in json.loads(self.read(name, "summary.json"))["joints"].items():
                described = json.loads(self.freeplay("describe", facts["type"], "--json")[0])
                named = described.get("channels_in_space", described["channels"])
                self.assertEqual([column for column in columns if column.startswith("joint.%s." % joint)],
                                 [channel["name"].replace("NAME", joint) for channel in named], facts["type"])
        text, _ = self.freeplay("describe", "revolute")
        self.assertLess(text.index("\nchannels\n"), text.index("\nchannels in space\n"))

    def test_describe_shows_default_and_range(self):
        text = self.freeplay("describe", "lankarani-nikravesh")[0]
        self.assertRegex(text, r"\n  name +unit +default +range +meaning\n")
        self.assertRegex(text, r"\n  restitution +1 +\S+ +\S.*")

    def test_unknown_type_suggests_the_nearest(self):
        self.assertEqual("freeplay: error: there is no type 'revolut' [unknown-name]\n      = did you mean 'revolute'?\n",
                         self.freeplay("describe", "revolut", code=2)[1])

    def test_channels_of_a_model(self):
        out, _ = self.freeplay("list", "channels", mechanism("pendulum"), "--json")
        channels = json.loads(out)
        self.assertEqual({"name": "time", "unit": "s"}, channels[0])
        self.assertIn({"name": "energy.residual", "unit": "J"}, channels)


if __name__ == "__main__":
    unittest.main()
