"""Plugins from outside: loading, the ways to find them, and probes that are broken on purpose."""
import csv
import hashlib
import json
import math
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from program import BUILD, PROGRAM, ProgramTest, let_work, mechanism

PLUGINS = os.path.join(BUILD, "plugins")
EXAMPLE = os.path.join(PLUGINS, "example", "torsional_spring_damper.so")

TWISTED = """freeplay: 1
name: twisted
%sbodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  spring: {type: torsional-spring-damper, between: [ground, disc], stiffness: 5 N*m, free_angle: 20 deg}
initial: {joints: {pin: 0.1}}
simulation: {end: 0.5 s, step: 0.5 ms, output: {interval: 0.1 s}}
"""

PROBED = """freeplay: 1
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  odd: {type: probe, between: [ground, disc]}
simulation: {end: 0.1 s, step: 1 ms, output: {interval: 10 ms}}
"""

# A journal that falls into its bearing; contact and friction law are filled in.
LOOSE = """freeplay: 1
gravity: [0, -9.81]
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin:
    type: revolute
    between: [ground, disc]
    clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, material: {E: 207 GPa, nu: 0.3}, contact: %s, friction: %s}
simulation: {end: 0.02 s, step: 5 us, output: {interval: 0.2 ms}}
"""

# Probe, exit code of a run, what its message must say.
REFUSED = {
    "missing_entry_point": "has no entry point freeplay_plugin_v1",
    "unresolved_symbol": "undefined symbol",
    "wrong_abi_version": "was built for plugin ABI 99, this program has ABI 1: update Freeplay",
    "older_abi_version": "was built for plugin ABI 0, this program has ABI 1: rebuild it",
    "wrong_fingerprint": "its fingerprint is 'ilp32 big vax'",
    "wrong_row_size": "has rows of another size (8 bytes",
    "larger_struct": "was built with a newer SDK",
    "empty_table": "publishes no types",
    "null_function": "publishes 'probe' with a null function pointer",
    "duplicate_parameter": "publishes 'probe' with two parameters called 'k'",
    "default_outside_bounds": "parameter 'k' whose default lies outside its bounds",
}


def probe(name):
    return os.path.join(PLUGINS, "probes", "probe_%s.so" % name)


