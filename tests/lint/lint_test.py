"""The checks of ./dev lint find what they are for, and let pass what is right."""
import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import commits
import lint
import sizes
import sources
import spelling


class Lint(unittest.TestCase):
    def test_a_suppression_without_check_or_reason_is_found(self):
        good = ("x();  // NOLINT(bugprone-x): the table is C's", "// NOLINTNEXTLINE(misc-y,misc-z): generated",
                "// False alarm of GCC 12.\n#pragma GCC diagnostic ignored \"-Wx\"")
        bad = ("x();  // NOLINT", "x();  // NOLINT(bugprone-x)", "// NOLINTNEXTLINE: no check",
               "\n#pragma GCC diagnostic ignored \"-Wx\"")
        for text in good:
            self.assertEqual([], lint.suppressions_without_reason("a.cpp", text), text)
        for text in bad:
            self.assertEqual(1, len(lint.suppressions_without_reason("a.cpp", text)), text)

    def test_functions_are_measured_from_their_first_line_to_their_last(self):
        text = """
            namespace a {
            constexpr int table[] = {1, 2};
            class B : public C<int> {
             public:
              B(int x) : x_{x}, y_(x) {
                if (x) {
                }
              }
              /// f(); { in a comment, "} in a text" and '{'
              [[noreturn]] void f(int a = g({1, 2}),
                                  std::function<void()> h = {}) const noexcept { auto l = [] { return "}"; }; }
              template <class T>
              auto k(T t) -> std::vector<T> {
                return {t};
              }
              bool operator==(const B&) const = default;
              int z() const;

             private:
              int hidden() const { return x_; }
              int x_{0}, y_;
            };
            }
            template <>
            int a::B::z<int>() const {
              for (;;) {
              }
            }
            """
        functions, classes = sizes.measure(text)
        self.assertEqual([("B", 4), ("f", 2), ("k", 4), ("hidden", 1), ("a::B::z<int>", 5)],
                         [(name, lines) for name, _, lines in functions])
        self.assertEqual([("B", 4, {"f", "k", "z"})], classes)

    def test_files_functions_and_classes_beyond_the_limits_are_found(self):
        self.assertEqual([], sizes.too_large("a.cpp", "void f() {\n" + "g();\n" * 58 + "}\n"))
        found = sizes.too_large("a.cpp", "void f() {\n" + "g();\n" * 59 + "}\n")
        self.assertEqual("a.cpp:1: f() has 61 lines, at most 60", str(found[0]))
        face = "struct A {\n" + "".join("int f%d();\nint f%d(int x);\n" % (i, i) for i in range(26)) + "};\n"
        self.assertEqual("a.cpp:1: A has 26 public functions, at most 25", str(sizes.too_large("a.cpp", face)[0]))
        self.assertEqual("a.cpp: 451 lines, at most 450", str(sizes.too_large("a.cpp", "\n" * 451)[0]))
        self.assertEqual("a.py: 451 lines, at most 450", str(sizes.too_large("a.py", "\n" * 451)[0]))

    def test_every_exception_of_size_is_still_needed(self):
        for key in list(sizes.EXCEPTIONS):
            path = key.partition(" ")[0]
            with open(os.path.join(sizes.ROOT, path), encoding="utf-8") as file:
                text = file.read()
            kept = dict(sizes.EXCEPTIONS)
            del sizes.EXCEPTIONS[key]
            try:
                self.assertTrue(sizes.too_large(path, text), key)
            finally:
                sizes.EXCEPTIONS.update(kept)

    def test_a_subject_has_at_most_72_characters(self):
        found = commits.too_long([("a1", "x" * 72), ("b2", "y" * 73)])
        self.assertEqual(["b2"], [finding.path for finding in found])
        self.assertIn("73 characters", str(found[0]))

    def test_code_and_numbers_are_no_prose_and_lines_stay(self):
        text = "a `colr`\n```sh\nwrng\n```\n<!-- bench x -->[b](c/d.md) ur5 1e-6m https://e.f/g h's"
        self.assertEqual([["a"], [], [], [], ["[b", "h"]], [line.split() for line in spelling.prose(text).split("\n")])

    @unittest.skipUnless(shutil.which("hunspell"), "without hunspell")
    def test_words_are_british_or_in_the_list(self):
        self.assertEqual({"colr", "color"}, spelling.unknown("The colour of a penetration, color, colr, the Lankarani law.\n"))

    def test_words_of_the_list_are_sorted_and_once(self):
        with open(spelling.WORDS, encoding="utf-8") as file:
            words = file.read().split()
        self.assertEqual(sorted(set(words), key=lambda word: (word.lower(), word)), words)

    def test_units_are_rooms_and_single_sources_that_changed_or_use_a_changed_header(self):
        with tempfile.TemporaryDirectory() as folder:
            batches = os.path.join(folder, "base.dir", "Unity")
            os.makedirs(batches)
            parts = [os.path.join(batches, "unity_%s_cxx.cxx" % group) for group in ("0", "rest")]
            for part, source in zip(parts, ("unit", "expression")):
                lint.write(part, '#include "%s/core/base/%s.cpp"\n' % (lint.ROOT, source))
            single = os.path.join(lint.ROOT, "joints", "revolute.cpp")
            of_tests = os.path.join(lint.ROOT, "tests", "bench", "step_bench.cpp")
            lint.write(os.path.join(folder, "compile_commands.json"), json.dumps(
                [{"file": path, "command": "c++ -fvect-cost-model=very-cheap -c " + path}
                 for path in (*parts, single, of_tests)]))
            units = lint.Units(folder)
            room = os.path.join(units.folder, "base.cpp")
            self.assertEqual(sorted([room, single]), units.all())
            self.assertEqual([room], units.of(["core/base/unit.cpp", "README.md"]))
            self.assertEqual([room], units.of(["core/base/expression.h"]))
            self.assertEqual([single], units.of(["joints/revolute.cpp", "tests/bench/step_bench.cpp"]))
            with open(room, encoding="utf-8") as file:
                self.assertEqual(2, file.read().count("#include"))
            with open(os.path.join(units.folder, "compile_commands.json"), encoding="utf-8") as file:
                self.assertEqual(["c++ -c " + room, "c++ -c " + single], [command["command"] for command in json.load(file)])

    def test_words_that_are_no_checks_or_revisions_are_refused(self):
        for words, answer in ((["spell"], "there is no check 'spell'"), (["--since", "no-such"], "no revision 'no-such'")):
            with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit) as ended:
                lint.parse(words)
            self.assertEqual(2, ended.exception.code)
            self.assertIn(answer, err.getvalue())

    @unittest.skipUnless(shutil.which("git"), "without git")
    def test_changed_files_are_those_since_a_revision(self):
        with tempfile.TemporaryDirectory() as folder:
            def git(*words):
                subprocess.run(["git", "-C", folder, "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True,
                               capture_output=True)

            def write(name, text):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            git("init", "-q")
            for name in ("a.cpp", "b.cpp"):
                write(name, "")
                git("add", ".")
                git("commit", "-qm", name)
            write("c.cpp", "")
            root, sources.ROOT = sources.ROOT, folder
            try:
                self.assertEqual(["b.cpp", "c.cpp"], sources.changed())
                write("a.cpp", "1")
                self.assertEqual(["a.cpp", "c.cpp"], sources.changed("HEAD"))
                shutil.rmtree(os.path.join(folder, ".git"))
                self.assertEqual([], sources.changed())
            finally:
                sources.ROOT = root


if __name__ == "__main__":
    unittest.main()
