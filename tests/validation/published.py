"""Runs the models of mechanisms/validation and compares them with published numbers.

usage: published.py PROGRAM FOLDER [PAGE]

FOLDER holds published.json: for each model its path from there, its source and a list of time [s], channel, published value and
tolerance. In place of a channel may stand a quantity with a name, the sum of channels times factors less an offset.
Prints a table; writes it to PAGE as well. Exit 7 when a number is off by more than its tolerance.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

HEAD = ("model", "time", "channel", "published", "ours", "error", "tolerance", "")


def results(program, model, folder):
    out = os.path.join(folder, os.path.basename(model))
    done = subprocess.run([program, "run", model, "--quiet", "--out", out], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit("%s: freeplay run exits %d: %s" % (model, done.returncode, done.stderr.strip()))
    with open(os.path.join(out, "results.csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def row_at(rows, time, model):
    nearest = min(rows, key=lambda row: abs(float(row["time"]) - time))
    if abs(float(nearest["time"]) - time) > 1e-9 * max(1.0, abs(time)):
        raise SystemExit("%s has no row at %.12g s" % (model, time))
    return nearest


def quantity(row, value):
    """Name and value in a row of results."""
    if "channel" in value:
        return value["channel"], float(row[value["channel"]])
    total = sum(factor * float(row[channel]) for channel, factor in value["sum"].items())
    return value["quantity"], total - value.get("offset", 0.0)


def table(program, folder):
    lines, good = [], True
    with open(os.path.join(folder, "published.json"), encoding="utf-8") as file:
        cases = json.load(file)
    with tempfile.TemporaryDirectory() as scratch:
        for case in cases:
            rows = results(program, os.path.join(folder, case["model"]), scratch)
            for value in case["values"]:
                name, ours = quantity(row_at(rows, value["time"], case["model"]), value)
                error = abs(ours - value["published"])
                holds = error <= value["tolerance"]
                good = good and holds
                lines.append((os.path.basename(case["model"])[:-len(".yaml")], "%.6g" % value["time"], name,
                              "%.12g" % value["published"], "%.12g" % ours, "%.1e" % error, "%.0e" % value["tolerance"],
                              "" if holds else "OFF"))
    return lines, good, cases


def main():
    program, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
    lines, good, cases = table(program, folder)
    widths = [max(len(line[i]) for line in [HEAD] + lines) for i in range(len(HEAD))]
    for line in [HEAD] + lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
    if len(sys.argv) > 3:
        page = ["# Published numbers and ours", "", "Written by `./dev validation` from the models of `mechanisms/validation`.", ""]
        page += ["| model | source |", "|---|---|"] + ["| %s | %s |" % (c["model"], c["source"]) for c in cases] + [""]
        page += ["| " + " | ".join(HEAD[:7]) + " |", "|---|---|---|---|---|---|---|"]
        page += ["| " + " | ".join(line[:6] + (line[6] + (" **" + line[7] + "**" if line[7] else ""),)) + " |" for line in lines]
        with open(sys.argv[3], "w", encoding="utf-8") as file:
            file.write("\n".join(page) + "\n")
    return 0 if good else 7


if __name__ == "__main__":
    sys.exit(main())
