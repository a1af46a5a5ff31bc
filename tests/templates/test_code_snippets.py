"""Code questions: what a snippet prints comes from running it, never from us.

Every template whose stem holds one printing program is run for several draws; the output must be
what the key says.
"""

from __future__ import annotations

import contextlib
import io
import re
import warnings
from fractions import Fraction

from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.kinds.code import fold_blanks
from quizgen.question.compose import compose_question
from quizgen.typeset.prose import CodeBlock

SEEDS = ["reference", *range(12)]
CODE = [
    name for name in builtin_bank().template_paths if builtin_bank().rules(name).topic == "code"
]


def programs(template, seed, lang="en"):
    """The programs in the stem, and the key."""
    question, key = compose_question(template, seed, lang, figures=False)
    return [block.text for block in question.stem if isinstance(block, CodeBlock)], key


def printed(source):
    out = io.StringIO()
    with contextlib.redirect_stdout(out), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exec(compile(source, "snippet", "exec"), {"__name__": "snippet"})
    return out.getvalue()


def numbers(text):
    return [Fraction(n) for n in re.findall(r"-?\d+(?:\.\d+)?", text)]


def values(spec):
    found = getattr(spec, "values", None) or spec.value
    if isinstance(found, dict):
        return list(found.values())
    return found if isinstance(found, list) else [found]


PRINTING = [
    name
    for name in CODE
    if builtin_bank().rules(name).part[0].answer["kind"] in {"number", "point", "table", "code"}
]


@together("name", PRINTING)
def test_the_key_is_what_the_program_prints(bank, name):
    template = bank.template(name)
    for seed in SEEDS:
        (source,), key = programs(template, seed)
        output = printed(source)
        spec = key.specs[0]
        if spec.kind == "code":
            assert fold_blanks(output) == fold_blanks(spec.output)
        else:
            assert numbers(output) == [Fraction(value) for value in values(spec)]


@together("name", CODE)
def test_both_languages_show_the_same_program(bank, name):
    sources = [programs(bank.template(name), 4, lang)[0] for lang in ("en", "bn")]
    assert sources[0] == sources[1]
