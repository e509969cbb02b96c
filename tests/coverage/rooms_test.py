"""The table of ./dev coverage counts lines and branches by room."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import rooms


class Rooms(unittest.TestCase):
    def test_lines_and_branches_are_summed_by_room(self):
        files = {"core/run/simulation.cpp": {"lines": {3: 4, 4: 0}, "branches": {(3, 7, True): 4, (3, 7, False): 0}},
                 "core/run/sink.h": {"lines": {9: 1}, "branches": {}},
                 "joints/revolute.cpp": {"lines": {1: 0}, "branches": {(1, 2, True): 0, (1, 2, False): 0}}}
        self.assertEqual({"core/run": [3, 2, 2, 1], "joints": [1, 0, 2, 0]}, rooms.by_room(files))
        self.assertEqual(["core/run/simulation.cpp:3: condition at column 7 never false",
                          "core/run/simulation.cpp:4: not reached",
                          "joints/revolute.cpp:1: not reached"], rooms.unreached(files))

    def test_a_line_has_the_largest_count_of_its_regions(self):
        segments = [[1, 10, 5, True, True, False],   # a function
                    [2, 9, 3, True, True, True],     # the gap before the body of an if
                    [2, 10, 0, True, True, False],   # the body, never reached
                    [4, 3, 5, True, False, False],   # after it
                    [6, 2, 0, False, False, False]]  # the end of the function
        self.assertEqual({1: 5, 2: 5, 3: 0, 4: 0, 5: 5, 6: 5}, rooms.lines(segments))

    def test_copies_of_a_template_are_counted_together(self):
        branch = [7, 5, 7, 9]
        file = {"segments": [], "branches": [branch + [0, 2, 0, 0, 4], branch + [1, 0, 0, 0, 4]]}
        self.assertEqual({(7, 5, True): 1, (7, 5, False): 2}, rooms.reached(file)["branches"])

    def test_the_table_ends_with_all_of_them(self):
        text = rooms.table({"core/run": [3, 2, 2, 1], "joints": [1, 0, 0, 0]})
        self.assertEqual(["all", "4", "50.0", "%", "2", "50.0", "%"], text.splitlines()[-1].split())
        self.assertEqual(["joints", "1", "0.0", "%", "0", "-"], text.splitlines()[2].split())


if __name__ == "__main__":
    unittest.main()
