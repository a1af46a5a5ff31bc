"""Bangla texts of the bank spell technical terms as the table of ``docs/bangla.md`` says."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
SECTION, JUDGED = re.compile(r"^## (\w+)"), {"gaps", "accept", "half", "refuse", "about"}
ENDINGS = "|ের|ে|য়|য়ের|তে|কে|টি|টা|টির|গুলো|ও|ই"


def refused_spellings() -> list[str]:
    rows = (ROOT / "docs" / "bangla.md").read_text(encoding="utf-8").splitlines()
    cells = [row.split("|")[3] for row in rows if row.startswith("| ")][1:]
    return [word.strip() for cell in cells for word in cell.split(",") if word.strip()]


def lines_that_are_read(file: Path):
    """Words that are judged, and the key words that vocabulary cards explain, may be spelt otherwise."""
    section = ""
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        section = found[1] if (found := SECTION.match(line)) else section
        if section not in JUDGED and not line.startswith("term ="):
            yield number, line


def test_terms_stand_in_one_spelling():
    refused = refused_spellings()
    assert "লেন্স" in refused
    assert len(refused) > 80
    letters = r"[\u0980-\u09ff]"
    wrong = re.compile(rf"(?<!{letters})(?:{'|'.join(refused)})(?:{ENDINGS})(?!{letters})")
    bank = ROOT / "templates"
    files = [*bank.glob("*/*/bn.md"), *bank.glob("cards/*.toml"), *bank.glob("quantities/*.toml")]
    found = [
        f"{file.relative_to(bank)}:{number}: {hit[0]}"
        for file in [*files, bank / "figures" / "bn.toml", bank / "curriculum.toml"]
        for number, line in lines_that_are_read(file)
        if (hit := wrong.search(line))
    ]
    assert found == []
