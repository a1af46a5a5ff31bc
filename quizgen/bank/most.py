"""Sizes beyond which nobody means what a template, a blueprint or a key says."""

MOST_CHOICES = 10_000
"""Values of a range, and entries of a list."""
MOST_POINTS, MOST_MINUTES, MOST_PARTS, MOST_OPTIONS = 1000, 9999, 10, 12
MOST_IN_POOL = 60
"""Options, pairs, steps or gaps of which every draw takes some."""
MOST_FORMULAS = 500
