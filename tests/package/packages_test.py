"""The Debian packages: what is in them, what they need, and that they run from wherever they are unpacked."""
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["FREEPLAY_BUILD"])
WITH_PYTHON = os.environ["FREEPLAY_PYTHON"] == "ON"
CONTENTS = {"freeplay": ["bin/freeplay", "include/freeplay/plugin.h", "lib/cmake/Freeplay/FreeplayConfig.cmake", "share/man/man1/freeplay.1",
                         "share/bash-completion/completions/freeplay", "share/zsh/vendor-completions/_freeplay",
                         "share/fish/vendor_completions.d/freeplay.fish", "share/mime/packages/freeplay.xml",
                         "share/doc/freeplay/copyright", "share/doc/freeplay/examples/mechanisms/pendulum.yaml"],
            "python3-freeplay": ["lib/python3/dist-packages/freeplay/" + name for name in ("__init__.py", "_core.pyi", "py.typed", "plot.py")]}


def output(*words, **options):
    return subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True, **options).stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        output("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none")
        cls.files = {path.name.split("_")[0]: path for path in cls.folder.glob("*.deb")}
        cls.root = cls.folder / "root"
        for path in cls.files.values():
            output("dpkg-deb", "-x", path, cls.root)

    @classmethod
    @functools.cache
    def fields(cls, name):
        return {word: output("dpkg-deb", "-f", cls.files[name], word).strip() for word in
                ("Package", "Version", "Architecture", "Maintainer", "Depends", "Suggests", "Description")}

    def run_program(self, *words, **options):
        return output(self.root / "usr/bin/freeplay", *words, cwd=self.folder, **options)

    def test_there_are_the_program_and_the_package_for_python(self):
        self.assertEqual({"freeplay", "python3-freeplay"} if WITH_PYTHON else {"freeplay"}, set(self.files))

    def test_each_says_what_it_is_and_what_it_needs(self):
        version = self.run_program("--version").split()[1]
        for name in self.files:
            fields = self.fields(name)
            self.assertEqual((name, version), (fields["Package"], fields["Version"]))
            self.assertRegex(fields["Maintainer"], r"^[\w ]+ <\S+@\S+>$")
            self.assertIn("libc6 (>= ", fields["Depends"])
            self.assertEqual(version, re.search(r"_([\d.]+)_", self.files[name].name)[1])
        if WITH_PYTHON:
            now, later = "%d.%d" % sys.version_info[:2], "%d.%d" % (sys.version_info[0], sys.version_info[1] + 1)
            for word in ("python3 (>= %s)" % now, "python3 (<< %s)" % later, "python3-numpy", "libhdf5-"):
                self.assertIn(word, self.fields("python3-freeplay")["Depends"])
            for word in ("python3-matplotlib", "python3-pandas", "python3-xarray", "python3-scipy"):
                self.assertIn(word, self.fields("python3-freeplay")["Suggests"])

    def test_every_library_that_is_loaded_is_of_a_package_that_it_depends_on(self):
        needed = {(name, library) for name, places in {"freeplay": "usr/bin/*", "python3-freeplay": "usr/lib/python3/dist-packages/freeplay/*.so"}.items()
                  if name in self.files for file in self.root.glob(places)
                  for library in re.findall(r"NEEDED.*\[(.*)\]", output("readelf", "-d", file))}
        self.assertTrue(needed)
        owners = output("dpkg-query", "-S", *("*/" + library for library in {library for _, library in needed})).splitlines()
        for name in self.files:
            depends = set(re.findall(r"[\w.+-]+(?= \(|,|$)", self.fields(name)["Depends"]))
            for library in (library for of, library in needed if of == name):
                found = {re.match(r"[\w.+-]+", line)[0] for line in owners if line.endswith("/" + library)}
                self.assertTrue(found & depends, "%s of %s" % (library, name))

    def test_files_lie_below_usr_and_belong_to_root(self):
        for name, path in self.files.items():
            lines = output("dpkg-deb", "-c", path).splitlines()
            for line in lines:
                mode, owner, _, _, _, place = line.split(maxsplit=5)
                self.assertRegex(place, r"^\./(usr/(?!local).*)?$")
                self.assertEqual("root/root", owner)
                self.assertNotIn("w", mode[4:], line)
            there = "\n".join(lines)
            for file in CONTENTS[name]:
                self.assertIn("./usr/%s\n" % file, there + "\n")

    def test_no_file_knows_where_it_was_made(self):
        places = [os.fsencode(ROOT), os.fsencode(BUILD), os.fsencode(self.folder)]
        for path in self.root.rglob("*"):
            if path.is_file():
                for place in places:
                    self.assertNotIn(place, path.read_bytes(), path)

    def test_the_unpacked_program_runs_its_examples(self):
        self.run_program("run", self.root / "usr/share/doc/freeplay/examples/mechanisms/pendulum.yaml", "--out", "pendulum", "--quiet")
        self.assertTrue((self.folder / "pendulum/results.csv").exists())

    @unittest.skipUnless(WITH_PYTHON, "the build has no package for Python")
    def test_the_unpacked_package_runs_the_first_script(self):
        script = re.search(r"^```python first\n(.*?)^```", (ROOT / "docs/python.md").read_text(encoding="utf-8"), re.S | re.M)[1]
        said = output(sys.executable, "-c", script, cwd=self.root / "usr/share/doc/freeplay/examples",
                      env={**os.environ, "PYTHONPATH": str(self.root / "usr/lib/python3/dist-packages"), "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertIn("completed", said)

    def test_the_manual_page_has_every_command_and_option(self):
        page = self.root / "usr/share/man/man1/freeplay.1"
        text = page.read_text(encoding="utf-8").replace("\\-", "-")
        helps = {(): self.run_program("--help")}
        for command in re.findall(r"^  ([a-z][a-z-]+) ", helps[()], re.M):
            helps[command,] = self.run_program(command, "--help")
            self.assertIn(".SS freeplay %s " % command, text)
        for option in set(re.findall(r"--[a-z-]+", "".join(helps.values()))) - {"--help"}:
            self.assertIn(option, text)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", page], capture_output=True, text=True)
            self.assertEqual("", done.stderr)

    def test_desktops_know_model_files_by_their_first_key(self):
        if not (shutil.which("update-mime-database") and shutil.which("gio")):
            self.skipTest("shared-mime-info or gio is not installed")
        share = self.root / "usr/share"
        subprocess.run(["update-mime-database", share / "mime"], check=True, capture_output=True)
        (self.folder / "other.yaml").write_text("a: 1\n", encoding="utf-8")
        model = (ROOT / "mechanisms/pendulum.yaml").read_bytes()
        for name, kind in (("rod.freeplay.yaml", "application/x-freeplay-model+yaml"), ("rod", "application/x-freeplay-model+yaml"),
                           ("other.yaml", "application/x-yaml")):
            if name != "other.yaml":
                (self.folder / name).write_bytes(model)
            said = output("gio", "info", "-a", "standard::content-type", self.folder / name, env={**os.environ, "XDG_DATA_HOME": str(share)})
            self.assertIn("content-type: %s\n" % kind, said)


if __name__ == "__main__":
    unittest.main()
