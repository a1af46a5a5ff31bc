"""Superscript digits, for exponents in plain text."""

_USUAL, _RAISED = "+-0123456789", "⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹"

RAISED = str.maketrans(_USUAL, _RAISED)
"""Signs and digits to superscripts: ``text.translate(RAISED)``."""

LOWERED = str.maketrans(_RAISED, _USUAL)
"""Superscripts back to signs and digits."""
