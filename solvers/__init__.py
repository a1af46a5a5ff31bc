"""The mathematics behind the questions.

``<family>.py`` holds a ``MODEL``: quantities, steps and known mistakes as SymPy formulas, in
textbook symbols. ``arrays/<family>.py`` holds the same mathematics as numerically stable NumPy
functions. There is no prose here; sentences live in ``templates/``.
"""
