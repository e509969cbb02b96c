"""Runs the program under test, whose path is in FREEPLAY (what was built with it in FREEPLAY_BUILD), and keeps its files in a folder of their own."""
import os
import re
import subprocess
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get("FREEPLAY_BUILD", os.path.join(ROOT, "build", "release"))
PROGRAM = os.environ.get("FREEPLAY", os.path.join(BUILD, "freeplay"))
MECHANISMS = os.path.join(ROOT, "mechanisms")


def mechanism(name):
    return os.path.join(MECHANISMS, name + ".yaml")


def drawing(text):
    """A picture without the record of how it was made, which has words of the compiler."""
    return re.sub(r"\n<metadata>.*</metadata>", "", text, flags=re.S)


def processor_seconds(process):
    """What the process of that number has used so far; None if there is none."""
    try:
        with open("/proc/%d/stat" % process, encoding="ascii") as file:
            state, *fields = file.read().rsplit(")", 1)[1].split()
    except FileNotFoundError:
        return None
    return None if state == "Z" else (int(fields[10]) + int(fields[11])) / os.sysconf("SC_CLK_TCK")


def let_work(process, seconds):
    """Waits until a child has used so much of the processor, however busy the machine is, or has ended."""
    while process.poll() is None and processor_seconds(process.pid) < seconds:
        time.sleep(0.005)


class ProgramTest(unittest.TestCase):
    """Every test starts in an empty folder."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def read(self, *names):
        with open(self.path(*names), encoding="utf-8", newline="") as file:
            return file.read()

    def freeplay(self, *arguments, code=0, environment=None, **options):
        """Runs the program, checks its exit code, and returns what it printed: stdout, stderr."""
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=500,
                              env={**os.environ, **(environment or {})}, **options)
        self.assertEqual(code, done.returncode, "%s\n%s%s" % (" ".join(arguments), done.stdout, done.stderr))
        return done.stdout, done.stderr
