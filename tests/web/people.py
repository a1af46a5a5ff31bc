"""People with browsers of their own, on a server where they sign in."""

from __future__ import annotations

import html
import re

from starlette.testclient import TestClient

ADDRESS = "http://192.168.1.5:8000"
PASSWORD = "drei gelbe Bohnen"


class Somebody:
    """A browser; it posts forms as its pages have them."""

    def __init__(self, app, address: str = ADDRESS) -> None:
        self.browser = TestClient(app, address)
        self.page = ""

    def get(self, address: str):
        answer = self.browser.get(address)
        self.page = answer.text
        return answer

    @property
    def token(self) -> str:
        return re.search(r'name="token" value="(\w+)"', self.page)[1]

    def post(self, address: str, **sent: object):
        answer = self.browser.post(address, data={"token": self.token, **sent})
        if 'name="token"' in answer.text:
            self.page = answer.text
        return answer

    def sign_in(self, name: str, password: str = PASSWORD):
        self.get("/sign-in")
        return self.post("/sign-in", name=name, password=password)

    def join(self, link: str, name: str, password: str = PASSWORD, **more: str):
        self.get(link)
        return self.post(link, **{"name": name, "password": password, "again": password, **more})

    def link(self, address: str = "/people/invite", **sent: str) -> str:
        """The link that a page of those who manage shows."""
        self.get("/people")
        self.post(address, **sent)
        return html.unescape(re.search(r'value="(http[^"]*/invited[^"]*)"', self.page)[1])
