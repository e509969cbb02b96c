"""Every command of README.md and docs/getting-started.md does what the text says."""
import json
import os
import re
import shlex
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, ProgramTest, drawing

BLOCK = re.compile(r"^```sh\n(.*?)^```", re.M | re.S)


def commands(page):
    with open(os.path.join(ROOT, page), encoding="utf-8") as file:
        blocks = BLOCK.findall(file.read())
    return [line for block in blocks for line in block.splitlines() if line and not line.startswith("#")]


def without_arkode(page):
    """The page as a program without SUNDIALS writes it."""
    return re.sub(r"\n## arkode\n.*?(?=\n## |\Z)", "", page, flags=re.S).replace(", `arkode`", "")


NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def words_and_numbers(text):
    """Printed text with its numbers apart; what depends on the hour and on rounding left out."""
    text = re.sub(r"[^ ]+ s wall|position residual .*", "...", text)
    return NUMBER.sub("#", text), [float(number) for number in NUMBER.findall(text)]


class Tutorial:
    """A page that is followed: files and changes of files in yaml blocks behind a comment, commands in sh blocks, and
    behind these what they print."""

    PIECES = re.compile(r"^(?:<!-- (?P<what>[^\n]*) -->\n)?```(?P<kind>sh|yaml|)\n(?P<text>.*?)^```$", re.M | re.S)

    def __init__(self, page):
        with open(os.path.join(ROOT, "docs", page), encoding="utf-8") as file:
            self.page = file.read()

    def pieces(self):
        return self.PIECES.finditer(self.page)

    @staticmethod
    def change(folder, what, text):
        """`file NAME`, `in NAME from "A" to "B"` (B stays), or `in NAME the line "A"`."""
        new, part, line = (re.fullmatch(pattern, what) for pattern in (
            r"file (.*)", r'in (.*) from "(.*)" to "(.*)"', r'in (.*) the line "(.*)"'))
        name = os.path.join(folder, (new or part or line)[1])
        if not new:
            with open(name, encoding="utf-8") as file:
                old = file.read()
            begin = old.index("\n" + (part or line)[2]) + 1
            end = old.index("\n" + part[3]) if part else old.index("\n", begin) + 1
            text = old[:begin] + text + old[end:]
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)


# Words that ./dev does not pass on to the program, and that take long or change the sources.
OF_DEV = ("test", "soak", "fuzz", "build", "tune", "format", "lint", "coverage", "races", "docs", "bench", "accuracy", "clean", "package")


