"""Includes stay within the dependency rule, and no file under core names a component."""
import json
import os
import re
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PLUGIN_FOLDERS = ("joints", "contact", "solvers", "plugins")

# Rooms of core, the lowest first: those that each stands on. It may include what those may, itself, and the SDK unless
# it is in WITHOUT_SDK.
STANDS_ON = {
    "base": [],
    "component": ["base"],
    "model": ["component"],
    "format": ["model"],
    "yaml": ["format"],
    "urdf": ["format"],
    "mjcf": ["urdf"],
    "sdf": ["urdf"],
    "convert": ["yaml"],
    "linear": ["base"],
    "system": ["model", "linear"],
    "stage": ["system"],
    "assembly": ["stage"],
    "run": ["assembly"],
    "results": ["run"],
    "svg": ["base"],
    "plot": ["results", "svg"],
    "analysis": ["assembly"],
    "drawing": ["analysis", "svg"],
    "load": ["yaml", "mjcf", "sdf", "run"],
    "report": ["results", "load"],
    "workers": ["base"],
    "job": ["results", "load", "workers"],
    "study": ["workers", "results", "load", "convert", "analysis", "svg"],
    "contract": ["format", "stage"],
    "python": ["load", "results", "convert", "drawing", "analysis", "contract", "study", "report", "job"],
    "cli": ["load", "convert", "plot", "drawing", "analysis", "contract", "report", "workers", "study", "job"],
}
WITHOUT_SDK = {"base", "linear", "svg", "workers"}


def rooms_below():
    below = {}
    for room, direct in STANDS_ON.items():
        below[room] = set(direct).union(*(below[lower] for lower in direct))
    return below


ROOMS = rooms_below()

# Besides names that begin with a dot, and what is made there: build and results.
TOP_LEVEL = {"README.md", "LICENSE", "CHANGELOG.md", "CMakeLists.txt", "CMakePresets.json", "dev", "core", "joints", "contact",
             "solvers", "mechanisms", "plugins", "tests", "docs"}

# Library headers by their first folder or name: the rooms that may include them.
EVERY_ROOM = set(ROOMS)
LIBRARIES = {
    "yaml-cpp": {"yaml"},
    "tinyxml2.h": {"urdf"},
    "expat.h": {"urdf"},
    "urdf_parser": {"urdf"},
    "urdf_model": {"urdf"},
    "console_bridge": {"urdf"},
    "klu.h": {"linear"},
    "SuiteSparseQR.hpp": {"linear"},
    "nettle": {"base"},
    "hdf5.h": {"results"},
    "matio.h": {"results"},
    "zlib.h": {"study"},
    "cxxabi.h": {"python"},
    "dlfcn.h": {"component", "python"},
    "elf.h": {"component"},
    "nlohmann": {"base"},
    "boost": {"study"},
    "CLI": {"cli"},
    "pybind11": {"python"},
    "fmt": EVERY_ROOM,
    "Eigen": EVERY_ROOM - {"base", "component", "model", "format", "yaml", "results", "svg", "plot", "load", "job", "cli", "python"},
}
# Libraries that may be missing: the files that are built only where they are.
OPTIONAL_LIBRARIES = {"solvers/sundials_": {"arkode", "nvector"}}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
STANDARD = re.compile(r"^[a-z_0-9]+$")
SYSTEM = {"unistd.h", "fcntl.h", "malloc.h", "poll.h", "pthread.h", "sched.h", "sys/file.h", "sys/ioctl.h", "sys/mman.h", "sys/prctl.h", "sys/resource.h", "sys/socket.h", "sys/stat.h", "sys/sysmacros.h", "sys/types.h", "sys/utsname.h", "sys/wait.h"}


def sources(*folders):
    for folder in folders:
        for path, _, files in os.walk(os.path.join(ROOT, folder)):
            for name in sorted(files):
                if name.endswith((".h", ".cpp", ".in")):
                    yield os.path.relpath(os.path.join(path, name), ROOT)


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def library_fault(first, room):
    """What is wrong with an include of a library by a room of core, or of a plugin folder (room None)."""
    if first in LIBRARIES:
        allowed = LIBRARIES[first] if room else {"Eigen"}
        return None if (room or first) in allowed else "%s is not for %s" % (first, room or "plugins")
    return "%s is not in the table of libraries" % first


def plugin_fault(path, target):
    folder = os.path.dirname(path)
    if target.startswith("freeplay/") or os.path.exists(os.path.join(ROOT, folder, target)):
        return None
    first = target.split("/")[0]
    if any(path.startswith(files) and first in libraries for files, libraries in OPTIONAL_LIBRARIES.items()):
        return None
    return library_fault(first, None)


