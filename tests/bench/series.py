"""Ratios to programs by hand from release to release: series.csv, a line each, with the revision that was measured and the
machine. Smaller is faster. Between releases machines differ: a step of a few percent is none.
"""
import csv
import os
import re
import subprocess

from page import BLOCK, PAGE
from problems import ROOT
from tables import table
from timing import Failed

FILE = os.path.join(ROOT, "tests", "bench", "series.csv")
TAKEN = re.compile(r"`\./dev bench \S+`, (\S+), (.+):$", re.M)
# Columns of the file: the part of the page, and which of its pairs.
RATIOS = {"slider-crank": ("slider-crank", 0), "3-rrr": ("3-rrr", 0), "4-rrr": ("4-rrr", 0),
          "slider-crank bathe": ("slider-crank", 1), "3-rrr bathe": ("3-rrr", 1), "4-rrr bathe": ("4-rrr", 1),
          "four-bar-5": ("four-bar-5", 0), "four-bar-40": ("four-bar-40", 0), "four-bar-320": ("four-bar-320", 0)}
COLUMNS = ("release", "date", "revision", "machine", *RATIOS)


def read(path=FILE):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def of_page(text, release, revision):
    """The line of a release from the text of docs/performance.md."""
    blocks = {name: block for block, name in ((match[0], match[2]) for match in BLOCK.finditer(text))}
    taken = TAKEN.search(blocks["slider-crank"])
    row = {"release": release, "date": taken[1], "revision": revision, "machine": taken[2]}
    for column, (part, place) in RATIOS.items():
        row[column] = re.findall(r"\*\*([\d.]+)\*\*", blocks[part])[place]
    return row


def revision_of(table, root=ROOT):
    """That which wrote this table into docs/performance.md: commits of the words around it measured nothing."""
    page = os.path.relpath(PAGE, ROOT)
    done = subprocess.run(["git", "-C", root, "log", "-1", "--format=%h", "-S", table, "--", page], capture_output=True, text=True)
    if done.returncode != 0 or not done.stdout.strip():
        raise Failed("git does not tell which revision wrote the table of docs/performance.md")
    return done.stdout.strip()


def append(release, path=FILE):
    """Adds what the page says now, by the revision that measured its first table."""
    if any(row["release"] == release for row in read(path)):
        raise Failed("series.csv has a line of '%s' already" % release)
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    row = of_page(text, release, revision_of(BLOCK.search(text)[0]))
    with open(path, "a", encoding="utf-8", newline="") as file:
        csv.DictWriter(file, COLUMNS, lineterminator="\n").writerow(row)


def text(rows):
    return table(["release", "revision", *RATIOS], [[row[c] for c in ("release", "revision", *RATIOS)] for row in rows])


def draw(rows, path):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "series"  # the same file every time
    import matplotlib.pyplot as plot
    figure, axes = plot.subplots(figsize=(9, 5))
    for column in RATIOS:
        axes.plot(range(len(rows)), [float(row[column]) for row in rows], marker=".", label=column)
    axes.set_yscale("log")
    axes.axhline(5.0, color="grey", linewidth=0.8)
    axes.set_xticks(range(len(rows)), [row["revision"] for row in rows], rotation=45)
    axes.set_ylabel("time, in times of the program by hand")
    axes.legend(fontsize="small", ncol=3)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plot.close(figure)
