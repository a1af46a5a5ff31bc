"""LaTeX as it is pasted from notes or a chat, to what would have been typed.

Commands become the characters that the other rewrites and the formula grammar know. What is not
listed keeps its backslash, so that it is asked back and never guessed.
"""

from __future__ import annotations

import re

from quizgen.grading.reading.source_map import Rewrite, SourceText
from quizgen.maths.notation.names import GREEK

DEEPEST = 40
"""Rounds from the innermost braces outwards."""

_SYMBOLS = {
    "cdot": "*", "times": "*", "ast": "*", "div": "/", "pi": "π", "infty": "∞", "degree": "°",
    "approx": "≈", "simeq": "≈", "sim": "≈", "leq": "≤", "le": "≤", "leqslant": "≤", "geq": "≥",
    "ge": "≥", "geqslant": "≥", "lt": "<", "gt": ">", "ne": "≠", "neq": "≠", "in": "∈",
    "to": "→", "rightarrow": "→", "longrightarrow": "→", "Rightarrow": "→", "mapsto": "→",
    "leftrightarrow": "↔", "langle": "(", "rangle": ")", "lbrace": "{", "rbrace": "}",
    "prime": "'", "mu": "μ", "emptyset": "∅", "mid": "|", "vert": "|", "lvert": "|", "rvert": "|",
    "percent": "%", "quad": " ", "qquad": " ", "varphi": "φ", "varepsilon": "ε", "vartheta": "θ",
    **{word: letter for letter, word in GREEK.items() if letter not in "µ∆"},
}  # fmt: skip
_FUNCTIONS = "arcsin|arccos|arctan|sinh|cosh|tanh|sin|cos|tan|exp|ln|log|lg|max|min|operatorname"
_WRAPPERS = (
    "text|textrm|textit|textbf|textnormal|mathrm|mathit|mathbf|mathsf|mathbb|mbox|boxed|num|unit"
    "|si|vec|bm|boldsymbol|operatorname|ensuremath|underline"
)
_ARGUMENT = r" ?(?:\{([^{}]*)\}|(\w))"

_ONCE: tuple[Rewrite, ...] = (
    (re.compile(rf"(?<=[\w}}])(?=\\(?:{_FUNCTIONS})(?![A-Za-z]))"), lambda _m: " "),
    (re.compile(r"\\[()\[\]]"), lambda _m: ""),
    (re.compile(r"\\begin ?\{[a-zA-Z]*matrix\}"), lambda _m: "("),
    (re.compile(r"\\end ?\{[a-zA-Z]*matrix\}"), lambda _m: ")"),
    (re.compile(r" ?\\\\ ?"), lambda _m: "; "),
    (re.compile(r"\\(?:left|right|[bB]igg?[lr]?)(?![A-Za-z]) ?\.?"), lambda _m: ""),
    (re.compile(r"\\[,;:> ]|(?<=[^ ~])~"), lambda _m: " "),
    (re.compile(r"\\!"), lambda _m: ""),
    (re.compile(r"\{ ?([.,]) ?\}"), lambda m: m[1]),
    (re.compile(r" ?\^ ?(?:\\circ(?![A-Za-z])|\{ ?\\circ ?\})"), lambda _m: "°"),
    (
        re.compile(r"\\(" + "|".join(sorted(_SYMBOLS, key=len, reverse=True)) + r")(?![A-Za-z])"),
        lambda m: _SYMBOLS[m[1]],
    ),
    (re.compile(r"μ (?=\\|m\b)"), lambda _m: "μ"),
    (re.compile(rf"\\({_FUNCTIONS})(?=[\w\\])(?![A-Za-z_])"), lambda m: f"{m[1]} "),
    (re.compile(rf"\\((?!operatorname){_FUNCTIONS})(?![A-Za-z])"), lambda m: m[1]),
)  # fmt: skip


def _unwrap_text_command(match: re.Match[str]) -> str:
    """Return the text inside, with a blank if it follows a number or word."""
    before = match.string[: match.start()][-1:]
    return f" {match[1].strip()}" if before.isalnum() and before != "μ" else match[1]


def _bracket_term(text: str) -> str:
    """Return a term in brackets, unless it is one number or letter."""
    return text if re.fullmatch(r"\d+|[^\W\d_]", text) else f"({text})"


def _rewrite_fraction_command(match: re.Match[str]) -> str:
    """Return a fraction; a proper one behind a whole number makes a mixed number."""
    whole, *terms = match.groups(default="")
    above, below = (terms[0] or terms[1]).strip(), (terms[2] or terms[3]).strip()
    if whole and above.isdecimal() and below.isdecimal() and int(above) < int(below):
        return f"({whole}+{above}/{below})"
    return f"{whole}({_bracket_term(above)}/{_bracket_term(below)})"


def _rewrite_root_command(match: re.Match[str]) -> str:
    """Return ``sqrt(...)``, with a blank where a name or number stands before it."""
    before = " " if match.string[: match.start()][-1:].isalnum() else ""
    return f"{before}sqrt({(match[1] or match[2] or '').strip()})"


def _rewrite_subscript(match: re.Match[str]) -> str:
    """Return a subscript as part of the name, without blanks and commas."""
    return "_" + re.sub(r"[\s,{}\\]", "", match[1])


_DOLLAR = re.compile(r"\$")
_INNERMOST: tuple[Rewrite, ...] = (
    (re.compile(r"\\(?:SI|qty) ?\{([^{}]*)\} ?\{([^{}]*)\}"), lambda m: f"{m[1]} {m[2]}"),
    (re.compile(rf"\\(?:{_WRAPPERS})\*? ?\{{([^{{}}]*)\}}"), _unwrap_text_command),
    (re.compile(r"\^ ?\{([^{}]*)\}"), lambda m: f"^({m[1].strip()})"),
    (re.compile(r"_ ?\{([^{}]*)\}"), _rewrite_subscript),
    (
        re.compile(r"\\sqrt ?\[ ?(\d) ?\] ?\{([^{}]*)\}"),
        lambda m: f"(({m[2].strip()})^(1/{m[1]}))",
    ),
    (re.compile(rf"\\sqrt(?![A-Za-z]){_ARGUMENT}"), _rewrite_root_command),
    (
        re.compile(rf"((?<![\d.,])\d{{1,9}}(?= ?\\))? ?\\[dt]?frac{_ARGUMENT}{_ARGUMENT}"),
        _rewrite_fraction_command,
    ),
)  # fmt: skip
_LAST: tuple[Rewrite, ...] = ((re.compile(r"\\([%{}&#])"), lambda m: m[1]),)


def rewrite_latex(source: SourceText) -> SourceText:
    """Return a text with its LaTeX as it would have been typed.

    Dollar signs go in pairs only; a lone one is no LaTeX.
    """
    if source.text.count("$") % 2 == 0:
        source = source.substitute(_DOLLAR, lambda _m: "")
    source = _apply_rewrites(source, _ONCE)
    for _ in range(DEEPEST):
        before = source.text
        source = _apply_rewrites(source, _INNERMOST)
        if source.text == before:
            break
    return _apply_rewrites(source, _LAST)


def _apply_rewrites(source: SourceText, rewrites: tuple[Rewrite, ...]) -> SourceText:
    """Return a text after some rewrites, in order."""
    for pattern, new in rewrites:
        source = source.substitute(pattern, new)
    return source
