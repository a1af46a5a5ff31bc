"""A picture beside a template's words stands in every output, with its words and nothing unsafe."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path

import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from quizgen.bank.bank import Bank
from quizgen.bank.pictures import read_picture
from quizgen.cards.deck import build_deck
from quizgen.core.errors import BankError
from quizgen.lms import FORMATS, get_exporter
from quizgen.lms.items import items_from_templates
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper, single_question_paper
from quizgen.render import html, pdf, text
from quizgen.web.question_view import QuestionRequest, question_view

RULES = """
topic = "circuits"
tier = "A"
covers = ["A01"]

[draw]
U = { pick = [2, 3, 4, 5, 6, 7] }

[[part]]
answer = { kind = "choice", options = { box = true, gap = false } }
"""
WORDS = """# A divider
Two resistors share a voltage:

![Two resistors $R_1$ and $R_2$ in series at {{ U }} V](circuit.svg)

**Which sign is a resistor?**

## options
- box: ![a box](box.png)
- gap: two bars

## why
A box.

## note
On a board it looks like ![a "brown" cylinder](board.jpg).
"""
BANGLA = """# একটি বিভাজক
দুটি রোধ একটি বিভব ভাগ করে:

![{{ U }} V বিভবে ধারায় দুটি রোধ $R_1$ ও $R_2$](circuit.svg)

**কোন চিহ্নটি রোধ?**

## options
- box: ![একটি বাক্স](box.png)
- gap: দুটি দাগ

## why
একটি বাক্স।

