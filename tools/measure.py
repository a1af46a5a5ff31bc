"""Print the figures that the house is held to: names, lengths of functions, parameters typed Any.

A function's name is a verb and a noun: at most 45 % are one word, at most 3 % a single past
participle (``told``), and no public function or class of the package stands twice. A docstring
names parameters and their classes as the signature does.

Run: ``uv run python tools/measure.py [folder ...]`` (default: quizgen solvers templates).
"""

from __future__ import annotations

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from statistics import median

Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(tree: ast.AST) -> Iterator[Function]:
    """Yield every function and method of a module."""
    return (n for n in ast.walk(tree) if isinstance(n, Function))


def length(function: Function) -> int:
    """Return the lines of a function from ``def`` to its end."""
    return int(function.end_lineno or function.lineno) - function.lineno + 1


def parameters(function: Function) -> list[ast.arg]:
    """Return all parameters but ``self`` and ``cls``."""
    a = function.args
    every = [*a.posonlyargs, *a.args, *a.kwonlyargs, *filter(None, (a.vararg, a.kwarg))]
    return [one for one in every if one.arg not in {"self", "cls"}]


def is_any(parameter: ast.arg) -> bool:
    """Return whether a parameter is annotated with ``Any`` itself."""
    note = parameter.annotation
    return isinstance(note, ast.Name) and note.id == "Any"


# Past participles that do not end in -ed, as far as functions have been named by them.
IRREGULAR = set(
    re.findall(
        r"\w+",
        "told kept made found known said shown drawn written seen taken given held built sent left "
        "meant spoken chosen broken grown thrown bound paid lost met brought split spent "
        "understood hidden begun done gone",
    )
)
ONE_WORD, PARTICIPLES = 0.45, 0.03
CONTRACTS = "effects", "kinds", "levels", "cli"
"""Folders whose modules keep one contract: its members, and commands, share their names."""


def is_participle(word: str) -> bool:
    """Return whether a word is a past participle, by its form."""
    return word in IRREGULAR or (word.endswith("ed") and len(word) > 4)


def find_faults_of_names(trees: dict[Path, ast.Module]) -> list[str]:
    """Print the shares of names, and return what is beyond the limits."""
    names = [f.name.strip("_") for tree in trees.values() for f in functions(tree)
             if not f.name.startswith("__")]  # fmt: skip
    single = [name for name in names if "_" not in name]
    one, past = len(single) / len(names), sum(map(is_participle, single)) / len(names)
    print(f"names of functions: {one:.1%} one word, {past:.1%} a past participle")
    public = Counter(
        node.name
        for path, tree in trees.items()
        if path.parent.name not in CONTRACTS and "migrations" not in path.parts
        for node in tree.body
        if isinstance(node, Function | ast.ClassDef) and not node.name.startswith("_")
    )
    twice = [name for name, count in public.items() if count > 1 and name != "main"]
    return [
        *([f"{one:.1%} of names are one word"] if one > ONE_WORD else []),
        *([f"{past:.1%} of names are participles"] if past > PARTICIPLES else []),
        *(f"{name} is defined twice" for name in twice),
    ]


DOCUMENTED = re.compile(r"^Parameters\n-+\n((?:.+\n|\n(?! *\w+\n *-))*)", re.MULTILINE)


def find_stale_docstrings(path: Path, tree: ast.AST) -> Iterator[str]:
    """Yield parameters, and classes of them, that a docstring names and the signature does not."""
    for function in functions(tree):
        notes = {a.arg: ast.unparse(a.annotation or a) for a in parameters(function)}
        listed = DOCUMENTED.search((ast.get_docstring(function) or "") + "\n")
        for line in listed[1].splitlines() if listed else ():
            names, _, kind = line.partition(" : ")
            for name in () if line.startswith(" ") or not line else names.split(", "):
                note = notes.get(name.strip("* "), "")
                other = [
                    w for w in re.findall(r"\b[A-Z]\w+", kind) if w not in re.findall(r"\w+", note)
                ]
                if not note or (other and note not in {"Any", "None"}):
                    yield f"{path}: {function.name}: its docstring says {line!r}"


def main(folders: list[str]) -> int:
    """Print the figures of all modules below the folders; return 1 if names exceed the limits."""
    paths = sorted(p for folder in folders for p in Path(folder).rglob("*.py"))
    trees = {p: ast.parse(p.read_text(encoding="utf-8")) for p in paths}
    lengths = [length(f) for tree in trees.values() for f in functions(tree)]
    anys, total = Counter[str](), 0
    for path, tree in trees.items():
        found = [a for f in functions(tree) for a in parameters(f)]
        total += len(found)
        anys["/".join(path.parts[:2])] += sum(map(is_any, found))
    share = sum(anys.values()) / max(total, 1)
    middle = median(lengths)
    print(f"{len(paths)} files, {len(lengths)} functions, median {middle:g} lines")
    print(f"parameters typed Any: {sum(anys.values())} of {total} ({share:.1%})")
    print("  " + ", ".join(f"{name} {count}" for name, count in anys.most_common() if count))
    faults = find_faults_of_names({p: t for p, t in trees.items() if p.parts[0] == "quizgen"})
    faults += [fault for path, tree in trees.items() for fault in find_stale_docstrings(path, tree)]
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or ["quizgen", "solvers", "templates"]))
