"""Tables of even motion: what rounding makes of their second derivatives is no doubt, what their points say is one."""
import json
import unittest

from program import ProgramTest

MODEL = """freeplay: 1
bodies: {m: {mass: 1, inertia: 1}}
joints: {guide: {type: prismatic, between: [ground, m]}}
drivers: {d: {joint: guide, kind: %s, table: {file: way.csv, interpolation: %s}}}
simulation: {end: 2 s, step: %s, output: {interval: 10 ms}}
"""
# A nanometre within 0.4 ms is an acceleration of 0.1 m/s^2, among points that are as rounded.
PEAK = [(1.0052, -1.5052), (1.0054, -1.505399999), (1.0056, -1.5056)]


def even_rows(by):
    return [(0.05 * i, -0.5 - by * i) for i in range(41)]


class EvenTable(ProgramTest):
    def doubts(self, kind, rows, interpolation, step):
        self.write("way.csv", "time,x\n" + "".join("%.17g,%.17g\n" % row for row in sorted(rows)))
        self.write("m.yaml", MODEL % (kind, interpolation, step))
        _, err = self.freeplay("run", "m.yaml", "--out", "out", "--force")
        reasons = [reason["id"] for reason in json.loads(self.read("out", "summary.json"))["trust"]["reasons"]]
        self.assertEqual("unresolved-input" in reasons, "which the step" in err, err)
        return "unresolved-input" in reasons

    def test_rounding_of_the_points_is_no_change(self):
        for kind in ("position", "velocity", "force"):
            for by in (0.0, 0.05, 1 / 3, 1e3):
                for interpolation in ("cubic", "linear"):
                    with self.subTest(kind=kind, by=by, interpolation=interpolation):
                        self.assertFalse(self.doubts(kind, even_rows(by), interpolation, "1.7 ms"))

    def test_a_peak_between_the_points_is_one(self):
        for kind in ("position", "velocity"):
            self.assertTrue(self.doubts(kind, even_rows(0.05) + PEAK, "cubic", "10 ms"), kind)

    def test_a_corner_between_the_ends_of_steps_is_one(self):
        ramp = [(0, 0), (0.993, 0), (0.996, 10), (0.999, 0), (2, 0)]
        self.assertTrue(self.doubts("force", ramp, "linear", "10 ms"))


if __name__ == "__main__":
    unittest.main()
