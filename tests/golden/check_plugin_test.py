"""freeplay check-plugin: sound libraries pass, and each probe is found out by the rule that it breaks."""
import json
import os
import re
import signal
import subprocess
import time
import unittest

from program import BUILD, PROGRAM, ROOT, ProgramTest

PLUGINS = os.path.join(BUILD, "plugins")
EXAMPLES = os.path.join(PLUGINS, "example")

# Probe, the rule that it breaks, what the detail must say.
BROKEN = {
    "wrong_jacobian": ("jacobian", r"row 0, wz of a \(column 5\) is .*differences give .* at t = .* s with b at"),
    "wrong_acceleration_term": ("gamma", r"gamma of row 0 is 0, differences .* give "),
    "wrong_velocity_term": ("nu", r"nu of row 0 is -0\..*, differences in time give 0\."),
    "unbalanced_pair": ("balance", r"leave a resultant of [\d.]+ N"),
    "pushes": ("energy", r"the wrenches do work at"),
    "writes_past_span": ("stays-in-span", r"apply\(\) writes beside the 1 numbers it was given"),
    "writes_past_rows": ("stays-in-span", r"constrain\(\) writes beside the 12 numbers it was given"),
    "writes_past_struct": ("stays-in-span", r"coordinate\(\) writes past the end of the struct"),
    "changes_input": ("stays-in-span", r"apply\(\) changes what it may only read"),
    "writes_past_scratch": ("stays-in-span", r"attempt\(\) writes beside the state, its memory or the scratch"),
    "hidden_state": ("no-hidden-state", r"the same input gives other numbers"),
    "keeps_contact": ("rollback", r"a walk that starts from saved z and h differs"),
    "allocates": ("allocation", r"apply\(\) allocates .*: 1 in one call"),
    "returns_nan": ("finite", r"apply\(\) gives a number that is not finite"),
    "nan_derivative": ("finite", r"apply\(\) gives a number that is not finite"),
    "nan_in_constrain": ("finite", r"constrain\(\) gives a number that is not finite"),
    "declares_nonsense": ("declares-sanely", r"it declares -2 constraint rows, of at most 3"),
    "null_texts": ("summary", r"is empty"),
    "throws_in_apply": ("answers", r"apply\(\) fails at t = .*: tired"),
    "throws_in_constrain": ("answers", r"constrain\(\) fails at t = .*: out of step"),
    "throws_in_create": ("accepts-parameters", r"no such luck"),
    "tension": ("no-tension", r"the normal force is -"),
    "contact_makes_energy": ("passive", r"gives back .* J more than it takes"),
    "contact_throws": ("answers", r"evaluate\(\) fails at .* m/s: too deep"),
    "contact_nan": ("finite", r"a result is not finite at"),
    "friction_pushes": ("opposes-slip", r"the force is .* N for a slip of"),
    "friction_throws": ("answers", r"evaluate\(\) fails at .*: stuck"),
    "friction_nan": ("finite", r"a result is not finite at"),
    "wrong_order": ("order-position", r"order 2\.\d*, declared 3"),
    "wrong_time": ("time", r"a step to [\d.]+ s ends at"),
    "pumps": ("energy", r"the energy of a free pendulum grows by"),
    "integrator_throws": ("answers", r"attempt\(\) fails: no further"),
    "integrator_nan": ("finite", r"a number in the state is not finite"),
}

# Probe, what the failure must say. A sanitizer turns some ends into others: it refuses huge blocks by itself.
FAILING = {
    "crashes": r"^'probe' crashed \(SIGSEGV\) in constrain\(\) \(as few as possible, in the plane\)$",
    "crashes_at_exit": r"^'probe' crashed \(SIGSEGV\) at the end of the program \(in its static destructors\)$",
    "exits": r"^'probe' ended the program with exit code 0 in apply\(\)",
}

