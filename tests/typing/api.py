"""The public interface as a type checker sees it: each wrong line is refused for its reason.

``test_public.py`` runs mypy --strict on this file; an ignore that is not needed is an error.
"""

from __future__ import annotations

from typing import assert_type

import quizgen

template = quizgen.builtin_bank().template("point-to-image-plane")
assert_type(template, quizgen.Template)

question, key = quizgen.compose_question(template, seed=3, lang="en")
assert_type(question, quizgen.Question)
assert_type(key, quizgen.QuestionKey)
assert_type(question.title, str)
assert_type(question.figure, quizgen.Figure | None)

verdict = quizgen.grade_answer(key.specs[0], "(4; 6)", decimal="comma")
assert_type(verdict, quizgen.Verdict)
assert_type(verdict.message, str)

blueprint = quizgen.load_blueprint("trial", quizgen.builtin_bank())
assert_type(blueprint, quizgen.Blueprint)
paper = quizgen.build_paper(quizgen.builtin_bank(), blueprint, seed=7, choice="en")
assert_type(paper, quizgen.Paper)
assert_type(quizgen.render_paper(paper, "exam", "html"), bytes)
result = quizgen.grade_paper(quizgen.make_answer_key(paper), {"1a": "6,67"})
assert_type(result, quizgen.PaperResult)
assert_type(quizgen.__version__, str)

quizgen.compose_question(template, sed=3)  # type: ignore[call-arg]
quizgen.compose_question(template, lang=7)  # type: ignore[arg-type]
quizgen.build_paper(quizgen.builtin_bank(), "trial", seed=7)  # type: ignore[arg-type]
quizgen.build_paper("nonsense")  # type: ignore[call-arg,arg-type]
quizgen.grade_answer(key.specs[0], 3)  # type: ignore[arg-type]
print(quizgen.nonsense)  # type: ignore[attr-defined]
