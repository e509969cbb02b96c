"""Built-in joints, laws and integrators give the same bytes whether they are linked into the program or loaded by it."""
import json
import os
import subprocess
import unittest

from program import BUILD, MECHANISMS, PROGRAM, ProgramTest, mechanism

OTHER = os.path.join(BUILD, "freeplay_other_linkage")


class LinkageTest(ProgramTest):
    def result(self, program, name, folder):
        subprocess.run([program, "run", mechanism(name), "--end", "5 ms", "--quiet", "--out", self.path(folder)],
                       cwd=self.folder, check=True)
        files = {}
        for file in ("results.csv", "events.csv"):
            with open(self.path(folder, file), "rb") as text:
                files[file] = text.read()
        summary = json.loads(self.read(folder, "summary.json"))
        del summary["performance"], summary["provenance"]["command"]
        return files, summary

    def test_five_milliseconds_of_every_mechanism_are_equal(self):
        names = sorted(os.path.splitext(name)[0] for name in os.listdir(MECHANISMS) if name.endswith(".yaml"))
        self.assertLessEqual(5, len(names))
        for name in names:
            with self.subTest(name):
                files, summary = self.result(PROGRAM, name, name + "-a")
                other_files, other_summary = self.result(OTHER, name, name + "-b")
                self.assertEqual(files, other_files)
                self.assertEqual(summary, other_summary)

    def test_both_programs_list_the_same_types(self):
        lists = [subprocess.run([program, "list", "--json"], cwd=self.folder, capture_output=True, check=True).stdout
                 for program in (PROGRAM, OTHER)]
        self.assertEqual(*lists)

    def test_one_of_the_programs_loads_its_own_libraries(self):
        self.assertEqual(1, sum(self.misses_libraries(program) for program in (PROGRAM, OTHER)))

    def misses_libraries(self, program):
        """True if a copy of the program without its libraries beside it says so."""
        copy = self.path(os.path.basename(program))
        with open(program, "rb") as source, open(copy, "wb") as target:
            target.write(source.read())
        os.chmod(copy, 0o755)
        done = subprocess.run([copy, "list"], cwd=self.folder, capture_output=True, text=True)
        if done.returncode == 0:
            return False
        self.assertEqual(5, done.returncode)
        self.assertIn("this program's own library '", done.stderr)
        return True


if __name__ == "__main__":
    unittest.main()
