"""The mathematics behind the questions.

``<subject>/<model>.py`` holds a ``MODEL``: quantities, steps and known mistakes as SymPy formulas,
in textbook symbols. ``quizgen/numerics`` holds the same mathematics as stable NumPy functions.
There is no prose here; sentences live in ``templates/``.
"""
