"""The ground floor: formula trees, number systems, numbers, units, chains.

In: formulas (from a solver's SymPy or from typed text) and exact rationals. Out: values, in the
number system that is asked for. Must never know: a template, a language, a page.
"""
