"""A variant in words: the ``Question`` that is asked and, apart from it, its ``QuestionKey``.

In: a ``Variant`` and a language. Out: stem, parts, figure; specifications, worked solution. Must
never know: the paper it will stand in, the format it is printed in.
"""
