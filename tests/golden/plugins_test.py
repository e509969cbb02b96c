"""Plugins from outside: loading, the ways to find them, and probes that are broken on purpose."""
import csv
import math
import os
import shutil
import unittest

from program import BUILD, ProgramTest, mechanism

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
        self.freeplay("run", model, "--out", "r")
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

    def test_misspelt_parameters_of_a_plugin_are_told_like_all_others(self):
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

    def test_a_name_of_a_built_in_type_is_refused(self):
        _, err = self.freeplay("run", mechanism("pendulum"), "--plugin", probe("name_clash"), code=5)
        self.assertIn("brings the joint 'revolute', which 'built-in' has already [plugin-clash]", err)

    def test_a_constructor_that_throws_names_the_joint_and_its_line(self):
        model = self.write("probed.yaml", PROBED)
        _, err = self.freeplay("run", model, "--plugin", probe("throws_in_create"), code=5)
        self.assertIn("no such luck", err)
        self.assertIn("probed.yaml:5:3", err)

    def test_a_joint_that_fails_while_running_names_itself_and_the_time_and_keeps_the_rows(self):
        model = self.write("probed.yaml", PROBED)
        for name, reason in (("throws_in_apply", "tired"), ("returns_nan", "not a finite number")):
            with self.subTest(name):
                _, err = self.freeplay("run", model, "--plugin", probe(name), "--out", name, code=5)
                self.assertRegex(err, r"t = 0\.0\d* s: joint 'odd' of type 'probe' failed: .*" + reason)
                rows = self.read(name, "results.csv").splitlines()
                self.assertGreaterEqual(len(rows), 6)


if __name__ == "__main__":
    unittest.main()
