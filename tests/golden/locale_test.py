"""A locale with decimal commas changes no byte of what is read, printed or written."""
import os
import subprocess
import unittest

from program import ROOT, ProgramTest, mechanism

DATA = os.path.join(ROOT, "tests", "data", "urdf")


class CommaLocale(ProgramTest):
    def setUp(self):
        super().setUp()
        # The locale is made here, so that it need not be installed.
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", self.path("de_DE.UTF-8")], check=True,
                       capture_output=True)
        self.german = {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8", "LOCPATH": self.folder}
        done = subprocess.run(["printf", "%.1f", "0,5"], capture_output=True, text=True,
                              env={**os.environ, **self.german})
        self.assertEqual("0,5", done.stdout, "the locale is not in force")
        for name in os.listdir(DATA):
            with open(os.path.join(DATA, name), encoding="utf-8") as file:
                self.write(name, file.read())
        self.write("table.csv", "t,angle\n0,0.5\n0.05,1.25\n0.2,1.5\n")
        self.write("bad.yaml", "freeplay: 1\nbodies: {b: {mass: 0.5 kq, inertia: 1e-3, com: [0,5, 0]}}\n")
        self.write("turn.yaml", """freeplay: 1
bodies: {b: {mass: 1.5 kg, inertia: 2.5e-3, com: [0.1 m, "smooth(0.5, 0.25, 1.5)"]}}
joints: {A: {type: revolute, between: [ground, b]}}
drivers: {d: {joint: A, kind: angle, table: table.csv}}
simulation: {end: 0.2 s, step: 0.5 ms}
""")

    def assert_same(self, *arguments, code=0, files=()):
        results = []
        for environment in ({"LC_ALL": "C"}, self.german):
            printed = self.freeplay(*arguments, code=code, environment=environment)
            results.append((printed, [self.read(*name.split("/")) for name in files]))
        self.assertEqual(results[0], results[1])
        return results[0][0]

    def test_words_and_messages(self):
        for model in ("turn.yaml", "four_bar_sidecar.yaml", "four_bar_loop.urdf", mechanism("3-rrr"),
                      mechanism("slider-crank")):
            with self.subTest(model):
                self.assert_same("validate", model)
                for form in ("text", "json", "dot", "svg"):
                    self.assert_same("show", model, "--format", form)
        self.assert_same("validate", "bad.yaml", "--json", code=3)
        self.assert_same("validate", "turn.yaml", "--set", "c=0,5", code=2)
        self.assert_same("list", "--json")
        self.assert_same("schema")

    def test_runs_and_conversions(self):
        for model in ("turn.yaml", "four_bar_sidecar.yaml", mechanism("slider-crank")):
            with self.subTest(model):
                self.assert_same("run", model, "--end", "0.5 ms", "--out", "out", "--quiet", files=[
                    "out/results.csv", "out/events.csv", "out/model.yaml"])
        self.assert_same("convert", "four_bar_loop.urdf", "c.yaml", "--force", files=["c.yaml"])
        for model in (mechanism("four-bar"), mechanism("3-rrr")):
            self.assert_same("convert", model, "c.urdf", "--force", files=["c.urdf", "c.urdf.sidecar.yaml"])


if __name__ == "__main__":
    unittest.main()
