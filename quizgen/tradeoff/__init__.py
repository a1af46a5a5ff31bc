"""What accuracy costs in time: ladders of number systems, measured and shown on one page.

``families`` lists the questions' formulas with exam and hard inputs, ``fields`` evaluates the same
formula in different number systems, ``rung`` is one way of computing, ``ladder`` and ``special``
give every family its rungs, ``measure`` times them and counts wrong digits, ``knobs`` does the
same for tunable approximations, ``page`` writes it down.
"""