def sdk_fault(target):
    if target.startswith("freeplay/") or target.startswith("Eigen/"):
        return None
    return "the SDK stands on the standard library"


def core_fault(path, target):
    room = path.split("/")[1]
    first = target.split("/")[0]
    if room == "include":
        return sdk_fault(target)
    if room not in ROOMS:
        return "core/%s is not in the table of rooms" % room
    if first == "freeplay":
        return "%s does without the SDK" % room if room in WITHOUT_SDK else None
    if first not in ROOMS:
        return library_fault(first, room)
    if first == room or first in ROOMS[room]:
        return None
    return "%s may not include %s" % (room, target)


def fault(path, bracket, target):
    """What is wrong with one include, or None."""
    if bracket == "<" and (STANDARD.match(target) or target in SYSTEM):
        return None
    if target.startswith(("gtest", "gmock")):
        return "tests stay outside"
    if path.startswith("core/"):
        return core_fault(path, target)
    return plugin_fault(path, target)


def faults(path, text):
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        include = INCLUDE.match(line)
        wrong = include and fault(path, include[1], include[2])
        if wrong:
            found.append("%s:%d: %s" % (path, number, wrong))
    return found


class Layering(unittest.TestCase):
    def test_the_table_names_what_there_is(self):
        rooms = {entry for entry in os.listdir(os.path.join(ROOT, "core")) if entry != "include"}
        self.assertEqual(rooms, set(ROOMS))
        included = {include[2].split("/")[0] for path in sources("core") for line in read(path).splitlines()
                    if (include := INCLUDE.match(line))}
        self.assertEqual(set(), set(LIBRARIES) - included)

    def test_nothing_else_stands_at_the_top(self):
        listed = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True)
        names = listed.stdout.splitlines() if listed.returncode == 0 else os.listdir(ROOT)
        there = {name.split("/")[0] for name in names if not name.startswith(".")}
        self.assertEqual(there - {"build", "results"}, TOP_LEVEL)

    def test_the_page_on_architecture_names_files_that_are_there(self):
        paths = [os.path.join(folder, name) for top in ("core", "tests", *PLUGIN_FOLDERS)
                 for folder, _, names in os.walk(os.path.join(ROOT, top)) for name in names]
        named = re.findall(r"`([a-z0-9_./]+\.(?:h|cpp|py|list))`", read("docs/architecture.md"))
        self.assertGreater(len(named), 100)
        self.assertEqual([], [name for name in named if not any(path.endswith("/" + name) for path in paths)])

    def test_no_file_repeats_the_name_of_its_folder(self):
        found = []
        for path in sources("core"):
            room, _, name = path[len("core/"):].rpartition("/")
            if name.startswith(room.rpartition("/")[2] + "_"):
                found.append(path)
        self.assertEqual([], found)

    def test_every_include_is_in_the_table(self):
        seen, found = 0, []
        for path in sources("core", *PLUGIN_FOLDERS):
            seen += 1
            found += faults(path, read(path))
        self.assertGreater(seen, 20)
        self.assertEqual([], found)

    def test_a_bad_include_is_caught(self):
        bad = {
            "core/base/a.cpp": ['#include "model/model.h"', "#include <Eigen/Core>", '#include "freeplay/joint.h"'],
            "core/model/a.cpp": ['#include "system/system.h"', "#include <yaml-cpp/yaml.h>", "#include <Eigen/Dense>"],
            "core/system/a.cpp": ['#include "run/sink.h"', "#include <nlohmann/json.hpp>"],
            "core/results/csv_sink.cpp": ['#include "load/load.h"', '#include "cli/options.h"'],
            "core/format/a.cpp": ["#include <yaml-cpp/yaml.h>", '#include "yaml/document.h"'],
            "core/stage/a.cpp": ['#include "run/energy_account.h"', '#include "assembly/assembly.h"'],
            "core/load/a.cpp": ['#include "cli/options.h"', '#include "python/refusal.h"', "#include <pybind11/numpy.h>"],
            "core/python/a.cpp": ['#include "cli/options.h"', "#include <CLI/CLI.hpp>"],
            "core/cli/a.cpp": ['#include "python/refusal.h"', "#include <pybind11/numpy.h>"],
            "core/run/a.cpp": ["#include <CLI/CLI.hpp>", "  #  include <gtest/gtest.h>", "#include <boost/any.hpp>"],
            "core/unheard/a.cpp": ['#include "base/error.h"'],
            "core/include/freeplay/a.h": ['#include "base/error.h"', "#include <fmt/format.h>"],
            "solvers/a.cpp": ["#include <arkode/arkode_erkstep.h>"],
            "joints/a.cpp": ['#include "base/error.h"', "#include <fmt/format.h>", '#include "model/model.h"'],
        }
        for path, lines in bad.items():
            for line in lines:
                with self.subTest(path=path, line=line):
                    self.assertEqual(1, len(faults(path, line)))

    def test_a_good_include_passes(self):
        good = {
            "core/results/summary.cpp": ['#include "run/simulation.h"', '#include "base/json_text.h"'],
            "core/results/csv_sink.cpp": ['#include "run/sink.h"', "#include <vector>"],
            "core/load/a.cpp": ['#include "urdf/document.h"', '#include "run/simulation.h"', '#include "base/error.h"'],
            "core/run/a.cpp": ["#include <Eigen/Dense>", '#include "system/system.h"', "#include <unistd.h>"],
            "solvers/sundials_a.cpp": ["#include <arkode/arkode_erkstep.h>"],
            "joints/a.cpp": ["#include <cmath>", '#include "freeplay/joint.h"', "#include <Eigen/Core>"],
        }
        for path, lines in good.items():
            for line in lines:
                self.assertEqual([], faults(path, line))


