"""What formulas of the motion cost: loading and runs with 100 to 10 000 of them, and one beside the same load in C++.

All of it is counted in machine instructions by valgrind, which repeat on a busy machine."""
import os
import re
import subprocess

from instructions import count
from tables import table
from timing import Failed

STEP, STEPS = 1e-3, 4
LOAD = "(%s N/m + 10 N/m^2*abs(joint.rail.position))*joint.rail.position"
SLED = """freeplay: 1
bodies: {sled: {mass: 1, inertia: 1}}
joints: {rail: {type: prismatic, between: [ground, sled]}}
%s
initial: {joints: {rail: 0.1}}
simulation: {end: 1 s, step: 1 ms, output: {interval: 1 s, channels: ["body.sled.x"]%s}}
"""


def forces(n):
    return SLED % ("forces:\n" + "".join('  f%d: {type: force, at: sled, value: ["-%s - 0.1 N*s/m*body.sled.vx", 0]}\n'
                                         % (i, LOAD % repr(1 / n + 1e-9 * i)) for i in range(n)), "")


def springs(n):
    return SLED % ("forces:\n" + "".join("  f%d: {type: spring-damper, between: [ground, sled], free_length: 0.05, "
                                         'spring: "(%r N/m + 10 N/m^2*abs(x))*x", damper: "0.1 N*s/m*v"}\n' % (i, 1 / n + 1e-9 * i)
                                         for i in range(n)), "")


def columns(n):
    return SLED % ("", ", columns: {%s}" % ", ".join('c%d: "%d*body.sled.x + joint.rail.speed*1 s"' % (i, i) for i in range(n)))


def parameters(n):
    return "parameters:\n  p0: 1 N\n" + "".join("  p%d: 2*$p%d - 1 N\n" % (i, i - 1) for i in range(1, n)) + SLED % (
        "forces: {f: {type: force, at: sled, value: [$p%d, 0]}}" % (n - 1), "")


def on_bodies(n):
    """Each on a body of its own, by the names of its body and its joint."""
    each = range(n)
    return "freeplay: 1\nbodies:\n%sjoints:\n%sforces:\n%sinitial: {joints: {%s}}\n%s" % (
        "".join("  b%d: {mass: 1, inertia: 1}\n" % i for i in each),
        "".join("  j%d: {type: prismatic, between: [ground, b%d]}\n" % (i, i) for i in each),
        "".join('  f%d: {type: force, at: b%d, value: ["-(1 N/m + 10 N/m^2*abs(joint.j%d.position))*joint.j%d.position - 0.1 N*s/m*body.b%d.vx", 0]}\n'
                % (i, i, i, i, i) for i in each),
        ", ".join("j%d: 0.1" % i for i in each),
        'simulation: {end: 1 s, step: 1 ms, output: {interval: 1 s, channels: ["body.b0.x"]}}\n')


# With the largest number that valgrind, fifty times as slow as the program, counts in a minute.
KINDS = (("forces on one body", forces, 1000), ("formulas of springs", springs, 1000), ("columns", columns, 10000),
         ("parameters, each of the one before", parameters, 10000), ("forces on a body each", on_bodies, 1000))

# A crank with a flywheel turns a slider against a load by its place and speed.
MACHINE = """freeplay: 1
%s
gravity: [0, -9.81]
bodies:
  crank: {mass: 1, inertia: 0.2, frames: {tip: [0.1, 0]}}
  rod: {mass: 0.5, inertia: 2e-3, com: [0.15, 0], frames: {tip: [0.3, 0]}}
  slider: {mass: 0.8, inertia: 1e-3}
joints:
  main: {type: revolute, between: [ground, crank]}
  pin: {type: revolute, between: [crank/tip, rod]}
  wrist: {type: revolute, between: [rod/tip, slider]}
  guide: {type: prismatic, between: [ground, slider]}
drivers: {motor: {joint: main, kind: torque, value: 3 N*m}}
forces:
  load: %s
initial: {joints: {main: 30 deg}, speeds: {main: 20 rad/s}}
simulation: {end: 0.2 s, step: 0.1 ms, output: {interval: 0.2 s, channels: ["body.slider.x"]}}
"""
SMOOTH = ("{type: force, at: slider, value: ['-(50 N/m + 800 N/m^3*joint.guide.position^2)*joint.guide.position - 5 N*s/m*joint.guide.speed', 0]}",
          "{type: slide-load, between: [ground, slider], linear: 50, cubic: 800, damping: 5}")
