"""What is asked of sources, pages and commits besides tests: `./dev lint`.

Every check prints a line with what it looked at and then what it found, each with its place. clang-tidy takes long: it
looks at what was changed since the revision REV (default: since the branch left the main one, and what is not committed),
with --all at everything.
"""
import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import time

import commits
import sizes
import spelling
from sources import ROOT, Finding, changed, git, sources

FOLDERS = ("core", "joints", "contact", "solvers", "plugins")  # that clang-tidy judges
BROKEN = os.path.join("plugins", "probes")  # on purpose
SUPPRESSION = re.compile(r"NOLINT(?:NEXTLINE|BEGIN|END)?(?P<checks>\([\w.,* -]+\))?(?P<reason>: \S)?")
PRAGMA = re.compile(r"#\s*pragma\s+(?:GCC|clang)\s+diagnostic\s+ignored")
# Options of GCC that clang refuses.
UNKNOWN_TO_CLANG = re.compile(r" -fvect-cost-model=\S+")


def format_findings(_):
    paths = sources("core", "joints", "contact", "solvers", "plugins", "tests")
    parts = [paths[i::os.cpu_count()] for i in range(os.cpu_count())]
    with concurrent.futures.ThreadPoolExecutor() as pool:
        texts = pool.map(lambda part: run("clang-format", "--dry-run", *part), parts)
    found = re.findall(r"^(\S+?):(\d+):\d+: (?:warning|error): (?:code should be )?(.*)$", "".join(texts), re.M)
    return "%d files" % len(paths), [Finding(path, int(line), words + " (./dev format)") for path, line, words in found]


def suppression_findings(_):
    """A warning that is switched off says which and why."""
    paths, found = sources("core", "joints", "contact", "solvers", "plugins", "tests"), []
    for path in paths:
        found += suppressions_without_reason(path, read(path))
    return "%d files" % len(paths), found


def suppressions_without_reason(path, text):
    found, previous = [], ""
    for number, line in enumerate(text.splitlines(), 1):
        mark = SUPPRESSION.search(line)
        if mark and not (mark["checks"] and mark["reason"]):
            found.append(Finding(path, number, "a suppression wants the check and the reason: NOLINT(check): reason"))
        if PRAGMA.search(line) and "//" not in line + previous:
            found.append(Finding(path, number, "a suppression wants its reason in a comment"))
        previous = line if line.strip().startswith("//") else ""
    return found


def layering_findings(_):
    done = subprocess.run([sys.executable, "-B", os.path.join(ROOT, "tests", "layering", "layering_test.py"), "Layering"],
                          capture_output=True, text=True)
    return "includes", [] if done.returncode == 0 else [Finding("tests/layering", 0, done.stderr.strip())]


def tidy_findings(options):
    units = Units(options.build)
    chosen = units.all() if options.all else units.of(changed(options.since))
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        texts = pool.map(lambda unit: run("clang-tidy", "-p", units.folder, "--quiet", unit), chosen)
    found = {}
    for path, line, words in re.findall(r"^(\S+?):(\d+):\d+: (?:warning|error): (.*)$", "".join(texts), re.M):
        words = words.replace(",-warnings-as-errors", "")
        path = os.path.relpath(path, ROOT)
        if not path.startswith(os.pardir):  # else in a library
            found[path, int(line), words] = None
    return "%d of %d units" % (len(chosen), len(units.all())), [Finding(*where) for where in found]


