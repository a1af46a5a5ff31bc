"""What goes over the wire: compressed, and kept by browsers where it never changes."""

from __future__ import annotations

import pytest


def test_long_pages_are_compressed_and_kept_by_nobody(client):
    answer = client.get("/exam", headers={"accept-encoding": "gzip"})
    assert answer.headers["content-encoding"] == "gzip"
    assert answer.headers["cache-control"] == "no-store"
    assert "Mock exam" in answer.text


@pytest.mark.parametrize(
    ("address", "kept"),
    [("/static/app.css", "no-cache"), ("/static/languages.css", "no-cache")],
)
def test_styles_are_asked_for_anew(client, address, kept):
    assert client.get(address).headers["cache-control"] == kept


def test_fonts_are_kept(client, settings):
    from quizgen.render.fonts import WEB

    name = next(file.name for file in WEB.iterdir() if file.suffix == ".woff2")
    assert client.get(f"/static/fonts/{name}").headers["cache-control"] == "max-age=604800"


def test_a_style_that_has_not_changed_is_not_sent_again(client):
    tag = client.get("/static/app.css").headers["etag"]
    assert client.get("/static/app.css", headers={"if-none-match": tag}).status_code == 304
