"""Fails every call of a run that writes, one at a time: the run ends with exit code 6, nothing is lost, and it goes on."""
import collections
import json
import os
import shutil
import subprocess

from results import Reference, need

ERRORS = ("ENOSPC", "EIO")


class Faults:
    def __init__(self, program, library, folder, model, options):
        self.program, self.library, self.folder = program, library, folder
        self.result = os.path.join(folder, "faulty")
        self.report = os.path.join(folder, "report")
        self.command = ["run", model, "--quiet", "--checkpoint", "20 ms", *options]
        self.run(self.command, "--out", os.path.join(folder, "undisturbed"))
        self.reference = Reference(os.path.join(folder, "undisturbed"))
        self.counted = self.calls()
        self.failed = collections.Counter()  # by call and file
        self.rows_left = self.from_start = self.made_good = self.not_met = 0

    def run(self, command, *options):
        done = subprocess.run([self.program, *command, *options], capture_output=True, text=True, timeout=120)
        need(done.returncode == 0, " ".join(done.args), "exits", done.returncode, done.stderr[-300:])

    def disturbed(self, call, error):
        """Runs with the call failing; its exit code, messages, calls that were made, and what failed."""
        shutil.rmtree(self.result, ignore_errors=True)
        if os.path.exists(self.report):
            os.remove(self.report)
        done = subprocess.run([self.program, *self.command, "--out", self.result], capture_output=True, text=True, timeout=120,
                              env={**os.environ, "LD_PRELOAD": self.library, "FAILING_FOLDER": self.result,
                                   "FAILING_CALL": str(call), "FAILING_WITH": error, "FAILING_REPORT": self.report,
                                   "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"})
        with open(self.report, encoding="utf-8") as file:
            said = dict(line.rstrip("\n").split(" ", 1) for line in file)
        return done.returncode, done.stderr, int(said["calls"]), said.get("failed")

    def calls(self):
        code, messages, calls, _ = self.disturbed(0, "EIO")
        need(code == 0, "without a failing call:", messages)
        self.reference.require_same(self.result)
        return calls

    def short_writes(self):
        code, messages, _, _ = self.disturbed(0, "SHORT")
        need(code == 0, "with short writes:", messages)
        self.reference.require_same(self.result)

    def fail(self, call, error):
        code, messages, calls, failed = self.disturbed(call, error)
        case = "%s of call %d of %d (%s): " % (error, call, calls, failed)
        if failed is None:  # this run made fewer calls
            self.not_met += 1
            return need(code == 0, case, "exit", code, messages[-400:])
        if code == 0:  # HDF5 tries to open a file once more
            self.made_good += 1
            return self.reference.require_same(self.result)
        need(code == 6 and "[cannot-write]" in messages, case, "exit", code, messages[-400:])
        self.failed[failed.split(" ")[0]] += 1
        rows = [count for count in self.reference.part(self.result) if count is not None]
        summary = os.path.join(self.result, "summary.json")
        if os.path.exists(summary):
            with open(summary, encoding="utf-8") as file:
                said = json.load(file)
            need(said["status"] == "failed" and said["exit_code"] == 6, case, "status", said["status"])
        self.rows_left += max(rows, default=0) > 0
        if os.path.exists(os.path.join(self.result, "checkpoint.bin")):
            self.run(["run", "--resume", self.result, "--quiet"])
        else:
            self.from_start += 1
            self.run(self.command, "--out", self.result, "--force")
        return self.reference.require_same(self.result)

    def words(self):
        calls = ", ".join("%s %d" % (call, count) for call, count in sorted(self.failed.items()))
        return ("%d failed with exit code 6 each (%s), %d were made good; a run makes about %d, %d were not met; rows left in %d, "
                "%d began anew; all reach the same bytes" % (self.failed.total(), calls, self.made_good, self.counted, self.not_met,
                                                             self.rows_left, self.from_start))
