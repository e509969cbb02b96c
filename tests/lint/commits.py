"""Subjects of commits that were made after the one that brought this check."""
import os

from sources import Finding, git

LONGEST = 72  # characters of a subject


def findings():
    first = git("log", "--diff-filter=A", "--format=%H", "--", os.path.join("tests", "lint", "commits.py"))
    log = git("log", "--no-merges", "--ancestry-path", "--format=%h %s", first.splitlines()[-1] + "..HEAD") if first else None
    if log is None:
        return "no history here", []
    commits = [line.partition(" ")[::2] for line in log.splitlines()]
    return "%d commits" % len(commits), too_long(commits)


def too_long(commits):
    return [Finding(commit, 0, "a subject of %d characters: %s" % (len(subject), subject))
            for commit, subject in commits if len(subject) > LONGEST]
