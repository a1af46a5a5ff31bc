"""``quizgen practice``: questions in the terminal, with hints, retries and a summary by topic."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import click
import msgspec

from quizgen.marking.messages import practice_words
from quizgen.marking.options import Options
from quizgen.paper.key import KeyChain, KeyPart, KeyQuestion
from quizgen.paper.marking import SELF_MARKED, Marker, PartResult

TRIES = 3
COLOURS = {"correct": "green", "partial": "yellow", "wrong": "red"}


@dataclass
class Outcome:
    """How one part went."""

    topic: str
    right: bool
    first: bool


@dataclass
class Session:
    """What is kept between runs."""

    filters: dict[str, Any]
    seed: str
    done: int = 0
    outcomes: list[Outcome] = field(default_factory=list)

    def save(self, path: Path) -> None:
        """Write the session, whole or not at all."""
        from quizgen.files import write_all

        write_all(path.parent, {path.name: json.dumps(asdict(self), indent=1).encode()})


def state_path() -> Path:
    """Where an interrupted session is kept."""
    return Path(click.get_app_dir("quizgen")) / "practice.json"


def load(path: Path, filters: dict[str, Any]) -> Session | None:
    """Return the interrupted session if it was started with the same filters and can be read."""
    try:
        table = msgspec.convert(json.loads(path.read_text("utf-8")), Session)
    except (OSError, ValueError, msgspec.ValidationError, RecursionError):
        return None
    return table if table.filters == filters else None


def run(**options: Any) -> None:
    """Hold a session.

    Parameters
    ----------
    **options
        ``topic``, ``tier``, ``lang``, ``count``, ``seed``, ``folder`` (a bank), ``fresh``.
    """
    fresh, seed = options.pop("fresh"), options.pop("seed")
    filters = {name: str(value) for name, value in options.items() if value is not None}
    words = practice_words(options["lang"])
    path = state_path()
    session = None if fresh or seed else load(path, filters)
    if session is None:
        session = Session(filters, seed or secrets.token_hex(3))
    else:
        click.echo(words["resumed"].format(seed=session.seed))
    try:
        _hold(session, path, options, words)
    except (click.exceptions.Abort, KeyboardInterrupt):
        session.save(path)
        click.echo(f"\n{words['saved']}")
        return
    path.unlink(missing_ok=True)
    _summary(session, words)


def _hold(session: Session, path: Path, options: dict[str, Any], words: dict[str, str]) -> None:
    templates = _templates(options)
    if not templates:
        click.echo(words["nothing"])
        return
    for number in range(session.done + 1, options["count"] + 1):
        name = _choose(templates, session.seed, number)
        session.outcomes += list(_question(name, number, session, options, words))
        session.done = number
        session.save(path)


def _bank(folder: Path | None) -> Any:
    from quizgen.bank.folder import Bank, builtin

    return Bank(folder) if folder else builtin()


def _templates(options: dict[str, Any]) -> list[Any]:
    bank = _bank(options.get("folder"))
    found = []
    for name in bank.paths:
        rules = bank.rules(name)
        if options["topic"] in {None, rules.topic} and options["tier"] in {None, rules.tier}:
            found.append(bank.template(name))
    return [template for template in found if options["lang"] in template.languages]


def _choose(templates: list[Any], seed: str, number: int) -> Any:
    """Go through all templates in an order of the seed before one comes again."""
    turn = (number - 1) // len(templates)

    def rank(template: Any) -> bytes:
        return hashlib.sha256(f"practice/{seed}/{turn}/{template.origin}".encode()).digest()

    return sorted(templates, key=rank)[(number - 1) % len(templates)]


def _question(
    template: Any, number: int, session: Session, options: dict[str, Any], words: dict[str, str]
) -> Iterator[Outcome]:
    from quizgen.question.compose import compose
    from quizgen.render.text import blocks

    lang = options["lang"]
    question, key = compose(template, session.seed, lang, slot=str(number), number=str(number))
    head = words["question"].format(number=number, count=options["count"], title=question.title)
    click.secho(f"\n{head}", bold=True)
    for line in blocks(question.stem):
        click.echo(line)
    _show_figure(question.figure, words)
    marker = Marker(_key(key), Options(lang))
    for part, solved, keyed in zip(
        question.parts, key.solution.parts, marker.question.parts, strict=True
    ):
        yield _Part(part, solved, keyed, marker, words).ask(question.topic)


def _key(key: Any) -> KeyQuestion:
    parts = [KeyPart(str(i), "1", spec) for i, spec in enumerate(key.specs)]
    chain = msgspec.convert(key.chain, KeyChain) if key.chain else None
    return KeyQuestion(key.number, parts, key.template, chain=chain)


def _show_figure(figure: Any, words: dict[str, str]) -> None:
    if figure is None:
        return
    path = state_path().with_name("figure.svg")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(figure.svg)
    click.echo(words["figure"].format(alt=figure.alt))
    click.echo(words["figure-file"].format(path=path))


class _Part:
    """One part: asked until it is right, given up, or out of tries."""

    def __init__(
        self, part: Any, solved: Any, keyed: KeyPart, marker: Marker, words: dict[str, str]
    ) -> None:
        self.part, self.solved, self.keyed = part, solved, keyed
        self.marker, self.words = marker, words
        self.tries, self.hints = 0, 0

    def ask(self, topic: str) -> Outcome:
        """Ask and return how it went."""
        self._show()
        while True:
            typed = click.prompt(self.words["prompt"], default="", show_default=False).strip()
            if typed == "?":
                self._hint()
            elif typed == "!":
                self._solution()
                return Outcome(topic, right=False, first=False)
            else:
                right = self._judge(self.marker.mark(self.keyed, typed))
                if right is not None:
                    first = right and self.tries == 1 and not self.hints
                    return Outcome(topic, right=right, first=first)

    def _show(self) -> None:
        from quizgen.render.text import blocks, inline

        click.echo()
        label = f"({self.part.label}) " if self.part.label else ""
        lines = list(blocks(self.part.body)) or [""]
        click.echo(f"{label}{lines[0]}")
        for line in lines[1:]:
            click.echo(line)
        for mark, text in (*self.part.field.options, *self.part.field.targets):
            click.echo(f"   {mark}  {inline(text)}")
        for hint in self.part.field.hints:
            click.echo(f"   [{hint}]")
        click.secho(f"   {self.words['help']}", dim=True)

    def _judge(self, result: PartResult) -> bool | None:
        """Return whether the part is done and right; None to ask again."""
        verdict = result.verdict
        if verdict.note in SELF_MARKED:
            return self._self_marked(result)
        if not verdict.graded:
            click.secho(verdict.message, fg="magenta")
            return None
        self.tries += 1
        click.echo(self.words["read"].format(read_as=verdict.read_as))
        click.secho(
            f"{self.words[verdict.verdict]} {verdict.message}".strip(), fg=COLOURS[verdict.verdict]
        )
        if verdict.verdict == "correct":
            return True
        if self.tries < TRIES:
            click.echo(self.words["again"].format(left=TRIES - self.tries))
            return None
        self._solution()
        return False

    def _self_marked(self, result: PartResult) -> bool:
        self.tries += 1
        click.echo(result.verdict.message)
        self._solution()
        return click.confirm(
            self.words["self-mark"].format(points=self.solved.answer), default=False
        )

    def _hint(self) -> None:
        from quizgen.render.text import inline

        if self.hints < len(self.solved.lines):
            why = inline(self.solved.lines[self.hints].why)
            click.echo(self.words["hint"].format(hint=why))
            self.hints += 1
        else:
            click.echo(self.words["no-more-hints"])

    def _solution(self) -> None:
        from quizgen.render.text import inline

        for line in self.solved.lines:
            click.echo(f"   {line.maths.typed}")
            click.echo(f"      {inline(line.why)}")
        click.secho(self.words["answer"].format(answer=self.solved.answer), bold=True)


def _summary(session: Session, words: dict[str, str]) -> None:
    if not session.outcomes:
        return
    click.secho(f"\n{words['summary']}", bold=True)
    for topic in sorted({outcome.topic for outcome in session.outcomes}):
        own = [outcome for outcome in session.outcomes if outcome.topic == topic]
        right = sum(outcome.first for outcome in own)
        later = sum(outcome.right and not outcome.first for outcome in own)
        click.echo(words["topic"].format(topic=topic, right=right, count=len(own), later=later))
