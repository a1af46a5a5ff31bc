"""Solvers: an author's Python, run once to be compiled to a chain, which is kept.

A chain follows from the solver's file and from how quizgen and SymPy make it one. So a caller that
asks questions runs no solver and loads no SymPy, unless a solver is new, or imports more than
others do.
"""

from __future__ import annotations

import ast
import importlib
import re
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType

from quizgen.bank.compile_cache import CompileCache
from quizgen.core.cache import compute_digest
from quizgen.core.errors import BankError
from quizgen.core.imports import LOCK
from quizgen.core.untrusted import read_bytes
from quizgen.maths.chain import Chain
from quizgen.maths.model import Model, work_out
from quizgen.maths.waiting import (
    ask_property,
    check_calls,
    compare_written,
    leave_symbolic,
    watch_calls,
)

_CHAINS = CompileCache("chains", Chain, "sympy")
_PRIVATE = "_quizgen_solvers_"
_RELATIVE = re.compile(rb"\bfrom[ \t]+\.")
_PURE = {"__future__", "fractions", "math", "quizgen", "sympy", "typing"}
"""What a solver may import if its chain is to be kept: nothing that reads files or settings."""
_IMPURE = {"__file__", "__import__", "open"}


class _AsWritten(SourceFileLoader):
    """Loader that compiles a file as it stands there, and writes no bytecode.

    What lies in ``__pycache__`` is not what a person read and trusted: whoever may write there
    would run anything, since Python believes bytecode by the date of its source.
    """

    def get_code(self, fullname: str) -> CodeType:
        """Return the code of the source, whatever bytecode there is."""
        path = self.get_filename(fullname)
        source = self.get_data(path)
        if not _REWRITTEN.search(source):
            return self.source_to_code(source, path)
        tree = _WaitingForNumbers().visit(_WorkingOut().visit(ast.parse(source, path)))
        return self.source_to_code(ast.fix_missing_locations(tree), path)


