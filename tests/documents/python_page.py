"""python_page.py [FILE]: prints docs/reference/python.md from the sources of the package in python/softland.

The page has the signature and the docstring of each public class and function. The methods of a scene that are verbs of the program stand in
FILE, which the program softland_python_methods prints (- for standard input). A public name without a docstring is an error.
"""

import ast
import inspect
import re
import sys
import textwrap
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "python/softland"
COLUMNS = 130  # of a line of a page
CODE_COLUMNS = 100  # of a line of a signature
HEAD = """# Classes and functions of Python

*For someone who writes Python: which classes and functions are there, what do they take, and what do they return?*

This page is made from the sources of the package. [softland from Python](../python.md) shows how they are used together.

- Numbers are in SI units. Shapes such as (n, d) stand after arrays.
- `Array` is a NumPy array of floats, `Value` what a key of a scene may hold.
- `Progress` is a function of what is computed and of the share that is done.
- `Device` is a function that gets a `Shot` and returns an answer for `Tuning.learn`.
"""


def tree_of(text):
    return ast.parse(text)


def definitions(tree):
    return {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def public_names():
    """Yields each public name with its definition, in the order of the page: functions, then classes."""
    modules = {}
    for node in tree_of((PACKAGE / "__init__.py").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.module:
            modules.update({one.name: node.module for one in node.names})
        if isinstance(node, ast.Assign) and node.targets[0].id == "__all__":
            names = ast.literal_eval(node.value)
    found = []
    for name in names:
        module = tree_of((PACKAGE / f"{modules[name]}.py").read_text(encoding="utf-8"))
        found.append(definitions(module)[name])
    return sorted(found, key=lambda node: (isinstance(node, ast.ClassDef), node.name))


def plain(text):
    """Returns text for Markdown: no mark outside of code, and options as code, or their dashes would become one."""
    parts = re.split(r"(`[^`]*`)", text)
    for k in range(0, len(parts), 2):
        part = re.sub(r"([*<$])", r"\\\1", parts[k])
        part = re.sub(r"\bdocs/([\w/-]+)\.md\b", lambda page: link(page.group(1)), part)
        parts[k] = re.sub(r"(?<![\w-])(--[a-z][a-z-]*)", r"`\1`", part)
    return "".join(parts)


def link(page):
    """Returns a link to a page of docs/, from a page of docs/reference."""
    folder, _, name = page.rpartition("/")
    return f"[{name}]({name}.md)" if folder == "reference" else f"[{name}](../{page}.md)"


def wrapped(text, first="", later=""):
    return textwrap.fill(text, COLUMNS, initial_indent=first, subsequent_indent=later, break_long_words=False, break_on_hyphens=False)


def arguments_of(function):
    given = function.args
    return {one.arg for one in [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg] if one}


def attributes_of(node):
    """Returns the names of the public attributes that the methods of a class assign."""
    named = {one.attr for one in ast.walk(node) if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store)}
    return {name for name in named if not name.startswith("_")}


def docstring(node, arguments=()):
    """Returns the docstring as Markdown: a line that begins with the name of an argument is an item of a list, and >>> begins code."""
    text = inspect.cleandoc(ast.get_docstring(node, clean=False) or "")
    if not text:
        sys.exit(f"{node.name} has no docstring")
    blocks = []
    for paragraph in text.split("\n\n"):
        if paragraph.startswith(">>>"):
            blocks.append(f"```text\n{paragraph}\n```")
            continue
        items = []  # [name of the argument or "", text]
        for line in paragraph.splitlines():
            name = re.match(r"(\w+): ", line)
            if name and name.group(1) in arguments:
                items.append([name.group(1), line[name.end() :]])
            elif items and (not items[-1][0] or line.startswith(" ")):
                items[-1][1] += " " + line.strip()
            else:
                items.append(["", line])
        lines = []
        for k, (name, words) in enumerate(items):
            if k and bool(name) != bool(items[k - 1][0]):
                lines.append("")
            lines.append(wrapped(plain(words), f"- `{name}`: ", "  ") if name else wrapped(plain(words)))
        blocks.append("\n".join(lines))
    joined = blocks[0]
    for before, after in zip(blocks, blocks[1:]):  # a list that goes on behind a blank line is one list
        joined += ("\n" if before.splitlines()[-1].startswith(("- ", "  ")) and after.startswith("- `") else "\n\n") + after
    return joined


def signature(function, name):
    """Returns the line of a call, or several if it is long."""
    given = function.args
    defaults = [None] * (len(given.posonlyargs) + len(given.args) - len(given.defaults)) + given.defaults
    words = []

    def add(one, default=None, stars=""):
        text = stars + one.arg + (f": {ast.unparse(one.annotation)}" if one.annotation else "")
        words.append(text + (f" = {ast.unparse(default)}" if default is not None else ""))

    for one, default in zip([*given.posonlyargs, *given.args], defaults):
        if one.arg not in ("self", "cls"):
            add(one, default)
    if given.vararg:
        add(given.vararg, stars="*")
    elif given.kwonlyargs:
        words.append("*")
    for one, default in zip(given.kwonlyargs, given.kw_defaults):
        add(one, default)
    if given.kwarg:
        add(given.kwarg, stars="**")
    is_told = function.returns is not None and function.name not in ("__init__", "__new__")
    returns = f" -> {ast.unparse(function.returns)}" if is_told else ""
    line = f"{name}({', '.join(words)}){returns}"
    return line if len(line) <= CODE_COLUMNS else f"{name}(\n" + "".join(f"    {one},\n" for one in words) + f"){returns}"


def is_a(function, decorator):
    return any(isinstance(one, ast.Name) and one.id == decorator for one in function.decorator_list)


def code(text):
    return f"```text\n{text}\n```"


def print_class(node, more):
    bases = [ast.unparse(base).split("[")[0] for base in node.bases if ast.unparse(base) != "Studies"]
    members = {one.name: one for one in node.body if isinstance(one, ast.FunctionDef)}
    print(f"\n## {node.name}\n")
    made = members.get("__new__") or members.get("__init__")
    about = docstring(node, attributes_of(node) | (arguments_of(made) if made else set()))
    if made and not re.search(r"\bMade\s+by\s+`", about) and bases != ["ValueError"]:
        print(code(signature(made, f"softland.{node.name}")) + "\n")
    print(about)
    if bases:
        print(f"\nBase: {', '.join(f'`{base}`' for base in bases)}.")
    public = {name: one for name, one in {**members, **more}.items() if not name.startswith("_") or name in ("__call__", "__len__")}
    public = {name: one for name, one in public.items() if name != "__len__" or ast.get_docstring(one)}
    properties = [one for one in public.values() if is_a(one, "property")]
    if properties:
        print("\nProperties:\n")
    for one in properties:
        words = " ".join(docstring(one).split())
        print(wrapped(f"{words}", f"- `{one.name}`: ", "  "))
    for name, one in public.items():
        if one in properties:
            continue
        instance = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", node.name).lower()
        heading, call = {
            "__call__": (f"{node.name} as a function", instance),
            "__len__": (f"Length of {node.name}", f"len({instance})"),
        }.get(name, (f"{node.name}.{name}", f"softland.{node.name}.{name}" if is_a(one, "classmethod") else name))
        print(f"\n### {heading}\n\n{code(call + ' -> int' if name == '__len__' else signature(one, call))}\n")
        print(docstring(one, arguments_of(one)))


def main():
    verbs = {}
    if len(sys.argv) == 2:
        text = sys.stdin.read() if sys.argv[1] == "-" else Path(sys.argv[1]).read_text(encoding="utf-8")
        studies = definitions(tree_of(text))["Studies"]
        verbs = {one.name: one for one in studies.body if isinstance(one, ast.FunctionDef)}
    print(HEAD, end="")
    names = public_names()
    links = [f"[{one.name}](#{'softland' if isinstance(one, ast.FunctionDef) else ''}{one.name.lower()})" for one in names]
    print("\n" + wrapped("Names: " + ", ".join(links) + "."))
    for node in names:
        if isinstance(node, ast.ClassDef):
            print_class(node, verbs if node.name == "Scene" else {})
            continue
        print(f"\n## softland.{node.name}\n\n{code(signature(node, f'softland.{node.name}'))}\n\n{docstring(node, arguments_of(node))}")


main()
