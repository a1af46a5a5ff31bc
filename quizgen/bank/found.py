"""Banks that are installed, and whose Python may run.

A package brings a bank by an entry point of the group ``quizgen.banks``: a name, and the package
that holds ``templates/``. Nothing of it is imported to find it. Whose Python a person has allowed
to run is remembered by what it says, so that a bank that changes is asked for anew.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import msgspec

from quizgen.bank.folder import SOLVERS, TEMPLATES, Bank, builtin, builtin_root
from quizgen.errors import BankError
from quizgen.files import write_all
from quizgen.kept import digest_of
from quizgen.outside import read_bytes

GROUP = "quizgen.banks"
_FILE = "trusted.json"


@cache
def installed() -> dict[str, Path]:
    """Name of each bank that a package brings to its folder."""
    from importlib.metadata import entry_points  # it brings the parser of e-mail along

    found: dict[str, Path] = {}
    for entry in entry_points(group=GROUP):
        spec = find_spec(entry.value)
        for place in spec.submodule_search_locations or () if spec else ():
            found[entry.name] = Path(place)
    return found


def known() -> dict[str, Path]:
    """Name to folder of the built-in bank, and of each that a package brings."""
    return {builtin().name: builtin_root(), **installed()}


def root_of(named: Path) -> Path:
    """The folder of a bank: itself, or that of the built-in or an installed bank of this name.

    Raises
    ------
    BankError
        If there is neither; it tells the names there are.
    """
    if named.exists():
        return named
    if str(named) not in known():
        raise BankError(f"{named}: no such folder, and no bank of this name ({', '.join(known())})")
    return known()[str(named)]


def python_of(root: Path) -> list[Path]:
    """The Python that a bank brings: solvers, figures, and what stands beside its templates."""
    return sorted(path for kind in (SOLVERS, TEMPLATES) for path in (root / kind).rglob("*.py"))


def digest_of_python(root: Path) -> str:
    """Changes whenever the Python of a bank does."""
    files = python_of(root)
    names = [path.relative_to(root).as_posix().encode() for path in files]
    return digest_of(*names, *(read_bytes(path, BankError) for path in files))


def is_remembered(root: Path) -> bool:
    """Whether a person has allowed the Python of a bank to run, as it is now."""
    return digest_of_python(root) in _remembered()


def remember(root: Path) -> None:
    """Let the Python of a bank run from now on, until it changes."""
    table = {**_remembered(), digest_of_python(root): str(root.resolve())}
    write_all(_place(), {_FILE: msgspec.json.format(msgspec.json.encode(table))})


def _remembered() -> dict[str, str]:
    with suppress(OSError, msgspec.MsgspecError):
        return msgspec.json.decode((_place() / _FILE).read_bytes(), type=dict[str, str])
    return {}


def _place() -> Path:
    from platformdirs import user_data_path

    return user_data_path("quizgen", ensure_exists=True)


def described(name: str, bank: Bank) -> tuple[str, ...]:
    """A bank as a row: name, version, languages, templates, whether its Python runs, and place."""
    about = bank.about
    if not python_of(bank.root):
        runs = "none"
    else:
        runs = "runs" if bank.trusted or is_remembered(bank.root) else "needs --trust"
    languages = ", ".join(bank.languages)
    return (name, about.version, languages, str(len(bank)), runs, about.licence, str(bank.root))