# Types of the model file that are the core's own: what ties or loads other elements and needs no plugin. And a joint
# whose name is a word of the format, too (`space: planar`).
CORE_TYPES = {"gear", "force", "torque", "gravity", "planar"}


# Names of components that are also plain words: they count only as a quoted word.
def is_plain_word(name):
    return name in {"fixed", "distance", "none", "constant", "linear", "spherical", "universal", "gear", "hard",
                    "expression"}


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            answer = subprocess.run([os.environ["FREEPLAY"], "list", "--json"], cwd=folder, capture_output=True,
                                    check=True)
        cls.names = [entry["name"] for entry in json.loads(answer.stdout) 
                     if entry["kind"] != "plugin" and entry["name"] not in CORE_TYPES]

    def test_core_names_no_component(self):
        self.assertTrue(self.names)
        found = []
        for path in sources("core"):
            if path.startswith(("core/urdf/", "core/mjcf/", "core/sdf/")):  # formats with joint types of their own
                continue
            # How the base of a robot is held is a word of the format, not a joint.
            text = re.sub(r'\{"base", .*?\}', "", read(path).lower(), flags=re.S)
            # Words of the command line: kinds of singularity, and no joint made ideal.
            text = text.replace('{"none", ', "").replace('text == "none"', "")
            found += ["%s: %s" % (path, name) for name in self.names if self.occurs(name, text)]
        self.assertEqual([], found)

    def test_no_source_names_a_mechanism(self):
        found = [path for path in sources("core", *PLUGIN_FOLDERS) if "rrr" in re.sub("arrrr*|errr+", "", read(path).lower())]
        self.assertEqual([], found)

    @staticmethod
    def occurs(name, text):
        if is_plain_word(name):
            return re.search("[\"']%s[\"']" % re.escape(name), text)
        return re.search(r"(?<![a-z0-9])%s(?![a-z0-9])" % re.escape(name).replace(r"\-", "[-_ ]"), text)

    def test_a_name_is_found_where_it_stands(self):
        self.assertTrue(self.occurs("slide-way", "a slide_way here"))
        self.assertTrue(self.occurs("fixed", 'type == "fixed"'))
        self.assertFalse(self.occurs("fixed", "a fixed step"))


    def test_no_two_headers_define_one_name(self):
        # The linker would take one for the other, silently.
        places = {}
        for folder, _, names in os.walk(os.path.join(ROOT, "core")):
            for name in names:
                if not name.endswith(".h"):
                    continue
                with open(os.path.join(folder, name), encoding="utf-8") as file:
                    text = file.read()
                scopes = re.findall(r"^namespace ([\w:]+) \{", text, re.M)
                for kind in re.findall(r"^(?:struct|class) (\w+)(?: final)?(?: : [^{;]*)? \{", text, re.M):
                    places.setdefault((scopes[0] if scopes else "", kind), []).append(os.path.join(folder, name))
        self.assertGreater(len(places), 100)
        self.assertEqual({}, {kind: where for kind, where in places.items() if len(where) > 1})


if __name__ == "__main__":
    unittest.main()
