"""Results that other programs cut, changed or replaced, and twins that were ended: what is said of them."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, mechanism

CRANK = mechanism("slider-crank")


class Changed(ProgramTest):
    def cut(self, keep, *names):
        with open(self.path(*names), "rb+") as file:
            file.truncate(int(os.path.getsize(self.path(*names)) * keep))

    def summary(self, *folders):
        return json.loads(self.read(*folders, "summary.json"))

    def begun(self, name, *options, until="results.csv", size=0):
        """A run that goes on and has that file, of more than so many bytes."""
        process = subprocess.Popen([PROGRAM, "run", CRANK, "--quiet", "--out", name, *options], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        file = self.path(name, until)
        while process.poll() is None and (not os.path.exists(file) or os.path.getsize(file) <= size):
            time.sleep(0.005)
        return process

    def test_a_killed_twin_is_run_again(self):
        self.freeplay("run", CRANK, "--twin", "--quiet", "--end", "0.3 s", "--out", "whole")
        whole = self.summary("whole")
        self.assertIsNotNone(whole["twin"])
        for number in (signal.SIGKILL, signal.SIGTERM):
            name = "cut%d" % number
            process = self.begun(name, "--twin", "--end", "0.3 s", until="twin/results.csv", size=1000)
            process.send_signal(number)
            process.wait()
            self.freeplay("run", "--resume", name, "--quiet")
            self.assertEqual(whole["twin"], self.summary(name)["twin"])
            for file in ("results.csv", "events.csv"):
                for folder in ((), ("twin",)):
                    self.assertEqual(self.read("whole", *folder, file), self.read(name, *folder, file))

    def test_a_twin_that_was_ended_alone_is_run_again(self):
        self.freeplay("run", CRANK, "--twin", "--quiet", "--end", "20 ms", "--out", "whole")
        whole = self.summary("whole")
        shutil.copytree(self.path("whole"), self.path("cut"))
        os.remove(self.path("cut", "twin", "summary.json"))
        self.write("cut/summary.json", json.dumps({**whole, "twin": None}))
        self.freeplay("run", "--resume", "cut", "--quiet")
        self.assertEqual(whole["twin"], self.summary("cut")["twin"])
        self.assertEqual("completed", self.summary("cut", "twin")["status"])

    def test_a_twin_without_a_row_that_counts_is_not_run_again(self):
        self.freeplay("run", CRANK, "--twin", "--quiet", "--end", "5 ms", "--out", "short")
        self.assertIsNone(self.summary("short")["twin"])
        made = os.stat(self.path("short", "twin", "summary.json"))
        self.assertIn("nothing to do", self.freeplay("run", "--resume", "short")[0])
        self.assertEqual(made.st_mtime_ns, os.stat(self.path("short", "twin", "summary.json")).st_mtime_ns)

    def test_a_completed_result_that_was_changed_is_not_called_done(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "10 ms", "--out", "whole")
        out, _ = self.freeplay("run", "--resume", "whole")
        self.assertIn("nothing to do", out)
        out, _ = self.freeplay("seal", "whole")
        self.assertIn("nothing to do", out)

        def swap(name):
            def change(folder):
                text = self.read(folder, name)
                place = next(i for i in range(len(text) // 2, len(text)) if text[i] in "12345678")
                self.write(os.path.join(folder, name), text[:place] + str(int(text[place]) + 1) + text[place + 1:])
            return change

        def comment(folder):
            self.write(os.path.join(folder, "model.yaml"), self.read(folder, "model.yaml") + "# another\n")

        cases = (("results.csv", lambda folder: self.cut(0.5, folder, "results.csv"), 6),
                 ("results.csv", swap("results.csv"), 6),
                 ("results.h5", lambda folder: self.cut(0.5, folder, "results.h5"), 6),
                 ("events.csv", lambda folder: self.cut(0.5, folder, "events.csv"), 6),
                 ("events.csv", lambda folder: os.remove(self.path(folder, "events.csv")), 6),
                 ("model", comment, 3))
        for number, (word, change, code) in enumerate(cases):
            folder = "changed%d" % number
            shutil.copytree(self.path("whole"), self.path(folder))
            change(folder)
            with self.subTest(word, number=number):
                _, err = self.freeplay("run", "--resume", folder, code=code)
                self.assertIn(word, err)
                _, err = self.freeplay("seal", folder, code=6)
                self.assertIn(word, err)

    def change_digit(self, *names):
        """The first that is no 9 in the middle line, or in one that any checkpoint knows."""
        lines = self.read(*names).splitlines(True)
        number = min(len(lines) // 2, 20)
        line = lines[number]
        place = next(i for i in range(line.index(",") + 1, len(line)) if line[i] in "12345678")
        lines[number] = line[:place] + str(int(line[place]) + 1) + line[place + 1:]
        self.write(os.path.join(*names), "".join(lines))

    def test_rows_and_events_that_were_changed_are_not_sealed(self):
        process = self.begun("killed", "--end", "100 s", "--checkpoint", "0.2 s", until="checkpoint.bin", size=9000)
        time.sleep(0.5)
        process.kill()
        process.wait()
        self.freeplay("run", CRANK, "--quiet", "--end", "10 ms", "--out", "done")
        os.remove(self.path("done", "summary.json"))
        for folder in ("killed", "done"):
            for name in ("results.csv", "events.csv"):
                shutil.copytree(self.path(folder), self.path("r"))
                self.change_digit("r", name)
                _, err = self.freeplay("seal", "r", code=6)
                self.assertIn("'r/%s' was changed: its %s are not those" % (name, "rows" if name == "results.csv" else "events"), err)
                self.assertNotIn("summary.json", os.listdir(self.path("r")))
                shutil.rmtree(self.path("r"))
            shutil.copytree(self.path(folder), self.path("r"))
            self.change_digit("r", "results.csv")
            os.remove(self.path("r", "results.csv"))  # as the message says
            self.freeplay("seal", "r")
            shutil.rmtree(self.path("r"))
            self.freeplay("seal", folder)

    def test_part_of_a_line_after_the_last_one_is_named_and_cut_off(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "10 ms", "--format", "csv", "--out", "whole")
        for name in ("results.csv", "events.csv"):
            shutil.copytree(self.path("whole"), self.path(name))
            with open(self.path(name, name), "a", encoding="utf-8") as file:
                file.write("0.1,wri")
            _, err = self.freeplay("run", "--resume", name, code=6)
            self.assertIn("'%s/%s' was changed: it ends in part of a line" % (name, name), err)
            self.assertIn("freeplay seal %s" % name, err)
            table = "events" if name == "events.csv" else "results"
            self.assertIn("is left out", self.freeplay("export", name, "--to", "csv", "--table", table)[1])
            self.freeplay("seal", name)
            self.assertEqual(self.read("whole", name), self.read(name, name))
            self.assertIn("nothing to do", self.freeplay("run", "--resume", name)[0])
        self.cut(0.5, "events.csv", "events.csv")
        self.assertIn("was changed or cut", self.freeplay("export", "events.csv", "--to", "csv", "--table", "impacts")[1])

    def test_a_cut_mat_file_is_refused_wherever_it_ends(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "4 ms", "--out", "r")
        self.freeplay("export", "r", "--to", "mat", "--out", "whole.mat")
        self.freeplay("compare", "whole.mat", "r/results.csv")
        size = os.path.getsize(self.path("whole.mat"))
        for end in [129, 135, *range(200, size, size // 20), size - 5000, size - 9, size - 1]:
            shutil.copy(self.path("whole.mat"), self.path("cut.mat"))
            os.truncate(self.path("cut.mat"), end)
            for command in (("compare", "cut.mat", "r"), ("export", "cut.mat", "--to", "csv")):
                with self.subTest(end=end, command=command[0]):
                    out, err = self.freeplay(*command, code=6)
                    self.assertEqual("", out)
                    self.assertIn("'cut.mat' cannot be read: it was cut", err)

    def test_either_file_of_rows_may_go(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "10 ms", "--out", "r")
        os.remove(self.path("r", "results.csv"))
        self.assertIn("nothing to do", self.freeplay("run", "--resume", "r")[0])
        self.assertIn("nothing to do", self.freeplay("seal", "r")[0])

    def test_a_damaged_hdf5_file_that_text_stands_for_is_named(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "4 ms", "--out", "r")
        self.cut(0.5, "r", "results.h5")
        for command in (("compare", "r", "r"), ("export", "r", "--to", "csv")):
            _, err = self.freeplay(*command)
            with self.subTest(command[0]):
                self.assertRegex(err, "warning: result 'r/results.h5' cannot be read: .*; rows are those of 'r/results.csv'")

    def test_an_export_of_a_part_says_so(self):
        self.freeplay("run", CRANK, "--quiet", "--end", "10 ms", "--format", "csv", "--out", "r")
        _, err = self.freeplay("export", "r", "--to", "csv", "--out", "whole.csv")
        self.assertNotIn("warning", err)
        shutil.copy(self.path("whole.csv"), self.path("alone.csv"))
        rows = self.summary("r")["counts"]["rows"]
        for name, words in (("r/results.csv", "its summary counts %d" % rows), ("whole.csv", "was changed or cut"),
                            ("alone.csv", "the last line of 'alone.csv' has no end")):
            self.cut(0.7, name)
            _, err = self.freeplay("export", name, "--to", "csv")
            self.assertIn(words, err)
        self.assertIn(words, self.freeplay("compare", name, name)[1])

    def test_a_file_that_another_program_cuts_or_replaces_ends_the_run(self):
        def replace(path):
            with open(path + ".new", "w", encoding="utf-8") as file:
                file.write("time\n0\n1\n")
            os.rename(path + ".new", path)

        for number, (name, change, words) in enumerate((
                ("results.csv", lambda path: os.truncate(path, 100_000), "another program cut it"),
                ("results.csv", replace, "it was removed or replaced"),
                ("results.h5", lambda path: os.truncate(path, os.path.getsize(path) // 2), "another program cut it"))):
            folder = "r%d" % number
            process = self.begun(folder, "--end", "1000 s", "--yes", until=name, size=1_000_000)
            change(self.path(folder, name))
            while process.poll() is None:
                time.sleep(0.2)
                if name.endswith(".h5"):  # what is written while it is cut may make it as long as before
                    change(self.path(folder, name))
            err = process.stderr.read()
            with self.subTest(name, words=words):
                self.assertEqual(6, process.returncode, err)
                self.assertIn("cannot write '%s/%s': %s" % (folder, name, words), err)
                self.assertIn("run the model again", err)
                self.assertNotIn("free some space", err)
                self.assertEqual(0, self.summary(folder)["counts"]["rows"])


if __name__ == "__main__":
    unittest.main()
