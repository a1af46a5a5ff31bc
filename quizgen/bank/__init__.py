"""From a folder to an admissible draw.

In: a folder of templates (and solvers), a seed. Out: a ``Template``, checked, and a ``Draw`` that no
known mistake can score in. Must never know: how a question is worded, printed or marked.
"""
