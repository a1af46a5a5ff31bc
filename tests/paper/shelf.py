"""A bank without files."""

from __future__ import annotations

from types import SimpleNamespace

from quizgen.bank.bank import builtin_bank

DEFAULT = {"tier": "A", "topic": "optics", "pool": None, "minutes": 5, "apart": (), "beyond": False,
           "points": 5, "figure": ""}  # fmt: skip


class Shelf:
    """Rules alone: name to tier, topic, pool, minutes, points, figure, what must stand apart."""

    def __init__(self, table=(), **named):
        self.table = dict(table, **named)
        self.template_paths = dict.fromkeys(self.table)
        self.members = (self,)
        self.metadata = builtin_bank().metadata

    def rules(self, name):
        given = {**DEFAULT, **self.table[name]}
        figure = given["figure"] and SimpleNamespace(name=given["figure"], quiz=True)
        part = (SimpleNamespace(points=given["points"]),)
        return SimpleNamespace(**{**given, "figure": figure, "part": part})

    def folder_of(self, name):
        return self.template_paths[name]

    def origin(self, name):
        return name

    def owner_of(self, name):
        return self, name
