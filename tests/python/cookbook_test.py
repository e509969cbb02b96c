"""The scripts of docs/python.md run as they stand there."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = dict(re.findall(r"^```python (\w+)\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S))
SAID = {"first": r"completed \d+ rows rad\nswings from ", "twin": r"[\d.]+ um, [\d.]+ N\n.* contact_begin ", "mistakes": r"<model>:9:(.|\n)*\n9 25 unknown-key inertia",
        "chain": r"5 freedoms \d+ steps", "archive": r"True True\nN \d+\n[\d.]+",
        "control": r"-?0\.0\d+ rad at 2\.0 s", "study": r"0\.1 mm [\d.]+ N exit 0\n(.*\n){3}0\.5 mm [\d.]+ N exit 0",
        "optimise": r"[\d.]+ rad/s (499\.9999|500\.0000)\d+ N \(3, 1\)", "errormap": r"\(21, 21\) [\d.e+-]+ [\d.e+-]+ m",
        "plots": r"True leg1\.B: x \[um\]"}
NEEDED = {"archive": "xarray", "optimise": "scipy", "errormap": "matplotlib", "plots": "matplotlib"}


class Cookbook(unittest.TestCase):
    def test_every_script_has_a_test(self):
        self.assertEqual(sorted(SAID), sorted(SCRIPTS))

    def test_scripts_run_as_they_stand(self):
        for name, text in SCRIPTS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                if name in NEEDED and subprocess.run([sys.executable, "-c", f"import {NEEDED[name]}"], capture_output=True).returncode:
                    self.skipTest(f"{NEEDED[name]} is not installed")
                os.symlink(ROOT / "mechanisms", os.path.join(folder, "mechanisms"))
                pathlib.Path(folder, f"{name}.py").write_text(text)
                done = subprocess.run([sys.executable, f"{name}.py"], cwd=folder, capture_output=True, text=True)
                self.assertEqual(0, done.returncode, done.stderr)
                self.assertRegex(done.stdout, SAID[name])


if __name__ == "__main__":
    unittest.main()
