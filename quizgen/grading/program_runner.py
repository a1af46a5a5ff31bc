"""Runs learners' functions on hidden inputs; started as a process of its own, by its path.

It imports nothing of quizgen. It loads NumPy once and then does nothing itself: each program has a
fork of its own, which nothing of another program has touched. What a program says was written by
somebody who may mean harm, so the text is taken apart first and runs only if it consists of what is
listed here: numbers, arithmetic, loops over what is there, and named functions of NumPy. Then the
fork gives up what it may do: files, network, further processes, memory and time. The list is the
wall, the limits stand behind it.
"""

from __future__ import annotations

import ast
import contextlib
import ctypes
import json
import os
import resource
import select
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from types import ModuleType

MOST_TEXT = 4000
"""Characters of a program."""
MOST_DEEP = 40
"""How far brackets and blocks may be nested."""
SECONDS = 3
"""CPU time for all programs on all inputs."""
HANGS = 20.0
"""Seconds after which a fork is killed: the machine is too busy for the little it computes."""
IDLE = 60.0
"""Seconds without a program after which the process ends."""
LARGEST = 100_000
"""Bytes of an outcome."""
MEMORY = 256 * 2**20
"""Bytes beyond what the process has when NumPy is loaded."""
SHOWN = 90
"""Characters of a value that are shown."""
HUGE = 10**30
"""Whole number beyond which no digits are shown."""
CLOSE = 1e-6
"""How near floats must come, absolutely and relatively."""
NEW_USER, NEW_NETWORK = 0x10000000, 0x40000000
NO_NEW_PRIVILEGES = 38
NOBODY = 65534

TREES = (
    ast.Module, ast.FunctionDef, ast.arguments, ast.arg, ast.Return, ast.Assign, ast.AugAssign,
    ast.AnnAssign, ast.For, ast.If, ast.Expr, ast.Pass, ast.Break, ast.Continue, ast.BoolOp,
    ast.BinOp, ast.UnaryOp, ast.IfExp, ast.Compare, ast.Call, ast.keyword, ast.Constant,
    ast.Attribute, ast.Subscript, ast.Slice, ast.Name, ast.List, ast.Tuple, ast.ListComp,
    ast.GeneratorExp, ast.comprehension, ast.expr_context, ast.boolop, ast.operator, ast.unaryop,
    ast.cmpop,
)  # fmt: skip
"""What a program may consist of. No import, class, lambda, string with blanks, or exception."""
BUILTINS: dict[str, Any] = {
    one.__name__: one
    for one in (abs, all, any, bool, divmod, enumerate, float, int, len, list, max, min, range,
                reversed, round, sorted, sum, tuple, zip)
}  # fmt: skip
OF_NUMPY = frozenset((
    "abs", "absolute", "add", "all", "any", "arange", "argmax", "argmin", "around", "array",
    "asarray", "astype", "atleast_1d", "atleast_2d", "bool_", "broadcast_to", "ceil", "clip",
    "column_stack", "concatenate", "copy", "count_nonzero", "cumsum", "diff", "divide", "dstack",
    "e", "equal", "exp", "expand_dims", "fix", "flip", "float16", "float32", "float64", "floor",
    "floor_divide", "full", "full_like", "hstack", "hypot", "inf", "int16", "int32", "int64",
    "int8", "isclose", "isfinite", "isinf", "isnan", "linspace", "log", "log10", "log2",
    "logical_and", "logical_not", "logical_or", "logical_xor", "maximum", "mean", "median",
    "meshgrid", "minimum", "mod", "moveaxis", "multiply", "nan", "nan_to_num",
    "newaxis", "nonzero", "ones", "ones_like", "outer", "pad", "pi", "power", "prod", "ravel",
    "remainder", "repeat", "reshape", "rint", "roll", "round", "shape", "sign", "size", "sqrt",
    "square", "squeeze", "stack", "std", "subtract", "sum", "swapaxes", "take", "tile",
    "transpose", "trunc", "uint16", "uint32", "uint64", "uint8", "var", "vstack", "where",
    "zeros", "zeros_like",
))  # fmt: skip
"""Functions, types and numbers of NumPy that compute, and neither read, write nor call back."""
OF_VALUES = frozenset((
    "all", "any", "append", "argmax", "argmin", "astype", "clip", "copy", "cumsum", "dtype",
    "flatten", "item", "max", "mean", "min", "ndim", "nonzero", "prod", "ravel", "repeat",
    "reshape", "round", "shape", "size", "squeeze", "std", "sum", "swapaxes", "T", "tolist",
    "transpose", "var",
))  # fmt: skip
"""Attributes of arrays, numbers and lists."""
KEYWORDS = frozenset((
    "a_max", "a_min", "axis", "constant_values", "copy", "decimals", "dtype", "fill_value",
    "initial", "keepdims", "mode", "ndigits", "out", "shape", "start", "step", "stop",
    "where",
))  # fmt: skip
"""Keywords of their calls."""
TYPES = frozenset((
    "bool", "edge", "float", "float16", "float32", "float64", "int", "int16", "int32",
    "int64", "int8", "reflect", "symmetric", "uint16", "uint32", "uint64", "uint8", "wrap",
))  # fmt: skip
"""The only texts: names of types, and how an array is padded."""


