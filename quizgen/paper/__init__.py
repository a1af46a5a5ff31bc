"""Papers: from a blueprint and a seed to questions with a code, key and form, and to marks.

In: a bank, a blueprint, a seed; filled forms. Out: ``Paper``, ``key.json``, ``answers.toml``,
marks. Must never know: the formats that papers are printed in.
"""
