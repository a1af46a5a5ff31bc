"""A bank: a folder with ``templates/`` and ``solvers/``, read on demand.

Beside the templates may stand ``bank.toml`` (title, topics), ``blueprints/``, ``cards/`` and
``curriculum.toml``: what the bank is about, and ``figures/``: what it draws.

The built-in bank is the first one; a third party's bank is a folder of the same shape. Text is
always safe to read. Solvers and figures are Python, so a foreign bank runs its own only when it is
trusted.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, cached_property
from pathlib import Path
from types import ModuleType

from quizgen.bank.candidate import Candidate
from quizgen.bank.drawn_lists import list_table_files
from quizgen.bank.language_file import read_language_file
from quizgen.bank.markdown import LanguageFile
from quizgen.bank.metadata import (
    BankMetadata,
    Curriculum,
    grading_words,
    pick_language,
    read_metadata,
    read_optional,
)
from quizgen.bank.pictures import pictures_beside, read_pictures
from quizgen.bank.quantities import QuantityNames, read_quantities
from quizgen.bank.rules import Rules, suggested_minutes, total_points
from quizgen.bank.solvers import import_module_file, load_chain, unload_modules
from quizgen.bank.template import Template, check_against_chain, read_rules
from quizgen.core.cache import compute_digest
from quizgen.core.errors import BankError
from quizgen.core.untrusted import (
    NAMES,
    error_context,
    is_identifier,
    read_bytes,
    require_identifier,
)
from quizgen.locale import list_languages, register_languages, resolve_language_choice
from quizgen.locale.custom import TAG
from quizgen.maths.chain import Chain

SOLVERS, TEMPLATES, FIGURES = "solvers", "templates", "templates/figures"
"""Where the Python of a bank stands."""
OWN_DATA = "data"
"""The module beside a template that draws its data, if it has ``[data]``."""
OWN_FIGURE = "figure"
"""The module beside a template that draws its figure, if ``[figure]`` names no other."""
LOCALE = "locale"
"""Where its words of a language stand, a folder for each."""
_BESIDE = ("blueprints", "cards", "figures", LOCALE, "quantities")
"""Folders beside the topics."""
PROSE = re.compile(rf"{TAG}\.md")
"""What a language's file is called."""


def builtin_root() -> Path:
    """Folder of the built-in bank: inside the installed package, else the checkout."""
    package = Path(__file__).parent.parent
    installed = package / "builtin"
    return installed if installed.is_dir() else package.parent


class _MissingError(BankError):
    """A template asks for a solver or a figure that is not there."""


