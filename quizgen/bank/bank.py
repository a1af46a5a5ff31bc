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
from contextlib import suppress
from fractions import Fraction
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType, ModuleType

import msgspec

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
from quizgen.bank.rules import Rules
from quizgen.bank.solvers import import_module_file, load_chain, unload_modules
from quizgen.bank.template import Template, check_against_chain, read_rules
from quizgen.bank.working_time import working_minutes
from quizgen.core.cache import compute_digest
from quizgen.core.errors import BankError, QuizgenError
from quizgen.core.trusted_files import trust_folder
from quizgen.core.untrusted import (
    NAMES,
    error_context,
    is_identifier,
    read_bytes,
    read_text,
    require_identifier,
)
from quizgen.kinds import KINDS
from quizgen.kinds.contract import asked_quantities
from quizgen.locale import list_languages, register_languages, resolve_language_choice
from quizgen.locale.custom import TAG
from quizgen.maths.chain import Chain
from quizgen.maths.numbers import parse_written_number

SOLVERS, TEMPLATES, FIGURES = "solvers", "templates", "templates/figures"
"""Where the Python of a bank stands."""
OWN_DATA = "data"
"""The module beside a template that draws its data, if it has ``[data]``."""
OWN_CHECK = "check"
"""The module beside a template that judges answers of kind ``checked``."""
OWN_FIGURE = "figure"
"""The module beside a template that draws its figure, if ``[figure]`` names no other."""
OWN_MODULES = (OWN_FIGURE, OWN_DATA, OWN_CHECK)
LOCALE = "locale"
"""Where its words of a language stand, a folder for each."""
_BESIDE = ("blueprints", "cards", "figures", LOCALE, "quantities")
"""Folders beside the topics."""
PROSE = re.compile(rf"{TAG}\.md")
"""What a language's file is called."""


def builtin_root() -> Path:
    """Return the folder of the built-in bank: inside the installed package, else the checkout."""
    package = Path(__file__).parent.parent
    installed = package / "builtin"
    return installed if installed.is_dir() else package.parent


class _MissingError(BankError):
    """Raised where a template asks for a solver or a figure that does not exist."""


