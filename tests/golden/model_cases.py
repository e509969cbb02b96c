"""What tests of whole models share: facts and columns of a model, and an integrator of their own."""
import csv
import json
import math

from program import ProgramTest

# Tight enough that only the mechanics is compared.
EXACT = "integrator: dopri5, step: {size: 1 ms, adaptive: true, tolerance: 1e-11}"


def rk4(rates, state, end, steps):
    """State at `end` of state' = rates(t, state), from t = 0, by the classical method of fourth order."""
    h, t = end / steps, 0.0
    shifted = lambda y, k, s: [a + s * b for a, b in zip(y, k)]
    for _ in range(steps):
        a = rates(t, state)
        b = rates(t + h / 2, shifted(state, a, h / 2))
        c = rates(t + h / 2, shifted(state, b, h / 2))
        d = rates(t + h, shifted(state, c, h))
        state = [y + h / 6 * (p + 2 * q + 2 * r + s) for y, p, q, r, s in zip(state, a, b, c, d)]
        t += h
    return state


class ModelTest(ProgramTest):
    def model(self, text, head="freeplay: 1\n"):
        return self.write("m.yaml", head + text)

    def facts(self, text, *options, **expected):
        """Loads a model and holds its facts; returns the whole verdict."""
        verdict = json.loads(self.freeplay("validate", self.model(text), "--json", *options)[0])
        self.assertEqual(expected, {name: verdict["facts"][name] for name in expected})
        return verdict

    def run_model(self, text, *options):
        """Runs a model; name of column to numbers."""
        self.freeplay("run", self.model(text), "--out", "out", "--quiet", *options)
        rows = list(csv.reader(self.read("out", "results.csv").splitlines()))
        return {name: [float(x) if x else math.nan for x in values] for name, *values in zip(*rows)}

    def assert_column(self, columns, name, formula, tolerance=1e-9):
        """The column is formula(t) to `tolerance`, of its largest value where that is above 1."""
        expected = [formula(t) for t in columns["time"]]
        scale = max(1.0, *map(abs, expected))
        for t, x, y in zip(columns["time"], expected, columns[name], strict=True):
            self.assertLess(abs(x - y), tolerance * scale, "%s at %r s: %r is not %r" % (name, t, y, x))

    def refusal(self, text, *options, code=3, head="freeplay: 1\n", **expected):
        """The messages of a model that is refused; the first error has what is expected."""
        out, _ = self.freeplay("validate", self.model(text, head), "--json", *options, code=code)
        messages = json.loads(out)["messages"] if code == 3 else json.loads(out)["error"]["messages"]
        errors = [message for message in messages if message["severity"] == "error"]
        self.assertEqual(expected, {name: errors[0][name] for name in expected}, messages)
        return errors


class VerdictTest(ProgramTest):
    """Runs of models of which the verdict is looked at."""

    def run_model(self, text):
        self.write("m.yaml", text)
        self.freeplay("run", "m.yaml", "--force", "--out", "r", "--quiet")
        self.summary = json.loads(self.read("r", "summary.json"))
        self.trust = self.summary["trust"]

    def ids(self):
        return [reason["id"] for reason in self.trust["reasons"]]
