"""The table of ./dev coverage counts lines and branches by room."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rooms


def line(count, *branches, **more):
    return {"count": count, "branches": [{"count": n} for n in branches], **more}


class Rooms(unittest.TestCase):
    def test_lines_and_branches_are_summed_by_room(self):
        files = [{"file": "core/run/simulation.cpp", "lines": [line(3, 1, 0), line(0), line(0, **{"gcovr/noncode": True}), line(0, **{"gcovr/excluded": True})]},
                 {"file": "core/run/sink.h", "lines": [line(1)]},
                 {"file": "joints/revolute.cpp", "lines": [line(0, 0, 0)]}]
        self.assertEqual({"core/run": [3, 2, 2, 1], "joints": [1, 0, 2, 0]}, rooms.by_room(files))

    def test_the_table_ends_with_all_of_them(self):
        text = rooms.table({"core/run": [3, 2, 2, 1], "joints": [1, 0, 0, 0]})
        self.assertEqual(["all", "4", "50.0", "%", "2", "50.0", "%"], text.splitlines()[-1].split())
        self.assertEqual(["joints", "1", "0.0", "%", "0", "-"], text.splitlines()[2].split())


if __name__ == "__main__":
    unittest.main()
