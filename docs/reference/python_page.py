"""The reference page of the Python package, from the signatures and texts of its files alone."""
import ast
import os

PACKAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "core", "python", "freeplay")
HEAD = "<!-- Made by `./dev docs` from core/python/freeplay; edit those files. -->\n"
INTRODUCTION = """# The package freeplay

What [python.md](../python.md) shows, name by name. Values are in SI; a `Quantity` is a number in SI or a text with a unit.
"""


def trees():
    for name in sorted(os.listdir(PACKAGE)):
        if name.endswith(".py"):
            with open(os.path.join(PACKAGE, name), encoding="utf-8") as file:
                yield name[:-3], ast.parse(file.read())


def public_names(init):
    for node in init.body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "__all__":
            return ast.literal_eval(node.value)
    raise ValueError("__init__.py has no __all__")


def document(node, indentation=""):
    return "".join(f"{indentation}{line}".rstrip() + "\n" for line in (ast.get_docstring(node) or "").splitlines())


def signature(name, node):
    words = ast.unparse(node.args)
    for own in ("self, ", "self"):
        words = words[len(own):] if words.startswith(own) else words
    back = f" -> {ast.unparse(node.returns)}" if node.returns is not None else ""
    return f"{name}({words}){back}\n"


def is_property(node):
    return any(isinstance(one, ast.Name) and one.id == "property" for one in node.decorator_list)


def methods(owner, node):
    text = ""
    for one in node.body:
        if not isinstance(one, ast.FunctionDef) or (one.name.startswith("_") and one.name not in ("__getitem__", "__call__")):
            continue
        text += "\n" + (f"{owner}.{one.name}\n" if is_property(one) else signature(f"{owner}.{one.name}", one)) + document(one, "    ")
    return text


def entry(name, node):
    if isinstance(node, ast.FunctionDef):
        return f"## `{name}`\n\n```\n" + signature(name, node) + document(node, "    ") + "```\n\n"
    bases = ", ".join(ast.unparse(base) for base in node.bases)
    start = next((one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"), None)
    made = signature(name, start) if start is not None and name == "Function" else f"{name}{f' ({bases})' if bases else ''}\n"
    return f"## `{name}`\n\n```\n" + made + document(node, "    ") + methods(name, node) + "```\n\n"


def page():
    """The whole page: names in the order of the alphabet, then pictures."""
    modules = dict(trees())
    found = {}
    for module, tree in modules.items():
        for node in tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and (module.startswith("_") or module == "plot"):
                found.setdefault((module == "plot", node.name), node)
    names = public_names(modules["__init__"])
    text = HEAD + INTRODUCTION + "\n" + "".join(entry(name, found[False, name]) for name in sorted(names, key=str.lower))
    pictures = [entry(f"plot.{name}", node) for (of_plot, name), node in found.items() if of_plot and ast.get_docstring(node)]
    return text + "".join(pictures)
