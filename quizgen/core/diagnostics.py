"""What is wrong, where, and what mends it: one shape for every check, one code for every rule.

``docs/diagnostics.md`` is the table of codes for people, and a test holds it to this one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import msgspec

from quizgen.core.positions import Place, Span, find_span


class Rule(msgspec.Struct, frozen=True):
    """One rule of a bank: what is wrong if it is broken, and how to mend it.

    The hint is empty where each message says itself what mends it.
    """

    what: str
    hint: str = ""


class Diagnostic(msgspec.Struct, frozen=True):
    """One thing that is wrong in a bank: its code, file, position, message and what mends it.

    Parameters
    ----------
    code : str
        One of ``CODES``.
    file : pathlib.Path
    span : Span or None
        None where it is about the whole file.
    message, hint : str
        The hint may be empty: many messages say what is allowed.
    """

    code: str
    file: Path
    span: Span | None
    message: str
    hint: str = ""

    def __str__(self) -> str:
        """Return one line for a terminal: ``file:line:column: code message; hint``."""
        place = f"{self.file}"
        if self.span:
            place += f":{self.span.line}:{self.span.column}"
        return "; ".join(filter(None, (f"{place}: {self.code} {self.message}", self.hint)))

    def as_json(self) -> dict[str, object]:
        """Return the fields as plain JSON values, for editors.

        Line and column are None without a span.
        """
        return {
            "code": self.code,
            "file": str(self.file),
            "line": self.span.line if self.span else None,
            "column": self.span.column if self.span else None,
            "message": self.message,
            "hint": self.hint,
        }


def diagnose(
    code: str, file: Path, message: str, place: Place = (), *, line: int = 0
) -> Diagnostic:
    """Return a diagnostic with the hint of its code, and with the line and column of a place.

    Parameters
    ----------
    code : str
    file : pathlib.Path
    message : str
    place : tuple of str or int
        As ``find_span`` takes it; empty for the whole file.
    line : int
        The line, from 1, where it is known already.
    """
    span = find_span(file, place) if place or not line else None
    span = span or (Span(line) if line else None)
    return Diagnostic(code, file, span, message, CODES[code].hint)


def can_be_ignored(code: str) -> bool:
    """Return whether a template may list a code under ``ignore``.

    What stops a paper cannot be ignored: lint would find nothing wrong where ``exam`` fails.
    """
    return code in CODES and code[2] in "234"


DEFAULT = "QG100"
"""Code of an error that has none of its own."""

_CODES = {
    # What stops a paper: files, rules, solvers, words that cannot be used.
    "QG100": Rule("Something else stops a paper; the message says what."),
    "QG101": Rule("A file cannot be read: it is missing, too large, or not UTF-8."),
    "QG102": Rule("A text has a character in it that nobody sees.", "take it out"),
    "QG103": Rule(
        "A file is not TOML.",
        "mend the line; texts stand in quotes, lists in brackets, and each key once",
    ),
    "QG104": Rule("A key is unknown; most often it is misspelt."),
    "QG105": Rule("A key is missing.", "write it"),
    "QG106": Rule("A value is of the wrong type."),
    "QG107": Rule("A value is none of those allowed."),
    "QG108": Rule("What must be a name is none."),
    "QG109": Rule(
        "A number cannot be read, or is too small or too large.",
        "write another number, or the same in another unit",
    ),
    "QG110": Rule("There are too many or too few entries.", "write as many as are allowed"),
    "QG111": Rule(
        "A range does not lead from its first value to its last.",
        "write [first, last, step] so that the steps lead there",
    ),
    "QG112": Rule(
        "An answer is not what its kind asks for.",
        "write what its kind asks for (docs/answers.md)",
    ),
    "QG113": Rule(
        "A tolerance cannot be used.",
        'write one, not negative, such as 0.01 or "1/200"',
    ),
    "QG114": Rule(
        "An answer names more or fewer quantities than its kind can ask.",
        "name so many, or choose another kind",
    ),
    "QG115": Rule(
        "A pool cannot give what is taken from it.",
        "write more of them, or take fewer",
    ),
    "QG116": Rule(
        "Something names a step, a mistake or a quantity that there is not.",
        "use a name of the solver, of [draw] or of the answer",
    ),
    "QG117": Rule("What is said to be read in a figure cannot be."),
    "QG118": Rule("A quantity is drawn in no way, or in several.", "keep one way of drawing it"),
    "QG119": Rule(
        "``ignore`` has a code that there is not, or that cannot be ignored.",
        "use codes of docs/diagnostics.md that begin with QG2, QG3 or QG4",
    ),
    "QG120": Rule("A derived quantity has no value.", "mend its formula, or widen [draw]"),
    "QG121": Rule(
        "A formula of template.toml cannot be read, or uses an unknown name.",
        "write it as students type it: 2*f*X/Z, x^2, sqrt(x)",
    ),
    "QG122": Rule("A unit is unknown or badly defined.",
                  "use a listed one, or define it in units of bank.toml"),
    "QG123": Rule("A given quantity of the solver is not drawn.",
                  "write a line for it under [draw]"),
    "QG124": Rule("The bank asks for another version of quizgen.",
                  "write a sign before the version, as in >=1.0, or install one that fits"),
    "QG125": Rule("Two things have one name.", "rename one of them"),
    "QG126": Rule("There is no such solver.", "mend the name, or write the file"),
    "QG127": Rule("There is no such figure, or no ``data.py``.",
                  "use one of those listed, or write templates/figures/NAME.py in the bank"),
    "QG128": Rule("A bank brings Python and is not trusted.",
                  "run it with --trust if you know who wrote it"),
    "QG129": Rule("A topic is not in bank.toml.",
                  "write it under [topics] there, or use one of these"),
    "QG130": Rule("A step or a drawn quantity uses what comes after it.",
                  "move its line, or put the other one among given"),
    "QG131": Rule("A step is no formula that students can type.",
                  "use +, -, *, /, powers and functions that students can type"),
    "QG132": Rule("A solver has no MODEL.",
                  "end the solver with MODEL = Model(given=..., steps=...)"),
    "QG133": Rule("A solver or a figure fails when it runs.", "mend the line"),
    "QG134": Rule("A solver or a figure imports what there is not.", "mend the name of the import"),
    "QG135": Rule("A name of a solver or a figure is not defined.",
                  "declare it with symbols(...) above, or mend its name"),
    "QG136": Rule("A solver or a figure is not Python.", "mend the line"),
    "QG137": Rule("A solver or a figure uses an attribute that there is not.",
                  "mend the name after the dot"),
    "QG138": Rule("A solver or a figure calls itself without end.",
                  "let the function end, or write the formula without it"),
    "QG139": Rule("A solver or a figure ends the program.", "leave out what ends it"),
    "QG140": Rule("No draw is admissible.",
                  "widen [draw], relax [keep] and where, or drop a mistake that equals the key"),
    "QG142": Rule("A figure is given a parameter that it does not have.",
                  "leave it out of values, or mend its name"),
    "QG143": Rule("A figure lacks a parameter.", "give it in values of [figure]"),
    "QG144": Rule("A figure cannot draw a value.", "draw other values, or mend the formula"),
    "QG145": Rule("The module of a figure lacks something.", "write it as docs/figures.md says"),
    "QG146": Rule("A photograph in a figure does not show what is asked.",
                  "draw values that make it larger"),
    "QG148": Rule("A step cannot be told from zero.",
                  "keep such draws out, or write the step so that it is exactly 0"),
    "QG150": Rule("A section of the words is unknown.", "rename the section"),
    "QG151": Rule("The words have no title."),
    "QG152": Rule("A line of a list is not ``- name: sentence``.", "write it so"),
    "QG153": Rule("The words use Markdown outside the subset.",
                  "use paragraphs, lists, tables, emphasis and code"),
    "QG154": Rule("Double braces hold more than a name.", "close it as {{ name }}"),
    "QG155": Rule("Mathematics in words or on cards cannot be read.",
                  "write it as students type it: 2*f*X/Z, x^2, sqrt(x)"),
    "QG156": Rule("A picture in the words cannot be shown.",
                  "put a PNG, JPEG or plain SVG of this name beside the words, and describe it"),
    "QG157": Rule("The words lack something that is needed to print the question.",
                  "write the section, or a line '- NAME: sentence' in it"),
    "QG158": Rule("A blank in the words names no quantity.",
                  "use a name of [draw] or of the solver's steps"),
    "QG159": Rule("LaTeX in the words cannot be read, or cannot be said in every output.",
                  "use what docs/formulas.md lists"),
    "QG160": Rule("The field of a part stands where it cannot.",
                  "write {{ ?b }} once, in section b or in that of a part before it"),
    "QG260": Rule("The points of steps are not those of their part.",
                  "let the points in scheme add up to the points of the part"),
    # Proofs over many draws: soundness of units, answers, languages.
    "QG201": Rule("A drawn unit is of another kind than the solver's.",
                  "give it a unit of the kind that the solver works with"),
    "QG202": Rule("What is asked has a unit of another kind than its step.",
                  "ask in a unit of the same kind"),
    "QG203": Rule("The units of a step do not fit its formula.",
                  "mend the formula, or the unit of its Step or of its quantities"),
    "QG204": Rule("A known mistake, typed, is not recognised.",
                  "widen the distance to the key: another rounding, or [keep]"),
    "QG205": Rule("The printed answer, typed, is not marked correct.",
                  "let the answer kind, its unit and rounding fit what is printed"),
    "QG206": Rule("A level does not mark all languages alike."),
    "QG207": Rule("A mistake never gives a usable wrong answer.",
                  "widen [draw], or leave it out with drop"),
    "QG208": Rule("The answer is the same in all draws.", "let it depend on what is drawn"),
    "QG209": Rule("A placeholder is left in the words.", "name a drawn or solved quantity"),
    "QG210": Rule("A language of the bank is missing.",
                  "write it, or leave the language out of languages in bank.toml"),
    "QG211": Rule("A section of the words is missing.", "write it"),
    "QG212": Rule("A section lacks a sentence.", "write a line '- NAME: sentence' for it"),
    "QG213": Rule("A section explains what there is not.", "rename or delete the line"),
    "QG214": Rule("Two languages show different values.",
                  "fill in the same {{ names }} in every language"),
    "QG215": Rule("Two languages have different entries.",
                  "give the entries the same names in every language"),
    "QG216": Rule("A solver names a formula that the bank does not have.",
                  "write it there, or mend its name in the solver"),
    "QG217": Rule("A step has the form of a formula and does not name it.",
                  "name it in formulas of the solver's MODEL"),
    "QG218": Rule("A question tells what another one asks.",
                  "say it in other words, or name the other template in apart"),
    "QG219": Rule("A quantity is drawn, and nothing uses it.",
                  "show it, ask for it or compute with it, or take it out"),
    "QG220": Rule("Words are in another language than their file.",
                  "translate them, or leave the language out of languages in bank.toml"),
    "QG221": Rule("An example of an answer is not judged as it says, or ``check.py`` fails.",
                  "mend check.py or the points of the example"),
    "QG222": Rule("An alternative formula of a step gives another value.",
                  "mend it, or leave it out of alternatives"),
    "QG230": Rule("A criterion or a verb names what there is not, or its points are no points."),
    "QG240": Rule("A line of a derivation does not hold.",
                  "mend it, or what let says the names are"),
    "QG241": Rule("A line of a derivation follows from what is given, whatever is written.",
                  "let it hold a name of let, or leave it out"),
    "QG242": Rule("The points of a derivation's lines are not those of its part.",
                  "let points of lines and reasons add up to points of the part"),
    "QG243": Rule("Hardly any numbers meet the conditions of a derivation.",
                  "widen where, or give the symbols bounds"),
    "QG231": Rule("An example of what counts is not recognised, or one that is refused is.",
                  "put it in other words, or take it out of the list"),
    "QG232": Rule("The model answer does not meet a criterion.",
                  "say it in the model answer, or add how it is said there to section accept"),
    # Item writing: whether a question teaches and cannot be guessed.
    "QG301": Rule("The answer hardly varies.",
                  "let other options, statements or pairs be right in turn"),
    "QG302": Rule("The right option stands too often in one place."),
    "QG303": Rule("The right option is clearly the longest.", "make wrong ones as long"),
    "QG304": Rule("An option, a statement, a pair or a gap has no reason.",
                  "write a line '- NAME: sentence' for it in section reasons"),
    "QG305": Rule("A statement has no name, and so no reason."),
    "QG306": Rule("No trap names a wrong answer.",
                  "add traps to the answer, each with its sentence in section traps"),
    "QG307": Rule("There are few different questions.", "draw more values, or take from pools"),
    "QG308": Rule("``pool`` is not what is counted.", "write what is counted, or leave it out"),
    "QG309": Rule("The pool of claims is small.", "write more of them"),
    "QG310": Rule("Claims and options share names.", "rename them in one of the two"),
    "QG311": Rule("Options and figure have the same letters.",
                  "give the figure other letters, or show fewer options"),
    "QG312": Rule("Numbered pictures are shown in any order."),
    "QG313": Rule("An option is never right (``--teach`` alone)."),
    "QG314": Rule("Each option is always right or always wrong (``--teach`` alone)."),
    "QG315": Rule("Points are far from the working time (``--teach`` alone)."),
    "QG320": Rule("A quota is of no verb, tier or topic.", "take one of those listed"),
    "QG321": Rule("A quota is no range of points.", "write [least, most]"),
    "QG322": Rule("Points, quotas and slots of a blueprint contradict each other.",
                  "make the sums agree"),
    "QG323": Rule("No paper meets the quotas of a blueprint.",
                  "widen the quota, or list other templates in the slots"),
    "QG324": Rule("An example in own words says no more than how much or how bright something is, "
                  "and another criterion of the part asks for that, too.",
                  "say of what"),
    # Figures.
    "QG330": Rule(
        "A solver asks of letters what only numbers have.",
        "compute it by what docs/functions.md lists, which waits for the drawn numbers",
    ),
    "QG401": Rule("The figure of the question shows the answer.",
                  "leave it out of draw and alt where quiz is true"),
    "QG402": Rule("What is to be read in the figure does not stand there.",
                  "show it in draw and alt where quiz is true, or leave it out of reads"),
    "QG403": Rule("Labels cover each other.",
                  "move one of them, or leave it out where there is no room"),
    "QG404": Rule("Letters are too small.", "write them larger, and no index of an index"),
    "QG405": Rule("The figure is wider than a page.",
                  "draw it narrower: it is as wide as what is drawn"),
    "QG406": Rule("Markers lie outside the axes.", "widen set_xlim and set_ylim"),
    "QG407": Rule("An axis with numbers has no name.",
                  'name it with its unit: ax.set_xlabel("$x$ / mm")'),
    "QG408": Rule("A line, an area or letters are too pale.",
                  "take an ink of the house (docs/figures.md) or a darker colour"),
    "QG409": Rule("Lines look alike on grey paper.",
                  "give one of them dashes, or say COLOUR = True"),
    # The bank as a whole, and its cards.
    "QG501": Rule("The bank has no template.", "write one with quizgen new template TOPIC/NAME"),
    "QG502": Rule("There are words and no template.toml.",
                  "write it, or mend the name of the file"),
    "QG503": Rule("A topic has no template.", "write one, or delete the line"),
    "QG504": Rule("No cards are made of a file.", "rename it"),
    "QG506": Rule("A version of a card is kept for a question that is gone.",
                  "run python -m quizgen.cards.update_versions, with the folder of the bank"),
    "QG507": Rule("A word that the bank brings cannot be used.", "mend it, or delete the line"),
    "QG508": Rule("A file of words is called as no language or no part of quizgen.",
                  "rename the file, or delete it"),
    # Outputs, and lint itself.
    "QG601": Rule("An output cannot be made.", "leave out or change what the message names"),
    "QG602": Rule("The author's Python does not end.",
                  "let every loop end, or give it more time with --limit"),
    "QG603": Rule("quizgen fails itself: an error that nobody expected."),
    # Sheets that come back on paper.
    "QG610": Rule("A file of a scanner cannot be read.", "save it again as PDF, JPEG or PNG"),
    "QG611": Rule("A picture is too large to be that of a page.", "scan it with 150 to 300 dpi"),
    "QG612": Rule("What was typed beside scanned sheets, or kept of them, cannot be read.",
                  "mend the line that the message names"),
    "QG613": Rule("A picture cannot be assigned to a page by hand.",
                  "name a picture and a page that the page of pictures shows"),
    "QG650": Rule("A rubric or the list of markers of a class cannot be read.",
                  "mend the file, or delete it: decisions stand in rulings.csv"),
    "QG651": Rule("A table of earlier classes cannot be read.",
                  "write it again: quizgen class analyse --earlier"),
}  # fmt: skip
CODES: Mapping[str, Rule] = MappingProxyType(_CODES)
"""Code of every rule; those of QG2, QG3 and QG4 can be ignored."""
