"""Practice: one question after another, with hints, tries and a summary by topic.

In: a bank, a wish, what was typed. Out: tasks, feedback, outcomes, a state that can be kept. Must
never know: whether a terminal or a page asks.
"""
