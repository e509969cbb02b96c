"""Some seconds of random calls with random arguments: each returns or raises, and the interpreter lives."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS = float(os.environ.get("FREEPLAY_RANDOM_SECONDS", "8"))
CALLS = r"""
import faulthandler, math, random, sys, threading, time, warnings
import numpy as np
import freeplay
faulthandler.enable()
warnings.simplefilter("ignore")
seed, seconds, model_path = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
chance = random.Random(seed)
ROD = '''freeplay: 1
gravity: [0, -9.81]
bodies: {rod: {mass: 1 kg, inertia: 0.1, com: [0.5, 0]}}
joints: {pivot: {type: revolute, between: [ground, rod]}}
drivers: {motor: {joint: pivot, kind: torque, input: 0 N*m}}
simulation: {end: 20 ms, step: 1 ms, output: {interval: 2 ms}}
'''
values = [None, True, 0, -1, 3, 1e-3, 5e-3, 1e300, math.nan, math.inf, 2**70, "", "2 ms", "1 kg", "\0", "\ud800", "*", "time", "motor", "rod", b"x", [], [1.0], {}, {"c": [1e-4]},
          np.float64(1e-3), np.array([1e-4, 2e-4]), np.zeros((2, 2)), object(), ROD, "freeplay: 1\nbodies: {", model_path, lambda *a: 1 / 0, ("body.rod.x", "max"), {"a": ("body.rod.x", "max")}]
kept = [freeplay.load(ROD), freeplay.load(ROD).simulation(), freeplay.run(ROD)]
names = ["load", "check", "run", "open", "compare", "map", "types", "describe", "schema", "Function"]
words = ["set", "end", "step", "accuracy", "channels", "interval", "reduce", "workers", "rows", "until", "points", "pose", "grid", "time", "progress", "ideal", "errors", "format", "inputs", "elbow"]

def call():
    owner = chance.choice([freeplay, chance.choice(kept)])
    name = chance.choice(names if owner is freeplay else [n for n in dir(type(owner)) if n not in ("save", "__class__", "__del__", "__init__") and not n.startswith("__sub")])
    thing = getattr(owner, name)
    if not callable(thing):
        return thing
    first = [chance.choice(values) for _ in range(chance.randint(0, 2))]
    if owner is freeplay and chance.random() < 0.5:
        first = [chance.choice([ROD, kept[0], {"freeplay": 1}]), *first[1:]]
    return thing(*first, **{chance.choice(words): chance.choice(values) for _ in range(chance.randint(0, 2))})

until, count = time.time() + seconds, 0
while time.time() < until:
    count += 1
    try:
        got = call()
        if isinstance(got, (freeplay.Model, freeplay.Simulation, freeplay.Result)):
            kept = (kept[:1] + [got] + kept[1:])[:6]
        if isinstance(got, freeplay.Simulation) or chance.random() < 0.02:
            kept.append(freeplay.load(ROD).simulation())
    except freeplay.InternalError as error:
        sys.exit(f"{type(error).__name__}: {error}")
    except (Exception, freeplay.Interrupted):
        pass
print(count)
"""


class RandomCalls(unittest.TestCase):
    def test_none_ends_the_interpreter(self):
        seed = int.from_bytes(os.urandom(3), "big")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", CALLS, str(seed), str(SECONDS), str(ROOT / "mechanisms/pendulum.yaml")], cwd=folder, capture_output=True, text=True)
        self.assertEqual(0, done.returncode, f"seed {seed}: {done.stderr[-3000:]}")
        self.assertGreater(int(done.stdout), 10)


if __name__ == "__main__":
    unittest.main()