class RefusedError(Exception):
    """A program that does not run, with the note that says why."""

    def __init__(self, note: str, line: int = 1, found: str = "") -> None:
        """Store note, line and what was found there."""
        super().__init__(note)
        self.note, self.line, self.found = note, line, found


def read_program(text: str, function: str, parameters: str) -> ast.Module:
    """Return a program as a tree that may run.

    Raises
    ------
    RefusedError
        If it cannot be read, holds anything that is not listed, or lacks the function.
    """
    _require_flat(text)
    try:
        tree: ast.Module = _Plainer().visit(ast.parse(text))
    except SyntaxError as error:
        line = (error.text or "").strip()[:60]
        raise RefusedError("program-syntax", error.lineno or 1, line) from None
    except (ValueError, MemoryError, RecursionError):
        raise RefusedError("program-syntax") from None
    own = {one.name for one in tree.body if isinstance(one, ast.FunctionDef)}
    for node in ast.walk(tree):
        _require_listed(node, own)
    for node in tree.body:
        if not isinstance(node, (ast.FunctionDef, ast.Pass)):
            raise RefusedError("program-outside", node.lineno)
    _require_function(tree, function, parameters)
    return tree


def _require_flat(text: str) -> None:
    """Raise ``RefusedError`` for a text that is too long, or nested too deeply to be parsed."""
    depth = deepest = 0
    for sign in text:
        depth += (sign in "([{") - (sign in ")]}")
        deepest = max(deepest, depth)
    runs = max((len(line) - len(line.lstrip(" \t~-+not")) for line in text.split("\n")), default=0)
    if len(text) > MOST_TEXT or deepest > MOST_DEEP or runs > 4 * MOST_DEEP:
        raise RefusedError("program-syntax")


def _is_docstring(node: ast.stmt) -> bool:
    """Return whether a statement is a text that explains."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def _require_listed(node: ast.AST, own: set[str]) -> None:
    """Raise ``RefusedError`` for a part of a program that is not listed."""
    line = getattr(node, "lineno", 1)
    if not isinstance(node, TREES):
        raise RefusedError("program-refused", line, type(node).__name__.lower())
    if isinstance(node, ast.Call):
        _require_listed_call(node, own)
    elif isinstance(node, ast.Attribute):
        allowed = OF_NUMPY if _is_numpy(node.value) else OF_VALUES
        if node.attr not in allowed or not isinstance(node.ctx, ast.Load):
            raise RefusedError("program-refused", line, f".{node.attr}")
    elif isinstance(node, ast.Constant):
        _require_listed_constant(node)
    elif isinstance(node, ast.FunctionDef) and (node.decorator_list or node.args.kwarg):
        raise RefusedError("program-refused", line, "@" if node.decorator_list else "**")
    for name in _iter_names(node):
        if name.startswith("_") and name != "_":
            raise RefusedError("program-refused", line, name)


def _require_listed_call(node: ast.Call, own: set[str]) -> None:
    """Raise ``RefusedError`` for a call of something that has no listed name."""
    called = node.func
    if isinstance(called, ast.Name) and called.id not in BUILTINS.keys() | own:
        note = "program-prints" if called.id == "print" else "program-refused"
        raise RefusedError(note, node.lineno, called.id)
    if not isinstance(called, (ast.Name, ast.Attribute)):
        raise RefusedError("program-refused", node.lineno, ast.unparse(called)[:30])
    for keyword in node.keywords:
        inside = isinstance(called, ast.Name) and called.id in own
        if keyword.arg is None or not (inside or keyword.arg in KEYWORDS):
            raise RefusedError("program-refused", node.lineno, f"{keyword.arg or '**'}=")


def _require_listed_constant(node: ast.Constant) -> None:
    """Raise ``RefusedError`` for a text that is no name of a type, and for bytes."""
    value = node.value
    if value not in TYPES and not isinstance(value, (int, float, type(None), type(...))):
        raise RefusedError("program-refused", node.lineno, repr(value)[:30])


def _is_numpy(node: ast.expr) -> bool:
    """Return whether an expression is the name of NumPy."""
    return isinstance(node, ast.Name) and node.id == "np"


def _iter_names(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node uses or gives; ``np`` may not be given to anything else."""
    if isinstance(node, ast.Name):
        yield "__np" if node.id == "np" and not isinstance(node.ctx, ast.Load) else node.id
    elif isinstance(node, (ast.FunctionDef, ast.arg)):
        name = node.name if isinstance(node, ast.FunctionDef) else node.arg
        yield "__np" if name == "np" else name