class Bank:
    """Templates and solvers of one folder.

    Parameters
    ----------
    root : pathlib.Path
        Folder that holds ``templates/`` and, optionally, ``solvers/``.
    trusted : bool
        Whether its own solvers may run; otherwise only built-in ones are used.
    """

    def __init__(self, root: Path, *, trusted: bool = False) -> None:
        self.root = root
        self.trusted = trusted
        self._templates: dict[str, Template] = {}
        self._rules: dict[str, Rules] = {}
        self._candidates: dict[str, Candidate] = {}
        self._pages: dict[str, list[Path]] = {}
        self._chains: dict[str, tuple[Chain, bytes]] = {}
        if not self.folder.is_dir():
            raise BankError(f"{root}: no folder 'templates' here")
        register_languages(place=self.folder / LOCALE)

    @property
    def members(self) -> tuple[Bank, ...]:
        """The banks that it consists of: itself, unless it is a mixed one."""
        return (self,)

    def owner_of(self, name: str) -> tuple[Bank, str]:
        """The bank that a template stands in, and what it is called there.

        Raises
        ------
        BankError
            If there is none of this name; tells similar ones.
        """
        self.folder_of(name)
        return self, name

    @property
    def name(self) -> str:
        """What the bank is called: as it says, else as its folder is."""
        return self.metadata.name or self.root.resolve().name

    @property
    def _solver_folder(self) -> Path:
        return self.root / SOLVERS

    @cached_property
    def _figure_folder(self) -> Path:
        return self.root / FIGURES

    @property
    def folder(self) -> Path:
        """Where templates and what is about them stand."""
        return self.root / "templates"

    @cached_property
    def metadata(self) -> BankMetadata:
        """What ``bank.toml`` says; nothing if there is none."""
        return read_metadata(self.folder / "bank.toml")

    @cached_property
    def curriculum(self) -> Curriculum:
        """What the bank is to cover; nothing if it does not say."""
        return read_optional(self.folder / "curriculum.toml", Curriculum)

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """Languages that the bank says it is written in, else those of its templates."""
        found = self.metadata.languages or sorted(
            {lang for name in self.template_paths for lang in self.template_languages(name)}
        )
        register_languages(found)
        return self.metadata.languages or tuple(lang for lang in list_languages() if lang in found)

    def resolve_languages(self, choice: str) -> tuple[str, ...]:
        """Languages of a choice, the leading one first; ``both`` stands for those of the bank.

        Raises
        ------
        BankError
            If nothing here is written in it.
        InvalidChoiceError
            If there is no such language.
        """
        langs = resolve_language_choice(choice, self.languages)
        for lang in set(langs) - set(self.languages or langs):
            if not any(lang in self.template_languages(name) for name in self.template_paths):
                held = ", ".join(self.languages)
                raise BankError(
                    f"nothing in {self.title('en')!r} is written in {lang!r} (only in {held})"
                )
        return langs

    @cached_property
    def topics(self) -> tuple[str, ...]:
        """Topics in the order of ``bank.toml``, else those of the templates."""
        return tuple(self.metadata.topics) or tuple(
            sorted({self.rules(n).topic for n in self.template_paths})
        )

    def title(self, lang: str) -> str:
        """Title of the chapter."""
        return pick_language(self.metadata.title, lang, _make_title_from_name(self.name))

    def topic_title(self, topic: str, lang: str) -> str:
        """Title of a topic."""
        return pick_language(
            self.metadata.topics.get(topic, {}), lang, _make_title_from_name(topic)
        )

    @cached_property
    def blueprints(self) -> dict[str, Path]:
        """Name of each blueprint to its file."""
        return self._list_toml_files("blueprints")

    def template_names_for(self, plan: str) -> Mapping[str, str]:
        """What a blueprint calls templates to their names here; nothing if these are the same."""
        del plan
        return {}

    @cached_property
    def cards(self) -> dict[str, Path]:
        """Name of each file of card content to the file."""
        return self._list_toml_files("cards")

    @cached_property
    def quantities(self) -> dict[str, QuantityNames]:
        """Solver to what its letters mean."""
        return read_quantities(self._list_toml_files("quantities").values())

    def _list_toml_files(self, name: str) -> dict[str, Path]:
        return {path.stem: path for path in sorted((self.folder / name).glob("*.toml"))}

    def __reduce__(self) -> tuple[object, ...]:
        """Another process opens the folder for itself."""
        return (
            (builtin_bank, ())
            if self is builtin_bank()
            else (_open_bank, (self.root, self.trusted))
        )

    def __repr__(self) -> str:
        return f"<Bank {self.root.name}: {len(self)} templates>"

    @cached_property
    def template_paths(self) -> dict[str, Path]:
        """Template name to its folder, in alphabetical order; of one name the first stands here."""
        return {name: folders[0] for name, folders in self._template_folders.items()}

    @cached_property
    def _template_folders(self) -> dict[str, list[Path]]:
        return find_template_folders(self.folder, _BESIDE)

    def reload(self) -> Bank:
        """The same bank, its files and solvers read again."""
        unload_modules(self._figure_folder)
        for folder in self.template_paths.values():
            if any((folder / f"{own}.py").is_file() for own in (OWN_FIGURE, OWN_DATA)):
                unload_modules(folder)
        return Bank(self.root, trusted=self.trusted)

    def solver(self, name: str) -> ModuleType:
        """Import a solver module of this bank.

        Raises
        ------
        BankError
            If it does not exist or fails, or the bank has solvers of its own and is not trusted.
        """
        return (
            import_module_file(self._solver_folder, name)
            if self._has_own_solver(name)
            else builtin_bank().solver(name)
        )

    def chain(self, name: str) -> tuple[Chain, bytes]:
        """The chain of a solver, once, and its source.

        Raises
        ------
        BankError
            As for ``solver``, or if it holds no model.
        """
        if not self._has_own_solver(name):
            return builtin_bank().chain(name)
        if name not in self._chains:
            self._chains[name] = load_chain(self._solver_folder, name)
        return self._chains[name]

    def _solver_file(self, name: str) -> Path | None:
        """The module of a solver, this bank's or the built-in one's."""
        if not name:
            return None
        root = self.root if self._has_own_solver(name) else builtin_root()
        return root / SOLVERS / f"{name}.py"

    def _has_own_solver(self, name: str) -> bool:
        """Whether a solver is one of this bank, not of the built-in one."""
        if not all(map(is_identifier, name.split("/"))):
            what = f"solver: {name!r} is no name (allowed: {NAMES}, folders by '/')"
            raise _MissingError(what, rule="QG108", place=("solver",))
        file = self._solver_folder / f"{name}.py"
        if not file.exists() and self.root == builtin_root():
            what = f"solver {name!r}: no such solver"
            raise _MissingError(what, rule="QG126", place=("solver",))
        if file.exists():
            self._must_be_trusted(file)
        return file.exists()

    @cached_property
    def figures(self) -> tuple[str, ...]:
        """Names of the figures that it brings."""
        return tuple(sorted(path.stem for path in self._figure_folder.glob("[a-z]*.py")))

    def figure(self, name: str) -> ModuleType:
        """Import a figure of this bank, or of the built-in one if it has none of this name.

        Raises
        ------
        BankError
            If it does not exist or fails, or the bank is not trusted.
        """
        file = self.figure_file(name)
        return import_module_file(file.parent, file.stem)

    def figure_file(self, name: str) -> Path:
        """The module of a figure, not imported; errors as ``figure``, but those of its code."""
        if name in self.figures:
            file = self._figure_folder / f"{name}.py"
            self._must_be_trusted(file)
            return file
        if name not in builtin_bank().figures:
            known = sorted({*self.figures, *builtin_bank().figures})
            what = f"unknown figure {name!r}; there are {', '.join(known)}"
            raise _MissingError(what, rule="QG127", place=("figure", "name"))
        return builtin_bank().figure_file(name)

    def _figure_of(self, name: str) -> Path | None:
        """What draws a template's figure: the module that it names, or the one beside it."""
        rule = self.rules(name).figure
        if rule is None or rule.name:
            return self.figure_file(rule.name) if rule else None
        file = self.folder_of(name) / f"{OWN_FIGURE}.py"
        if not file.is_file():
            what = f"[figure] has no name, and there is no {file.name} beside it"
            raise _MissingError(what, rule="QG127", place=("figure",))
        self._must_be_trusted(file)
        return file

    def _data_of(self, name: str) -> Path | None:
        """What draws a template's data: the module beside it, if it has ``[data]``."""
        if not self.rules(name).data:
            return None
        file = self.folder_of(name) / f"{OWN_DATA}.py"
        if not file.is_file():
            what = f"there is [data], and no {file.name} beside it"
            raise _MissingError(what, rule="QG127", place=("data",))
        self._must_be_trusted(file)
        return file

    def _must_be_trusted(self, file: Path) -> None:
        if not self.trusted:
            what = "this bank brings its own Python; allow it with --trust"
            raise BankError(what, rule="QG128", file=file)

    def rules(self, name: str) -> Rules:
        """Checked ``template.toml`` of a template, without loading solver or prose."""
        if name not in self._rules:
            path = self.folder_of(name) / "template.toml"
            check_name(self._template_folders[name])
            rules = read_rules(path)
            if rules.topic not in (self.metadata.topics or {rules.topic}):
                allowed = ", ".join(self.metadata.topics)
                what = f"topic {rules.topic!r} is not in bank.toml ({allowed})"
                raise BankError(what, rule="QG129", file=path, place=("topic",))
            self._rules[name] = rules
        return self._rules[name]

    def origin(self, name: str) -> str:
        """The name that a template's numbers are drawn under: its first one."""
        return self.rules(name).formerly or name

    def candidates(self, names: Iterable[str] | None = None) -> list[Candidate]:
        """What a paper may choose from: the templates named, or all of them.

        Only the rules of those are read, so that one that is wrong stops no paper that lists
        others.

        Raises
        ------
        BankError
            If one of them is unknown or wrong.
        """
        return [self._candidate(name) for name in (self.template_paths if names is None else names)]

    def _candidate(self, name: str) -> Candidate:
        if name not in self._candidates:
            rules, (owner, _) = self.rules(name), self.owner_of(name)
            # A figure of the template's own has no name: it is a kind by itself.
            figure = (rules.figure.name or name) if rules.figure and rules.figure.quiz else ""
            self._candidates[name] = Candidate(
                name,
                self.origin(name),
                self.members.index(owner),
                rules.tier,
                rules.topic,
                rules.beyond,
                total_points(rules),
                Fraction(suggested_minutes(rules)),
                figure,
                figure in owner.metadata.photographs,
                frozenset(rules.apart),
                rules.pool,
            )
        return self._candidates[name]

    def template(self, name: str) -> Template:
        """Load a template, once.

        Raises
        ------
        BankError
            If it is unknown or wrong; names the file and the place.
        """
        if name not in self._templates:
            with error_context(self.folder_of(name) / "template.toml", _MissingError):
                self._templates[name] = self._load_template(name)
        return self._templates[name]

    def folder_of(self, name: str) -> Path:
        """Folder of a template.

        Raises
        ------
        BankError
            If there is none of this name; tells similar ones.
        """
        if name not in self.template_paths:
            raise BankError(f"unknown template {name!r}{self._suggest_template(name)}")
        return self.template_paths[name]

    def _suggest_template(self, name: str) -> str:
        renamed = [known for known in self.template_paths if self.rules(known).formerly == name]
        if renamed:
            return f"; it is now called {renamed[0]!r}"
        from difflib import get_close_matches

        close = get_close_matches(name, self.template_paths, 3)
        if close:
            return f"; did you mean {', '.join(close)}?"
        return f" (there are {len(self.template_paths)}; quizgen templates lists them)"

    def template_files(self, name: str) -> tuple[bytes, ...]:
        """The files behind a template; none of them is run."""
        return tuple(read_bytes(file, BankError) for file in self._list_template_files(name))

    def _list_template_files(self, name: str) -> list[Path]:
        """Rules, words, pictures, solver and figure of a template."""
        rules = self.rules(name)
        figure = rules.figure.name if rules.figure else ""
        solver = Path(SOLVERS, f"{rules.solver}.py")
        roots = [root for root in (self.root, builtin_root()) if (root / solver).is_file()]
        python = [*(root / solver for root in roots[:1]), self._figure_folder / f"{figure}.py"]
        python += self._beside_template(name)
        return [
            self.folder_of(name) / "template.toml",
            *self._list_prose_files(name),
            *pictures_beside(self.folder_of(name)),
            *filter(Path.is_file, python),
        ]

    def _beside_template(self, name: str) -> list[Path]:
        """What draws figure and data beside a template, and the tables that it reads."""
        rules, folder = self.rules(name), self.folder_of(name)
        own = {OWN_FIGURE: rules.figure and not rules.figure.name, OWN_DATA: rules.data}
        files = [folder / f"{module}.py" for module, used in own.items() if used]
        files += sorted({folder / table for table in list_table_files(rules)})
        return [file for file in files if file.is_file()]

    def template_languages(self, name: str) -> tuple[str, ...]:
        """Languages that a template is written in, without reading them."""
        return tuple(path.stem for path in self._list_prose_files(name))

    def _list_prose_files(self, name: str) -> list[Path]:
        if name not in self._pages:
            found = sorted(self.folder_of(name).iterdir())
            self._pages[name] = [path for path in found if PROSE.fullmatch(path.name)]
        return self._pages[name]

    def _load_template(self, name: str) -> Template:
        folder = self.folder_of(name)
        rules = self.rules(name)
        prose = self._list_prose_files(name)
        files = [folder / "template.toml", *prose, *self._beside_template(name)]
        files += pictures_beside(folder)
        chain, source = self.chain(rules.solver) if rules.solver else (Chain({}, ()), b"")
        texts = {path.stem: read_language_file(path) for path in prose}
        register_languages(sorted(texts))
        order = [lang for lang in list_languages() if lang in texts]
        words = grading_words(self.metadata, [part.answer for part in rules.part])
        digest = compute_digest(*(read_bytes(path, BankError) for path in files), source, *words)
        ordered: dict[str, LanguageFile] = {lang: texts[lang] for lang in order}
        quantities = self.quantities.get(rules.solver, QuantityNames())
        figure, data = self._figure_of(name), self._data_of(name)
        template = Template(
            name, rules, chain, ordered, digest, folder, self.metadata, quantities, figure,
            self._solver_file(rules.solver), data, read_pictures(folder, ordered),
        )  # fmt: skip
        check_against_chain(template)
        return template

    def __iter__(self) -> Iterator[Template]:
        """All templates in alphabetical order."""
        return (self.template(name) for name in self.template_paths)

    def __len__(self) -> int:
        """How many templates there are."""
        return len(self.template_paths)


