"""Kills runs at random instants: every file opens, holds what is older than a second, and the run goes on to the same bytes."""
import json
import os
import pty
import re
import shutil
import signal
import subprocess
import threading
import time

from results import Reference, need

OLD = 1.0  # rows of that age are in the files [s]
PROGRESS = re.compile(rb"t = (\S+) / \S+ s")


def surely(text):
    """What a rounded number is at least."""
    digits, _, power = text.partition("e")
    unit = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
    return float(text) - 0.5 * unit


class Watched:
    """A run whose progress line, on a terminal of its own, says how far it has come."""

    def __init__(self, command):
        ours, theirs = pty.openpty()
        self.began = time.monotonic()
        self.reached = []  # when, and the time of the run
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=theirs, stdin=subprocess.DEVNULL,
                                        env={**os.environ, "TERM": "xterm", "COLUMNS": "120"})
        os.close(theirs)
        self.reader = threading.Thread(target=self.read, args=(ours,))
        self.reader.start()

    def read(self, terminal):
        text = b""
        while True:
            try:
                piece = os.read(terminal, 4096)
            except OSError:  # the other side is closed
                piece = b""
            if not piece:
                break
            text, end = text + piece, 0
            for found in PROGRESS.finditer(text):
                self.reached.append((time.monotonic(), surely(found[1].decode())))
                end = found.end()
            text = text[end:]
        os.close(terminal)

    def kill(self, after):
        """Whether it was still going so many seconds after its start, and when it was killed."""
        try:
            self.process.wait(max(0.0, self.began + after - time.monotonic()))
        except subprocess.TimeoutExpired:
            pass
        killed = time.monotonic()
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self.reader.join()
        return self.process.returncode == -signal.SIGKILL, killed

    def old_at(self, instant):
        """The time of the run that it had reached a second before."""
        return max((t for when, t in self.reached if when < instant - OLD), default=None)


class Kills:
    """Of one model with some options."""

    def __init__(self, name, program, folder, model, options):
        self.name, self.program, self.folder = name, program, folder
        self.command = [program, "run", model, *options]
        began = time.monotonic()
        self.finish(self.command, "--out", os.path.join(folder, name), "--quiet")
        self.seconds = time.monotonic() - began
        self.reference = Reference(os.path.join(folder, name))
        self.killed = self.over = self.without_checkpoint = self.resumed = self.judged = 0
        self.kept = []

    @staticmethod
    def finish(command, *options):
        done = subprocess.run([*command, *options], capture_output=True, text=True, timeout=600)
        need(done.returncode == 0, " ".join(done.args), "exits", done.returncode, done.stderr[-300:])

    def look(self, folder, run, instant):
        rows = self.reference.part(folder)
        old = run.old_at(instant)
        if old is not None:
            due = int((self.reference.times <= old).sum())
            self.judged += 1
            for name, count in zip(("results.csv", "results.h5"), rows):
                need(count is not None and count >= due, folder, name, "holds", count, "rows; a second before it was killed the run had made",
                     due, "rows, to t =", old)
        self.kept.append(rows[1] or 0)

    def kill(self, draw):
        folder = os.path.join(self.folder, "killed")
        shutil.rmtree(folder, ignore_errors=True)
        run = Watched([*self.command, "--out", folder])
        going, instant = run.kill(draw.uniform(0.0, self.seconds))
        self.killed += going
        if not going:
            self.over += 1
            self.seconds = min(self.seconds, instant - run.began)
        self.look(folder, run, instant)
        while os.path.exists(os.path.join(folder, "checkpoint.bin")) and draw.random() < 1 / 3:
            run = Watched([self.program, "run", "--resume", folder])
            going, instant = run.kill(draw.uniform(0.0, 0.5 * self.seconds))
            self.killed += going
            self.look(folder, run, instant)
        if os.path.exists(os.path.join(folder, "checkpoint.bin")):
            self.finish([self.program, "run", "--resume", folder, "--quiet"])
            with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
                self.resumed += (json.load(file)["performance"].get("resumed_from") or 0) > 0
        else:  # killed before there was anything
            self.without_checkpoint += 1
            self.finish([*self.command, "--out", folder, "--force", "--quiet"])
        self.reference.require_same(folder)

    def words(self):
        return ("%d killed (%d were over), %d before there was a checkpoint; %d to %d of %d rows left, what was older than a second "
                "seen in %d; %d went on from the middle; all reach the same bytes" %
                (self.killed, self.over, self.without_checkpoint, min(self.kept, default=0), max(self.kept, default=0),
                 len(self.reference.times), self.judged, self.resumed))