def _require_function(tree: ast.Module, function: str, parameters: str) -> None:
    """Raise ``RefusedError`` unless the function is there and takes what it is given."""
    found = {one.name: one for one in tree.body if isinstance(one, ast.FunctionDef)}
    if function not in found:
        raise RefusedError("program-function", 1, f"def {function}({parameters}):")
    wanted = ast.parse(f"def f({parameters}): pass").body[0]
    args = found[function].args
    if args.vararg is None and len(args.args) != len(wanted.args.args):  # type: ignore[attr-defined]
        line = found[function].lineno
        raise RefusedError("program-parameters", line, f"def {function}({parameters}):")


class _Plainer(ast.NodeTransformer):
    """Takes away what has no effect: texts that explain, annotations, the usual import."""

    def visit_Import(self, node: ast.Import) -> ast.stmt:
        """Return nothing in place of ``import numpy as np``, which is so anyway."""
        usual = [(one.name, one.asname) for one in node.names] == [("numpy", "np")]
        return ast.copy_location(ast.Pass(), node) if usual else node

    def visit_Expr(self, node: ast.Expr) -> ast.stmt:
        """Return nothing in place of a text."""
        return ast.copy_location(ast.Pass(), node) if _is_docstring(node) else node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        """Return the function without annotations."""
        node.returns = None
        for one in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs):
            one.annotation = None
        self.generic_visit(node)
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.stmt:
        """Return a plain assignment."""
        if node.value is None:
            return ast.copy_location(ast.Pass(), node)
        return ast.copy_location(ast.Assign([node.target], node.value), node)


def lock() -> None:
    """Give up files, network, processes, privileges, and all but some memory and time.

    Whatever the system does not know is passed over: what runs afterwards is only what is listed.
    """
    used = int(_read("/proc/self/statm").split()[0]) * resource.getpagesize()
    libc = ctypes.CDLL(None, use_errno=True)
    with contextlib.suppress(AttributeError):
        libc.unshare(NEW_NETWORK) and libc.unshare(NEW_USER | NEW_NETWORK)
        libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    if os.geteuid() == 0:
        with contextlib.suppress(OSError):
            os.setgroups([])
            os.setgid(NOBODY)
            os.setuid(NOBODY)
    for kind, most in ((resource.RLIMIT_AS, used + MEMORY), (resource.RLIMIT_CPU, SECONDS),
                       (resource.RLIMIT_FSIZE, 0), (resource.RLIMIT_CORE, 0),
                       (resource.RLIMIT_NPROC, 0), (resource.RLIMIT_NOFILE, 0)):  # fmt: skip
        resource.setrlimit(kind, (most, most))
    os.close(0)


def _read(path: str) -> str:
    """Return what is in a file."""
    with open(path, encoding="utf-8") as file:  # noqa: PTH123 - nothing else needs pathlib here
        return file.read()


def import_loaded(name: str, *rest: Any) -> Any:
    """Return a module of NumPy that is loaded: NumPy looks some of its own up where it is called.

    No program can name this, as no name may begin with ``_``.
    """
    if name.partition(".")[0] == "numpy" and name in sys.modules:
        return __import__(name, *rest)
    raise ImportError(name)


class Result(NamedTuple):
    """What a call came to: the error it ends with, else a value, and whether its inputs stayed."""

    error: str
    value: Any
    intact: bool