class _Finder(MetaPathFinder):
    """Finder for modules of the packages that ``_mount_folder`` makes: sources, and their folders.

    No bytecode without a source and no extension module: no digest of sources covers them.
    """

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return where a module of such a package stands; None for any other module.

        Raises
        ------
        ModuleNotFoundError
            If a bank has no such source.
        """
        del target
        if not fullname.startswith(_PRIVATE):
            return None
        for folder in path or ():
            place = Path(folder, fullname.rpartition(".")[2])
            init, file = place / "__init__.py", place.with_name(f"{place.name}.py")
            if init.is_file():
                return _make_module_spec(fullname, init, [str(place)])
            if file.is_file():
                return _make_module_spec(fullname, file, None)
            if place.is_dir():
                found = ModuleSpec(fullname, None, is_package=True)
                found.submodule_search_locations = [str(place)]
                return found
        # None would let the next finder look, which takes bytecode and extensions.
        raise ModuleNotFoundError(f"No module named {fullname.partition('.')[2]!r}", name=fullname)


_FINDER = _Finder()


def _make_module_spec(name: str, file: Path, inside: list[str] | None) -> ModuleSpec | None:
    """Return the spec of a source file; ``inside`` lists the folder of a package."""
    loader = _AsWritten(name, str(file))
    return spec_from_file_location(name, file, loader=loader, submodule_search_locations=inside)


@lru_cache(maxsize=64)
def _make_package_name(folder: Path) -> str:
    """Return the private package name of a folder: two banks may have files of one name."""
    return _PRIVATE + compute_digest(str(folder.resolve()).encode())[:8]


def _mount_folder(folder: Path) -> str:
    """Return the private name of the package that a folder is, and make it importable."""
    name = _make_package_name(folder.absolute())
    with LOCK:
        if _FINDER not in sys.meta_path:
            sys.meta_path.insert(0, _FINDER)
        if name not in sys.modules:
            sys.modules[name] = ModuleType(name)
            sys.modules[name].__path__ = [str(folder)]
    return name


def import_module_file(folder: Path, name: str) -> ModuleType:
    """Return a solver or a figure, imported.

    Raises
    ------
    BankError
        Naming the place, if it fails.
    """
    with author_error_context(folder / f"{name}.py"), LOCK:
        return importlib.import_module(f"{_mount_folder(folder)}.{name.replace('/', '.')}")


def unload_modules(folder: Path) -> None:
    """Forget all modules of a folder, so that the next import reads them again."""
    inside = f"{_mount_folder(folder)}."
    for module in [module for module in list(sys.modules) if module.startswith(inside)]:
        del sys.modules[module]
    importlib.invalidate_caches()


def load_chain(folder: Path, name: str) -> tuple[Chain, bytes]:
    """Return the chain of a solver, cached or compiled, and the solver's source.

    Parameters
    ----------
    folder : pathlib.Path
        All solvers of a bank.
    name : str
        A file among them, without its suffix.

    Raises
    ------
    BankError
        If the file cannot be run, or holds no model.
    """
    sources = _read_solver_sources(folder, name)
    chain = _CHAINS.get(*sources)
    if chain is None:
        with LOCK:
            chain = _compile_solver(folder, name)
        if all(map(_is_pure, sources)) and sources == _read_solver_sources(folder, name):
            _CHAINS.store_compiled(chain, *sources)
    return chain, sources[0]


def _read_solver_sources(folder: Path, name: str) -> list[bytes]:
    """Return the source of a solver, and of all of its bank if it imports some of them."""
    own = read_bytes(folder / f"{name}.py", BankError)
    every = sorted(folder.rglob("*.py")) if _RELATIVE.search(own) else []
    return [own, *(read_bytes(path, BankError) for path in every)]


def _compile_solver(folder: Path, name: str) -> Chain:
    """Return the chain of a solver as it is now, with what it imports.

    Raises ``BankError`` if the file cannot be run, or holds no model.
    """
    unload_modules(folder)
    with watch_calls() as calls:
        model = getattr(import_module_file(folder, name), "MODEL", None)
    file = folder / f"{name}.py"
    if not isinstance(model, Model):
        raise BankError("no MODEL in this solver", rule="QG132", file=file)
    with author_error_context(file):
        chain = model.chain()
        check_calls(calls, {*chain.given, *(step.name for step in chain.steps)})
        return chain


_EVALUATING = frozenset({
    "LUsolve", "Poly", "adjugate", "apart", "cancel", "charpoly", "collect", "det", "diff", "doit",
    "dsolve", "eigenvals", "eigenvects", "expand", "factor", "gauss_jordan_solve", "hessian",
    "integrate", "inv", "inverse_laplace_transform", "jacobian", "laplace_transform", "limit",
    "linsolve", "nsolve", "nullspace", "rank", "real_roots", "residue", "roots", "rref", "rsolve",
    "series", "simplify", "solve", "solveset", "summation", "together", "trigsimp",
})  # fmt: skip
"""Functions and methods of SymPy that give nonsense or fail where nothing is evaluated."""
_WORK_OUT = "_quizgen_work_out"
_BROUGHT = {
    one: f"_quizgen_{one.__name__}" for one in (leave_symbolic, compare_written, ask_property)
}
"""What a solver is rewritten with, to its name there."""
_REWRITTEN = re.compile(rb"\bsympy\b")


class _WorkingOut(ast.NodeTransformer):
    """Has SymPy evaluate its computations inside ``with evaluate(False)``.

    There ``integrate`` fails with an AttributeError and ``diff`` gives ``a**3*(0*log(a) + 1*3/a)``,
    which no author expects: what is meant is that formulas print as they are written.
    """

    def visit_With(self, node: ast.With) -> ast.With:
        """Rewrite the body of a block that stops evaluation."""
        if not _stops_evaluation(node):
            return self.generic_visit(node)  # type: ignore[return-value]
        body = [_WrapCalls().visit(one) for one in node.body]
        name = ast.alias(work_out.__name__, _WORK_OUT)
        bring = ast.ImportFrom(work_out.__module__, [name], 0)
        return ast.copy_location(ast.With(node.items, [bring, *body]), node)


class _WaitingForNumbers(ast.NodeTransformer):
    """Has what needs numbers wait until they are drawn, or refused if it cannot wait."""

    def visit_Module(self, node: ast.Module) -> ast.Module:
        """Rewrite a file, which may begin with its docstring and ``from __future__``."""
        self.generic_visit(node)
        first = next((n for n, one in enumerate(node.body) if not _stands_first(one)), 0)
        for one, name in _BROUGHT.items():
            bring = ast.ImportFrom(one.__module__, [ast.alias(one.__name__, name)], 0)
            node.body.insert(first, bring)
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Rewrite a call: what is called, and functions that it is given."""
        self.generic_visit(node)
        node.func = _wrap(leave_symbolic, node.func)
        node.args = [
            _wrap(leave_symbolic, arg) if isinstance(arg, ast.Name | ast.Attribute) else arg
            for arg in node.args
        ]
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        """Rewrite ``a == b`` and ``a != b``."""
        self.generic_visit(node)
        sign = {ast.Eq: "==", ast.NotEq: "!="}.get(type(node.ops[0]))
        if sign is None or len(node.ops) > 1:
            return node
        call = _wrap(compare_written, ast.Constant(sign), node.left, node.comparators[0])
        return ast.copy_location(call, node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Rewrite ``a.is_prime`` and the like."""
        self.generic_visit(node)
        if not isinstance(node.ctx, ast.Load) or not node.attr.startswith("is_"):
            return node
        return ast.copy_location(_wrap(ask_property, node.value, ast.Constant(node.attr)), node)


def _wrap(brought: Callable[..., object], *args: ast.expr) -> ast.Call:
    """Return a call of what a solver is rewritten with."""
    return ast.Call(ast.Name(_BROUGHT[brought], ast.Load()), [*args], [])


def _stands_first(node: ast.stmt) -> bool:
    """Whether a statement must stand before all others."""
    is_future = isinstance(node, ast.ImportFrom) and node.module == "__future__"
    return is_future or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))


class _WrapCalls(ast.NodeTransformer):
    """Puts each computation of SymPy's, arguments and all, into a call of ``work_out``."""

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Rewrite the outermost call of one of ``_EVALUATING``."""
        if _called_name(node) not in _EVALUATING:
            return self.generic_visit(node)
        nothing = ast.arguments(posonlyargs=[], args=[], kwonlyargs=[], kw_defaults=[], defaults=[])
        whole = ast.Call(ast.Name(_WORK_OUT, ast.Load()), [ast.Lambda(nothing, node)], [])
        return ast.copy_location(whole, node)


def _stops_evaluation(node: ast.AST) -> bool:
    """Whether a node is ``with evaluate(False)``."""
    return isinstance(node, ast.With) and any(
        isinstance(item.context_expr, ast.Call)
        and _called_name(item.context_expr) == "evaluate"
        and any(isinstance(arg, ast.Constant) and not arg.value for arg in item.context_expr.args)
        for item in node.items
    )


def _called_name(node: ast.AST) -> str:
    """Return the name of a called function or method; empty if a node calls none."""
    if not isinstance(node, ast.Call):
        return ""
    called = node.func
    return called.id if isinstance(called, ast.Name) else getattr(called, "attr", "")


def _is_pure(source: bytes) -> bool:
    """Return whether what a solver gives follows from solvers alone.

    One that reads files or settings is not cached: its result may change without its source.
    """
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names = [node.module or ""]
        else:
            names = []
        if {name.partition(".")[0] for name in names} - _PURE:
            return False
        if isinstance(node, ast.Name) and node.id in _IMPURE:
            return False
    return True


_NEEDS_NUMBER = re.compile(
    r"is not an integer|symbols to int|truth value of Relational|float\b|and numerical function"
)
"""What SymPy and Python say where they need a number and get a name."""
_CODES = (
    (ModuleNotFoundError, "QG134"),
    (NameError, "QG135"),
    (SyntaxError, "QG136"),
    (AttributeError, "QG137"),
    (RecursionError, "QG138"),
    (SystemExit, "QG139"),
)
"""What an author's Python raises, to its code."""


@contextmanager
def author_error_context(file: Path) -> Iterator[None]:
    """Run an author's Python: whatever goes wrong in it is one line that names the place.

    Raises
    ------
    BankError
        Naming the file, its last line that ran, and what was wrong there.
    """
    try:
        yield
    except BankError as error:
        error.file = error.file or file
        raise
    except (Exception, SystemExit) as error:  # an author's Python may raise anything
        whole = file.resolve()  # as Python names it, wherever one stands
        lines = [at.lineno for at in traceback.extract_tb(error.__traceback__)
                 if Path(at.filename).resolve() == whole]  # fmt: skip
        number = getattr(error, "lineno", None) if isinstance(error, SyntaxError) else None
        number = number or (lines[-1] if lines else None)
        known = next((code for kind, code in _CODES if isinstance(error, kind)), "QG133")
        rule = getattr(error, "rule", "") or known
        said = " ".join(str(error).split())
        if isinstance(error, RecursionError):  # what Python was doing there is chance
            said = said.partition(" while ")[0].partition(" in ")[0]
        what = f"{type(error).__name__}: {said}"
        if _NEEDS_NUMBER.search(what):
            what += " (what is drawn is a letter here: docs/functions.md has what waits for it)"
        raise BankError(what, rule=rule, file=file, line=number or 0) from error