KINKED = ("{type: force, at: slider, value: ['-(50 N/m + 200 N/m^2*abs(joint.guide.position))*joint.guide.position - 5 N*s/m*joint.guide.speed', 0]}",
          "{type: slide-load, between: [ground, slider], linear: 50, quadratic: 200, damping: 5}")
BESIDE = (("smooth, steps of 0.1 ms", SMOOTH, ["--step", "1e-4"]), ("with abs, steps of 0.1 ms", KINKED, ["--step", "1e-4"]),
          ("smooth, accuracy 1e-6 m", SMOOTH, ["--accuracy", "1e-6"]), ("with abs, accuracy 1e-6 m", KINKED, ["--accuracy", "1e-6"]))


GROWTH = ["formulas", "number", "instructions of loading, each", "of a step, each", "of all else in a run, each"]


def write(bench, name, text):
    path = os.path.join(bench.build, "models", name + ".yaml")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def whole(bench, *words):
    """Instructions of the whole process."""
    log = os.path.join(bench.build, "runs", "callgrind.out")
    os.makedirs(os.path.dirname(log), exist_ok=True)
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=" + log, bench.program.path, *words],
                          capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not found:
        raise Failed("%s: %s" % (" ".join(words), done.stderr.strip()[-2000:]))
    return int(found[1])


def growth(bench):
    """By kind: instructions of reading and checking, of a step, and of all else in a run (assembly, rows, summary), of each formula."""
    numbers = (10, 100) if bench.quick else (100, 1000, 10000)
    folder = os.path.join(bench.build, "runs", "counted")

    def counts(name, text):
        model = write(bench, name, text)
        runs = [whole(bench, "run", model, "--end", repr(STEP * steps), "--step", repr(STEP), "--quiet", "--force", "--out", folder)
                for steps in (2, 2 + STEPS)]
        return whole(bench, "validate", model, "--quiet"), runs[0], (runs[1] - runs[0]) / STEPS

    nothing = counts("formulas-none", SLED % ("", ""))
    rows, found = [], []
    for name, text, most in KINDS:
        for n in (number for number in numbers if number <= most):
            load, run, step = ((own - without) / n for own, without in zip(counts("formulas-%s-%d" % (text.__name__, n), text(n)), nothing))
            rest = run - load - 2 * step
            rows.append([name, n, "%.0f" % load, "%.0f" % step, "%.0f" % rest])
            found.append({"kind": name, "number": n, "load": load, "step": step, "rest": rest})
    bench.print(table(GROWTH, rows))
    return {"rows": rows, "found": found}


def beside(bench):
    """The same load as a formula and as a joint of a plugin in C++."""
    library = os.path.join(os.path.dirname(bench.program.path), "plugins", "tests", "slide_load.so")
    if not os.path.exists(library):
        raise Failed("'%s' is not built: cmake --build --preset release --target slide_load" % library)
    rows, found = [], []
    folder = os.path.join(bench.build, "runs", "counted")
    for name, (formula, plugin), options in BESIDE[:1] if bench.quick else BESIDE:
        ours = count(bench.program.path, write(bench, "load-formula", MACHINE % ("", formula)), options, folder)
        theirs = count(bench.program.path, write(bench, "load-plugin", MACHINE % ("plugins: [%s]" % library, plugin)),
                       [*options, "--allow-plugins"], folder)
        steps = [summary["counts"]["steps"] for _, summary in (ours, theirs)]
        each = [number / taken for (number, _), taken in zip((ours, theirs), steps)]
        rows.append([name, steps[0], "%.0f" % each[0], steps[1], "%.0f" % each[1], "%+.1f %%" % (100 * (ours[0] / theirs[0] - 1))])
        found.append({"name": name, "formula": ours[0], "plugin": theirs[0], "steps": steps})
    bench.print(table(["load", "formula: steps", "instructions a step", "plugin: steps", "instructions a step", "whole run"], rows))
    return {"rows": rows, "found": found}


def measure(bench):
    return {"growth": growth(bench), "beside": beside(bench)}
