"""What an answer kind is: what authors write, what it may ask of a variant, what it hands over.

A kind is one module of this folder that ends in a ``KIND``: an ``AnswerKind`` of

``Authored...``
    a struct of the keys that ``answer`` may have in ``template.toml``, tagged with the kind's name,
``...Spec``
    a struct of what a key stores; ``judge`` reads and judges what was typed, ``show`` prints it,
``ask``
    from a part of a variant to an ``AskedPart``,
``input_hints``, ``explain_key``
    how to type an answer, and the key as the solution states it,
``paper_hints``
    what stands beside its field on paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Generic,
    Literal,
    NamedTuple,
    Protocol,
    TypeAlias,
    TypeVar,
)

import msgspec
from flint import fmpq

from quizgen.core.errors import BankError
from quizgen.core.positions import Place
from quizgen.grading.judge import show_spec
from quizgen.grading.spec import AnySpec
from quizgen.kinds.work import Verb, WorkCounter, count_values
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import to_rational
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.tree import Expr
from quizgen.maths.values import Value, Values

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

# Sizes beyond which nobody means what a template, a blueprint or a key says.
MOST_CHOICES = 10_000  # values of a range, entries of a list
MOST_POINTS, MOST_MINUTES, MOST_PARTS, MOST_OPTIONS = 1000, 9999, 10, 12
MOST_IN_POOL = 60  # options, pairs, steps or gaps; every variant takes some of them
MOST_FORMULAS = 500

Condition: TypeAlias = bool | str
Formulas: TypeAlias = tuple[Scalar, Scalar]
SymbolDomain: TypeAlias = Literal["real", "positive"] | tuple[Scalar, Scalar]

FieldProblem: TypeAlias = tuple[Place, str, str]
"""Where in the answer's table, the code of the diagnostic, and what is wrong."""


class AuthoredAnswer(msgspec.Struct, kw_only=True, frozen=True, forbid_unknown_fields=True,
                     tag_field="kind"):  # fmt: skip
    """The key of every kind: the quantities that are asked.

    A subclass is tagged with the name of its kind. Editors are told what a key means by its
    ``msgspec.Meta(description=...)``; ``bank/told.toml`` has the keys that several kinds share.
    """

    of: str | tuple[str, ...] | dict[str, str] = ()

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong apart from types; a kind with rules of its own overrides it."""
        return iter(())


class AuthoredMeasured(Tolerance, kw_only=True, frozen=True, tag_field="kind"):
    """The same, and how near an answer must be."""

    of: str | tuple[str, ...] | dict[str, str] = ()
    worth: dict[str, Scalar] = msgspec.field(default_factory=dict)
    accept: tuple[Scalar, Scalar] | None = None  # type: ignore[assignment]

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong apart from types."""
        for name, share in self.worth.items():
            if not 0 < to_rational(str(share)) < 1:
                yield ("worth", name), "QG112", "a share of the points: more than 0, less than 1"


class AuthoredNumeric(AuthoredMeasured, kw_only=True, frozen=True):
    """What is computed: one quantity at least, and as many as its kind has."""

    of: str | tuple[str, ...] | dict[str, str]
    least: ClassVar[int] = 1
    most: ClassVar[int] = 1

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield a problem unless there are as many quantities as the kind asks for."""
        count = 1 if isinstance(self.of, str) else len(self.of)
        if not self.least <= count <= self.most:
            wanted = f"{self.least} to {self.most}" if self.most > 1 else "one"
            yield ("of",), "QG114", f"names {count}, and this kind asks for {wanted}"


class AuthoredPooled(AuthoredAnswer, frozen=True):
    """What may be asked in part, a different one in every variant."""

    take: int = 0
    listed: ClassVar[str]
    """Key that holds the names; ``take`` of them are shown."""

    def listed_names(self) -> Sequence[str]:
        """Return all names that must differ."""
        return tuple(getattr(self, self.listed))

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield what is wrong with the names, and if more are taken than a part can show."""
        yield from find_name_problems(self.listed, self.listed_names(), self.take)
        count = len(getattr(self, self.listed))
        if self.take and not 1 <= self.take <= min(MOST_OPTIONS, count):
            wrong = f"must be 1 to {MOST_OPTIONS} and at most the number of {self.listed}"
            yield ("take",), "QG115", wrong


