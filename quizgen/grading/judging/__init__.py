"""What was read, held against the key: near enough, equal as formulas, the same word.

In: read values and a specification. Out: a verdict. Must never know: how the text was typed.
"""
