"""What accuracy costs in time: ladders of number systems, measured and shown on one page.

In: the formulas of solvers, with inputs as in an exam and hard ones. Out: a report, and a page,
plots and JSON of it. Must never know: a question, a paper, a mark.

``families`` lists the questions' formulas with exam and hard inputs, ``rung`` is one way of
computing, ``ladder`` and ``special`` give every family its rungs, ``measure`` times them and counts
wrong digits, ``knobs`` does the same for tunable approximations, ``page`` writes it down.
"""