class LoadingTest(ProgramTest):
    def test_a_model_uses_the_joint_of_a_plugin_that_it_names(self):
        shutil.copy(EXAMPLE, self.path("spring.so"))
        model = self.write("twisted.yaml", TWISTED % "plugins: [spring.so]\n")
        self.freeplay("run", model, "--out", "r", "--allow-plugins")
        rows = list(csv.DictReader(self.read("r", "results.csv").splitlines()))
        rest, frequency = math.radians(20), math.sqrt(5 / 0.05)
        for row in rows:
            exact = rest + (0.1 - rest) * math.cos(frequency * float(row["time"]))
            # Second order in the step: omega^3 h^2 t / 12 of the amplitude, and some room.
            self.assertAlmostEqual(exact, float(row["joint.pin.angle"]), delta=1e-5)
            self.assertAlmostEqual(-5 * (float(row["joint.pin.angle"]) - rest),
                                   float(row["joint.spring.spring_torque"]), delta=1e-9)

    def test_an_option_loads_a_plugin(self):
        model = self.write("twisted.yaml", TWISTED % "")
        self.freeplay("validate", model, code=3)
        self.freeplay("validate", model, "--plugin", EXAMPLE)
        out, _ = self.freeplay("describe", "torsional-spring-damper", "--plugin", EXAMPLE)
        self.assertIn("stiffness", out)

    def test_a_name_is_sought_in_the_plugin_path(self):
        model = self.write("twisted.yaml", TWISTED % "plugins: [torsional_spring_damper]\n")
        _, err = self.freeplay("validate", model, code=5)
        self.assertIn("[plugin-not-found]", err)
        self.assertIn("twisted.yaml:3:11", err)
        folder = os.path.dirname(EXAMPLE)
        self.freeplay("validate", model, environment={"FREEPLAY_PLUGIN_PATH": "/nonexistent:" + folder})

    def test_libraries_of_the_plugin_path_are_loaded_at_start(self):
        model = self.write("twisted.yaml", TWISTED % "")
        self.freeplay("validate", model, environment={"FREEPLAY_PLUGIN_PATH": os.path.dirname(EXAMPLE)})

    def test_one_file_found_twice_is_loaded_once(self):
        model = self.write("twisted.yaml", TWISTED % ("plugins: ['%s']\n" % EXAMPLE))
        self.freeplay("validate", model, "--plugin", EXAMPLE, "--plugin", EXAMPLE,
                      environment={"FREEPLAY_PLUGIN_PATH": os.path.dirname(EXAMPLE)})

    def test_two_plugins_with_one_name_are_refused_with_both_paths(self):
        shutil.copy(EXAMPLE, self.path("other.so"))
        _, err = self.freeplay("list", "--plugin", EXAMPLE, "--plugin", "other.so", code=5)
        self.assertIn(EXAMPLE, err)
        self.assertIn("other.so", err)
        self.assertIn("[plugin-clash]", err)

    def test_a_refused_library_of_the_path_gives_a_warning_and_is_skipped(self):
        os.mkdir(self.path("p"))
        self.write("p/text.so", "no library\n")
        out, err = self.freeplay("list", "joints", environment={"FREEPLAY_PLUGIN_PATH": self.path("p")})
        self.assertIn("revolute", out)
        self.assertRegex(err, r"warning: plugin '.*text\.so' cannot be loaded")

    def test_a_library_that_only_a_model_names_is_not_loaded(self):
        # Its constructor leaves a mark.
        self.write("mark.c", """#include <stdio.h>
__attribute__((constructor)) static void leave(void) { fclose(fopen("%s", "w")); }
""" % self.path("mark"))
        subprocess.run(["cc", "-shared", "-fPIC", "-o", self.path("mark.so"), self.path("mark.c")], check=True)
        with open(self.path("mark.so"), "rb") as file:
            digits = hashlib.sha256(file.read()).hexdigest()
        robot = self.write("m.yaml", TWISTED % "plugins: [./mark.so]\n")
        commands = [("run", robot), ("run", robot, "--dry-run"), ("validate", robot), ("show", robot),
                    ("show", robot, "--format", "svg"), ("analyze", "ik", robot, "--pose", "0,0,0"), ("convert", robot, "x.yaml"),
                    ("list", "channels", robot)]
        for words in commands:
            with self.subTest(words):
                out, err = self.freeplay(*words, code=5)
                self.assertIn("m.yaml:3:11", err)
                self.assertIn("the plugin './mark.so' (SHA-256 %s) lies outside of the folders for plugins" % digits, err)
                self.assertIn("--allow-plugins", err)
                self.assertIn("[plugin-not-allowed]", err)
                self.assertFalse(os.path.exists(self.path("mark")))
        # Told to, or found in a folder for plugins, it is.
        for options in (("--allow-plugins",), ("--plugin", "./mark.so")):
            _, err = self.freeplay("validate", robot, *options, code=5)
            self.assertIn("has no entry point", err)
            os.remove(self.path("mark"))
        _, err = self.freeplay("validate", robot, code=5, environment={"FREEPLAY_PLUGIN_PATH": self.folder})
        self.assertIn("has no entry point", err)
        # A folder inside of one for plugins is none.
        os.mkdir(self.path("inside"))
        os.rename(self.path("mark.so"), self.path("inside", "mark.so"))
        os.remove(self.path("mark"))
        robot = self.write("m.yaml", TWISTED % "plugins: [inside/mark.so]\n")
        _, err = self.freeplay("validate", robot, code=5, environment={"FREEPLAY_PLUGIN_PATH": self.folder})
        self.assertIn("[plugin-not-allowed]", err)
        self.assertFalse(os.path.exists(self.path("mark")))

    def test_the_model_of_a_result_finds_its_plugins_and_its_tables(self):
        for folder in ("lib", "models"):
            os.mkdir(self.path(folder))
        shutil.copy(EXAMPLE, self.path("lib", "spring.so"))
        self.write("models/load.csv", "t,f\n0,1\n0.05,3\n0.5,2\n")
        driven = (TWISTED % "plugins: [../lib/spring.so]\n").replace("name: twisted\n", "").replace(
            "initial:", "drivers: {load: {joint: pin, kind: torque, table: load.csv}}\ninitial:")
        self.write("models/twisted.yaml", driven)
        self.freeplay("run", "models/twisted.yaml", "--out", "r", "--allow-plugins")
        # In its own folder, and after a kill of the run.
        _, err = self.freeplay("run", "r/model.yaml", "--out", "again", code=5)
        self.assertIn("[plugin-not-allowed]", err)
        self.freeplay("run", "r/model.yaml", "--out", "again", "--allow-plugins")
        self.assertEqual(self.read("r", "results.csv"), self.read("again", "results.csv"))
        self.assertEqual("twisted", json.loads(self.read("again", "summary.json"))["model"]["name"])
        self.assertIn("twisted", self.freeplay("show", "r", "--allow-plugins")[0])
        running = subprocess.Popen([PROGRAM, "run", "models/twisted.yaml", "--out", "cut", "--quiet", "--allow-plugins",
                                    "--end", "20000 s"], cwd=self.folder, stderr=subprocess.DEVNULL)
        self.addCleanup(running.kill)
        while not os.path.exists(self.path("cut", "results.h5")):
            self.assertIsNone(running.poll())
            time.sleep(0.01)
        running.send_signal(signal.SIGTERM)
        self.assertEqual(130, running.wait(timeout=60))
        os.remove(self.path("cut", "summary.json"))
        _, err = self.freeplay("run", "--resume", "cut", code=5)
        self.assertIn("[plugin-not-allowed]", err)
        for options in (("--allow-plugins",), ("--plugin", "lib/spring.so")):
            with self.subTest(options):
                made = os.stat(self.path("cut", "checkpoint.bin")).st_ino
                going_on = subprocess.Popen([PROGRAM, "run", "--resume", "cut", "--quiet", "--checkpoint", "50 ms", *options],
                                            cwd=self.folder, stderr=subprocess.DEVNULL)
                self.addCleanup(going_on.kill)
                while os.stat(self.path("cut", "checkpoint.bin")).st_ino == made:
                    self.assertIsNone(going_on.poll())
                    time.sleep(0.01)
                going_on.send_signal(signal.SIGTERM)
                self.assertEqual(130, going_on.wait(timeout=60))
                self.assertEqual("twisted", json.loads(self.read("cut", "summary.json"))["model"]["name"])

    def test_misspelt_parameters_of_a_plugin_are_reported_like_all_others(self):
        model = self.write("twisted.yaml", (TWISTED % "").replace("stiffness", "stifness"))
        _, err = self.freeplay("validate", model, "--plugin", EXAMPLE, code=3)
        self.assertIn("did you mean 'stiffness'?", err)


