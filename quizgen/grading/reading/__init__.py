"""What people type, read: rewrites, decimal signs, units, lists, names, formulas.

In: text as typed. Out: numbers with how they were written, lists, trees; or what to ask back.
Must never know: the key.
"""
