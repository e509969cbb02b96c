"""The tables of docs/performance.md, each between `<!-- bench NAME -->` and `<!-- end -->`."""
import os
import re

import formulas
import studies
from problems import PROBLEMS, ROOT

PAGE = os.path.join(ROOT, "docs", "performance.md")
BLOCK = re.compile(r"(<!-- bench (\S+) -->\n).*?(<!-- end -->)", re.S)


def markdown(heading, rows):
    lines = ["| " + " | ".join(heading) + " |", "|" + "---|" * len(heading)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def how(record):
    unit = {"step": " s", "accuracy": " m"}[record["kind"]] if "kind" in record else ""
    return "`%s`%s %g%s" % (record.get("integrator") or record["method"], " " + record["kind"] if "kind" in record else "",
                            record["value"], unit)


def of_problem(found):
    text = markdown(["cheapest with at most %g m" % found["target"], "error [m]", "steps", "wall s/s"], [
        [how(r), "%.1e" % r["error"], r["steps"], "%.3g" % r["rate"]] for r in sorted(found["best"], key=lambda r: r["rate"])])
    pairs = found.get("comparisons", [])
    if not pairs:
        return text
    return text + "\n" + markdown(["ours", "error [m]", "steps", "wall s/s", "by hand", "error [m]", "steps", "wall s/s", "ratio"], [
        [*side(pair["ours"], pair["rate"]), *side(pair["theirs"], pair["their_rate"]), "**%.3g**" % pair["ratio"]]
        for pair in pairs])


def side(record, rate):
    return [how(record), "%.1e" % record["error"], record["steps"], "%.3g" % rate]


def of_growth(found):
    parts = [("", found)] + [("\n%s\n\n" % words, found[key]) for key, words in (
        ("in_space", "The chain of bodies in space:"), ("on_pins", "On pins, with 3 N redundant constraints:")) if key in found]
    return "".join(heading + growth_table(part) for heading, part in parts)


def growth_table(found):
    rows = [[run["windows"], "%.3g" % run["seconds_per_step"], "%.3g" % run["seconds_of_start"],
             "%.3g" % run["process_seconds"], "%.0f" % (run["peak_bytes"] / 1e6)] for run in found["runs"]]
    return markdown(["N", "seconds per step", "start of the run [s]", "process of two steps [s]", "peak memory [MB]"], rows) + \
        "\nTime per step grows as N^%.2f from the first N to the last; fitted to all as N^%.2f, between neighbours at most as N^%.2f.\n" % (
            found["from_first_to_last"], found["exponent"], found["steepest"])


def of_start(found):
    columns = ["median [ms]", "least [ms]", "processor [ms]", "to the end of the step [ms]"]
    return markdown(["process with one step", *columns], [
        [name] + ["%.1f" % (1e3 * min(numbers)) for numbers in (
            [one["median"]], one["seconds"], one["processor"], one["first_step"])]
        for name, one in found.items()])


def of_load(found):
    return markdown(["read and checked", "seconds"], [[name, "%.3g" % seconds] for name, seconds in found.items()])


def of_output(found):
    return markdown(["run", "rows", "wall without [s]", "wall", "process", "processor"], [
        [name, one["rows"], "%.3g" % one["wall_without"], *("%+.1f %%" % (100.0 * one[what])
                                                           for what in ("wall", "seconds", "processor"))]
        for name, one in found.items()])


def of_kernels(found):
    return markdown(["kernel", "ns"], [[one["name"], "%.4g" % one["ns"]] for one in found["kernels"]])


def of_instructions(found):
    return markdown(found["heading"], found["rows"])


def of_formulas(found):
    return markdown(formulas.GROWTH, found["growth"]["rows"]) + "\n" + markdown(
        ["load", "formula: steps", "instructions a step", "plugin: steps", "instructions a step", "whole run"], found["beside"]["rows"])


def of_studies(found):
    return markdown(*studies.rows_of_engine(found)) + "\n" + markdown(*studies.rows_of_large(found))


MAKERS = {"kernels": of_kernels, "growth": of_growth, "startup": of_start, "load": of_load, "output": of_output, "studies": of_studies, "instructions": of_instructions, "loose-slider": of_instructions, "formulas": of_formulas,
          **{name: of_problem for name in PROBLEMS}}


def rewritten(text, results):
    """The page with the tables of the parts that were measured; the others stay."""
    machine = results["machine"]

    def block(match):
        name = match[2]
        if name not in results:
            return match[0]
        taken = "`./dev bench %s`, %s, %d cores (%s):\n\n" % (name, results["date"], machine["cores"], machine["processor"])
        return match[1] + taken + MAKERS[name](results[name]) + match[3]
    return BLOCK.sub(block, text)


def rewrite(results):
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(rewritten(text, results))
