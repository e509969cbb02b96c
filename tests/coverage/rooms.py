"""Lines and branches that were reached, by room: rooms.py BUILD, after tests in a build of the preset `coverage`.

A branch is one of the two outcomes of a condition in the source, as clang counts them: what the compiler adds for exceptions,
destructors or copies of inlined functions is none. Lines and branches that nothing reached stand in BUILD/coverage.txt.
"""
import collections
import glob
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDERS = ("core", "joints", "contact", "solvers")
PROGRAMS = ("freeplay", "tests/unit_tests", "tests/validation_tests", "tests/threads_tests")


def printed(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit("%s: %s" % (os.path.basename(command[0]), done.stderr.strip()))
    return done.stdout


def measured(build):
    """What llvm-cov says of every file."""
    profile = os.path.join(build, "coverage.profdata")
    printed("llvm-profdata", "merge", "--sparse", "-o", profile, *glob.glob(os.path.join(build, "profiles", "*")))
    programs = [os.path.join(build, name) for name in PROGRAMS if os.path.exists(os.path.join(build, name))]
    objects = [word for program in programs[1:] for word in ("--object", program)]
    sources = [os.path.join(ROOT, folder) + "/" for folder in FOLDERS]
    text = printed("llvm-cov", "export", "--instr-profile", profile, programs[0], *objects, *sources)
    return {os.path.relpath(file["filename"], ROOT): reached(file) for file in json.loads(text)["data"][0]["files"]}


def reached(file):
    """Of a file {"lines": {line: count}, "branches": {(line, column, outcome): count}}; of a template all copies together."""
    branches = collections.Counter()
    for line, column, _, _, taken, not_taken, *_ in file["branches"]:
        branches[line, column, True] += taken
        branches[line, column, False] += not_taken
    return {"lines": lines(file["segments"]), "branches": branches}


def lines(segments):
    """The count of each line that has code: the largest of the regions that begin in it and of the one that it begins in.

    A segment is [line, column, count, has a count, begins a region, is a gap]; it goes on to the next.
    """
    by_line = collections.defaultdict(list)
    for line, _, *segment in segments:
        by_line[line].append(segment)
    counts = {}
    around, since = None, 0  # the segment that a line begins in, and the line after that of its beginning
    for line, here in sorted(by_line.items()):
        if around is not None and around[1]:
            counts.update((between, around[0]) for between in range(since, line))
        begun = [count for count, counted, begins, gap in here if counted and begins and not gap]
        skipped = not here[0][1] and here[0][2]
        if not skipped and (begun or around is not None and around[1]):
            counts[line] = max(begun + ([around[0]] if around is not None and around[1] else []))
        around, since = here[-1], line + 1
    return counts


def room(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "core" else parts[0]


def by_room(files):
    """Of each room [lines, reached lines, branches, reached branches]."""
    rooms = collections.defaultdict(lambda: [0, 0, 0, 0])
    for path, file in files.items():
        counts = rooms[room(path)]
        for index, kind in enumerate(("lines", "branches")):
            counts[2 * index] += len(file[kind])
            counts[2 * index + 1] += sum(count > 0 for count in file[kind].values())
    return dict(sorted(rooms.items()))


def unreached(files):
    """A line of text each for lines and outcomes that nothing reached."""
    found = []
    for path, file in sorted(files.items()):
        missed = [(line, "") for line, count in file["lines"].items() if not count]
        missed += [(line, "condition at column %d never %s" % (column, str(outcome).lower()))
                   for (line, column, outcome), count in file["branches"].items()
                   if not count and file["lines"].get(line, 1)]
        found += ["%s:%d: %s" % (path, line, why or "not reached") for line, why in sorted(missed)]
    return found


def percent(part, whole):
    return "%.1f %%" % (100.0 * part / whole) if whole else "-"


def table(rooms):
    rows = [("room", "lines", "reached", "branches", "reached")]
    total = [sum(column) for column in zip(*rooms.values())]
    for name, (lines, reached, branches, taken) in [*rooms.items(), ("all", total)]:
        rows.append((name, str(lines), percent(reached, lines), str(branches), percent(taken, branches)))
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(cell.rjust(width) if i else cell.ljust(width)
                               for i, (cell, width) in enumerate(zip(row, widths))) for row in rows)


def main(build):
    files = measured(build)
    listed = os.path.join(build, "coverage.txt")
    with open(listed, "w", encoding="utf-8") as out:
        out.write("\n".join(unreached(files)) + "\n")
    print(table(by_room(files)))
    print("what nothing reached: " + listed)


if __name__ == "__main__":
    main(sys.argv[1])
