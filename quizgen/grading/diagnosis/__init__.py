"""Which mistake gives exactly this wrong value: slips in one number, slips in the chain.

In: a wrong value, the key, the chain around it. Out: the name of the mistake, or nothing.
Must never know: whether marks are given for it.
"""