class ProbesTest(ProgramTest):
    def test_every_broken_library_is_refused_with_its_reason(self):
        model = self.write("probed.yaml", PROBED)
        for name, reason in REFUSED.items():
            with self.subTest(name):
                _, err = self.freeplay("run", model, "--plugin", probe(name), code=5)
                self.assertIn(reason, err)
                self.assertIn("[plugin-refused]", err)

    def test_a_file_that_is_no_library_is_refused(self):
        self.write("text.so", "no library\n")
        _, err = self.freeplay("list", "--plugin", "./text.so", code=5)
        self.assertIn("cannot be loaded", err)

    def test_an_ideal_type_that_is_not_there_is_refused_before_it_is_used(self):
        for command in (("run", mechanism("pendulum")), ("list",)):
            _, err = self.freeplay(*command, "--plugin", probe("absent_ideal"), code=5)
            self.assertRegex(err, "the ideal type 'no-such-pin' of its joint 'probe' is not there.*plugin-refused")
        os.mkdir(self.path("found"))
        shutil.copy(probe("absent_ideal"), self.path("found"))
        _, err = self.freeplay("validate", mechanism("pendulum"), environment={"FREEPLAY_PLUGIN_PATH": self.path("found")})
        self.assertIn("warning: plugin", err)

    def test_the_log_of_a_run_names_its_plugins(self):
        self.write("m.yaml", TWISTED % ("plugins: [%s]\n" % EXAMPLE))
        self.freeplay("run", "m.yaml", "--out", "r", "--end", "1 ms", "--allow-plugins")
        self.assertRegex(self.read("r", "run.log"), r"note: plugin \S+ \S+, compiler .+, from %s" % re.escape(EXAMPLE))

    def test_a_name_of_a_built_in_type_is_refused(self):
        _, err = self.freeplay("run", mechanism("pendulum"), "--plugin", probe("name_clash"), code=5)
        self.assertIn("brings the joint 'revolute', which 'built-in' has already [plugin-clash]", err)

    def test_a_constructor_that_throws_names_the_joint_and_its_line(self):
        model = self.write("probed.yaml", PROBED)
        _, err = self.freeplay("run", model, "--plugin", probe("throws_in_create"), code=5)
        self.assertIn("no such luck", err)
        self.assertIn("probed.yaml:5:3", err)

    def fails_while_running(self, model, name, who, reason, rows=6, options=()):
        """Runs into a failure of a plugin: named on stderr and in the summary; what was computed before is kept."""
        with self.subTest(name):
            _, err = self.freeplay("run", model, "--plugin", probe(name), "--out", name, *options, code=5)
            told = r"t = 0[.\d]* s: %s of type 'probe' of plugin '%s'( failed)?: %s.*\[plugin-failed\]"
            self.assertRegex(err, told % (who, re.escape(probe(name)), reason))
            kept = list(csv.reader(self.read(name, "results.csv").splitlines()))
            self.assertGreaterEqual(len(kept), rows)
            for row in kept[1:]:
                self.assertEqual(len(kept[0]), len(row))
                self.assertTrue(all(math.isfinite(float(number)) for number in row if number))
            summary = json.loads(self.read(name, "summary.json"))
            self.assertEqual("failed", summary["status"])
            self.assertIn(probe(name), summary["stop_reason"])

    def test_a_joint_that_fails_while_running_names_itself_and_the_time_and_keeps_the_rows(self):
        model = self.write("probed.yaml", PROBED)
        for name, reason in (("throws_in_apply", "tired"),
                             ("returns_nan", "it returned a force, a rate or a derivative that is not a finite number")):
            self.fails_while_running(model, name, "joint 'odd'", reason)
        self.fails_while_running(model, "nan_derivative", "joint 'odd'", "it returned a force, a rate or a derivative", 2)
        model = self.write("slot.yaml", PROBED.replace("  pin: {type: revolute, between: [ground, disc]}\n", ""))
        for name, reason in (("throws_in_constrain", "out of step"),
                             ("nan_in_constrain", "it returned a row that is not a finite number")):
            self.fails_while_running(model, name, "joint 'odd'", reason)

    def test_a_law_that_fails_while_running_is_named_with_its_joint(self):
        for kind, other in (("contact", "{law: hertz}"), ("friction", "{law: hertz}")):
            own = "{law: probe}"
            contact, friction = (own, "{law: none}") if kind == "contact" else (other, own)
            model = self.write(kind + ".yaml", LOOSE % (contact, friction))
            for end, reason in (("throws", "too deep|stuck"), ("nan", "it returned a force that is not a finite number")):
                who = "joint 'pin' of type 'revolute-clearance' failed: %s law" % kind
                self.fails_while_running(model, "%s_%s" % (kind, end), who, "(%s)" % reason)

    def test_an_integrator_that_fails_while_running_is_named(self):
        for name, rows, reason in (("integrator_throws", 20, "no further"),
                                   ("integrator_nan", 20, "it left a state that is not a finite number"),
                                   ("wrong_time", 2, r"a step to 0\.001 s ends at 0\.001001 s"),
                                   ("writes_past_scratch", 2, "it wrote beside the state, its memory or its scratch")):
            self.fails_while_running(mechanism("pendulum"), name, "the integrator", reason, rows,
                                     ("--integrator", "probe"))

    def test_a_joint_that_declares_nonsense_is_refused_with_its_line(self):
        model = self.write("probed.yaml", PROBED)
        _, err = self.freeplay("run", model, "--plugin", probe("declares_nonsense"), code=5)
        self.assertIn("probed.yaml:5:3", err)
        self.assertIn("failed: it declares -2 constraint rows, of at most 3 [plugin-failed]", err)

    def test_texts_that_are_missing_are_empty(self):
        out, _ = self.freeplay("describe", "probe", "--plugin", probe("null_texts"))
        self.assertIn("probe", out)

    def test_a_joint_that_writes_past_its_numbers_is_stopped(self):
        model = self.write("probed.yaml", PROBED)
        for name, words in (("writes_past_span", "[plugin-failed]"), ("writes_past_rows", "[plugin-failed]")):
            with self.subTest(name):
                _, err = self.freeplay("run", model, "--plugin", probe(name), code=5)
                self.assertIn("joint 'odd' of type 'probe' of plugin '%s' failed" % probe(name), err)
                self.assertIn("it wrote beside the numbers that it was given to fill " + words, err)

    def test_a_second_interrupt_ends_a_function_that_never_returns(self):
        model = self.write("probed.yaml", PROBED)
        running = subprocess.Popen([PROGRAM, "run", model, "--plugin", probe("never_returns"), "--out", "r"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        self.addCleanup(running.kill)
        deadline = time.monotonic() + 60.0
        while not os.path.exists(self.path("r", "results.csv")):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        let_work(running, 0.5)  # of which the way to the function takes a hundredth
        running.send_signal(signal.SIGINT)
        time.sleep(0.3)
        self.assertIsNone(running.poll())
        running.send_signal(signal.SIGINT)
        self.assertEqual("freeplay: interrupted at once, the result directory is unfinished\n",
                         running.communicate(timeout=60)[1])
        self.assertEqual(130, running.returncode)
        self.assertNotIn("summary.json", os.listdir(self.path("r")))


if __name__ == "__main__":
    unittest.main()
