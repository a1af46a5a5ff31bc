"""A part of a question on a phone: most fit its screen, none needs more than two."""

from __future__ import annotations

import pytest
from sweep import IS_FULL

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WIDTH, HEIGHT = 390, 844
EVERY = 1 if IS_FULL else 24
"""Of so many templates one is looked at, of all topics."""
BOTTOM = "document.querySelector('section.part').getBoundingClientRect().bottom + scrollY"


def test_parts_fit_a_phone(opened, served, bank):
    page = opened(viewport={"width": WIDTH, "height": HEIGHT}, has_touch=True, is_mobile=True)
    token = page.locator("[name=token]").first.input_value()
    heights, wide = {}, []
    for template in sorted(bank.template_paths)[::EVERY]:
        sent = {"token": token, "template": template}
        page.goto(page.request.post(f"{served.address}/practice", form=sent).url)
        links = [link.get_attribute("href") for link in page.locator(".parts a").all()]
        for link in links:
            page.goto(served.address + link)
            name = f"{template}?{link.partition('part=')[2]}"
            heights[name] = page.evaluate(BOTTOM)
            if page.evaluate("document.documentElement.scrollWidth > innerWidth"):
                wide.append(name)
    long = {name: height for name, height in heights.items() if height > 2 * HEIGHT}
    assert (wide, long) == ([], {})
    fitting = sum(height <= HEIGHT + 2 for height in heights.values())
    assert fitting >= 0.8 * len(heights), (fitting, len(heights))
