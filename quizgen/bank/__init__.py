"""From a folder to an admissible draw.

In: a folder of templates (and solvers), a seed. Out: a ``Template``, checked, and a ``Draw`` in
which no misconception can score. Must never know: how a question is worded, printed or marked.
"""
