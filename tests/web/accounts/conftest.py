"""A server on which people sign in, those who manage it and those whom they invite."""

from __future__ import annotations

import argon2
import pytest
from people import Somebody
from sqlalchemy import delete

from quizgen.store.schema import INVITATION, LEARNER
from quizgen.web import passwords
from quizgen.web.passwords import PasswordLimits
from quizgen.web.settings import ServerSettings


@pytest.fixture(scope="module")
def settings(database):
    return ServerSettings(database(), host="0.0.0.0", workers=1)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Passwords that take no time; how long they take is Argon2's own matter."""
    cheap = argon2.PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    other = cheap.hash(b"nobody's")
    monkeypatch.setattr(passwords, "_make_hasher", lambda: cheap)
    monkeypatch.setattr(passwords, "_make_dummy_hash", lambda: other)


@pytest.fixture
def site(app):
    """A server on which nobody has an account."""
    site = app.state.site
    with site.store.database.writing() as connection:
        for table in (INVITATION, LEARNER):
            connection.execute(delete(table))
    site.password_limits = PasswordLimits()
    return site


@pytest.fixture
def manager(app, site):
    """The first one, who manages."""
    found = Somebody(app)
    found.join(f"/invited?key={site.store.accounts.invite(manages=True)}", "Farida")
    return found


@pytest.fixture
def learner(app, manager):
    """Somebody whom they have invited."""
    found = Somebody(app)
    found.join(manager.link(), "রহিম উদ্দিন")
    return found
