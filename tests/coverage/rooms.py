"""Lines and branches that were reached, by room: rooms.py BUILD, after tests in a build of the preset `coverage`.

Branches that only an exception takes are left out. Lines that nothing reached stand in BUILD/coverage.txt.
"""
import collections
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDERS = ("core", "joints", "contact", "solvers")


def measured(build):
    """What gcovr says of every file."""
    options = ["--root", ROOT, "--object-directory", build, "--exclude-throw-branches", "--exclude-unreachable-branches",
               "-j", str(os.cpu_count())]
    for folder in FOLDERS:
        options += ["--filter", os.path.join(ROOT, folder) + "/"]
    path = os.path.join(build, "coverage.json")
    done = subprocess.run(["gcovr", *options, "--json", path, "--txt", os.path.join(build, "coverage.txt"), build],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit("gcovr: " + done.stderr.strip())
    with open(path, encoding="utf-8") as file:
        return json.load(file)["files"]


def room(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "core" else parts[0]


def by_room(files):
    """Of each room [lines, reached lines, branches, reached branches]."""
    rooms = collections.defaultdict(lambda: [0, 0, 0, 0])
    for file in files:
        counts = rooms[room(file["file"])]
        for line in file["lines"]:
            if line.get("gcovr/noncode") or line.get("gcovr/excluded"):
                continue
            branches = [branch["count"] for branch in line["branches"] if not branch.get("throw")]
            counts[0] += 1
            counts[1] += line["count"] > 0
            counts[2] += len(branches)
            counts[3] += sum(count > 0 for count in branches)
    return dict(sorted(rooms.items()))


def percent(reached, all_of_them):
    return "%.1f %%" % (100.0 * reached / all_of_them) if all_of_them else "-"


def table(rooms):
    rows = [("room", "lines", "reached", "branches", "reached")]
    total = [sum(column) for column in zip(*rooms.values())]
    for name, (lines, reached, branches, taken) in [*rooms.items(), ("all", total)]:
        rows.append((name, str(lines), percent(reached, lines), str(branches), percent(taken, branches)))
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(cell.rjust(width) if i else cell.ljust(width)
                               for i, (cell, width) in enumerate(zip(row, widths))) for row in rows)


if __name__ == "__main__":
    print(table(by_room(measured(sys.argv[1]))))
    print("lines that nothing reached: " + os.path.join(sys.argv[1], "coverage.txt"))
