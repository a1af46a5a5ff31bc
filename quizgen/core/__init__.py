"""What every room stands on: where something is found to be wrong, and how that is said.

In: files and what was found in them. Out: diagnostics with code and place. Must never know: what a
question is; the table of codes has words about them, and no code does.
"""
