"""Types: the package and the scripts of docs/python.md hold under mypy --strict, and mistakes are seen; docstrings name what they take."""
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import freeplay

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "core/python/freeplay"
MISTAKES = """import freeplay
freeplay.run("a.yaml", endd=1.0)
n: int = freeplay.run("a.yaml").status
freeplay.load(3)
freeplay.load("a.yaml").simulation().advance([1.0])
freeplay.map("a.yaml", reduce=3)
"""


@unittest.skipIf(subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True).returncode, "NO TYPES CHECKED: mypy is not installed")
class Types(unittest.TestCase):
    def mypy(self, folder, *words):
        return subprocess.run([sys.executable, "-m", "mypy", "--no-error-summary", "--ignore-missing-imports", "--cache-dir", os.path.join(folder, "cache"), *words], cwd=folder,
                              capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})

    def test_package_and_cookbook_hold(self):
        with tempfile.TemporaryDirectory() as folder:
            scripts = dict(re.findall(r"^```python (\w+)\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S))
            for name, text in scripts.items():
                pathlib.Path(folder, f"{name}.py").write_text(text)
            done = self.mypy(folder, "--strict", str(PACKAGE), *(f"{name}.py" for name in scripts))
            self.assertEqual(("", 0), (done.stdout, done.returncode))

    def test_mistakes_are_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "mistakes.py").write_text(MISTAKES)
            done = self.mypy(folder, "mistakes.py")
            self.assertEqual(["2", "3", "4", "5", "6"], re.findall(r"^mistakes\.py:(\d+): error", done.stdout, re.M))


class Docstrings(unittest.TestCase):
    def members(self):
        for name in freeplay.__all__:
            thing = getattr(freeplay, name)
            yield name, thing
            if inspect.isclass(thing) and not issubclass(thing, (BaseException, tuple)):
                for member, value in vars(thing).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        yield f"{name}.{member}", value

    def test_everything_public_has_one(self):
        self.assertEqual([], [name for name, thing in self.members() if not inspect.getdoc(thing)])

    def test_functions_name_their_arguments(self):
        for function in (freeplay.load, freeplay.run, freeplay.map, freeplay.compare, freeplay.open, freeplay.Simulation.advance, freeplay.Simulation.set):
            text = inspect.getdoc(function)
            missing = [name for name in inspect.signature(function).parameters if name != "self" and not re.search(rf"\b{name}\b", text)]
            self.assertEqual([], missing, function)


if __name__ == "__main__":
    unittest.main()
