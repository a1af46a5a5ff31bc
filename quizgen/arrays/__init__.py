"""Stable array functions: NumPy in, NumPy out, Python numbers too; no prose, no SymPy.

One module per family. Every function follows the policy of ``domain``: a pole is an infinity,
no answer is a ``DomainError`` on scalars and a masked element on arrays, a NaN is never silent.
"""
