"""`freeplay schema` says what models and summaries look like, for editors: checked with an independent validator."""
import copy
import json
import os
import re
import subprocess
import unittest

import jsonschema
import yaml

from program import BUILD, PROGRAM, ROOT, ProgramTest, mechanism

MECHANISMS = sorted(name[:-5] for name in os.listdir(os.path.join(ROOT, "mechanisms")) if name.endswith(".yaml"))
TEMPLATES = os.path.join(ROOT, "plugins", "template")


class Yaml12(yaml.SafeLoader):
    """YAML 1.2: `on` and `no` are words."""


Yaml12.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}
Yaml12.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))


def load(text):
    return yaml.load(text, Yaml12)


class SchemaTest(ProgramTest):
    def schema(self, *words):
        schema = json.loads(self.freeplay("schema", *words)[0])
        jsonschema.Draft202012Validator.check_schema(schema)
        return schema

    def faults(self, schema, document):
        return [error.message for error in jsonschema.Draft202012Validator(schema).iter_errors(document)]

    def mechanism(self, name):
        with open(mechanism(name), encoding="utf-8") as file:
            return load(file.read())

    def test_every_mechanism_fits(self):
        schema = self.schema()
        for name in MECHANISMS:
            self.assertEqual([], self.faults(schema, self.mechanism(name)), name)

    def test_the_pieces_of_the_model_page_fit(self):
        with open(os.path.join(ROOT, "docs", "model-file.md"), encoding="utf-8") as file:
            pieces = re.findall(r"^```yaml\n(.*?)^```", file.read(), re.M | re.S)
        self.assertEqual([], self.faults(self.schema(), load("".join(pieces))))

    def test_studies_fit(self):
        schema = self.schema("study")
        with open(os.path.join(ROOT, "docs", "studies.md"), encoding="utf-8") as file:
            page = re.search(r"^```yaml\n(.*?)^```", file.read(), re.M | re.S)[1]
        self.assertEqual([], self.faults(schema, load(page)))
        study = load("""
freeplay: 1
study:
  models: [a.yaml, b.yaml]
  zip: [[a, b]]
  axes:
    a: [1, 2 mm]
    b: {target: law, list: [flores, {law: hertz, K: 1}]}
    c: {cases: {slow: {v: 1}, fast: {v: 2, w: [1, 2]}}}
    d: 3 m
    e: {fit: [H7/g6, H8/e8], diameter: 10 mm}
  do: {analyze: error, pose: [0, 0, 0]}
  warm_start: {along: a}
  stop: {reducer: y, of: p95, relative: 0.01}
  reducers: {y: {summary: joints.pin.max_force}, z: {of: "2*[y]"}}
  plots: {p: {kind: line, x: a, y: y}}
""")
        self.assertEqual([], self.faults(schema, study))
        for change in (lambda d: d.update(bodies={}), lambda d: d.pop("study"), lambda d: d["study"].update(axis={}),
                       lambda d: d["study"].update(combine="mix"), lambda d: d["study"]["axes"]["b"].update(lst=1)):
            document = copy.deepcopy(study)
            change(document)
            self.assertNotEqual([], self.faults(schema, document))

    def test_a_wrong_key_or_word_does_not_fit(self):
        schema = self.schema()
        good = self.mechanism("slider-crank")
        self.assertEqual([], self.faults(schema, good))

        def spoilt(change):
            document = copy.deepcopy(good)
            change(document)
            return self.faults(schema, document)

        clearance = lambda document: next(j for j in document["joints"].values() if "clearance" in j)["clearance"]
        for change in (lambda d: d.update(bodiez={}),
                       lambda d: d.pop("freeplay"),
                       lambda d: d["bodies"]["slider"].update(mas=1),
                       lambda d: d["bodies"]["slider"].pop("inertia"),
                       lambda d: d["joints"]["guide"].update(type="prismatik"),
                       lambda d: d["joints"]["guide"].pop("type"),
                       lambda d: d["joints"]["guide"].pop("between"),
                       lambda d: d["joints"]["guide"].update(clearance={}),
                       lambda d: clearance(d).update(radios=1),
                       lambda d: clearance(d).pop("contact"),
                       lambda d: clearance(d)["contact"].update(restitutoin=1),
                       lambda d: clearance(d)["contact"].update(law="herz"),
                       lambda d: d["simulation"].update(integrator="bath"),
                       lambda d: d["simulation"].update(integrator={"type": "bathe", "splitt": 1}),
                       lambda d: d.update(forces={"f": {"type": "revolute", "between": ["ground", "slider"]}}),
                       lambda d: d.update(gravity=[0]),
                       lambda d: d.update(joints={"g": {"type": "gear", "of": ["a", "b"]}})):
            self.assertNotEqual([], spoilt(change))

    def test_notes_presets_and_empty_sections_fit(self):
        document = load("""
freeplay: 1
x-note: {anything: [1]}
presets: {steel: {mass: 1 kg, inertia: 1}, held: {type: revolute}}
bodies: {a: {use: steel, x-colour: red}, ground: {frames: {p: [0, 1]}}}
joints: {pin: {use: held, between: [ground/p, a]}, two: {type: revolute, bearing: ground, journal: a}}
drivers:
""")
        self.assertEqual([], self.faults(self.schema(), document))

    def test_types_of_a_plugin_are_known(self):
        for kind in ("joint", "contact", "friction", "integrator"):
            with open(os.path.join(TEMPLATES, kind + ".yaml"), encoding="utf-8") as file:
                document = load(file.read())
            library = os.path.join(BUILD, "plugins", "template", "template_%s.so" % kind)
            self.assertNotEqual([], self.faults(self.schema(), document), kind)
            self.assertEqual([], self.faults(self.schema("--plugin", library), document), kind)

    def test_a_summary_fits(self):
        schema = self.schema("summary")
        for name in ("four-bar", "slider-crank", "3-rrr"):
            self.freeplay("run", mechanism(name), "--end", "0.2 ms", "--out", name)
            summary = json.loads(self.read(name, "summary.json"))
            self.assertEqual([], self.faults(schema, summary), name)
            del summary["counts"]["steps"]
            self.assertNotEqual([], self.faults(schema, summary))

    def test_an_unknown_schema_is_refused_with_a_suggestion(self):
        _, err = self.freeplay("schema", "modl", code=2)
        self.assertIn("did you mean 'model'?", err)