# Probe, what the message of a library that does not even load must say.
NOT_LOADED = {
    "crashes_at_load": r"crashed \(SIGSEGV\) while it was loaded .*\[plugin-failed\]",
    "exits_at_load": r"ended the program with exit code 0 while it was loaded .*\[plugin-failed\]",
    "missing_entry_point": r"has no entry point freeplay_plugin_v1 \[plugin-refused\]",
    "unresolved_symbol": r"undefined symbol",
    "wrong_abi_version": r"was built for plugin ABI 99",
    "older_abi_version": r"was built for plugin ABI 0",
    "wrong_fingerprint": r"its fingerprint is 'ilp32 big vax'",
    "wrong_row_size": r"has rows of another size",
    "larger_struct": r"was built with a newer SDK",
    "empty_table": r"publishes no types",
    "null_function": r"with a null function pointer",
    "duplicate_parameter": r"with two parameters called 'k'",
    "default_outside_bounds": r"whose default lies outside its bounds",
    "name_clash": r"brings the joint 'revolute', which 'built-in' has already \[plugin-clash\]",
}

# Probes that have tests of their own below.
APART = {"closes_files", "never_returns", "hangs_at_load", "eats_memory", "prints", "mixed", "absent_ideal", "waits"}


def probe(name):
    return os.path.join(PLUGINS, "probes", "probe_%s.so" % name)


