"""What a notebook shows: drawings and tables without network and scripts, and a notebook that is run where nbconvert is installed."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

import freeplay

ROOT = pathlib.Path(__file__).resolve().parents[2]


def has(*modules):
    return not any(subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True).returncode for module in modules)


class Notebook(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", freeplay.ModelWarning)
        self.model = freeplay.load(str(ROOT / "mechanisms/3-rrr.yaml"), end="0.2 ms")

    def test_models_results_and_maps_are_drawn_and_tables_are_short(self):
        grid = self.model.workspace(grid={"x": (-0.2, 0.2, 7), "y": (-0.2, 0.2, 7)})
        rows = self.model.ik(time=(0, 0.1, 49))
        for thing, parts in ((self.model, ("<svg", "<table")), (self.model.run(), ("<svg", "<table", "<iframe sandbox")),
                             (grid, ("<svg", "condition number")), (rows, ("<table", "and 29 more rows"))):
            page = thing._repr_html_()
            for part in parts:
                self.assertTrue(part in page, f"{part} of {thing}")
            self.assertLess(len(page), 3e6)
            self.assertNotRegex(page, r"<script|(src|href)=[\"']https?:")
        self.assertIn("leg1.B", self.model.run()._repr_html_())

    def test_names_of_models_are_text(self):
        text = (ROOT / "mechanisms/pendulum.yaml").read_text().replace("name: pendulum", 'name: "<script>alert(1)</script>"')
        self.assertNotIn("<script", freeplay.load(text)._repr_html_())

    def test_two_drawings_share_no_ids(self):
        pages = self.model._repr_html_() + self.model._repr_html_()
        ids = re.findall(r'\bid="([^"]+)"', pages)
        self.assertEqual(len(ids), len(set(ids)))
        for used in re.findall(r'(?:url\(#|href="#)([^")]+)', pages):
            self.assertIn(used, ids)

    @unittest.skipUnless(has("nbconvert", "ipykernel"), "NO NOTEBOOK WAS RUN: nbconvert or ipykernel is not installed")
    def test_a_notebook_runs_and_shows_them(self):
        scripts = dict(re.findall(r"^```python (\w+)\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S))
        cells = [scripts["first"], "result.model", "result"]
        book = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}},
                "cells": [{"cell_type": "code", "id": f"c{i}", "metadata": {}, "execution_count": None, "outputs": [], "source": text} for i, text in enumerate(cells)]}
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "mechanisms", os.path.join(folder, "mechanisms"))
            pathlib.Path(folder, "book.ipynb").write_text(json.dumps(book))
            subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", "done.ipynb", "book.ipynb"], cwd=folder, check=True, capture_output=True)
            shown = json.loads(pathlib.Path(folder, "done.ipynb").read_text())["cells"]
            for cell in shown[1:]:
                self.assertTrue(any("<svg" in "".join(output.get("data", {}).get("text/html", "")) for output in cell["outputs"]))


if __name__ == "__main__":
    unittest.main()
