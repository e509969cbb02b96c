"""What a loose slider costs beside a loose pin: the same slider-crank with play in its guide, and with play in its wrist.

Both let two rows go and are counted in machine instructions by valgrind, which repeat on a busy machine."""
import os

from instructions import count
from problems import ROOT
from tables import table

# Of each the joint with play; four corners touch two walls in one, one journal touches its bearing in the other.
MODELS = (("loose-pin", "wrist"), ("loose-slider", "guide"))

# In flight, and over two turns of the crank, of which either is in contact for nearly all.
RUNS = (("in flight", ["--end", "0.4 ms", "--integrator", "bathe", "--step", "0.1us"]),
        ("by steps", ["--integrator", "bathe", "--step", "2us"]),
        ("by accuracy", ["--accuracy", "1um"]),
        ("by accuracy", ["--accuracy", "1nm"]))
QUICK = (("in flight", ["--end", "0.02 ms", "--integrator", "bathe", "--step", "0.1us"]),)

HEADING = ["run", "by", "pin: steps", "in contact", "instructions a step", "slider: steps", "in contact", "instructions a step", "ratio"]


def measure(bench):
    rows, found = [], []
    for label, options in QUICK if bench.quick else RUNS:
        row, record = [label, " ".join(options[-2:]).replace("--", "")], {"name": label, "options": options}
        for name, joint in MODELS:
            instructions, summary = count(bench.program.path, os.path.join(ROOT, "tests", "bench", name + ".yaml"), options,
                                          os.path.join(bench.build, "runs", "counted"))
            steps, contact = summary["counts"]["steps"], summary["joints"][joint]["contact_fraction"]
            row += [steps, "%.0f %%" % (100.0 * contact), "%.0f" % (instructions / steps)]
            record[name] = {"steps": steps, "contact": contact, "instructions": instructions}
        record["ratio"] = (record["loose-slider"]["instructions"] / record["loose-slider"]["steps"]) / (
            record["loose-pin"]["instructions"] / record["loose-pin"]["steps"])
        rows.append([*row, "%.2f" % record["ratio"]])
        found.append(record)
    bench.print(table(HEADING, rows))
    return {"heading": HEADING, "rows": rows, "runs": found}