def _open_bank(root: Path, trusted: bool) -> Bank:
    return Bank(root, trusted=trusted)


def _make_title_from_name(name: str) -> str:
    return name.replace("-", " ").replace("_", " ").capitalize()


@cache
def builtin_bank() -> Bank:
    """The built-in bank."""
    return Bank(builtin_root(), trusted=True)


def find_template_folders(templates: Path, beside: Collection[str]) -> dict[str, list[Path]]:
    """Name to all folders that are called so, although one alone may be.

    Parameters
    ----------
    templates : pathlib.Path
    beside : collection of str
        Folders in it that hold something else.
    """
    found: dict[str, list[Path]] = {}
    others = {templates / name for name in beside}
    for folder in sorted(path.parent for path in templates.glob("**/template.toml")):
        if folder not in others:
            found.setdefault(folder.name, []).append(folder)
    return found


def check_name(folders: Sequence[Path]) -> None:
    """Refuse a template that cannot be called by its name; the others stay what they are.

    Raises
    ------
    BankError
        If it is no name, or another folder has it, too.
    """
    folder, *others = folders
    file = folder / "template.toml"
    with error_context(file, BankError):
        require_identifier(folder.name, "folder", BankError)
    if others:
        also = ", ".join(map(str, others))
        what = f"two templates share the name {folder.name!r}: also {also}"
        raise BankError(what, rule="QG125", file=file)
