"""The public interface as a type checker sees it: each wrong line is refused for its reason.

``test_public.py`` runs mypy --strict on this file; an ignore that is not needed is an error.
"""

from __future__ import annotations

from typing import assert_type

import quizgen

template = quizgen.builtin().template("point-to-image-plane")
assert_type(template, quizgen.Template)

question, key = quizgen.compose(template, seed=3, lang="en")
assert_type(question, quizgen.Question)
assert_type(key, quizgen.Key)
assert_type(question.title, str)
assert_type(question.figure, quizgen.Figure | None)

verdict = quizgen.mark(key.specs[0], "(4; 6)", decimal="comma")
assert_type(verdict, quizgen.Verdict)
assert_type(verdict.message, str)

blueprint = quizgen.load_blueprint("trial", quizgen.builtin())
assert_type(blueprint, quizgen.Blueprint)
paper = quizgen.build(quizgen.builtin(), blueprint, seed=7, choice="en")
assert_type(paper, quizgen.Paper)
assert_type(quizgen.render_paper(paper, "exam", "html"), bytes)
result = quizgen.mark_paper(quizgen.key_of(paper), {"1a": "6,67"})
assert_type(result, quizgen.PaperResult)
assert_type(quizgen.__version__, str)

quizgen.compose(template, sed=3)  # type: ignore[call-arg]
quizgen.compose(template, lang=7)  # type: ignore[arg-type]
quizgen.build(quizgen.builtin(), "trial", seed=7)  # type: ignore[arg-type]
quizgen.build("nonsense")  # type: ignore[call-arg,arg-type]
quizgen.mark(key.specs[0], 3)  # type: ignore[arg-type]
print(quizgen.nonsense)  # type: ignore[attr-defined]