class Documentation(ProgramTest):
    """In an empty folder that sees the mechanisms; ./dev stands for the program where it only passes on."""

    def setUp(self):
        super().setUp()
        os.symlink(os.path.join(ROOT, "mechanisms"), self.path("mechanisms"))

    @staticmethod
    def read_file(*names):
        with open(os.path.join(ROOT, *names), encoding="utf-8") as file:
            return file.read()

    def run_page(self, page):
        lines = commands(page)
        self.assertTrue(lines)
        for line in lines:
            words = shlex.split(line)
            self.assertEqual("./dev", words[0], line)
            if words[1] in OF_DEV:
                continue
            if words[1:3] == ["study", "run"]:
                words += ["--only", "0"]  # all points take minutes
            done = subprocess.run([PROGRAM, *words[1:]], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(0, done.returncode, "%s\n%s" % (line, done.stderr))

    def test_readme(self):
        self.run_page("README.md")

    def test_getting_started(self):
        self.run_page(os.path.join("docs", "getting-started.md"))

    def test_contributing(self):
        self.run_page(os.path.join("docs", "contributing.md"))

    def test_every_page_asks_dev_for_words_that_it_has(self):
        told = subprocess.run([os.path.join(ROOT, "dev")], capture_output=True, text=True, check=True).stdout
        words = set(re.findall(r"^  ([a-z]+)", told, re.M))
        self.assertLess({"run", *OF_DEV}, words)
        commands = set(re.findall(r"^  ([a-z-]+)", self.freeplay("--help")[0], re.M))
        asked = set()
        for folder, _, names in [(ROOT, [], ["README.md", "CHANGELOG.md"]), *os.walk(os.path.join(ROOT, "docs"))]:
            for name in names:
                if name.endswith(".md"):
                    with open(os.path.join(folder, name), encoding="utf-8") as file:
                        asked |= set(re.findall(r"\./dev ([a-z][a-z-]*)", file.read()))
        self.assertLess(5, len(asked))
        self.assertEqual(set(), asked - words - commands)

    def test_spatial(self):
        self.run_page(os.path.join("docs", "spatial.md"))

    def test_first_mechanism(self):
        printed = shown = None
        for piece in Tutorial("first-mechanism.md").pieces():
            if piece["kind"] == "yaml":
                Tutorial.change(self.folder, piece["what"], piece["text"])
            elif piece["kind"] == "sh":
                printed = ""
                for line in piece["text"].splitlines():
                    command, _, code = line.partition("  # exit code ")
                    words = shlex.split(command)
                    self.assertEqual("./dev", words[0], line)
                    out, err = self.freeplay(*words[1:], code=int(code or 0))
                    printed = out + err
            else:
                shown = piece["text"]
                words, numbers = words_and_numbers(printed)
                expected_words, expected = words_and_numbers(shown)
                self.assertEqual(expected_words, words)
                for x, y in zip(expected, numbers, strict=True):
                    self.assertLessEqual(abs(x - y), 1e-6 * abs(x), shown)
        self.assertIsNotNone(shown)
        with open(os.path.join(ROOT, "docs", "images", "press.svg"), encoding="utf-8") as file:
            self.assertEqual(drawing(self.read("press.svg")), file.read())

    def test_analysis(self):
        shown = 0
        for piece in Tutorial("analysis.md").pieces():
            if piece["kind"] == "sh":
                printed = ""
                for line in piece["text"].splitlines():
                    printed += self.freeplay(*shlex.split(line)[1:])[0]
            elif piece["kind"] == "":
                shown += 1
                for wanted, line in zip(piece["text"].splitlines(), printed.splitlines(), strict=True):
                    for x, y in zip(wanted.split(","), line.split(","), strict=True):
                        if NUMBER.fullmatch(x):
                            self.assertAlmostEqual(float(x), float(y), delta=1e-9 + 1e-6 * abs(float(x)))
                        else:
                            self.assertEqual(x, y)
        self.assertGreater(shown, 4)
        with open(os.path.join(ROOT, "docs", "images", "4-rrr-error.svg"), encoding="utf-8") as file:
            self.assertEqual(drawing(self.read("map.svg")), file.read())

    def test_pictures_are_those_that_their_commands_draw(self):
        self.run_page(os.path.join("docs", "pictures.md"))
        for image, name in (("plot-forces", "forces"), ("plot-orbit", "orbit"), ("show-slider-crank", "shown")):
            shown, drawn = self.read_file("docs", "images", image + ".svg"), drawing(self.read(name + ".svg"))
            words, numbers = words_and_numbers(drawn)
            expected_words, expected = words_and_numbers(shown)
            self.assertEqual(expected_words, words)
            for x, y in zip(expected, numbers, strict=True):
                self.assertAlmostEqual(x, y, delta=0.1)

    def test_accuracy(self):
        self.run_page(os.path.join("docs", "accuracy.md"))

    def test_urdf(self):
        page = os.path.join("docs", "urdf.md")
        self.run_page(page)
        with open(os.path.join(ROOT, page), encoding="utf-8") as file:
            text = file.read()
        self.write("rocker.urdf", re.search(r"^```xml\n(.*?)^```", text, re.M | re.S)[1])
        for number, sidecar in enumerate(re.findall(r"^```yaml\n(.*?)^```", text, re.M | re.S)):
            self.freeplay("run", self.write("rocker%d.yaml" % number, sidecar))

    def test_mjcf(self):
        page = os.path.join("docs", "mjcf.md")
        text = self.read_file(page)
        self.write("four-bar.xml", re.search(r"^```xml\n(.*?)^```", text, re.M | re.S)[1])
        self.write("four-bar-loose.yaml", re.search(r"^```yaml\n(.*?)^```", text, re.M | re.S)[1])
        self.run_page(page)

    def test_sdf(self):
        page = os.path.join("docs", "sdf.md")
        text = self.read_file(page)
        self.write("four-bar.sdf", re.search(r"^```xml\n(.*?)^```", text, re.M | re.S)[1])
        self.write("four-bar-loose.yaml", re.search(r"^```yaml\n(.*?)^```", text, re.M | re.S)[1])
        self.run_page(page)

    def test_text_is_read_as_the_model_page_says(self):
        with open(os.path.join(ROOT, "docs", "model-file.md"), encoding="utf-8") as file:
            rows = re.findall(r"^\| `(.*)` \| (?:`([a-z-]+)`|([\d.]+)) \|$", file.read(), re.M)
        self.assertLess(10, len(rows))
        for written, wrong, number in rows:
            with self.subTest(written):
                self.write("m.yaml", "freeplay: 1\nbodies: {b: {mass: %s, inertia: 1}}\n" % written)
                out, err = self.freeplay("show", "m.yaml", "--format", "json", code=3 if wrong else 0)
                if wrong:
                    self.assertIn("[%s]" % wrong, err)
                else:
                    self.assertEqual(float(number), json.loads(out)["bodies"]["b"]["mass"])
        for written in ("yes", "on", "True", "1"):
            self.write("m.yaml", "freeplay: 1\nbodies: {b: {mass: 1, inertia: 1}}\n"
                                 "simulation: {step: {adaptive: %s}}\n" % written)
            self.assertIn("[wrong-type]", self.freeplay("validate", "m.yaml", code=3)[1])

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