class Bank:
    """Templates and solvers of one folder.

    Parameters
    ----------
    root : pathlib.Path
        Folder that holds ``templates/`` and, optionally, ``solvers/``.
    trusted : bool
        Whether its own solvers may run; otherwise only built-in ones are used.
    left_out : mapping, optional
        What is wrong with templates that it is to be without, by name.
    """

    def __init__(
        self,
        root: Path,
        *,
        trusted: bool = False,
        left_out: Mapping[str, QuizgenError] = MappingProxyType({}),
    ) -> None:
        """Open the folder; nothing in it is read yet but its languages.

        Raises
        ------
        BankError
            If it has no folder ``templates``.
        """
        self.root = root
        self.trusted = trusted
        self.left_out = left_out
        self._templates: dict[str, Template] = {}
        self._rules: dict[str, Rules] = {}
        self._candidates: dict[str, Candidate] = {}
        self._minutes: dict[str, Fraction] = {}
        self._pages: dict[str, list[Path]] = {}
        self._chains: dict[str, tuple[Chain, bytes]] = {}
        if not self.folder.is_dir():
            raise BankError(f"{root}: no folder 'templates' here")
        register_languages(place=self.folder / LOCALE)
        if trusted:
            trust_folder(self.folder)

    @property
    def members(self) -> tuple[Bank, ...]:
        """Return the banks that it consists of: itself, unless it is a ``CombinedBank``."""
        return (self,)

    def owner_of(self, name: str) -> tuple[Bank, str]:
        """Return the bank that a template stands in, and its name there.

        Raises
        ------
        BankError
            If there is none of this name; suggests similar ones.
        """
        self.folder_of(name)
        return self, name

    @property
    def name(self) -> str:
        """Return the name in ``bank.toml``, else that of the folder."""
        return self.metadata.name or self.root.resolve().name

    @property
    def _solver_folder(self) -> Path:
        """Return the folder of its own solvers, which may not exist."""
        return self.root / SOLVERS

    @cached_property
    def _figure_folder(self) -> Path:
        """Return the folder of its own figures, which may not exist."""
        return self.root / FIGURES

    @property
    def folder(self) -> Path:
        """Return the folder ``templates``: templates, metadata, cards, blueprints."""
        return self.root / "templates"

    @cached_property
    def metadata(self) -> BankMetadata:
        """Return what ``bank.toml`` says; empty metadata if there is no such file."""
        return read_metadata(self.folder / "bank.toml")

    @cached_property
    def curriculum(self) -> Curriculum:
        """Return what the bank is to cover; empty if it has no such file."""
        return read_optional(self.folder / "curriculum.toml", Curriculum)

    @cached_property
    def _sections(self) -> Mapping[str, str]:
        """Return the section of the notes in which each item of the curriculum stands."""
        return self.curriculum.sections

    def notes_section(self, template: str) -> str:
        """Return the number of the section of the notes that a template is about, or nothing."""
        covers = self.rules(template).covers
        return next((self._sections[item] for item in covers if item in self._sections), "")

    def section_title(self, section: str, lang: str) -> str:
        """Return the title of a section of the notes; its number if there is none."""
        titles = {one.section: one.title for one in self.curriculum.notes}
        return pick_language(titles.get(section, {}), lang, section)

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """Return the languages that ``bank.toml`` lists, else those of its templates."""
        found = self.metadata.languages or sorted(
            {lang for name in self.template_paths for lang in self.template_languages(name)}
        )
        register_languages(found)
        return self.metadata.languages or tuple(lang for lang in list_languages() if lang in found)

    def resolve_languages(self, choice: str) -> tuple[str, ...]:
        """Return the languages of a choice, the leading one first.

        ``both`` stands for those of the bank. A language that only some templates are written in
        may be chosen, too.

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
        """Return the topics in the order of ``bank.toml``, else those of the templates by name."""
        return tuple(self.metadata.topics) or tuple(
            sorted({self.rules(n).topic for n in self.template_paths})
        )

    def title(self, lang: str) -> str:
        """Return the title of the chapter, made from the bank's name if it has none."""
        return pick_language(self.metadata.title, lang, _make_title_from_name(self.name))

    def topic_title(self, topic: str, lang: str) -> str:
        """Return the title of a topic, made from its name if it has none."""
        return pick_language(
            self.metadata.topics.get(topic, {}), lang, _make_title_from_name(topic)
        )

    @cached_property
    def blueprints(self) -> dict[str, Path]:
        """Return the file of each blueprint by its name."""
        return self._list_toml_files("blueprints")

    def template_names_for(self, plan: str) -> Mapping[str, str]:
        """Return what a blueprint's template names are called in this bank.

        Empty if they are the same, as they are in a single bank; ``CombinedBank`` renames some.
        """
        del plan
        return {}

    @cached_property
    def cards(self) -> dict[str, Path]:
        """Return the files of card content by their names."""
        return self._list_toml_files("cards")

    @cached_property
    def quantities(self) -> dict[str, QuantityNames]:
        """Return the names of a solver's quantities, by solver."""
        return read_quantities(self._list_toml_files("quantities").values())

    def _list_toml_files(self, name: str) -> dict[str, Path]:
        """Return the TOML files of a folder by their stems; empty if there is no such folder."""
        return {path.stem: path for path in sorted((self.folder / name).glob("*.toml"))}

    def __reduce__(self) -> tuple[object, ...]:
        """Return how another process opens the folder for itself: no template is sent."""
        return (
            (builtin_bank, ())
            if self is builtin_bank()
            else (_open_bank, (self.root, self.trusted, dict(self.left_out)))
        )

    def __repr__(self) -> str:
        """Return the folder's name and the number of templates."""
        return f"<Bank {self.root.name}: {len(self)} templates>"

    @cached_property
    def template_paths(self) -> dict[str, Path]:
        """Return the folder of each template by name, in alphabetical order.

        If several folders share a name, the first stands here; ``rules`` refuses it.
        """
        return {
            name: folders[0]
            for name, folders in self._template_folders.items()
            if name not in self.left_out
        }

    @cached_property
    def _template_folders(self) -> dict[str, list[Path]]:
        """Return all folders of each template name."""
        return find_template_folders(self.folder, _BESIDE)

    def reload(self) -> Bank:
        """Return the same bank, its files, figures and solvers to be read again."""
        unload_modules(self._figure_folder)
        for folder in self.template_paths.values():
            if any((folder / f"{own}.py").is_file() for own in OWN_MODULES):
                unload_modules(folder)
        return Bank(self.root, trusted=self.trusted)

    def without(self, broken: Mapping[str, QuizgenError]) -> Bank:
        """Return the same bank without some templates, given what is wrong with each."""
        return Bank(self.root, trusted=self.trusted, left_out=broken)

    def solver(self, name: str) -> ModuleType:
        """Return a solver module, imported: the bank's own, else the built-in one of this name.

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
        """Return the chain of a solver, loaded once, and its source.

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
        """Return the file of a solver, this bank's or the built-in one's; None for no name."""
        if not name:
            return None
        root = self.root if self._has_own_solver(name) else builtin_root()
        return root / SOLVERS / f"{name}.py"

    def _has_own_solver(self, name: str) -> bool:
        """Return whether a solver is one of this bank, not of the built-in one.

        Raises
        ------
        BankError
            If its name is none, if it is the bank's own and the bank is not trusted, or if it is
            missing from the built-in bank, which has nowhere else to look.
        """
        if not all(map(is_identifier, name.split("/"))):
            what = f"solver: {name!r} is no name (allowed: {NAMES}, folders by '/')"
            raise _MissingError(what, rule="QG108", place=("solver",))
        file = self._solver_folder / f"{name}.py"
        if not file.exists() and self.root == builtin_root():
            what = f"solver {name!r}: no such solver"
            raise _MissingError(what, rule="QG126", place=("solver",))
        if file.exists():
            self._require_trust(file)
        return file.exists()

    @cached_property
    def figures(self) -> tuple[str, ...]:
        """Return the names of the figures that it brings, without those of the built-in bank."""
        return tuple(sorted(path.stem for path in self._figure_folder.glob("[a-z]*.py")))

    def figure(self, name: str) -> ModuleType:
        """Return a figure module, imported: the bank's own, else the built-in one of this name.

        Raises
        ------
        BankError
            If it does not exist or fails, or the bank is not trusted.
        """
        file = self.figure_file(name)
        return import_module_file(file.parent, file.stem)

    def figure_file(self, name: str) -> Path:
        """Return the file of a figure without importing it.

        Raises
        ------
        BankError
            If it does not exist or the bank is not trusted.
        """
        if name in self.figures:
            file = self._figure_folder / f"{name}.py"
            self._require_trust(file)
            return file
        if name not in builtin_bank().figures:
            known = sorted({*self.figures, *builtin_bank().figures})
            what = f"unknown figure {name!r}; there are {', '.join(known)}"
            raise _MissingError(what, rule="QG127", place=("figure", "name"))
        return builtin_bank().figure_file(name)

    def _find_figure_file(self, name: str) -> Path | None:
        """Return the file that draws a template's figure; None if it shows none.

        It is the module that the template names, or the one in its folder. Raises ``BankError`` as
        ``figure_file``.
        """
        rule = self.rules(name).figure
        if rule is None or rule.name:
            return self.figure_file(rule.name) if rule else None
        return self._find_module_beside(name, OWN_FIGURE, "[figure] has no name", "figure")

    def _find_data_file(self, name: str) -> Path | None:
        """Return the module that draws a template's data; None if it has no ``[data]``."""
        if not self.rules(name).data:
            return None
        return self._find_module_beside(name, OWN_DATA, "there is [data]", "data")

    def _find_check_file(self, name: str) -> Path | None:
        """Return the module that judges answers of a template; None if no part asks for it."""
        if not _has_checked_part(self.rules(name)):
            return None
        return self._find_module_beside(name, OWN_CHECK, 'there is kind = "checked"', "part")

    def _find_module_beside(self, name: str, stem: str, because: str, table: str) -> Path:
        """Return the module of a name in a template's folder, which its rules call for.

        Raises
        ------
        BankError
            At the table of its rules, if it is not there or the bank is not trusted.
        """
        file = self.folder_of(name) / f"{stem}.py"
        if not file.is_file():
            what = f"{because}, and there is no {file.name} beside it"
            raise _MissingError(what, rule="QG127", place=(table,))
        self._require_trust(file)
        return file

    def _require_trust(self, file: Path) -> None:
        """Raise ``BankError`` at a file with Python of a bank that is not trusted."""
        if not self.trusted:
            what = "this bank brings its own Python; allow it with --trust"
            raise BankError(what, rule="QG128", file=file)

    def rules(self, name: str) -> Rules:
        """Return the checked ``template.toml`` of a template, without loading solver or prose.

        Raises
        ------
        BankError
            If the template is unknown, its rules are wrong, or its topic is not in ``bank.toml``.
        """
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
        """Return the first name of a template, which its numbers are drawn under."""
        return self.rules(name).formerly or name

    def candidates(self, names: Iterable[str] | None = None) -> list[Candidate]:
        """Return what a paper may choose from: the templates named, or all of them.

        Only the rules of those are read, so that one that is wrong stops no paper that lists
        others.

        Raises
        ------
        BankError
            If one of them is unknown or wrong.
        """
        return [self._candidate(name) for name in (self.template_paths if names is None else names)]

    def _candidate(self, name: str) -> Candidate:
        """Return what a template adds to a paper, worked out once."""
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
                tuple(
                    (KINDS[part.answer["kind"]].verb, parse_written_number(part.points))
                    for part in rules.part
                ),
                self.minutes(name),
                figure,
                figure in owner.metadata.photographs,
                frozenset(rules.apart),
                rules.pool,
            )
        return self._candidates[name]

    def minutes(self, name: str) -> Fraction:
        """Return the working time of a template in minutes, worked out once.

        A solver or words that cannot be read say so when a paper is to hold the template; until
        then they take no time.

        Raises
        ------
        BankError
            If its rules cannot be read.
        """
        if name not in self._minutes:
            rules, chain, page = self.rules(name), Chain({}, ()), ""
            owner, _ = self.owner_of(name)
            with suppress(QuizgenError):
                file = min(self._list_prose_files(name), key=self._rank_language, default=None)
                page = read_text(file, BankError) if file else ""
                chain = owner.chain(rules.solver)[0] if rules.solver else chain
            self._minutes[name] = working_minutes(rules, chain, page)
        return self._minutes[name]

    def _rank_language(self, file: Path) -> tuple[int, str]:
        """Return the sort key of a language file: the languages of the bank in their order."""
        known = list(self.languages)
        return (known.index(file.stem) if file.stem in known else len(known), file.stem)

    def template(self, name: str) -> Template:
        """Return a template, loaded once.

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
        """Return the folder of a template.

        Raises
        ------
        BankError
            If there is none of this name; suggests similar ones. One that is left out raises what
            is wrong with it.
        """
        if name in self.left_out:
            raise self.left_out[name]
        if name not in self.template_paths:
            raise BankError(f"unknown template {name!r}{self._suggest_template(name)}")
        return self.template_paths[name]

    def _suggest_template(self, name: str) -> str:
        """Return how to go on after an unknown name, to end the message of an error.

        It gives the present name of a renamed template, else up to three similar ones, else where
        all are listed. A topic before the name, as in the template's folder, is no part of it.
        """
        renamed = [known for known in self.template_paths if self._has_been_called(known, name)]
        if renamed:
            return f"; it is now called {renamed[0]!r}"
        from difflib import get_close_matches

        own = name.rpartition("/")[2]
        known = own in self.template_paths
        close = [own] if known else get_close_matches(own, self.template_paths, 3)
        if close:
            return f"; did you mean {', '.join(close)}?"
        return f" (there are {len(self.template_paths)}; quizgen templates lists them)"

    def _has_been_called(self, known: str, name: str) -> bool:
        """Return whether a template had a name before; False where its rules cannot be read."""
        with suppress(BankError):
            return self.rules(known).formerly == name
        return False

    def template_files(self, name: str) -> tuple[bytes, ...]:
        """Return the bytes of the files that make a template; none of them is run.

        They are what a paper's record of its banks is hashed from.
        """
        return tuple(read_bytes(file, BankError) for file in self._list_template_files(name))

    def _list_template_files(self, name: str) -> list[Path]:
        """Return the paths of rules, words, pictures, solver and figure of a template."""
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
        own[OWN_CHECK] = _has_checked_part(rules)
        files = [folder / f"{module}.py" for module, used in own.items() if used]
        files += sorted({folder / table for table in list_table_files(rules)})
        return [file for file in files if file.is_file()]

    def template_languages(self, name: str) -> tuple[str, ...]:
        """Return the languages that a template is written in, without reading them."""
        return tuple(path.stem for path in self._list_prose_files(name))

    def _list_prose_files(self, name: str) -> list[Path]:
        """Return the language files of a template, by name."""
        if name not in self._pages:
            found = sorted(self.folder_of(name).iterdir())
            self._pages[name] = [path for path in found if PROSE.fullmatch(path.name)]
        return self._pages[name]

    def _load_template(self, name: str) -> Template:
        """Return a template read from its files, and checked against its chain.

        The digest covers all that its questions follow from: files, solver, and the bank's words
        that grading uses. Raises ``BankError`` at the file that is wrong.
        """
        folder = self.folder_of(name)
        rules = self.rules(name)
        prose = self._list_prose_files(name)
        files = [folder / "template.toml", *prose, *self._beside_template(name)]
        files += pictures_beside(folder)
        chain, source = self.chain(rules.solver) if rules.solver else (Chain({}, ()), b"")
        chain = _add_asked_draws(chain, rules)
        texts = {path.stem: read_language_file(path) for path in prose}
        register_languages(sorted(texts))
        order = [lang for lang in list_languages() if lang in texts]
        words = grading_words(self.metadata, [part.answer for part in rules.part])
        digest = compute_digest(*(read_bytes(path, BankError) for path in files), source, *words)
        ordered: dict[str, LanguageFile] = {lang: texts[lang] for lang in order}
        quantities = self.quantities.get(rules.solver, QuantityNames())
        figure, data = self._find_figure_file(name), self._find_data_file(name)
        check = self._find_check_file(name)
        template = Template(
            name, rules, chain, ordered, digest, folder, self.metadata, quantities, figure,
            self._solver_file(rules.solver), data,
            compute_digest(read_bytes(check, BankError)) if check else "",
            read_pictures(folder, ordered), self.minutes(name),
        )  # fmt: skip
        check_against_chain(template)
        return template

    def __iter__(self) -> Iterator[Template]:
        """Yield all templates in alphabetical order, each loaded when it comes."""
        return (self.template(name) for name in self.template_paths)

    def __len__(self) -> int:
        """Return how many templates there are; loads none."""
        return len(self.template_paths)


def _add_asked_draws(chain: Chain, rules: Rules) -> Chain:
    """Return a chain that also knows what is asked and drawn, not solved: it has no steps."""
    asked = [name for part in rules.part for name in asked_quantities(part.answer)]
    units = {n: r.unit for n, r in rules.draw.items()} | {n: r.unit for n, r in rules.data.items()}
    drawn = {name: units[name] for name in asked if name in units}
    more = {n: unit for n, unit in drawn.items() if n not in {*chain.given, *chain.by_name}}
    return msgspec.structs.replace(chain, given={**chain.given, **more}) if more else chain


def _has_checked_part(rules: Rules) -> bool:
    """Return whether ``check.py`` judges an answer."""
    return any(part.answer.get("kind") == "checked" for part in rules.part)


def _open_bank(root: Path, trusted: bool, left_out: Mapping[str, QuizgenError]) -> Bank:
    """Return a bank; ``pickle`` calls it by name, as it cannot pass ``trusted`` by keyword."""
    return Bank(root, trusted=trusted, left_out=left_out)


def _make_title_from_name(name: str) -> str:
    """Return a title made of a name: words instead of hyphens, a capital in front."""
    return name.replace("-", " ").replace("_", " ").capitalize()


@cache
def builtin_bank() -> Bank:
    """Return the built-in bank, opened once; it is always trusted."""
    return Bank(builtin_root(), trusted=True)


def find_template_folders(templates: Path, beside: Collection[str]) -> dict[str, list[Path]]:
    """Return all folders of each template name, although only one may have it.

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
    """Raise ``BankError`` for a template that its name does not lead to; the others stay usable.

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
