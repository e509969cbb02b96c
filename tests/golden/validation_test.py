"""The table of published numbers holds, and tells when a number does not."""
import json
import os
import shutil
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, ProgramTest

TOOL = os.path.join(ROOT, "tests", "validation", "published.py")
MODELS = os.path.join(ROOT, "mechanisms", "validation")


class Published(ProgramTest):
    def table(self, folder, code):
        done = subprocess.run([sys.executable, "-B", TOOL, PROGRAM, folder, self.path("page.md")], capture_output=True,
                              text=True)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout

    def test_every_number_holds(self):
        out = self.table(MODELS, 0)
        self.assertNotIn("OFF", out)
        with open(self.path("page.md"), encoding="utf-8") as file:
            self.assertIn("| squeezer | 0.03 | body.K1.angle |", file.read())

    def test_every_model_is_in_the_table(self):
        with open(os.path.join(MODELS, "published.json"), encoding="utf-8") as file:
            named = {case["model"] for case in json.load(file) if "/" not in case["model"]}
        self.assertEqual({name for name in os.listdir(MODELS) if name.endswith(".yaml")}, named)

    def test_a_wrong_digit_is_reported(self):
        folder = self.path("models")
        os.mkdir(folder)
        shutil.copy(os.path.join(MODELS, "a01-pendulum.yaml"), folder)
        with open(os.path.join(MODELS, "published.json"), encoding="utf-8") as file:
            case = json.load(file)[0]
        case["values"][0]["published"] += 2e-10
        with open(os.path.join(folder, "published.json"), "w", encoding="utf-8") as file:
            json.dump([case], file)
        self.assertIn("OFF", self.table(folder, 7))


if __name__ == "__main__":
    unittest.main()