class FormatTableTest(ProgramTest):
    """The table from which the schema and the reference pages are made, against the reader."""

    def documented(self):
        schema = json.loads(self.freeplay("schema")[0])
        yield "", schema
        for name, definition in schema["$defs"].items():
            if "x-where" in definition and name not in ("joint", "force", "integrator", "grid"):
                yield definition["x-where"], definition

    def around(self, where, content):
        """A model that holds `content` at a place such as bodies.NAME.pose."""
        for part in reversed(where.split(".")):
            content = {"n" if part == "NAME" else part: [content] if part == "stop" else content}
        model = {"freeplay": 1}
        model.update(content)
        if where.startswith("templates"):
            model["instances"] = {"i": {"template": "n"}}
        return model

    def unknown_keys(self, model):
        file = self.write("m.yaml", yaml.safe_dump(model))
        done = subprocess.run([PROGRAM, "validate", file, "--json", "--max-errors", "0"], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 3, 5), done.stderr)
        return [one["message"] for one in json.loads(done.stdout)["messages"] if one["id"] == "unknown-key"]

    def test_every_documented_key_is_read(self):
        tried = 0
        for where, definition in self.documented():
            for key, schema in definition["properties"].items():
                content = {key: load(schema["examples"][0])} if "examples" in schema else {key: 1}
                if "type" in definition["properties"]:
                    content.setdefault("type", load(definition["properties"]["type"]["examples"][0]))
                model = self.around(where, content) if where else {"freeplay": 1, **content}
                unknown = self.unknown_keys(model)
                if unknown and where:  # a key of spatial models alone
                    unknown = self.unknown_keys({**model, "space": "spatial"})
                if unknown and "file" in definition["properties"]:  # a key of what is read from a file
                    unknown = self.unknown_keys(self.around(where, {**content, "file": "numbers.csv"}))
                self.assertEqual([], unknown, "%s.%s" % (where, key))
                tried += 1
        self.assertGreater(tried, 100)


if __name__ == "__main__":
    unittest.main()
