"""Every command of README.md and docs/getting-started.md does what the text says."""
import json
import os
import re
import shlex
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, ProgramTest

BLOCK = re.compile(r"^```sh\n(.*?)^```", re.M | re.S)


def commands(page):
    with open(os.path.join(ROOT, page), encoding="utf-8") as file:
        blocks = BLOCK.findall(file.read())
    return [line for block in blocks for line in block.splitlines() if line and not line.startswith("#")]


def without_arkode(page):
    """The page as a program without SUNDIALS writes it."""
    return re.sub(r"\n## arkode\n.*?(?=\n## |\Z)", "", page, flags=re.S).replace(", `arkode`", "")


class Documentation(ProgramTest):
    """In an empty folder that sees the mechanisms; ./dev stands for the program where it only passes on."""

    def setUp(self):
        super().setUp()
        os.symlink(os.path.join(ROOT, "mechanisms"), self.path("mechanisms"))

    def run_page(self, page):
        lines = commands(page)
        self.assertTrue(lines)
        for line in lines:
            words = shlex.split(line)
            self.assertEqual("./dev", words[0], line)
            if words[1] in ("test", "build", "format", "docs", "bench", "clean"):
                continue
            done = subprocess.run([PROGRAM, *words[1:]], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(0, done.returncode, "%s\n%s" % (line, done.stderr))

    def test_readme(self):
        self.run_page("README.md")

    def test_getting_started(self):
        self.run_page(os.path.join("docs", "getting-started.md"))

    def test_check_plugin_page(self):
        page = os.path.join("docs", "check-plugin.md")
        self.run_page(page)
        with open(os.path.join(ROOT, page), encoding="utf-8") as file:
            explained = set(re.findall("`([a-z-]+)`", file.read()))
        out, _ = self.freeplay("check-plugin", "built-in", "--json", "--time-limit", "300 s")
        rules = {rule["rule"] for found in json.loads(out)["types"] for rule in found["rules"]}
        self.assertGreater(len(rules), 50)
        self.assertEqual(set(), rules - explained)

    def test_accuracy(self):
        self.run_page(os.path.join("docs", "accuracy.md"))

    def test_urdf(self):
        page = os.path.join("docs", "urdf.md")
        self.run_page(page)
        with open(os.path.join(ROOT, page), encoding="utf-8") as file:
            text = file.read()
        self.write("rocker.urdf", re.search(r"^```xml\n(.*?)^```", text, re.M | re.S)[1])
        self.write("rocker.yaml", re.search(r"^```yaml\n(.*?)^```", text, re.M | re.S)[1])
        self.freeplay("run", "rocker.yaml")

    def test_pieces_of_the_model_page_are_a_model(self):
        with open(os.path.join(ROOT, "docs", "model-file.md"), encoding="utf-8") as file:
            pieces = re.findall(r"^```yaml\n(.*?)^```", file.read(), re.M | re.S)
        with open(self.path("page.yaml"), "w", encoding="utf-8") as file:
            file.write("".join(pieces))
        done = subprocess.run([PROGRAM, "run", "page.yaml"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(("", 0), (done.stderr, done.returncode))

    def test_reference_pages_are_what_the_program_says(self):
        folder = os.path.join(ROOT, "docs", "reference")
        subprocess.run([sys.executable, "-B", os.path.join(folder, "generate.py"), PROGRAM, self.folder], check=True)
        pages = [name for name in os.listdir(folder) if name.endswith(".md")]
        self.assertLess(4, len(pages))
        for page in pages:
            with open(os.path.join(folder, page), encoding="utf-8") as file:
                kept = file.read()
            self.assertEqual(self.read(page), kept if self.has_sundials() else without_arkode(kept),
                             "%s is old: ./dev docs" % page)

    def has_sundials(self):
        return "arkode" in self.freeplay("list", "integrators")[0]

    def test_links_lead_somewhere(self):
        pages = ["README.md"] + [os.path.relpath(os.path.join(folder, name), ROOT)
                                 for folder, _, names in os.walk(os.path.join(ROOT, "docs"))
                                 for name in names if name.endswith(".md")]
        self.assertLess(5, len(pages))
        for page in pages:
            with open(os.path.join(ROOT, page), encoding="utf-8") as file:
                for target in re.findall(r"\]\((?!https?:)([^)#]+)", file.read()):
                    self.assertTrue(os.path.exists(os.path.join(ROOT, os.path.dirname(page), target)), target)


if __name__ == "__main__":
    unittest.main()
