"""From a typed text and a specification to a verdict with its reason.

In: a specification (a plain table or a struct), what was typed, what is known around it. Out: a
``Verdict``. Must never know: templates, papers, SymPy, NumPy. What a student types never raises.
"""
