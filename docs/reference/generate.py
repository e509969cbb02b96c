#!/usr/bin/env python3
"""Writes the reference pages from what the program says of itself: generate.py PROGRAM FOLDER."""
import json
import os
import subprocess
import sys

import python_page

HEAD = "<!-- Made by `./dev docs` from the tables that check model files; edit those. -->\n"


def ask(program, *words):
    return json.loads(subprocess.run([program, *words], capture_output=True, check=True, text=True).stdout)


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def code(text):
    return "`%s`" % cell(text) if text not in ("", None) else ""


def table(head, rows):
    lines = ["| %s |" % " | ".join(head), "|%s" % ("---|" * len(head))]
    return "\n".join(lines + ["| %s |" % " | ".join(row) for row in rows]) + "\n"


# --- the model file ------------------------------------------------------------------------------------------------

def sort_of(schema):
    """What may stand under a key, in words."""
    if "$ref" in schema:
        name = schema["$ref"].split("/")[-1]
        if name in ("quantity", "integer", "time-function", "vector", "text", "value"):
            return name.replace("-", " ")
        return "[%s](#%s)" % (name, name)
    if "anyOf" in schema:
        return " or ".join(sort_of(one) for one in schema["anyOf"])
    if "enum" in schema:
        words = schema["enum"]
        return ", ".join(code(word) for word in words) if len(words) < 9 else "name"
    if "const" in schema:
        return code(schema["const"])
    if schema.get("type") == "boolean":
        return "`true`, `false`"
    if schema.get("type") == "array":
        return "list of " + sort_of(schema["items"])
    if isinstance(schema.get("additionalProperties"), dict):
        return "map of names to " + sort_of(schema["additionalProperties"])
    return "map"


def required_keys(definition):
    required = set(definition.get("required", ()))
    for alternative in definition.get("anyOf", ()):
        if alternative.get("required") != ["use"]:
            required |= set(alternative.get("required", ()))
    return required


def map_section(name, definition):
    required = required_keys(definition)
    rows = []
    for key, schema in definition["properties"].items():
        fallback = "required" if key in required else schema.get("default", "")
        rows.append((code(key), sort_of(schema), cell(schema.get("x-unit", "")), cell(fallback),
                     cell(schema.get("description", "")), code(schema.get("examples", [""])[0])))
    text = "## %s\n\n" % (name or "the file")
    where = definition.get("x-where")
    if where:
        text += "%s: " % (code(where) if " " not in where else where.capitalize())
    text += definition.get("description", "The whole file.") + "\n\n"
    return text + table(("key", "value", "unit", "default", "meaning", "example"), rows) + "\n"


def model_page(schema):
    text = HEAD + ("# Keys of the model file\n\n[The model file](../model-file.md) explains it with examples; "
                   "this page is for looking up. Parameters of types are on the pages of [joints](joints.md), "
                   "[contact laws](contact-laws.md), [friction laws](friction-laws.md) and "
                   "[integrators](integrators.md). Keys that begin with `x-` are notes and are ignored everywhere.\n\n"
                   "A *quantity* is a number or an expression, with a unit if it is not SI; a *time function* is one "
                   "that may hold `t`, an *integer* one that comes to a whole number. A *vector* is a list of two "
                   "quantities, of three in space.\n\n")
    text += map_section("", schema)
    for name, definition in schema["$defs"].items():
        if "x-where" in definition and name not in ("joint", "force", "integrator"):
            text += map_section(name, definition)
        elif name in ("joint", "force", "integrator"):
            text += choice_section(name, definition)
    return text


def choice_section(name, definition):
    places = {"joint": "`joints.NAME`", "force": "`forces.NAME`", "integrator": "`simulation.integrator`"}
    words = definition["properties"]["type"]["enum"]
    text = "## %s\n\n%s: The other keys depend on `type`: " % (name, places[name])
    return text + ", ".join(code(word) for word in words) + ".\n\n"


# --- types ---------------------------------------------------------------------------------------------------------

def limits(parameter):
    low, high, length = parameter.get("minimum"), parameter.get("maximum"), parameter.get("length")
    variables = ", ".join(code(one["name"]) + ("" if one["unit"] == "1" else " [%s]" % one["unit"])
                          for one in parameter.get("variables") or [])
    if variables and not length:
        return "formula in " + variables
    if parameter.get("choices"):
        return ", ".join(code(word) for word in parameter["choices"])
    words = []
    if length:
        count = "%d to %d" % (length["minimum"], length["maximum"])
        words.append("%s points over %s" % (count, variables) if variables else "%s numbers" % count)
    if low is not None:
        words.append("%s %g" % (">" if parameter.get("exclusive_minimum") else ">=", low))
    if high is not None:
        words.append("%s %g" % ("<" if parameter.get("exclusive_maximum") else "<=", high))
    return ", ".join(words)


def type_section(entry):
    text = "## %s\n\n%s\n\n" % (entry["name"], entry["summary"])
    if entry["formula"]:
        text += "*Equations.* %s\n\n" % entry["formula"]
    if entry["validity"]:
        text += "*Validity.* %s\n\n" % entry["validity"]
    if entry["references"]:
        text += "*Source.* %s\n\n" % entry["references"]
    if entry["parameters"]:
        rows = [(code(p["name"]), cell(p["unit"]), cell(fallback(p)), cell(limits(p)), cell(p["summary"]))
                for p in entry["parameters"]]
        text += table(("key", "unit", "default", "range", "meaning"), rows) + "\n"
    for key, heading in (("channels", "Results"), ("channels_in_space", "Results in space")):
        if entry.get(key):
            text += "*%s.* %s.\n\n" % (heading, ", ".join(
                "%s%s" % (code(c["name"]), "" if c["unit"] == "1" else " [%s]" % c["unit"]) for c in entry[key]))
    return text


def fallback(parameter):
    if parameter.get("required"):
        return "required"
    value = parameter.get("default")
    return "" if value is None else value


def type_page(program, entries, title, introduction):
    text = HEAD + "# %s\n\n%s\n\n" % (title, introduction)
    for entry in entries:
        answer = ask(program, "describe", entry["name"], "--json")
        same = [one for one in (answer if isinstance(answer, list) else [answer]) if one["kind"] == entry["kind"]]
        text += type_section(same[0])
    return text


def pages(program):
    entries = ask(program, "list", "--json")
    kind = lambda word: [entry for entry in entries if entry["kind"] == word and entry["source"] == "built-in"]
    return {
        "model-file.md": model_page(ask(program, "schema")),
        "joints.md": type_page(program, kind("joint"), "Joints", "Types for `joints` of a model file. A type without "
                               "constraint rows may stand under `forces`, too."),
        "contact-laws.md": type_page(program, kind("contact"), "Contact laws", "Laws for `clearance.contact`: the "
                                     "normal force between journal and bearing."),
        "friction-laws.md": type_page(program, kind("friction"), "Friction laws", "Laws for `clearance.friction`: the "
                                      "tangential force between journal and bearing."),
        "python.md": python_page.page(),
        "integrators.md": type_page(program, kind("integrator"), "Integrators", "Types for `simulation.integrator`."),
    }


def main(program, folder):
    for name, text in pages(program).items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text.rstrip("\n") + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
