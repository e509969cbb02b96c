"""Limits of size: lines of a file and of a function, functions of the public face of a class.

Read by a scanner of its own, for sources that clang-format has set: it blanks out comments and literals, then follows
braces and tells from what stands before each whether a namespace, a class, a function or a list begins.
"""
import os
import re

from sources import ROOT, Finding, files, sources

FOLDERS = ("core", "joints", "contact", "solvers", "plugins", "tests")
SCRIPTS = ("docs", "mechanisms", "tests")  # whose files have a limit, too
LONGEST_FILE, LONGEST_FUNCTION, MOST_FUNCTIONS = 450, 60, 25
# What may be larger, each with the reason: a path, "path function" or "path class".
EXCEPTIONS = {
    "tests/validation/inverse_dynamics_test.cpp instants": "a table of published numbers",
}

BLANKED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<mark>\w*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.M)
ACCESS = re.compile(r"^\s*(?:public|protected|private)\s*:")
TEMPLATE = re.compile(r"\btemplate\s*<(?:[^<>]|<[^<>]*>)*>")
SCOPE = re.compile(r"^(?:export\s+)?(?P<kind>namespace|class|struct|union|enum)\b(?P<rest>[^;(]*)$", re.S)
BODY = re.compile(r"(?:\)|\bconst|\bnoexcept|\boverride|\bfinal|\bmutable|\}|->\s*[\w:<>,&*\s]+)\s*$")
SPECIAL = re.compile(r"=\s*(?:default|delete)\s*$|^(?:friend|using|typedef|static_assert|extern)\b|\boperator\s*=\s*\(")


def blanked(text):
    """Without comments, literals and directives; lines stay where they are."""
    def blank(match):
        word = match[0]
        keep = "0" if word[0] in "\"'R" else " "
        return keep + re.sub(r"[^\n]", " ", word[1:])
    return DIRECTIVE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), BLANKED.sub(blank, text))


class Scope:
    def __init__(self, kind, name, line, public=False):
        self.kind, self.name, self.line, self.public = kind, name, line, public
        self.functions = set()  # of a class: names of its public ones; overloads are one


def name_of(head):
    """The name of what has this head: what stands before its list of parameters."""
    found = re.search(r"([~\w:]+(?:<[\w:, ]*>)?|operator\s*(?:\(\)|[^\s(]+|\w+[^(]*))\s*\(", head)
    return found[1].strip() if found else ""


def begins(head, inside):
    """What a brace opens after this text, at this kind of scope."""
    head = TEMPLATE.sub("", head).strip()
    head = re.sub(r"\[\[.*?\]\]", "", head, flags=re.S).strip()
    scope = SCOPE.match(head)
    if scope:
        rest = re.sub(r"\balignas\s*\(.*?\)|\bfinal\b", "", scope["rest"]).partition(" : ")[0].split()
        return scope["kind"], rest[-1] if rest else ""
    if inside in ("file", "namespace", "class", "struct", "union") and "(" in head and BODY.search(head) and not re.search(
            r"(?<![=!<>])=\s*(?:\[|[\w:<>{(]*$)", head.partition("(")[0]):
        return "function", name_of(head)
    return "list", ""


def measure(text):
    """Functions as (name, line, lines), classes as (name, line, public functions)."""
    text = blanked(text)
    scopes, functions, classes = [Scope("file", "", 1)], [], []
    head, head_line, line, depth = "", 1, 1, 0  # depth: of round and square brackets
    for character in text:
        top = scopes[-1]
        if character == "\n":
            line += 1
        if character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        if character == "{" and depth == 0:
            kind, name = begins(head, top.kind)
            if kind == "function":
                declare(top, head)
            scopes.append(Scope(kind, name, head_line, kind in ("struct", "union")))
            if kind != "list" or top.kind == "function":
                head = ""
        elif character == "}" and depth == 0:
            ended = scopes.pop()
            if ended.kind == "function":
                functions.append((ended.name, ended.line, line - ended.line + 1))
            elif ended.kind in ("class", "struct", "union"):
                classes.append((ended.name, ended.line, ended.functions))
            head = head + "}" if ended.kind == "list" and scopes[-1].kind != "function" else ""
        elif character == ";" and depth == 0:
            if top.kind in ("class", "struct", "union"):
                declare(top, head)
            head = ""
        elif top.kind != "list":
            if not head.strip():
                head_line = line
            head += character
            access = ACCESS.match(head) if character == ":" and top.kind in ("class", "struct", "union") else None
            if access:
                top.public, head = "public" in access[0], ""
    return functions, classes


def declare(scope, head):
    head = re.sub(r"\[\[.*?\]\]", "", TEMPLATE.sub("", head), flags=re.S).strip()
    if scope.kind not in ("class", "struct", "union") or not scope.public or "(" not in head or SPECIAL.search(head):
        return
    if "=" in head.partition("(")[0].replace("operator=", "") or head.startswith(("class ", "struct ")):
        return
    name = name_of(head)
    if name and name.lstrip("~") != scope.name and name != "exchange":  # the list of what is saved is no function to call
        scope.functions.add(name)


def too_large(path, text):
    found = []

    def limit(what, line, size, most, words):
        key = path if what is None else "%s %s" % (path, what)
        if size > most and key not in EXCEPTIONS:
            found.append(Finding(path, line, words % (what, size, most) if what else words % (size, most)))
    limit(None, 0, text.count("\n"), LONGEST_FILE, "%d lines, at most %d")
    functions, classes = measure(text) if not path.endswith(".py") else ([], [])
    for name, line, lines in functions:
        limit(name, line, lines, LONGEST_FUNCTION, "%s() has %d lines, at most %d")
    for name, line, public in classes:
        limit(name, line, len(public), MOST_FUNCTIONS, "%s has %d public functions, at most %d")
    return found


def findings():
    paths, scripts, found = sources(*FOLDERS), sorted(files(SCRIPTS, ".py")), []
    for path in paths + scripts:
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            found += too_large(path, file.read())
    return "%d files" % len(paths + scripts), found
