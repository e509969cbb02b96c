"""check-plugin tells what is wrong with a slider written by hand, in thirty-one ways, and nothing of one that is right."""
import json
import os
import unittest

from program import BUILD, ProgramTest

LIBRARY = os.path.join(BUILD, "plugins", "tests", "faulty_slides.so")


class FaultySlides(ProgramTest):
    def test_every_fault_is_reported_with_parameters_and_state(self):
        report = json.loads(self.freeplay("check-plugin", LIBRARY, "--json", code=5)[0])
        slides = {kind["name"]: kind for kind in report["types"]}
        self.assertEqual(32, len(slides))
        self.assertTrue(slides.pop("slide-0")["ok"])
        for name, slide in slides.items():
            with self.subTest(name):
                self.assertIsNone(slide["failure"])
                broken = [rule["detail"] for rule in slide["rules"] if not rule["held"]]
                self.assertTrue(any("gap = 0.0002 m" in detail and " at t = " in detail for detail in broken), broken)


if __name__ == "__main__":
    unittest.main()
