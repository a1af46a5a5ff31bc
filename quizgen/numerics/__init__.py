"""Stable array functions: the formulas of the chapter, right to the last digits for every input.

In: Python numbers, lists and NumPy arrays that broadcast together. Out: floats for scalar
arguments, else arrays. Must never know: a question, a picture, SymPy.

One module per family of formulas, and below them:

* ``domain``: the types that pass, where there is an answer, and what happens where there is none
* ``ufunc``: how a formula is run over blocks, and by fractions where it is not to be trusted
* ``double_double``, ``rational``, ``tables``, ...: more digits where they are needed

The policy is the same everywhere, so the functions do not repeat it:

* A scalar argument outside the range that ``Parameters`` states raises ``DomainError`` with the
  reason ``not-positive``, ``negative`` or ``negative-intensity``; one that is not finite has the
  reason ``not-finite``. ``Raises`` names only the further reasons.
* In arrays nothing is raised: the elements without an answer are masked.
* A pole is an infinity, and a NaN is never silent.

Nothing here knows a question, a language, SymPy or a picture.
"""