## note
বোর্ডে তা ![বাদামি সিলিন্ডার](board.jpg)-এর মতো।
"""
SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="120" height="60">'
    '<path d="M0 30H120" stroke="#000"/>{}</svg>'
)


def encode(kind: str, size=(40, 20), **more) -> bytes:
    file = io.BytesIO()
    Image.new("RGB", size, (200, 30, 30)).save(file, kind, **more)
    return file.getvalue()


@pytest.fixture
def folder(tmp_path) -> Path:
    folder = tmp_path / "bank" / "templates" / "circuits" / "divider"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES)
    (folder / "en.md").write_text(WORDS)
    (folder / "bn.md").write_text(BANGLA, encoding="utf-8")
    (folder / "circuit.svg").write_text(SVG.format(""))
    (folder / "box.png").write_bytes(encode("PNG"))
    (folder / "board.jpg").write_bytes(encode("JPEG"))
    return folder


def bank_of(folder: Path) -> Bank:
    return Bank(folder.parents[2])


def template_of(folder: Path):
    return bank_of(folder).template("divider")


ALTS = ("Two resistors R₁ and R₂ in series at {U} V", "a box", 'a "brown" cylinder')


def said(template, seed: int = 1) -> list[str]:
    item = single_question_paper(template, seed, "en").items[0]
    return [alt.format(U=item.keys[0].draw.format_value("U")) for alt in ALTS]


# Every output


def test_a_page_holds_the_pictures_and_their_words(folder):
    paper = single_question_paper(template_of(folder), 1, "en")
    exam, solutions = (
        html.render_paper_html(paper, kind).decode() for kind in ("exam", "solutions")
    )
    shown = dict(re.findall(r'src="data:image/([a-z+]+);base64,[^"]+" alt="([^"]*)"', solutions))
    circuit, box, board = (one.replace('"', "&#34;") for one in said(template_of(folder)))
    assert shown == {"svg+xml": circuit, "png": box, "jpeg": board}
    assert board not in exam


def test_a_pdf_draws_them(folder):
    paper = single_question_paper(template_of(folder), 1, "en")
    source = pdf.typst_sources(paper, "solutions")["main.typ"].decode()
    for words in said(template_of(folder)):
        assert words.replace('"', r"\\\"") in source or words in source
    with_jpeg = pdf.render_paper_pdf(paper, "solutions")
    assert with_jpeg.startswith(b"%PDF")
    assert with_jpeg.count(b"/Subtype/Image") + with_jpeg.count(b"/Subtype /Image") >= 2


def test_plain_text_says_their_words(folder):
    item = single_question_paper(template_of(folder), 1, "en").items[0]
    told = text.format_question(item)
    assert all(f"[{words}]" in told for words in said(template_of(folder)))


def test_both_languages_on_a_sheet_show_a_picture_of_the_story_once(folder):
    bank = bank_of(folder)
    paper = build_paper(bank, load_blueprint("circuits", bank), 1, "both")
    page = html.render_paper_html(paper, "exam").decode()
    assert page.count("data:image/svg+xml") == 1


def test_a_deck_brings_their_files(folder):
    deck = build_deck(bank=bank_of(folder))
    assert {Path(name).suffix for name in deck.media} == {".svg", ".png", ".jpeg"}
    fields = "".join("".join(note.fields()) for note in deck.notes)
    assert set(re.findall(r'src="([^"]+)"', fields)) == set(deck.media)


@pytest.mark.parametrize("target", FORMATS)
def test_an_export_holds_them_or_their_files(folder, target):
    items = list(items_from_templates(bank_of(folder), ["divider"], 1, 1, ["en"]))
    data = get_exporter(target).write(items)
    if not zipfile.is_zipfile(io.BytesIO(data)):
        written = data.decode().replace("\\", "").replace("&#61;", "=")
        for kind in ("svg+xml", "png", "jpeg"):
            assert f'src="data:image/{kind};base64,' in written
        return
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = {name for name in archive.namelist() if name.startswith("figures/")}
        texts = "".join(archive.read(n).decode() for n in archive.namelist() if n.endswith(".xml"))
    assert {Path(name).suffix for name in names} == {".svg", ".png", ".jpeg"}
    assert all(texts.count(name) >= 2 for name in names)  # in a question and in the manifest


def test_practice_in_a_browser_shows_them(folder):
    item = single_question_paper(template_of(folder), 1, "en").items[0]
    page = question_view(QuestionRequest("divider", "1", "en"), item.questions[0], item.keys[0])
    assert 'class="picture" src="data:image/svg+xml' in page.stem
    assert any("data:image/png" in words for _, words in page.parts[0].field.options)
    assert "data:image/jpeg" in page.note


def test_a_changed_picture_is_another_template(folder):
    before, files = template_of(folder).digest, bank_of(folder).template_files("divider")
    (folder / "board.jpg").write_bytes(encode("JPEG", (41, 20)))
    assert template_of(folder).digest != before
    assert bank_of(folder).template_files("divider") != files


# What is wrong is said with its line


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("![](box.png)", "en.md:4: picture 'box.png' has no words: describe the picture in words"),
        ("![words](none.png)", "there is no picture 'none.png' beside the words (there are board"),
        ("![words](../divider/box.png)", "en.md:4: picture '../divider/box.png': not the name of"),
        ("![words](/etc/passwd.png)", "picture '/etc/passwd.png': not the name of a file beside"),
        ("![words](https://a.b/c.png)", "picture 'https://a.b/c.png': not the name of a file"),
        ("![words](box.gif)", "picture 'box.gif': not the name of a file beside the words that"),
        ("![words](my box.png)", "a picture is not like ![words](file.png), without blanks"),
    ],
)
def test_a_picture_that_cannot_be_shown_is_named(folder, line, what):
    (folder / "en.md").write_text(WORDS.replace(WORDS.splitlines()[3], line))
    with pytest.raises(BankError) as error:
        template_of(folder)
    assert what in str(error.value)


def test_a_link_out_of_the_folder_is_refused(folder, tmp_path):
    (tmp_path / "secret.png").write_bytes(encode("PNG"))
    (folder / "box.png").unlink()
    (folder / "box.png").symlink_to(tmp_path / "secret.png")
    with pytest.raises(BankError, match=r"bn\.md:9: picture 'box\.png' is a link out of|en\.md:9"):
        template_of(folder)


def test_a_file_that_is_no_picture_is_refused(folder):
    (folder / "box.png").write_bytes(b"<script>alert(1)</script>")
    with pytest.raises(BankError, match=r"picture 'box\.png': cannot be read as PNG or JPEG"):
        template_of(folder)


def test_a_picture_cannot_stand_where_there_is_no_folder():
    from quizgen.bank.entries import load_entries
    from quizgen.cards.content import TrapEntry
    from quizgen.question.entry_prose import entry_blocks

    source = (
        '[[entry]]\nid = "a"\ntopic = "t"\ntier = "A"\nsection = "1"\n'
        'claim = { en = "![words](box.png)" }\nright = { en = "x" }\n'
    )
    (entry,) = load_entries(source, TrapEntry, "traps.toml", ("en",))
    with pytest.raises(BankError, match=r"claim\.en: picture 'box\.png' cannot stand here"):
        entry_blocks(entry, "claim", "en")


# Nothing but pixels and drawing is left


def test_notes_in_a_picture_are_dropped(folder):
    told = PngInfo()
    told.add_text("Author", "a secret")
    (folder / "box.png").write_bytes(encode("PNG", pnginfo=told) + b"<script>")
    exif = Image.Exif()
    exif[0x010E] = "a secret"
    (folder / "board.jpg").write_bytes(encode("JPEG", exif=exif, comment=b"a secret"))
    for name in ("box.png", "board.jpg"):
        assert b"secret" in (folder / name).read_bytes()
        data = read_picture(folder, name).data
        assert b"secret" not in data
        assert b"<script>" not in data


def test_a_photograph_is_upright_and_no_larger_than_a_page(folder):
    turned = Image.Exif()
    turned[0x0112] = 6  # a quarter turn clockwise
    (folder / "board.jpg").write_bytes(encode("JPEG", (3000, 2000), exif=turned))
    picture = read_picture(folder, "board.jpg")
    with Image.open(io.BytesIO(picture.data)) as image:
        assert (max(image.size), image.height > image.width) == (1600, True)
    assert picture.height_pt == 340


def test_pixels_to_an_inch_give_the_size(folder):
    (folder / "box.png").write_bytes(encode("PNG", (300, 150), dpi=(150, 150)))
    picture = read_picture(folder, "box.png")
    assert (picture.width_pt, picture.height_pt) == (
        pytest.approx(144, abs=0.1),
        pytest.approx(72, abs=0.1),
    )


UNSAFE = [
    "<script>alert(1)</script>",
    '<rect onclick="alert(1)"/>',
    "<foreignObject><p>hello</p></foreignObject>",
    '<image href="https://a.b/c.png"/>',
    '<image href="data:image/svg+xml;base64,PHN2Zy8+"/>',
    '<use href="other.svg#a"/>',
    '<use href="data:text/html,x"/>',
    '<rect fill="url(https://a.b/c#d)"/>',
    "<rect style=\"fill: url('https://a.b/c#d')\"/>",
    r'<rect style="fill: u\72l(https://a.b/c)"/>',
    "<style>@import 'https://a.b/c.css';</style>",
    "<style>rect { background: image-set('https://a.b/c' 1x) }</style>",
    '<a href="javascript:alert(1)"><rect/></a>',
    '<animate attributeName="href" to="javascript:alert(1)"/>',
    "<metadata>https://a.b</metadata>",
    '<x:script xmlns:x="http://www.w3.org/1999/xhtml">alert(1)</x:script>',
]


@pytest.mark.parametrize("inside", UNSAFE)
def test_of_an_svg_stays_what_only_draws(folder, inside):
    (folder / "circuit.svg").write_text(SVG.format(inside))
    left = read_picture(folder, "circuit.svg").data.decode()
    left = left.replace("http://www.w3.org/2000/svg", "")
    assert not re.search(r"script|alert|onclick|https?:|import|hello|data:|other|\\", left)
    assert "M0 30H120" in left


def test_an_svg_keeps_its_own_shapes_and_styles(folder):
    inside = (
        '<style>.w { stroke: #123456 }</style><defs><g id="r"><rect class="w"/></g></defs>'
        '<use xmlns:xlink="http://www.w3.org/1999/xlink" xlink:href="#r"/>'
        '<path clip-path="url(#c)" d="M1 1"/><text>&lt;R&gt;</text>'
    )
    (folder / "circuit.svg").write_text(SVG.format(inside))
    picture = read_picture(folder, "circuit.svg")
    left = picture.data.decode()
    for kept in (".w { stroke: #123456 }", 'href="#r"', 'clip-path="url(#c)"', "&lt;R&gt;"):
        assert kept in left
    assert (picture.width_pt, picture.height_pt) == (90, 45)
    assert 'viewBox="0 0 120 60"' in left


@pytest.mark.parametrize(
    ("source", "what"),
    [
        ('<!DOCTYPE svg [<!ENTITY a "b">]><svg xmlns="http://www.w3.org/2000/svg"/>', "entities"),
        ("<svg xmlns='http://www.w3.org/2000/svg'><g></svg>", "cannot be read as SVG"),
        ("<html/>", "its first element is no svg"),
        ("<svg xmlns='http://www.w3.org/2000/svg'/>", "says no size"),
        (SVG.format('<g id="a"><use href="#b"/></g><use href="#a"/>'), "uses a shape that uses"),
        (SVG.format("<g>" * 60 + "</g>" * 60), "more than 50 groups"),
        (SVG.format("<g/>" * 20_001), "more than 20000 elements"),
    ],
)
def test_an_svg_that_cannot_be_made_safe_is_refused(folder, source, what):
    (folder / "circuit.svg").write_text(source)
    with pytest.raises(BankError, match=what):
        read_picture(folder, "circuit.svg")
