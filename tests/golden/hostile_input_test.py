"""Inputs that are made to cost time or memory are refused, or read, in 512 MiB and without hanging (one of 16 MiB takes up to
2 s; what takes 20 s of the processor is killed)."""
import os
import resource
import subprocess
import unittest

from program import PROGRAM, ProgramTest

HEAD = "freeplay: 1\n"
CRANK = HEAD + ("bodies: {crank: {mass: 1 kg, inertia: 1 kg*m^2}}\n"
                "joints: {A: {type: revolute, between: [ground, crank]}}\n")
LARGEST = 1 << 24  # bytes of an input file
MEMORY = 512 << 20


def filled(begin, unit, end="", size=LARGEST // 8):
    """Of an eighth of what is allowed: time and memory of most inputs are as their length."""
    return begin + unit * ((size - len(begin) - len(end)) // len(unit.encode())) + end


def lines(text, count):
    return "".join(text.format(i, i + 1) for i in range(count))


def instances(content, count):
    return HEAD + "templates: {t: {%s}}\ninstances: {i: {template: t, count: %d}}\n" % (content, count)


def drivers(tables):
    """A model with a body, a joint and a driver for each table."""
    count = len(tables)
    return (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", count) +
            "joints:\n" + lines("  j{0}: {{type: revolute, between: [ground, b{0}]}}\n", count) +
            "drivers:\n" + "".join("  d%d: {joint: j%d, kind: angle, table: %s}\n" % (i, i, table)
                                   for i, table in enumerate(tables)))


BODY = "bodies: {b: {mass: 1, inertia: 1}}, joints: {j: {type: revolute, between: [ground, b]}}"
LINK = ('<link name="l{0}"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>')
JOINT = '<joint name="j{0}" type="{{}}"><parent link="l{0}"/><child link="l{1}"/><axis xyz="0 0 1"/></joint>'


class HostileInput(ProgramTest):
    def cost(self, name, text, code, *ids):
        """Reads a file in a child and checks what it says and what it takes."""
        self.write(name, text)
        with open(self.path("messages"), "wb") as messages:
            child = subprocess.Popen([PROGRAM, "validate", "--no-assemble", name], cwd=self.folder,
                                     stdout=subprocess.DEVNULL, stderr=messages,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (20, 20)))
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        said = self.read("messages")[:400]
        os.remove(self.path(name))
        self.assertEqual(code, child.returncode, said)
        self.assertLess(usage.ru_maxrss * 1024, MEMORY if len(text) > LARGEST // 8 else MEMORY // 2, said)
        for word in ids:
            self.assertIn(word, said)

    def each(self, ending, code, cases):
        for name, (text, *ids) in cases.items():
            with self.subTest(name):
                self.cost("m." + ending, text, code, *ids)

    def test_yaml_that_is_deep_long_or_wide(self):
        laughs = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
        laughs += "".join("a%d: &a%d [%s]\n" % (i, i, ", ".join(["*a%d" % (i - 1)] * 9)) for i in range(1, 40))
        self.each("yaml", 3, {
            "open brackets": (filled("", "[", size=LARGEST), "[too-large]"),
            "empty brackets": (filled("[", "[],"), "[too-large]"),
            "commas": (filled("[", ","), "[too-large]"),
            "dashes": (filled("", "- ", size=LARGEST), "[too-large]"),
            "question marks": (filled("", "? "), "error:"),
            "keys in one map": (lines("k{0}: 1\n", 900000), "error:"),
            "the same key": (filled("", "k: 1\n"), "[duplicate-key]"),
            "tags": (filled("", "- !t b\n"), "[yaml-feature]"),
            "anchors": (filled("", "- &a b\n"), "[too-large]"),
            "aliases that explode": (laughs, "[too-large]"),
            "a long key": (filled(HEAD, "a", ": 1\n"), "error:"),
            "a long number": (filled(HEAD + "gravity: ", "1", size=LARGEST), "error:"),
            "a quote that is never closed": (filled(HEAD + 'name: "', "a"), "[yaml-syntax]"),
            "null bytes": (filled("", "\0", size=LARGEST), "[yaml-syntax]"),
            "byte-order marks": (filled("", "\ufeff"), "error:"),
            "a file too large": (filled("", "a", size=LARGEST) + "aa", "[too-large]"),
        })

    def test_models_with_mistakes_without_end(self):
        self.each("yaml", 3, {
            "unknown keys of every instance": (instances("bodies: {b: {mass: 1, inertia: 1, %s}}" %
                                                         lines("k{0}: 1, ", 1000), 190000), "error:"),
            "missing keys of every instance": (instances("bodies: {b: {mas: 1, inertia: 1}}", 150000), "[missing-key]"),
            "unknown bodies": (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", 50000) + "forces:\n" +
                               lines("  f{0}: {{type: torque, on: c{0}, value: 1 N*m}}\n", 50000), "[unknown-name]"),
            "unknown parameters": (HEAD + "parameters:\n" + lines("  p{0}: $q{0}\n", 100000), "[unknown-name]"),
            "unknown channels": (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", 20000) +
                                 "simulation: {output: {channels: [%s]}}\n" % lines("x{0}, ", 20000), "[unknown-name]"),
            "unknown channels that stop": (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", 20000) +
                                           "simulation: {stop: [%s]}\n" % lines("{{channel: x{0}, above: 1}}, ", 20000),
                                           "[unknown-name]"),
            "patterns of bodies": (HEAD + "bodies:\n" + lines("  b" + "a" * 50 + "{0}: {{mass: 1, inertia: 1}}\n", 60000) +
                                   "forces:\n" + lines('  f{0}: {{type: gravity, on: ["' + "*a" * 20 + 'b{0}"], value: [0, 0]}}\n',
                                                       9000), "error:"),
            "the same pattern": (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", 60000) +
                                 "forces: {g: {type: gravity, on: [%s], value: [0, 0]}}\n" % ('"*", ' * 3000), "[too-large]"),
            "patterns of channels": (HEAD + "bodies:\n" + lines("  b{0}: {{mass: 1, inertia: 1}}\n", 20000) +
                                     "simulation: {output: {channels: [%s]}}\n" % lines('"*x{0}*", ', 20000),
                                     "[too-large]"),
        })

    def test_instances_that_explode(self):
        self.each("yaml", 3, {
            "parameters": (instances("parameters: {%s}, " % lines("p{0}: 1, ", 1000) + BODY, 60000), "[too-large]"),
            "frames": (instances(BODY + ", frames: {%s}" % lines("b/f{0}: [0, 0], ", 10000), 60000), "[too-large]"),
            "expressions": (instances('bodies: {b: {mass: "%s1", inertia: 1}}' % ("1+" * 4900), 190000), "[too-large]"),
            "points": (instances(BODY + ", drivers: {d: {joint: j, kind: angle, table: {points: [%s]}}}" %
                                 lines("[{0}, 1], ", 10000), 60000), "[too-large]"),
            "patterns": (instances(BODY + ', forces: {g: {type: gravity, on: ["*"], value: [0, 0]}}', 50000),
                         "[too-large]"),
            "elements": (instances(BODY, 1000000), "[too-large]"),
        })

    def test_expressions_that_are_long_or_many(self):
        self.each("yaml", 0, {
            "sums": (CRANK + "parameters:\n" + "".join('  p%d: "%s1"\n' % (i, "1+" * 4900) for i in range(400)),),
        })
        self.each("yaml", 3, {
            "one": (filled(CRANK + "parameters: {a: '", "1+", "1'}\n"), "[bad-expression]"),
            "references": (CRANK + "parameters: {a: '%s'}\n" % lines("$p{0}+", 1500000), "error:"),
            "parentheses": (CRANK + "parameters: {a: '%s'}\n" % ("(" * 9000), "[bad-expression]"),
        })

    def test_tables_that_are_long_wide_or_many(self):
        self.write("rows.csv", "t,x\n" + lines("{0},1\n", 1000000))
        self.each("yaml", 0, {
            "one": (drivers(["rows.csv"]),),
            "the same": (drivers(["rows.csv", "./rows.csv"] * 150),),
        })
        ways = ["{file: rows.csv, outside: %s}" % word for word in ("hold", "repeat", "error")]
        self.each("yaml", 3, {"different": (drivers(ways), "[too-large]")})
        for name, text in {"columns": filled("", ","), "short rows": filled("t,x\n", "1\n"),
                           "a number": filled("t,x\n0,", "1"), "null bytes": filled("", "\0")}.items():
            with self.subTest(name):
                self.write("rows.csv", text)
                self.cost("m.yaml", drivers(["rows.csv"]), 3, "error:")

    def test_urdf_that_is_deep_long_or_wide(self):
        chain = "<robot name='r'>" + lines(LINK, 20000) + lines(JOINT, 19999).replace("{}", "continuous") + "</robot>"
        ring = chain.replace('<child link="l19999"/>', '<child link="l0"/>')
        self.each("urdf", 0, {"a chain": (chain,), "fixed joints": (chain.replace("continuous", "fixed"),)})
        self.each("urdf", 3, {
            "a ring": (ring, "[bad-urdf]"),
            "open elements": (filled("", "<a>"), "[too-large]"),
            "elements": (filled("<robot name='r'>", "<a/>", size=LARGEST), "[too-large]"),
            "links without a name": ("<robot name='r'>" + "<link/>" * 990000 + "</robot>", "[bad-urdf]"),
            "attributes": ("<robot " + lines("a{0}='1' ", 900000) + "/>", "[too-large]"),
            "an attribute": (filled("<robot name='", "a", "'/>"), "error:"),
            "references": (filled("<robot name='r'>", "&amp;", "</robot>"), "error:"),
            "a document type": ("<!DOCTYPE r [" + "<!ENTITY a 'aaaaaaaaaa'>" * 100000, "[bad-urdf]"),
            "a comment": (filled("<!--", "a", "--><robot name='r'/>"), "[bad-urdf]"),
            "a comment that never ends": (filled("<!--", "a"), "[bad-urdf]"),
        })


if __name__ == "__main__":
    unittest.main()