class Programs:
    """Programs on hidden inputs.

    Parameters
    ----------
    np : module
        NumPy.
    job : mapping
        What the parent wrote.
    """

    def __init__(self, np: ModuleType, job: Mapping[str, Any]) -> None:
        """Store NumPy and the job."""
        self._np, self._job = np, job

    def judge(self) -> dict[str, Any]:
        """Return which cases the learner's program passes, and what is wrong with the first."""
        wanted = self._run(self._job["solution"])
        found = self._run(self._job["program"])
        differ = {name: self._compare(found[name], wanted[name]) for name in wanted}
        missed = [name for name, difference in differ.items() if difference]
        changed = [name for name, result in found.items() if not result.intact]
        told = next(iter([*missed, *changed]), "")
        trap = next((name for name, text in self._job["traps"].items()
                     if missed and self._is_alike(found, self._run(text))), "")  # fmt: skip
        return {
            "missed": missed,
            "changed": bool(changed),
            "trap": trap,
            "difference": differ.get(told) or {},
            "call": self._show_call(told) if told else "",
        }

    def _run(self, text: str) -> dict[str, Result]:
        """Return what a program makes of each case."""
        function = self._job["function"]
        tree = read_program(text, function, self._job["parameters"])
        space: dict[str, Any] = {
            "__builtins__": {**BUILTINS, "__import__": import_loaded},
            "np": self._np,
        }
        try:
            code = compile(ast.fix_missing_locations(tree), "answer", "exec")
        except SyntaxError as error:  # a break outside of a loop, one name for two parameters
            raise RefusedError("program-syntax", error.lineno or 1) from None
        try:
            exec(code, space)  # noqa: S102 - what is listed, in a process that may do nothing
        except Exception as raised:  # noqa: BLE001 - a default may be 1/0
            return dict.fromkeys(self._job["cases"], Result(_name_error(raised), None, True))
        return {name: self._call(space[function], name) for name in self._job["cases"]}

    def _call(self, function: Callable[..., Any], case: str) -> Result:
        """Return the error or the value of a call, and whether its inputs are as they were."""
        args, kept = self._read_args(case), self._read_args(case)
        try:
            value, error = function(*args), ""
        except Exception as raised:  # noqa: BLE001 - a learner's program may raise anything
            value, error = None, _name_error(raised)
        return Result(error, value, all(map(self._is_equal, args, kept)))

    def _read_args(self, case: str) -> list[Any]:
        """Return the inputs of a case; arrays stand under the name of their type."""
        return [
            self._np.array(*arg.values(), dtype=next(iter(arg))) if isinstance(arg, dict) else arg
            for arg in self._job["cases"][case]
        ]

    def _is_equal(self, one: Any, other: Any) -> bool:
        """Return whether two inputs are the same in every bit that counts."""
        return bool(
            type(one) is type(other)
            and self._np.array_equal(one, other, equal_nan=isinstance(one, float))
        )

    def _compare(self, found: Result, wanted: Result) -> dict[str, str] | None:
        """Return in what a value differs from the wanted one; None if in nothing."""
        if found.error:
            return {"note": "program-raises", "got": found.error}
        if found.value is None:
            return {"note": "program-nothing"}
        return self._compare_kinds(found.value, wanted.value) or self._compare_values(
            self._np.asarray(found.value), self._np.asarray(wanted.value), self._show(found.value)
        )

    def _compare_kinds(self, value: Any, goal: Any) -> dict[str, str] | None:
        """Return whether a number stands for an array or the other way round; None if not."""
        np = self._np
        is_wanted = isinstance(goal, np.ndarray)
        is_given = isinstance(value, np.ndarray)
        if is_wanted and not is_given:
            return {"note": "program-no-array", "got": self._show(value)}
        known = is_given or isinstance(value, (bool, int, float, np.generic))
        if (
            not known
            or np.asarray(value).dtype.kind not in "biuf"
            or (is_given and value.ndim and not is_wanted)
        ):
            return {"note": "program-no-number", "got": self._show(value)}
        return None

    def _compare_values(self, one: Any, other: Any, got: str) -> dict[str, str] | None:
        """Return in what two arrays differ: shape, type, values; None if in nothing."""
        np = self._np
        if one.shape != other.shape:
            return {"note": "program-shape", "given": str(one.shape), "wanted": str(other.shape)}
        if other.ndim and not _is_same_type(one.dtype, other.dtype):
            wanted = "float" if other.dtype.kind == "f" else str(other.dtype)
            return {"note": "program-dtype", "given": str(one.dtype), "wanted": wanted}
        off = ~np.isclose(one.astype(float), other.astype(float), CLOSE, CLOSE, equal_nan=True)
        if not off.any():
            return None
        if not off.ndim:
            return {"note": "program-value", "got": got}
        place = [int(index[0]) for index in np.nonzero(off)]
        return {"note": "program-values", "got": got, "place": str(place), "count": str(off.sum())}

    def _is_alike(self, one: dict[str, Result], other: dict[str, Result]) -> bool:
        """Return whether two programs do the same on all cases."""
        return all(
            _kind_of_error(one[name]) == _kind_of_error(other[name])
            and (one[name].error or self._compare(one[name], other[name]) is None)
            for name in one
        )

    def _show_call(self, case: str) -> str:
        """Return the call of a case, as one would write it."""
        return f"{self._job['function']}({', '.join(map(self._show, self._read_args(case)))})"

    def _show(self, value: Any) -> str:
        """Return a value as people read it, shortened."""
        np = self._np
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, int) and abs(value) > HUGE:
            return type(value).__name__
        if isinstance(value, np.ndarray):
            text = np.array2string(value, separator=", ", precision=4, threshold=40, edgeitems=2,
                                   max_line_width=10**6)  # fmt: skip
            text = f"{' '.join(text.split())} ({value.dtype})"
        elif isinstance(value, (bool, int, float)):
            text = f"{value:.6g}" if isinstance(value, float) else str(value)
        else:
            text = type(value).__name__
        return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"


