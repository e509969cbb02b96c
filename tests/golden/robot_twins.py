"""What tests of robot files share: their motion beside that of a twin, and a four-bar that is closed by hand."""
import csv
import math

from program import ProgramTest


def closed_four_bar():
    """Angles of crank, coupler and rocker of four_bar_twin.yaml: two circles about the crank's tip and the far pin."""
    a = math.radians(60)
    x, y = 0.4 - 0.1 * math.cos(a), -0.1 * math.sin(a)
    gap = math.hypot(x, y)
    coupler = math.atan2(y, x) + math.acos((0.3 ** 2 + gap ** 2 - 0.25 ** 2) / (2 * 0.3 * gap))
    tip = (0.1 * math.cos(a) + 0.3 * math.cos(coupler), 0.1 * math.sin(a) + 0.3 * math.sin(coupler))
    return a, coupler, math.atan2(tip[1], tip[0] - 0.4)


class TwinTest(ProgramTest):
    tolerance = 1e-10

    def columns(self, model, *options):
        """Results of a run: column names to numbers."""
        out = model + ".out"
        self.freeplay("run", model, "--out", out, "--quiet", *options)
        rows = list(csv.reader(self.read(out, "results.csv").splitlines()))
        return {name: [float(x) for x in values] for name, *values in zip(*rows)}

    def assert_same_motion(self, expected, actual, tolerance=None):
        names = [name for name in expected if name.startswith("body.")]
        self.assertTrue(names)
        for name in names:
            for x, y in zip(expected[name], actual[name], strict=True):
                gap = math.remainder(x - y, 2 * math.pi) if name.endswith(".angle") else x - y
                self.assertLess(abs(gap), (tolerance or self.tolerance) * max(1.0, abs(x)), name)