class CheckPlugin(ProgramTest):
    def check(self, library, *options, code=5):
        """The one type of a library and what was printed on stderr."""
        out, err = self.freeplay("check-plugin", library, "--json", *options, code=code)
        report = json.loads(out)
        self.assertEqual(code == 0, report["ok"])
        self.assertEqual(1, len(report["types"]))
        return report["types"][0], err

    def broken(self, kind):
        return {rule["rule"]: rule["detail"] for rule in kind["rules"] if not rule["held"]}

    def test_every_probe_has_a_test(self):
        files = {name[:-4] for name in os.listdir(os.path.join(ROOT, "plugins", "probes")) if name.endswith(".cpp")}
        self.assertEqual(files, set(BROKEN) | set(FAILING) | set(NOT_LOADED) | APART)

    def test_a_broken_rule_is_named_with_its_case(self):
        for name, (rule, detail) in BROKEN.items():
            with self.subTest(name):
                found, _ = self.check(probe(name))
                self.assertIsNone(found["failure"])
                self.assertFalse(found["ok"])
                self.assertIn(rule, self.broken(found))
                self.assertRegex(self.broken(found)[rule], detail)

    def test_one_fault_breaks_few_rules(self):
        # Consequences of one number that is none, or of one throw, are not told as faults of their own.
        for name in ("returns_nan", "nan_in_constrain", "contact_nan", "friction_nan", "throws_in_apply",
                     "contact_throws", "friction_throws", "integrator_throws", "integrator_nan"):
            with self.subTest(name):
                self.assertEqual(1, len(self.broken(self.check(probe(name))[0])))

    def test_a_child_that_dies_is_named_with_the_function(self):
        for name, words in FAILING.items():
            with self.subTest(name):
                found, _ = self.check(probe(name))
                self.assertRegex(found["failure"], words)

    def test_what_was_found_before_a_crash_is_kept(self):
        found, _ = self.check(probe("crashes"))
        self.assertIn("declares-sanely", [rule["rule"] for rule in found["rules"]])

    def test_a_library_that_does_not_load_is_refused_with_its_reason(self):
        for name, reason in NOT_LOADED.items():
            with self.subTest(name):
                out, err = self.freeplay("check-plugin", probe(name), code=5)
                self.assertEqual("", out)
                self.assertRegex(err, reason)
                self.assertIn(probe(name), err)

    def test_a_refusal_is_one_json_document(self):
        out, _ = self.freeplay("check-plugin", probe("crashes_at_load"), "--json", code=5)
        self.assertEqual(5, json.loads(out)["error"]["exit_code"])

    def test_a_function_that_never_returns_is_ended_and_named(self):
        found, _ = self.check(probe("never_returns"), "--time-limit", "1.5 s")
        self.assertRegex(found["failure"], r"^'probe' did not return from apply\(\) \(.*\) within 1.5 s$")

    def test_a_type_that_goes_on_answering_may_take_longer_on_a_busy_machine(self):
        # 500 calls of 5 ms each, without processor time.
        started = time.monotonic()
        out, _ = self.freeplay("check-plugin", probe("waits"), "--time-limit", "1.5 s")
        self.assertGreater(time.monotonic() - started, 1.5)
        self.assertIn("keeps its contract", out)

    def test_a_library_that_hangs_while_loading_is_ended(self):
        _, err = self.freeplay("check-plugin", probe("hangs_at_load"), "--time-limit", "1 s", code=5)
        self.assertRegex(err, r"did not come to an end within 1 s while it was loaded")

    def test_a_constructor_that_takes_all_memory_is_stopped(self):
        out, _ = self.freeplay("check-plugin", probe("eats_memory"), code=5)
        self.assertRegex(out, r"bad_alloc|ended the program|crashed")

    def test_a_report_that_was_cut_off_does_not_pass(self):
        found, _ = self.check(probe("closes_files"))
        self.assertEqual("'probe' cut off the report of its examination", found["failure"])

    def test_what_a_library_prints_goes_to_stderr_when_asked_for(self):
        found, err = self.check(probe("prints"))
        self.assertEqual({"allocation"}, set(self.broken(found)))  # printf makes a buffer
        self.assertEqual("", err)
        _, err = self.check(probe("prints"), "--verbose")
        self.assertIn('{"chatter": 1}\n', err)
        self.assertIn("chatter\n", err)

    def test_one_type_does_not_harm_the_others(self):
        out, _ = self.freeplay("check-plugin", probe("mixed"), "--json", code=5)
        report = json.loads(out)
        types = {found["name"]: found for found in report["types"]}
        self.assertEqual(["crashes", "idle", "unbalanced"], list(types))
        self.assertIn("crashed (SIGSEGV) in apply()", types["crashes"]["failure"])
        self.assertTrue(types["idle"]["ok"])
        self.assertIn("balance", self.broken(types["unbalanced"]))

    def test_every_example_passes(self):
        for name in sorted(os.listdir(EXAMPLES)):
            with self.subTest(name):
                out, err = self.freeplay("check-plugin", os.path.join(EXAMPLES, name))
                self.assertRegex(out, r"keeps? (its contract|their contracts)")
                self.assertEqual("", err)

    def test_every_built_in_type_passes_within_the_time_and_the_page_explains_its_rules(self):
        with open(os.path.join(ROOT, "docs", "check-plugin.md"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn("\n./dev check-plugin built-in\n", page)
        build = json.loads(self.freeplay("--version", "--json")[0])["build"]
        limit = [] if build == "Release" else ["--time-limit", "300 s"]  # of processor time: sanitizers are slow
        out, _ = self.freeplay("check-plugin", "built-in", "--json", *limit)
        rules = {rule["rule"] for found in json.loads(out)["types"] for rule in found["rules"]}
        self.assertGreater(len(rules), 50)
        self.assertEqual(set(), rules - set(re.findall("`([a-z-]+)`", page)))
        listed, _ = self.freeplay("list", "--json")
        # The program has forces and gears besides that are no types of a library.
        found = {(found["kind"], found["name"]) for found in json.loads(out)["types"]}
        names = {(entry["kind"], entry["name"]) for entry in json.loads(listed)}
        self.assertLess(found, names)
        for kind in ("joint", "contact", "friction", "integrator"):
            named = {name for name in names if name[0] == kind}
            self.assertGreater(len(found & named), 3)
            self.assertLessEqual(len(named - found), 1)

    def test_the_report_has_library_types_parameters_and_rules(self):
        out, _ = self.freeplay("check-plugin", os.path.join(EXAMPLES, "torsional_spring_damper.so"), "--json")
        report = json.loads(out)
        self.assertEqual(["library", "name", "version", "abi", "compiler", "ok", "types"], list(report))
        self.assertEqual(("example", "1.0.0", 1), (report["name"], report["version"], report["abi"]))
        found = report["types"][0]
        self.assertEqual(["name", "kind", "parameters", "ok", "rules", "failure"], list(found))
        self.assertEqual(["stiffness", "damping", "free_angle"], [p["name"] for p in found["parameters"]])
        self.assertGreater(len(found["rules"]), 15)
        self.assertEqual(["rule", "held", "detail"], list(found["rules"][0]))

    def test_the_text_explains_a_broken_rule(self):
        out, _ = self.freeplay("check-plugin", probe("unbalanced_pair"), code=5)
        self.assertIn("joint 'probe': breaks 2 of", out)
        self.assertRegex(out, r"broken +balance\n")
        self.assertIn("Look at\n", out)
        self.assertIn("\nThe type does not keep its contract.\n", out)
        quiet, _ = self.freeplay("check-plugin", os.path.join(EXAMPLES, "torsional_spring_damper.so"), "--quiet")
        self.assertEqual("", quiet)

    def test_equal_seeds_give_equal_reports_and_others_try_other_states(self):
        first, _ = self.freeplay("check-plugin", probe("wrong_jacobian"), "--seed", "7", code=5)
        again, _ = self.freeplay("check-plugin", probe("wrong_jacobian"), "--seed", "7", code=5)
        other, _ = self.freeplay("check-plugin", probe("wrong_jacobian"), code=5)
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_a_library_is_found_as_by_the_plugin_option(self):
        environment = {"FREEPLAY_PLUGIN_PATH": EXAMPLES}
        self.freeplay("check-plugin", "torsional_spring_damper", environment=environment)
        _, err = self.freeplay("check-plugin", "no_such_thing", environment=environment, code=5)
        self.assertIn("[plugin-not-found]", err)
        _, err = self.freeplay("check-plugin", "./no_such_file.so", code=5)
        self.assertIn("[plugin-not-found]", err)

    def test_wrong_usage_is_reported(self):
        _, err = self.freeplay("check-plugin", code=2)
        self.assertIn("check-plugin needs a library", err)
        _, err = self.freeplay("check-plugin", probe("mixed"), "--time-limit", "3 kg", code=2)
        self.assertIn("bad value '3 kg' of --time-limit", err)
        _, err = self.freeplay("check-plugin", probe("mixed"), "--sed", "3", code=2)
        self.assertIn("did you mean '--seed'?", err)

    def test_an_interrupt_leaves_no_process(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with self.subTest(number.name):
                running = subprocess.Popen([PROGRAM, "check-plugin", probe("never_returns")], cwd=self.folder,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.addCleanup(running.stdout.close)
                self.addCleanup(running.stderr.close)
                child = self.child_of(running.pid)
                running.send_signal(number)
                self.assertEqual(-9 if number == signal.SIGKILL else 130, running.wait(20))
                self.wait_until(lambda: not self.alive(child))

    def child_of(self, process):
        """Number of a child that has started to work."""
        path = "/proc/%d/task/%d/children" % (process, process)
        found = []

        def look():
            with open(path, encoding="ascii") as file:
                found[:] = file.read().split()
            return found

        self.wait_until(look)
        time.sleep(0.5)  # past the child that only lists the types
        self.wait_until(look)
        return int(found[0])

    @staticmethod
    def alive(process):
        try:
            with open("/proc/%d/stat" % process, encoding="ascii") as file:
                return file.read().rsplit(")", 1)[1].split()[0] != "Z"
        except FileNotFoundError:
            return False

    def wait_until(self, condition):
        deadline = time.monotonic() + 60.0
        while not condition():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)


if __name__ == "__main__":
    unittest.main()
