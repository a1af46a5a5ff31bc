"""What accuracy costs: digits, questions and arrays, measured and shown on one page.

In: printed formulas with inputs as in an exam and hard ones, the bank's questions, other libraries.
Out: a report, a page with a slider and a plot, the numbers as JSON. Must never know: a paper, a
learner.

``formulas`` are what the slider moves, ``sweeps`` counts their digits, ``questions`` times whole
questions and counts wrong keys (``solving``), ``rivals`` times arrays, ``page`` writes it down.
"""
