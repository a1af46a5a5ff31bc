"""The PDF: tagged, PDF/UA-1, fonts embedded, alternatives for every figure and formula."""

from __future__ import annotations

import io

import pikepdf
import pytest

from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper, single_question_paper
from quizgen.render import KINDS, pdf, render_paper


@pytest.fixture(scope="module")
def files(bank):
    paper = build_paper(bank, load_blueprint("mock"), 11, "both")
    return paper, {
        kind: pikepdf.open(io.BytesIO(render_paper(paper, kind, "pdf"))) for kind in KINDS
    }


def structure(node, found):
    if isinstance(node, pikepdf.Array):
        for item in node:
            structure(item, found)
    elif isinstance(node, pikepdf.Dictionary):
        if "/S" in node:
            found.append(node)
        if "/K" in node:
            structure(node.K, found)
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_tagged_with_title_and_language(files, kind):
    paper, pdfs = files
    root = pdfs[kind].Root
    assert root.MarkInfo.Marked
    assert str(root.Lang).startswith("en")
    with pdfs[kind].open_metadata() as metadata:
        assert metadata["pdfuaid:part"] == "1"
        assert metadata["dc:title"].startswith(paper.title("en"))
    assert root.ViewerPreferences.DisplayDocTitle


@pytest.mark.parametrize("kind", KINDS)
def test_every_figure_and_formula_has_an_alternative(files, kind):
    nodes = structure(files[1][kind].Root.StructTreeRoot.K, [])
    pictures = [n for n in nodes if str(n.S) in {"/Figure", "/Formula"}]
    assert pictures
    assert all(str(n.get("/Alt", "")).strip() for n in pictures)


def fonts_of(pdf):
    for page in pdf.pages:
        yield from page.get("/Resources", {}).get("/Font", {}).values()


def embedded(font):
    for one in font.get("/DescendantFonts", [font]):
        descriptor = one.get("/FontDescriptor")
        if descriptor is not None:
            return any(f"/FontFile{n}" in descriptor for n in ("", "2", "3"))
    return str(font.get("/Subtype")) == "/Type3"


@pytest.mark.parametrize("kind", KINDS)
def test_all_fonts_are_embedded_with_bangla_among_them(files, kind):
    fonts = list(fonts_of(files[1][kind]))
    assert all(embedded(font) for font in fonts)
    assert any("HindSiliguri" in str(font.get("/BaseFont")) for font in fonts)


def test_english_papers_carry_no_bangla_font(bank):
    pdf = pikepdf.open(
        io.BytesIO(render_paper(build_paper(bank, load_blueprint("trial"), 1, "en"), "exam", "pdf"))
    )
    assert not any("HindSiliguri" in str(f.get("/BaseFont")) for f in fonts_of(pdf))


@pytest.mark.parametrize(("lang", "said"), [("en", "1 Question"), ("bn", "1 প্রশ্ন")])
def test_one_question_is_counted_as_one(bank, lang, said):
    paper = single_question_paper(bank.template("point-to-image-plane"), 0, lang)
    assert f", {said}. " in pdf._TypstPaper(paper, "exam").source()


def test_a_field_in_a_sentence_stands_once_on_a_bilingual_paper(bank, tmp_path):
    named = '["complete-table-of-mixing", "rods-cones-and-peaks"]'
    plan = f'[title]\nen = "A"\nbn = "B"\n[[slot]]\ntemplates = {named}\ncount = 2\n'
    (tmp_path / "two.toml").write_text(plan, "utf-8")
    blueprint = load_blueprint(str(tmp_path / "two.toml"))
    alone, both = (
        pdf._TypstPaper(build_paper(bank, blueprint, 3, lang), "exam").source()
        for lang in ("en", "both")
    )
    for field in ("#blank(", "#gap;"):
        assert both.count(field) == alone.count(field) > 0