def _name_error(raised: Exception) -> str:
    """Return an error as Python prints it, shortened."""
    return f"{type(raised).__name__}: {raised}"[:SHOWN]


def _kind_of_error(result: Result) -> str:
    """Return the type of the error that a call ended with; empty if with none."""
    return result.error.partition(":")[0]


def _is_same_type(one: Any, other: Any) -> bool:
    """Return whether types of arrays are alike: floats of any width, else the same."""
    return bool(one.kind == other.kind and (one.kind == "f" or one == other))


def judge_job(np: ModuleType, job: bytes) -> dict[str, Any]:
    """Return the outcome of a job, for which this process gives up all that it may do."""
    wanted = json.loads(job)
    lock()
    try:
        return Programs(np, wanted).judge()
    except RefusedError as error:
        return {"refused": error.note, "line": error.line, "found": error.found}
    except MemoryError:
        return {"refused": "program-time"}
    except Exception as error:  # noqa: BLE001 - the parent hears of it
        return {"fault": _name_error(error)}


def fork_job(np: ModuleType, job: bytes) -> bytes:
    """Return what a fork says of a job: JSON, in which ``fault`` says why it came to nothing."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        try:
            os.dup2(writing, 1)
            os.closerange(2, writing + 1)
            os.write(1, json.dumps(judge_job(np, job)).encode())
        finally:
            os._exit(0)
    os.close(writing)
    told = _read_until(reading, time.monotonic() + HANGS)
    os.close(reading)
    if told is None:
        os.kill(child, signal.SIGKILL)
    ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if told is None:
        return json.dumps({"fault": f"no outcome after {HANGS:g} seconds"}).encode()
    # without a word: its limits left it none
    return told if told and not ended else json.dumps({"refused": "program-time"}).encode()


def _read_until(stream: int, end: float) -> bytes | None:
    """Return all that is written to a pipe, as far as it may be; None if that takes too long."""
    told = b""
    while len(told) < LARGEST:
        if not select.select([stream], [], [], max(0.0, end - time.monotonic()))[0]:
            return None
        more = os.read(stream, LARGEST)
        if not more:
            break
        told += more
    return told


def main() -> None:
    """Read jobs from standard input, each after its length, and write outcomes likewise."""
    import numpy as np

    np.array2string(np.ones(2) / 3)  # what it loads late, it cannot load afterwards
    warnings.simplefilter("ignore")
    sys.setrecursionlimit(500)
    jobs, outcomes = sys.stdin.buffer, sys.stdout.buffer
    while select.select([0], [], [], IDLE)[0] and (length := jobs.readline()):
        told = fork_job(np, jobs.read(int(length)))
        outcomes.write(b"%d\n%b" % (len(told), told))
        outcomes.flush()


if __name__ == "__main__":
    main()
