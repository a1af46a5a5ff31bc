"""Banks that are installed, and whose Python may run.

A package brings a bank by an entry point of the group ``quizgen.banks``: a name, and the package
that holds ``templates/``. The bank is called as its ``bank.toml`` says. Nothing of it is imported
to find it. Whose Python a person has allowed to run is remembered by what it says, so that a bank
that changes is asked for again.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import msgspec

from quizgen.bank.bank import SOLVERS, TEMPLATES, Bank, builtin_bank, builtin_root
from quizgen.bank.metadata import read_metadata
from quizgen.core.cache import compute_digest
from quizgen.core.errors import BankError
from quizgen.core.files import write_all
from quizgen.core.untrusted import read_bytes

GROUP = "quizgen.banks"
_FILE = "trusted.json"


@cache
def installed_banks() -> dict[str, Path]:
    """Return the folder of each bank that a package brings, by the name of its entry point."""
    from importlib.metadata import entry_points  # it brings the parser of e-mail along

    found: dict[str, Path] = {}
    for entry in entry_points(group=GROUP):
        spec = find_spec(entry.value)
        for place in spec.submodule_search_locations or () if spec else ():
            found[entry.name] = Path(place)
    return found


def available_banks() -> dict[str, Path]:
    """Return the folder of the built-in bank, and of each that a package brings, by name.

    That is the ``name`` in ``bank.toml``. The entry point's name stands for a bank that has none,
    that cannot be read, or whose name another one has taken.
    """
    found = {builtin_bank().name: builtin_root()}
    for entry, place in installed_banks().items():
        own = ""
        with suppress(BankError):
            own = read_metadata(place / TEMPLATES / "bank.toml").name
        found[own if own and own not in found else entry] = place
    return found


def resolve_bank(named: Path) -> Path:
    """Return the folder of a bank: the given one, or that of a bank of this name.

    A folder that happens to have the name of an installed bank, such as that of a project, is one
    only if it holds templates.

    Raises
    ------
    BankError
        If there is neither; it tells the names there are.
    """
    if (named / TEMPLATES).is_dir():
        return named
    known = {**installed_banks(), **available_banks()}
    if str(named) in known:
        return known[str(named)]
    if named.exists():
        return named
    raise BankError(
        f"{named}: no such folder, and no bank of this name ({', '.join(available_banks())})"
    )


def python_files(root: Path) -> list[Path]:
    """Return the Python that a bank brings: solvers, figures, and what stands in templates."""
    return sorted(path for kind in (SOLVERS, TEMPLATES) for path in (root / kind).rglob("*.py"))


def python_digest(root: Path) -> str:
    """Return a digest that changes whenever the Python of a bank does."""
    files = python_files(root)
    names = [path.relative_to(root).as_posix().encode() for path in files]
    return compute_digest(*names, *(read_bytes(path, BankError) for path in files))


def is_trust_remembered(root: Path) -> bool:
    """Return whether a person has allowed the Python of a bank to run, as it is now."""
    return python_digest(root) in _read_remembered()


def remember_trust(root: Path) -> None:
    """Let the Python of a bank run from now on, until it changes."""
    table = {**_read_remembered(), python_digest(root): str(root.resolve())}
    write_all(_get_user_data_folder(), {_FILE: msgspec.json.format(msgspec.json.encode(table))})


def _read_remembered() -> dict[str, str]:
    """Return the digest of the Python that was allowed, by folder; empty without a usable file."""
    with suppress(OSError, msgspec.MsgspecError):
        return msgspec.json.decode(
            (_get_user_data_folder() / _FILE).read_bytes(), type=dict[str, str]
        )
    return {}


def _get_user_data_folder() -> Path:
    """Return the user's own data folder, created if it is missing."""
    from platformdirs import user_data_path

    return user_data_path("quizgen", ensure_exists=True)


def describe_bank(name: str, bank: Bank) -> tuple[str, ...]:
    """Return the row of a bank: name, version, languages, templates, trust, folder."""
    about = bank.metadata
    if not python_files(bank.root):
        runs = "none"
    else:
        runs = "runs" if bank.trusted or is_trust_remembered(bank.root) else "needs --trust"
    languages = ", ".join(bank.languages)
    return (name, about.version, languages, str(len(bank)), runs, about.licence, str(bank.root))
