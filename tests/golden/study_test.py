"""The study of the 3-RRR and the 4-RRR, with few points: its page is made, and what does not depend on their number is
what the page under docs says."""
import os
import re
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, ProgramTest

FOLDER = os.path.join(ROOT, "mechanisms", "studies", "3-rrr-vs-4-rrr")
# What makes both study files short: one value an axis, coarse, and less than two turns.
SHORT = {"1 um": "100 um", r"3\*\$T": "1.3*$T", r"c: \[.*\]": "c: [0.05 mm]", r"T: \[.*\]": "T: [1 s, 0.5 s]", r"mu: \[.*\]": "mu: [0.2]",
         r"\.\./\.\./": os.path.join(ROOT, "mechanisms", "")}


def centre(page):
    """Rows of the table of errors at rest, up to those that depend on the number of poses."""
    rows = re.findall(r"^\| ([34]-rrr) \| ([^|]*) \| ([^|]*) \| ([^|]*) \| [^|]* \| [^|]* \| [^|]* \| [^|]* \|$", page, re.M)
    return rows


class Study(ProgramTest):
    def test_the_page_is_made_and_agrees_with_the_one_in_docs(self):
        for name in ("series", "ideal"):
            with open(os.path.join(FOLDER, name + ".yaml"), encoding="utf-8") as file:
                text = file.read()
            for long, short in SHORT.items():
                text, changes = re.subn(long, lambda _, short=short: short, text)
                self.assertTrue(changes or name == "ideal", long)
            self.freeplay("study", "run", self.write(name + ".yaml", text), "--keep", "all", "--out", "runs/" + name)
        done = subprocess.run([sys.executable, "-B", os.path.join(FOLDER, "page.py"), PROGRAM, self.folder, self.path("runs")],
                              capture_output=True, text=True)
        self.assertEqual(0, done.returncode, done.stderr)
        page = self.read("3-rrr-vs-4-rrr.md")
        with open(os.path.join(ROOT, "docs", "3-rrr-vs-4-rrr.md"), encoding="utf-8") as file:
            published = file.read()
        self.assertEqual(2, len(centre(page)))
        self.assertEqual(centre(published), centre(page))
        # The least-squares bound at the centre speaks against the 4-RRR, whatever the rest says.
        for text in (page, published):
            self.assertRegex(text, r"at the centre \(least squares\) \| does not hold \| 282\.8 um against 266\.7 um")
            # The platform stays within the play and the penetration: what is beyond is of second order.
            beyond, second = (float(re.search(pattern, text)[1]) for pattern in
                              (r"last column is (-?[\d.]+) um", r"so ([\d.]+) um at the largest"))
            self.assertLess(beyond, second)
        pictures = re.findall(r"!\[[^]]*\]\(([^)]*)\)", page)
        self.assertGreater(len(pictures), 4)
        for picture in pictures:
            self.assertIn("<svg", self.read(picture)[:1000])
            self.assertTrue(os.path.exists(os.path.join(ROOT, "docs", picture)), picture)


if __name__ == "__main__":
    unittest.main()