def find_name_problems(
    field: str, names: Sequence[str], take: int, least: int = 1
) -> Iterator[FieldProblem]:
    """Yield what is wrong with a list of names; a variant takes ``take`` of them, all if 0."""
    most = MOST_IN_POOL if take else MOST_OPTIONS
    if not least <= len(names) <= most:
        yield (field,), "QG110", f"1 to {most} are needed"
    if len(set(names)) < len(names):
        yield (field,), "QG110", "a name stands twice"


def find_extra_problems(extra: int | None, spare: int) -> Iterator[FieldProblem]:
    """Yield what is wrong with the number of distractors that are shown."""
    if extra is not None and not 0 <= extra <= spare:
        yield ("extra",), "QG115", f"must be 0 to {spare}, the number of distractors"


FORM_KINDS = frozenset({"expression", "interval", "equation", "complex", "matrix", "vector"})
"""Kinds whose ``of`` names a form of the solver and no number."""


def asked_form(answer: Mapping[str, Any]) -> str:
    """Return the form of the solver that an authored answer names; empty if it names none."""
    of, kind = answer.get("of", ()), answer.get("kind")
    return of if isinstance(of, str) and (kind in FORM_KINDS or kind == "set") else ""


def asked_quantities(answer: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the quantities of the chain that an authored answer consists of, in order."""
    of = () if asked_form(answer) else answer.get("of", ())
    if isinstance(of, str):
        return (of,)
    return tuple(of.values()) if isinstance(of, Mapping) else tuple(of)


Point = tuple[float, float]
Line = tuple[Point, ...]

WIDE = 250.0
"""Width of a field to draw in, in points: 88 mm."""
LEFT, RIGHT, TOP, FOOT = 26.0, 8.0, 8.0, 18.0
"""Room around the field, at the left and at the foot for numbers."""
NAME = 14.0
"""Room for the name of an axis."""


class DrawingField(msgspec.Struct, frozen=True):
    """A field to draw in.

    Parameters
    ----------
    view : tuple of float
        From and to along x, from and to along y.
    grid : tuple of float
        Distance of the grid's lines along x and along y.
    tall : float
        Height over width, where the axes do not have one scale.
    given : tuple of lines
        What is there already, in grey.
    bars : bool
        Whether what is there are bars of a histogram.
    marks : tuple of (str, point)
        Points with a label.
    axes : tuple of str
        Names of the axes with their units, such as ``$λ$ / nm``: across and upright.
    """

    view: tuple[float, float, float, float]
    grid: tuple[float, float]
    tall: float = 0.0
    given: tuple[Line, ...] = ()
    bars: bool = False
    marks: tuple[tuple[str, Point], ...] = ()
    axes: tuple[str, str] = ("", "")

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the field itself in points."""
        left, right, low, high = self.view
        return WIDE, WIDE * (self.tall or (high - low) / (right - left))

    @property
    def picture_size(self) -> Point:
        """Width and height of the picture in points: the field and the room around it."""
        wide, tall = self.size
        return LEFT + wide + RIGHT, self._top + tall + self._foot

    @property
    def _top(self) -> float:
        """Room above the field in points, with the name of the upright axis if it has one."""
        return TOP + (NAME if self.axes[1] else 0)

    @property
    def _foot(self) -> float:
        """Room below the field in points, with the name of the level axis if it has one."""
        return FOOT + (NAME if self.axes[0] else 0)

    @property
    def frame(self) -> tuple[float, float, float, float]:
        """Where the field lies in the picture, in points from the upper left: x, y, size."""
        return (LEFT, self._top, *self.size)

    def to_picture(self, point: Point) -> Point:
        """Return a point in the picture, in points from the lower left."""
        left, right, low, high = self.view
        wide, tall = self.size
        x, y = point
        return LEFT + (x - left) / (right - left) * wide, self._foot + (y - low) / (
            high - low
        ) * tall


InputForm = Literal["line", "lines", "one", "many", "truth", "pairs", "order", "gaps"]
"""What a learner fills in: a line or more of text, one or many of the lettered options, true or
false, a target for each option, the options in order, a word for each gap."""

LabelledName = tuple[str, str]
"""A mark (letter or number) and the name of a sentence, or a section and a name in it."""


class InputBox(NamedTuple):
    """A value of an answer that has several: its name, empty where it is its place, and unit."""

    name: str
    unit: str = ""


class InputControl(msgspec.Struct, frozen=True):
    """How a learner answers: all that an output needs to know about a kind.

    Parameters
    ----------
    form : str
        What is filled in. ``line`` and ``lines`` need nothing else from any output: a kind that
        takes typed text works in all of them.
    lines : int
        Ruled lines that writing it by hand takes; 0 where the options themselves are ticked.
    boxes : tuple of InputBox
        Where an answer has several values, a box for each in the order in which they are typed; a
        learner may type all of them in one line just as well.
    named : bool
        Whether a value needs its name before it, as cells of a table do.
    board : DrawingField, optional
        The field that is drawn in, if the answer is a drawing.
    keeps_lines : bool
        Whether lines and the blanks before them count, as in a program.
    rows : bool
        Whether each line is judged by itself: a terminal reads lines until an empty one.
    """

    form: InputForm
    lines: int = 1
    boxes: tuple[InputBox, ...] = ()
    named: bool = False
    board: DrawingField | None = None
    keeps_lines: bool = False
    rows: bool = False

    @property
    def needs_working(self) -> bool:
        """Whether there is something to work out on the way to the answer."""
        return self.form == "line" or bool(self.boxes and self.form == "lines")

    @property
    def has_several_fields(self) -> bool:
        """Whether a page has a field for each of several values."""
        return bool(self.boxes) or self.form == "pairs"

    @property
    def is_ticked(self) -> bool:
        """Whether options are ticked, with no further place for the answer."""
        return self.lines == 0


LINE = InputControl("line")


class DerivedStep(NamedTuple):
    """A line that a solution shows: its name in section ``steps``, what it states, its points."""

    name: str
    tree: Expr
    points: Fraction


S = TypeVar("S", bound=AnySpec)


class SchemeRow(NamedTuple):
    """A criterion of a mark scheme: its name, points, what it may follow from, whether in halves.

    What counts and what is refused stand in the language files, in sections ``points`` (the idea),
    ``accept`` and ``refuse``.
    """

    name: str
    points: Fraction
    follows: str = ""
    halves: bool = False


class AskedPart(msgspec.Struct, Generic[S], frozen=True):
    """One part of a variant as its kind asks it.

    Parameters
    ----------
    spec : AnySpec
        What it is graded by.
    control : InputControl
    options, targets : tuple of (str, str)
        Marks and names (in section ``options``) of the lettered options, and of the right side of
        a matching, in the order in which they are shown.
    right : tuple of (str, str)
        Section and name of the sentences that tell the right answer in words.
    shares : tuple of Fraction
        What share of the points each of these earns, where an answer may have some of them.
    reasons : tuple of (str, str)
        What a learner may choose wrongly (an option's mark, a pair of marks) and the name of the
        sentence in section ``reasons`` that says why it is wrong.
    statements : tuple of (str, str)
        Section and name of the sentences that are asked: a claim, or sentences with a gap each.
    source : str
        Where the reason that tells the right answer is to be found.
    drawn : tuple of lines
        What the solution draws in the field of the control.
    mistakes : mapping of str to AnySpec
        Each known mistake and the spec of which its answer would be the key.
    is_long : bool
        Whether answers are too long for a solution to print those of mistakes, too.
    derived : tuple of DerivedStep
        The lines of a derivation, which the solution shows as its steps.
    scheme : tuple of SchemeRow
        The criteria that a person marks by.
    """

    spec: S
    control: InputControl = LINE
    options: tuple[LabelledName, ...] = ()
    targets: tuple[LabelledName, ...] = ()
    right: tuple[LabelledName, ...] = ()
    shares: tuple[Fraction, ...] = ()
    reasons: tuple[LabelledName, ...] = ()
    statements: tuple[LabelledName, ...] = ()
    source: str = ""
    drawn: tuple[Line, ...] = ()
    mistakes: Mapping[str, S] = msgspec.field(default_factory=dict)
    is_long: bool = False
    derived: tuple[DerivedStep, ...] = ()
    scheme: tuple[SchemeRow, ...] = ()


VALUE_OPTION = "="
"""Begins the name of an option that is no sentence of the template but the text after this sign."""


class PartContext(Protocol):
    """What a kind may ask of the part of a variant that it makes.

    A kind knows no bank, no seed and no output: all values come through here.
    """

    answer: Mapping[str, Any]
    """The ``answer`` table as authored."""
    shown: Mapping[str, fmpq]
    """Drawn quantities in the units they are shown in."""
    shown_values: Values
    """Every quantity, drawn or solved, in the unit it is shown in."""
    words: Mapping[str, str]
    """Drawn phrases, by their name in the language files."""
    lists: Mapping[str, Sequence[Any]]
    """Drawn lists in the units they are shown in."""
    check_digest: str
    """The digest of ``check.py`` beside the template; empty without one."""
    units: Mapping[str, str]
    """The unit that each quantity is shown in."""
    defined_units: Sequence[str]
    """Units of the bank, as ``bank.toml`` defines them."""
    terms: Sequence[str]
    """Words of the bank's subject."""
    points: str
    """Points of the part as authored."""

    def error(self, what: str, rule: str = "QG112") -> BankError:
        """Return an error that names the template and the part; ``rule`` is its diagnostic code."""

    def evaluate(self, formula: str) -> Value:
        """Return the value of a formula over the quantities in shown units."""

    def answer_values(self) -> tuple[Value, ...]:
        """Return the components of the answer, each in the unit it is asked in."""

    def misconception_answers(self) -> dict[str, tuple[Value, ...]]:
        """Return each usable mistake and the answer it gives, as ``answer_values``."""

    def exact_texts(self) -> tuple[str, ...]:
        """Return each irrational component of the answer as a formula; empty where it is none."""

    def answer_form(self) -> Expr:
        """Return the form that the answer names, with the drawn numbers in place."""

    def misconception_forms(self) -> dict[str, Expr]:
        """Return each usable mistake and the form that it gives, as ``answer_form``."""

    def count_nouns(self) -> dict[str, Any]:
        """Return the field ``counts`` of a spec: the words for what the answer counts."""

    def misconception_notes(self, mistakes: Iterable[str]) -> dict[str, dict[str, str]]:
        """Return the sentence for somebody who made a mistake, by language and mistake."""

    def with_reason(self, names: Iterable[LabelledName]) -> tuple[LabelledName, ...]:
        """Return those of the marks and names for which a reason is written."""

    def reasons(self, names: Iterable[LabelledName]) -> dict[str, dict[str, str]]:
        """Return the reasons as plain text, by language and mark."""

    def reason_names(self) -> list[str]:
        """Return the names of all sentences in section ``reasons``."""

    def shuffle_names(self, names: Iterable[str], side: str = "") -> list[str]:
        """Return names in the order shown: a drawn one, unless ``in_order`` is set."""

    def shuffle(self, names: Sequence[str], side: str) -> list[str]:
        """Return names in a drawn order, even if ``in_order`` is set."""

    def accepted_words(self, name: str, section: str = "gaps") -> list[str]:
        """Return the words of a gap, or the examples of a criterion, from all languages."""

    def sentences(self, section: str, names: Iterable[LabelledName]) -> dict[str, dict[str, str]]:
        """Return the sentences of a section as plain text, by language and mark."""

    def model_answers(self) -> dict[str, str]:
        """Return the model answer by language, where one is written."""

    def synonyms(self, texts: Iterable[str]) -> list[list[str]]:
        """Return the groups of words of the bank that mean the same, of which texts have one."""

    def has_gap(self, name: str) -> bool:
        """Return whether a language file has words for a gap of this name."""

    def format_option(self, value: Value, unit: str) -> str:
        """Return a value with its unit as an option shows it: exact if short, else 4 figures."""

    def asked_bound(self) -> str:
        """Return ``most`` or ``least`` where the part asks for such a number, else nothing."""

    def value_words(self, names: Mapping[str, str]) -> dict[str, list[str]]:
        """Return the words by which the question calls values, by the names of the values.

        ``names`` leads from each to its quantity in the chain.
        """

    def numbered_words(self, count: int) -> list[list[str]]:
        """Return what the question numbers, ``(1) rounded, (2) raised``, in each language.

        A language that does not number so many is left out.
        """

    def option_texts(self, names: Iterable[str]) -> list[list[str]]:
        """Return the wording of options as they would be typed, in each language once."""

    def condition_holds(self, condition: Condition) -> bool:
        """Return whether an authored condition holds in this variant."""

    def selection(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return what the part shows of its pool (of all that is listed where it has none).

        Options, left sides, steps or gaps; and right sides or steps that fit nowhere.
        """

    def matching_pairs(self) -> dict[str, str]:
        """Return left side to right side of a matching, also of pairs that are not shown."""

    def claim(self) -> tuple[str, Condition, str]:
        """Return the claim from the pool: its name, when it is true, its source."""

    def fill_program(self, text: str) -> str:
        """Return program text or its output with the drawn values in place."""

    def examples(self) -> Sequence[tuple[str, Fraction]]:
        """Return the answers that an author gives as examples, and the share that each earns."""


def no_paper_hints(_spec: AnySpec, _lang: str) -> tuple[TextOrInlines, ...]:
    """Return nothing: on paper the field itself shows how it is filled in."""
    return ()


def accept_nothing_else(_spec: AnySpec, _lang: str) -> str:
    """Return nothing: the printed answer is the only one."""
    return ""


@dataclass(frozen=True)
class AnswerKind(Generic[S]):
    """One kind of answer: all that differs between kinds.

    Parameters
    ----------
    authored : type
        What an author writes; its tag is the kind's name.
    spec : type
        What a key stores, judges what is typed and shows what is right.
    ask : callable
        From a part of a variant to what is asked.

        Raises ``BankError`` (of ``PartContext.error``) if the authored answer is not complete.
    input_hints : callable
        Sentences that tell the learner how to type the answer, from how it is graded. Where the
        answer has several values, the first says how they are typed in one line; a page with a
        field for each leaves it out.
    explain_key : callable
        The key as the solution states it; empty where sentences tell it.
    paper_hints : callable
        What is said beside the field on paper, where nothing is typed and units are printed:
        a word on precision or form, most often nothing.
    accepted : callable
        What a marker accepts besides the printed answer, in few words; empty for nothing.
    verb : str
        What it asks for, as blueprints count it.
    work : callable
        What is done to answer it, from which its minutes follow.
    """

    authored: type[AuthoredAnswer | AuthoredMeasured]
    spec: type[S]
    ask: Callable[[PartContext], AskedPart[S]]
    input_hints: Callable[[S, str], tuple[TextOrInlines, ...]]
    explain_key: Callable[[S, str], TextOrInlines] = show_spec
    paper_hints: Callable[[S, str], tuple[TextOrInlines, ...]] = no_paper_hints
    accepted: Callable[[S, str], str] = accept_nothing_else
    verb: Verb = "compute"
    work: WorkCounter = count_values

    @property
    def name(self) -> str:
        """Its name in templates and keys."""
        return str(self.authored.__struct_config__.tag)
