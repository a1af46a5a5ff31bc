"""Print the figures that the house is held to: lengths of functions, parameters typed Any.

Run: ``uv run python tools/measure.py [folder ...]`` (default: quizgen solvers templates).
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from statistics import median

Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(tree: ast.AST) -> Iterator[Function]:
    """Every function and method of a module."""
    return (n for n in ast.walk(tree) if isinstance(n, Function))


def length(function: Function) -> int:
    """Lines of a function from ``def`` to its end."""
    return int(function.end_lineno or function.lineno) - function.lineno + 1


def parameters(function: Function) -> list[ast.arg]:
    """All parameters but ``self`` and ``cls``."""
    a = function.args
    every = [*a.posonlyargs, *a.args, *a.kwonlyargs, *filter(None, (a.vararg, a.kwarg))]
    return [one for one in every if one.arg not in {"self", "cls"}]


def is_any(parameter: ast.arg) -> bool:
    """Whether a parameter is annotated with ``Any`` itself."""
    note = parameter.annotation
    return isinstance(note, ast.Name) and note.id == "Any"


def main(folders: list[str]) -> None:
    """Print the figures of all modules below the folders."""
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


if __name__ == "__main__":
    main(sys.argv[1:] or ["quizgen", "solvers", "templates"])
