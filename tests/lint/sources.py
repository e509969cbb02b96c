"""Files of the repository, and what git knows of them."""
import dataclasses
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


@dataclasses.dataclass(frozen=True)
class Finding:
    path: str
    line: int  # 0: none
    words: str

    def __str__(self):
        return "%s: %s" % (self.path + (":%d" % self.line if self.line else ""), self.words)


def files(folders, endings):
    for folder in folders:
        for path, _, names in os.walk(os.path.join(ROOT, folder)):
            for name in names:
                if name.endswith(endings):
                    yield os.path.relpath(os.path.join(path, name), ROOT)


def sources(*folders):
    return sorted(files(folders, (".cpp", ".h")))


def git(*words):
    """What git answers; None where it refuses, or there is none."""
    try:
        done = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def changed(since=None):
    """Files that differ from a revision: where the branch left the main one, on that itself the commit before."""
    base = since or git("merge-base", "HEAD", "origin/HEAD") or git("rev-parse", "HEAD~1")
    if base and not since and base == git("rev-parse", "HEAD"):
        base = git("rev-parse", "HEAD~1")
    listed = [git("diff", "--name-only", "--diff-filter=d", base) if base else None,
              git("ls-files", "--others", "--exclude-standard")]
    return sorted({path for text in listed if text for path in text.splitlines()})