class Units:
    """What clang-tidy reads at once, and the sources in each: most of its time goes into headers, so that all sources of
    a room that are compiled together, several at a time, make one unit."""

    INCLUDE = re.compile(r'^#include "(.*)"$', re.M)
    TOGETHER = re.compile(r"/(?P<room>\w+)\.dir/Unity/unity_\w+_cxx\.cxx$")

    def __init__(self, build):
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            commands = json.load(file)
        self.folder = os.path.join(build, "lint")
        os.makedirs(self.folder, exist_ok=True)
        self.sources, chosen = {}, {}
        for command in commands:
            parts = self.sources_of(command["file"])
            if any(part.split(os.sep)[0] not in FOLDERS or part.startswith(BROKEN) for part in parts):
                continue
            unit = self.unit_of(command["file"])
            self.sources.setdefault(unit, []).extend(parts)
            text = UNKNOWN_TO_CLANG.sub("", command["command"]).replace(command["file"], unit)
            chosen[unit] = {**command, "file": unit, "command": text}
        for unit, parts in self.sources.items():
            if unit.startswith(self.folder):
                write(unit, "".join('#include "%s"\n' % os.path.join(ROOT, part) for part in parts))
        write(os.path.join(self.folder, "compile_commands.json"), json.dumps(list(chosen.values())))

    def unit_of(self, path):
        together = self.TOGETHER.search(path)
        return os.path.join(self.folder, together["room"] + ".cpp") if together else path

    def sources_of(self, path):
        paths = self.INCLUDE.findall(read(path)) if self.TOGETHER.search(path) else [path]
        return [os.path.relpath(path, ROOT) for path in paths]

    def all(self):
        return sorted(self.sources)

    def of(self, paths):
        """Units with one of these sources, or for a header with the first source that includes it."""
        wanted = set(paths)
        for path in paths:
            if path.endswith(".h"):
                wanted.update(self.first_user(path))
        return sorted(unit for unit, parts in self.sources.items() if wanted.intersection(parts))

    def first_user(self, header):
        names = {header.removeprefix("core/include/").removeprefix("core/"), os.path.basename(header)}
        users = [part for parts in self.sources.values() for part in parts
                 if names.intersection(self.INCLUDE.findall(read(part)))]
        return sorted(users, key=lambda user: (os.path.dirname(user) != os.path.dirname(header), user))[:1]


def run(*words):
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    return done.stdout + done.stderr


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


CHECKS = {
    "format": ("sources as .clang-format sets them", format_findings),
    "suppressions": ("each has a check and a reason", suppression_findings),
    "layering": ("includes as the rooms allow them", layering_findings),
    "sizes": ("files of %d lines, functions of %d, classes of %d public functions"
              % (sizes.LONGEST_FILE, sizes.LONGEST_FUNCTION, sizes.MOST_FUNCTIONS), lambda _: sizes.findings()),
    "spelling": ("pages in British English", lambda _: spelling.findings()),
    "commits": ("subjects of at most %d characters" % commits.LONGEST, lambda _: commits.findings()),
    "tidy": ("the checks of .clang-tidy", tidy_findings),
}


def parse(arguments):
    words = argparse.ArgumentParser(
        prog="./dev lint", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="checks:\n" + "\n".join("  %-13s %s" % (name, what) for name, (what, _) in CHECKS.items()))
    words.add_argument("names", nargs="*", metavar="CHECK", help="checks to make (default: all)")
    words.add_argument("--all", action="store_true", help="clang-tidy looks at all sources")
    words.add_argument("--since", metavar="REV", help="clang-tidy looks at what was changed since this revision")
    words.add_argument("--build", default=os.path.join(ROOT, "build", "release"), help=argparse.SUPPRESS)
    options = words.parse_args(arguments)
    for name in options.names:
        if name not in CHECKS:
            words.error("there is no check '%s'; these are: %s" % (name, ", ".join(CHECKS)))
    if options.since and git("rev-parse", "--verify", "--quiet", options.since + "^{commit}") is None:
        words.error("there is no revision '%s' here" % options.since)
    return options


def main(arguments):
    options = parse(arguments)
    bad = 0
    for name in options.names or CHECKS:
        start = time.monotonic()
        what, found = CHECKS[name][1](options)
        verdict = "ok" if not found else "%d finding%s" % (len(found), "" if len(found) == 1 else "s")
        print("%-13s %-12s %s, %.1f s" % (name, verdict, what, time.monotonic() - start), flush=True)
        for finding in found:
            print("  %s" % finding)
        bad += len(found)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
