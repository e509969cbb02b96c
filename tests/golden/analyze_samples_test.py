"""freeplay analyze error --samples: the laws of distribution. Drawing so many takes minutes with sanitizers."""
import csv
import io
import math
import unittest

from program import ProgramTest, mechanism


class Samples(ProgramTest):
    def rows(self, *words):
        out, _ = self.freeplay("analyze", *words)
        return list(csv.DictReader(io.StringIO(out)))

    def test_samples_follow_the_law_that_is_given(self):
        with open(mechanism("five-bar"), encoding="utf-8") as file:
            five_bar = file.read()
        # One loose joint: the position errs by a number of the law, whose standard deviation is known.
        model = self.write("m.yaml", five_bar.split("\nanalysis:")[0] +
                           "\nanalysis: {error: {clearance: {B2: 0.1 mm}}}\n")
        words = ("error", model, "--pose", "0.05,0.25", "--samples", "100000")
        default, = self.rows(*words)
        q = 4.5  # 1 / (2 sigma^2) for sigma = 1/3
        for law, variance in (("uniform", 1 / 4), ("rim", 1 / 2), ("normal", (1 - q / math.expm1(q)) / 9),
                              ("normal:0.05", 0.0025), ("normal: 10 ", 1 / 4)):
            row, = self.rows(*words, "--distribution", law)
            wanted = float(row["position"]) * math.sqrt(variance)
            self.assertAlmostEqual(1, float(row["sample_rms_position"]) / wanted, delta=0.01)
            self.assertEqual(law == "uniform", row == default)
        # With redundancy, too, none exceeds the worst case.
        for law in ("rim", "normal:0.4"):
            row, = self.rows("error", mechanism("4-rrr"), "--pose", "0.05,0", "--samples", "20000", "--distribution", law)
            self.assertLess(float(row["sample_max_position"]), float(row["position"]))


if __name__ == "__main__":
    unittest.main()
