"""The energy ledger closes for every contact law, friction law and integrator that the program lists."""
import csv
import json
import os
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest

MODEL = """freeplay: 1
name: journal
gravity: [0, -9.81]
bodies: {ball: {mass: 0.2 kg, inertia: 4e-6}}
joints:
  ring:
    type: revolute
    between: [ground, ball]
    clearance:
      bearing_radius: 10 mm
      radial_clearance: 0.1 mm
      length: 15 mm
      material: {E: 207 GPa, nu: 0.3}
      contact: {law: %s}
      friction: {law: %s}
      initial: {eccentricity: [0, -0.09 mm], velocity: [0.05 m/s, -0.02 m/s]}
initial: {joints: {ring: 0}, speeds: {ring: 20 rad/s}}
simulation: {end: 6 ms, %s, output: {interval: 0.1 ms}}
"""
# Values for parameters that a law requires, whatever the law.
VALUES = {"K": "1e7", "D": "50", "restitution": "0.8", "mu": "0.1", "mu_s": "0.15", "mu_k": "0.1", "v0": "1e-3",
          "v1": "1e-2", "v_r": "1e-2", "xi": "10", "v_stribeck": "1e-2", "sigma0": "1e5", "vs": "1e-2",
          "force": '"1e7 N/m*delta"', "coefficient": '"0.1*tanh(vt/(1 cm/s))"'}
KINETIC = 0.5 * 0.2 * (0.05**2 + 0.02**2) + 0.5 * 4e-6 * 20**2  # at the start [J]


class Ledger(ProgramTest):
    def listed(self, kind):
        return [entry["name"] for entry in json.loads(self.freeplay("list", "--json")[0]) if entry["kind"] == kind]

    def words(self, law, kind):
        """NAME, and what the law cannot do without."""
        entries = json.loads(self.freeplay("describe", law, "--json")[0])
        entries = entries if isinstance(entries, list) else [entries]  # laws of two kinds may share a name
        entry = next(entry for entry in entries if entry["kind"] == kind)
        needed = [p["name"] for p in entry["parameters"] if p["required"]]
        return ", ".join([law] + ["%s: %s" % (name, VALUES[name]) for name in needed])

    def rows(self, contact, friction, steps):
        self.write("m.yaml", MODEL % (contact, friction, steps))
        done = subprocess.run([PROGRAM, "run", "m.yaml", "--quiet", "--out", "r"], cwd=self.folder, capture_output=True,
                              text=True)
        self.assertEqual(0, done.returncode, done.stderr)
        rows = list(csv.DictReader(self.read("r", "results.csv").splitlines()))
        return {name: [float(row["energy." + name]) for row in rows] for name in ("dissipated", "residual", "potential")}

    def integrators(self):
        """How each integrator is asked, and the part of the energy that may be left over."""
        for name in self.listed("integrator"):
            out = json.loads(self.freeplay("describe", name, "--json")[0])
            adaptive = "always adaptive" in out["summary"]
            yield name, ("accuracy: 1 nm" if adaptive else "step: 2 us") + ", integrator: " + name, 1e-6 if adaptive else 2e-3

    def check(self, contact, friction, steps, part):
        energy = self.rows(contact, friction, steps)
        elastic = friction == "none" and "restitution" not in contact and "D:" not in contact
        rounding = 1e-15
        self.assertLessEqual(max(abs(x) for x in energy["residual"]), part * KINETIC)
        if elastic:
            self.assertLessEqual(max(abs(x) for x in energy["dissipated"]), rounding)
        elif not friction.startswith("lugre"):  # whose bristles give back what they store
            falls = [b - a for a, b in zip(energy["dissipated"], energy["dissipated"][1:])]
            self.assertGreaterEqual(min(falls), -rounding)
            self.assertGreater(energy["dissipated"][-1], 0.0)
        self.assertGreaterEqual(energy["dissipated"][-1], -rounding)

    def test_every_contact_law_with_every_integrator(self):
        laws = [self.words(law, "contact") for law in self.listed("contact")]
        self.assertGreater(len(laws), 12)
        for name, steps, part in self.integrators():
            for law in laws:
                with self.subTest(integrator=name, law=law):
                    self.check(law, "none", steps, part)

    def test_every_friction_law_with_every_integrator(self):
        laws = [self.words(law, "friction") for law in self.listed("friction")]
        self.assertGreater(len(laws), 8)
        for name, steps, part in self.integrators():
            for law in laws:
                with self.subTest(integrator=name, friction=law):
                    self.check("flores, restitution: 0.8", law, steps, part)

    def test_rows_inside_an_impact_close_as_the_ends_of_its_steps_do(self):
        """The block of Flores, Leine and Glocker through its first impact: 1e-8 of the energy at the start."""
        self.freeplay("run", os.path.join(ROOT, "mechanisms", "benchmark", "translational.yaml"), "--set", "mu=0",
                      "--accuracy", "100 nm", "--end", "3 ms", "--interval", "1 us", "--quiet", "--out", "r")
        rows = list(csv.DictReader(self.read("r", "results.csv").splitlines()))
        start = float(rows[0]["energy.kinetic"]) + float(rows[0]["energy.potential"])
        self.assertGreater(float(rows[-1]["energy.dissipated"]), 3e-3 * start)
        self.assertLess(max(abs(float(row["energy.residual"])) for row in rows), 4e-9 * start)


if __name__ == "__main__":
    unittest.main()
