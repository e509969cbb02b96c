"""Same bytes on every processor: elementary functions of the program and of the libraries that it loads are the program's own."""
import json
import os
import re
import subprocess
import unittest

from program import BUILD, MECHANISMS, PROGRAM, ROOT, ProgramTest, mechanism

LIBRARY = os.path.join(BUILD, "plugins", "tests", "wavy_spring.so")
LIST = os.path.join(ROOT, "core", "base", "elementary_functions.list")
MODEL = """freeplay: 1
bodies: {disc: {mass: 1 kg, inertia: 0.05}}
joints:
  pin: {type: revolute, between: [ground, disc]}
  spring: {type: wavy-spring, between: [ground, disc], stiffness: 5 N*m}
drivers: {push: {joint: pin, kind: torque, value: 3*exp(-t)*sin(20*t) + log(1 + t)^1.5}}
initial: {joints: {pin: 0.7}}
simulation: {end: 2 s, step: 1 ms, output: {interval: 10 ms}}
"""
# What the C library chooses by processor: as if this one had neither FMA nor AVX2.
OLDER_PROCESSOR = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4"}

# Of the mathematical library: exact in every implementation, or about bits and the environment.
EXACT = re.compile(r"""^(?:ceil|conj|copysign|cimag|creal|cproj|drem|fabs|fdim|finite|floor|fma|fmax\w*?|fmin\w*?|fmod|frexp|ilogb|ldexp|llogb|
    llrint|llround|logb|lrint|lround|modf|nan|nearbyint|next\w+|remainder|remquo|rint|round|roundeven|scalb|scalbln|scalbn|significand|sqrt|
    trunc|canonicalize|u?fromfpx?|[gs]etpayload(?:sig)?|totalorder(?:mag)?|fe[a-z]+|matherr|signgam|
    __(?:finite|fpclassify|iscanonical|iseqsig|issignaling|signbit)|f?d?(?:add|sub|mul|div|sqrt|fma))[fl]?$""", re.X)
OTHER_TYPE = re.compile(r"^(?!ceil$|floor$).*(?:l|l_r|f(?:32|64|128|32x|64x)(?:_r)?)$")
SANITIZER = re.compile(r"/lib[a-z]+san\.so")
# GNU's names for what has another, and names without a header.
UNUSUAL = {"gamma", "gammaf", "clog10", "clog10f", "__clog10", "__clog10f", "pow10", "pow10f"}
# The list says why they are not in it.
INVERSE_OF_COMPLEX = {"ca" + name for name in ("cos", "cosf", "cosh", "coshf", "sin", "sinf", "sinh", "sinhf", "tan", "tanf",
                                               "tanh", "tanhf")}


def symbols(library, *options):
    lines = subprocess.run(["nm", "-D", *options, library], capture_output=True, text=True, check=True).stdout.splitlines()
    return {line.split()[-1].split("@")[0] for line in lines if line.split()[-2] in "TtWwiU"}


class ArithmeticTest(ProgramTest):
    def bindings(self, *arguments):
        """Of a run with a library: (from, to, symbol) as the system's linker binds them, files by their names."""
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, check=True,
                              env={**os.environ, "LD_DEBUG": "bindings", "LD_BIND_NOW": "1"})
        found = re.findall(r"binding file (\S+) \[\d+\] to (\S+) \[\d+\]: normal symbol `(\w+)'", done.stderr)
        self.assertTrue(found, done.stderr[:1000])
        return found

    def test_what_is_loaded_takes_elementary_functions_from_the_program(self):
        self.write("m.yaml", MODEL)
        bindings = self.bindings("run", "m.yaml", "--plugin", LIBRARY, "--out", "r", "--quiet")
        system = {to for _, to, _ in bindings if os.path.basename(to).startswith("libm.so")}
        # What the program defines itself, it takes to watch calls of it: sanitizers that are linked in do.
        watched = {(PROGRAM, symbol) for symbol in symbols(PROGRAM, "--defined-only")}
        strays = {(source, symbol) for source, to, symbol in bindings
                  if to in system and source not in system and not EXACT.match(symbol) and not SANITIZER.search(source)} - watched
        self.assertEqual(set(), strays)
        own = {symbol for source, to, symbol in bindings if source == LIBRARY and to == PROGRAM}
        self.assertLessEqual({"sin", "cos", "tan", "atan", "tanh", "exp", "expm1", "log", "pow", "cbrt", "sinh", "erf", "sinf"},
                             own | ({"sin", "cos"} if "sincos" in own else set()))

    def test_the_program_has_every_function_that_the_system_might_choose_by_processor(self):
        with open(LIST, encoding="utf-8") as file:
            names = set(re.findall(r"\w+(?=;)", file.read()))
        exported = symbols(PROGRAM, "--defined-only")
        self.assertEqual(set(), names - exported)
        maps = self.bindings("list", "joints", "--quiet")
        library = next(to for _, to, _ in maps if os.path.basename(to).startswith("libm.so"))
        left = {name for name in symbols(library, "--defined-only")
                if not EXACT.match(name) and not OTHER_TYPE.match(name) and not name.endswith("_finite")}
        self.assertEqual(set(), left - names - UNUSUAL - INVERSE_OF_COMPLEX)
        taken = symbols(PROGRAM, "--undefined-only") & symbols(library, "--defined-only")
        self.assertEqual([], sorted(name for name in taken if not EXACT.match(name)))

    def files(self, folder, *arguments, environment=None):
        self.freeplay("run", *arguments, "--quiet", "--out", folder, environment=environment)
        found = {}
        for name in ("results.csv", "events.csv"):
            with open(self.path(folder, name), "rb") as file:
                found[name] = file.read()
        record = json.loads(self.read(folder, "summary.json"))["provenance"]
        return found, record["hashes"], record["arithmetic"]

    def test_results_have_the_same_bytes_on_an_older_processor(self):
        self.write("m.yaml", MODEL)
        folders = (MECHANISMS, os.path.join(MECHANISMS, "spatial"))
        shipped = sorted(os.path.join(folder, name) for folder in folders for name in os.listdir(folder) if name.endswith(".yaml"))
        runs = [("m.yaml", "--plugin", LIBRARY), *((model, "--end", "40 ms", "--interval", "0.5 ms") for model in shipped)]
        self.assertLessEqual(12, len(runs))
        for i, run in enumerate(runs):
            with self.subTest(run[0]):
                here = self.files("here-%d" % i, *run)
                self.assertEqual(here, self.files("older-%d" % i, *run, environment=OLDER_PROCESSOR))
                self.assertRegex(here[2], "^[0-9a-f]{16}$")

    def test_analyses_have_the_same_bytes_on_an_older_processor(self):
        pose = ("--pose", "0.05,0,0")
        for words in (("error", *pose, "--samples", "2000"), ("singularity", *pose)):
            with self.subTest(words[0]):
                words = ("analyze", words[0], mechanism("4-rrr"), *words[1:], "--json")
                self.assertEqual(self.freeplay(*words)[0], self.freeplay(*words, environment=OLDER_PROCESSOR)[0])


if __name__ == "__main__":
    unittest.main()
