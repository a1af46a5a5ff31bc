"""Digests of two papers, one deck and three draws of every template, names of templates aside.

A change that must not alter what a person gets leaves them as they are. One that must writes them
anew with ``uv run python tests/golden/golden_papers.py`` and says in the changelog what changed.
"""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

from msgspec import to_builtins
from msgspec.structs import replace

from quizgen.bank.bank import builtin_bank
from quizgen.cards import build_deck
from quizgen.cards.delimited import write_tsv
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import Paper, build_paper
from quizgen.question.compose import compose_question
from quizgen.render import KINDS, RENDERERS, render_paper

STORED = Path(__file__).with_name("digests.tsv")
PAPERS = {"mock": (11, "both"), "trial": (5, "both")}
"""Blueprint to seed and languages."""


def without_names(data: bytes, names: list[str]) -> bytes:
    """The bytes with the names of templates blotted out."""
    longest_first = sorted(names, key=len, reverse=True)
    pattern = rb"(?<![\w-])(?:" + b"|".join(re.escape(n.encode()) for n in longest_first)
    return re.sub(pattern + rb")(?![\w-])", b"NAME", data)


def paper(blueprint: str) -> Paper:
    """The paper under a fixed code: a code names the files behind it, which may change."""
    seed, langs = PAPERS[blueprint]
    return replace(
        build_paper(builtin_bank(), load_blueprint(blueprint), seed, langs), code="golden"
    )


def files_of(made: Paper) -> dict[str, bytes]:
    """Every file that a paper consists of."""
    rendered = {
        f"{kind}.{name}": render_paper(made, kind, name) for name in RENDERERS for kind in KINDS
    }
    return {**rendered, "key.json": write_answer_key(made), "answers.toml": write_blank_form(made)}


def drawn(name: str) -> bytes:
    """What three draws of a template are marked by."""
    template = builtin_bank().template(name)
    keys = [compose_question(template, seed, figures=False)[1] for seed in range(3)]
    table = [[key.identity.split("(")[1], to_builtins(key.specs), key.chain] for key in keys]
    return json.dumps(table, sort_keys=True, ensure_ascii=False).encode()


def digests() -> dict[str, str]:
    """Name of each file to the digest of its bytes."""
    found = {
        f"{name}/{file}": data for name in PAPERS for file, data in files_of(paper(name)).items()
    }
    found["deck/cards.tsv"] = write_tsv(build_deck("both"))
    names = list(builtin_bank().template_paths)
    found |= {f"draws/{name}": drawn(name) for name in names}
    return {
        name: hashlib.sha256(without_names(data, names)).hexdigest()
        for name, data in found.items()
    }  # fmt: skip


if __name__ == "__main__":
    rows = sorted(digests().items())
    STORED.write_text("".join(f"{name}\t{digest}\n" for name, digest in rows), encoding="utf-8")
