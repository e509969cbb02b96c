"""What the shells complete: `freeplay complete` and the scripts that ask it."""
import os
import shutil
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest, mechanism

SHELLS = os.path.join(ROOT, "core", "cli", "package")


class Completion(ProgramTest):
    def complete(self, *words):
        return self.freeplay("complete", *words)[0].splitlines()

    def test_words(self):
        self.assertEqual(["report", "reproduce", "run"], self.complete("r"))
        self.assertIn("study", self.complete(""))
        self.assertEqual(["plan", "plot", "point"], self.complete("study", "p"))
        self.assertEqual([], self.complete("nonsense", ""))

    def test_options_of_the_command_alone(self):
        self.assertEqual(["--end", "--interval"], [w for w in self.complete("run", "--") if w in ("--end", "--interval", "--elbow", "--sweep")])
        self.assertEqual(["--checkpoint"], self.complete("run", mechanism("pendulum"), "--che"))
        self.assertIn("--verbose", self.complete("--"))
        self.assertEqual([], self.complete("convert", "--idea"))  # hidden

    def test_values_that_the_help_names(self):
        for words, values in ((("run", "--format"), ["both", "csv", "hdf5"]), (("export", "--to"), ["csv", "hdf5", "json", "mat"]),
                              (("schema",), ["model", "study", "summary"]), (("init", "--kind"), ["model", "plugin"]),
                              (("study", "script", "--engine"), ["gnu-parallel", "slurm", "snakemake"]),
                              (("study", "run", "--keep"), ["all", "failed", "none"]),
                              (("init", "--type"), ["contact", "friction", "integrator", "joint"]),
                              (("analyze",), ["error", "ik", "inverse-dynamics", "singularity", "workspace"]),
                              (("list",), ["channels", "forces", "integrators", "joints", "laws", "plugins"]),
                              (("analyze", "error", "x.yaml", "--distribution"), ["normal", "rim", "uniform"])):
            self.assertEqual(values, self.complete(*words, ""), words)
        self.assertEqual(["--format=csv"], self.complete("run", "--format=c"))
        self.assertEqual([], self.complete("run", "--end", ""))

    def test_types(self):
        self.assertIn("bathe", self.complete("run", "--integrator", ""))
        self.assertNotIn("revolute", self.complete("run", "--integrator", ""))
        self.assertEqual(["flores"], self.complete("describe", "flo"))

    def test_models_and_folders(self):
        for name in ("a.yaml", "a.yml", "a.urdf", "a.sdf", "a.csv", ".a.yaml"):
            self.write(name, "")
        os.mkdir(self.path("all"))
        self.write("all/b.yaml", "")
        self.assertEqual(["a.sdf", "a.urdf", "a.yaml", "a.yml", "all/"], self.complete("run", ""))
        self.assertEqual(["all/b.yaml"], self.complete("validate", "a.yaml", "all/"))
        self.assertEqual([], self.complete("run", "a.yaml", ""))  # takes one model
        self.assertIn("a.csv", self.complete("compare", "a."))
        self.assertEqual(["~/a.sdf", "~/a.urdf", "~/a.yaml", "~/a.yml"],
                         self.freeplay("complete", "run", "~/a.", environment={"HOME": self.folder})[0].splitlines())

    def test_names_of_the_model_on_the_line(self):
        model = mechanism("slider-crank")
        self.assertEqual(["c="], self.complete("run", model, "--set", "c"))
        self.assertEqual(["wrist"], self.complete("run", model, "--ideal", "w"))
        self.assertIn("joint.wrist.fn", self.complete("run", model, "--channels", "joint.wrist."))
        self.write("broken.yaml", "freeplay: [")
        self.assertEqual([], self.complete("run", "broken.yaml", "--set", ""))

    def in_shell(self, shell, script):
        if not shutil.which(shell):
            self.skipTest("%s is not installed: its completion was not tried" % shell)
        environment = {**os.environ, "PATH": os.path.dirname(PROGRAM) + ":" + os.environ["PATH"], "LC_ALL": "C.UTF-8"}
        done = subprocess.run([shell, "-c", script], cwd=self.folder, capture_output=True, text=True, env=environment)
        self.assertEqual("", done.stderr)
        return done.stdout.splitlines()

    def in_bash(self, line):
        return self.in_shell("bash", "compopt() { :; }; . %s/freeplay.bash; COMP_LINE='%s'; COMP_POINT=${#COMP_LINE}; _freeplay; "
                                     "printf '%%s\\n' \"${COMPREPLY[@]}\"" % (SHELLS, line))

    def test_bash(self):
        self.write("my model.yaml", "")
        self.assertEqual(["report", "reproduce", "run"], self.in_bash("freeplay r"))
        self.assertEqual(["my\\ model.yaml"], self.in_bash("freeplay run my\\ mo"))
        self.assertEqual(["csv"], self.in_bash("freeplay run --format=c"))
        self.assertIn("--integrator", self.in_bash("freeplay run --"))
        self.assertEqual(["my\\ model.yaml"], self.in_bash("freeplay run "))

    def test_zsh(self):
        said = self.in_shell("zsh", "compadd() { while [[ $1 != -- ]]; do shift; done; shift; print -l -- $@ }; words=(freeplay run --format ''); "
                                    "CURRENT=4; . %s/freeplay.zsh" % SHELLS)
        self.assertEqual(["both", "csv", "hdf5"], [word for word in said if word])

    def test_fish(self):
        said = self.in_shell("fish", "source %s/freeplay.fish; complete -C 'freeplay run --format '" % SHELLS)
        self.assertEqual(["both", "csv", "hdf5"], said)


if __name__ == "__main__":
    unittest.main()
