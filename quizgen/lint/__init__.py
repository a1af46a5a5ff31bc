"""Proofs about the bank and the machine: lint, coverage, doctor. Nothing imports them but commands.

In: a bank. Out: findings. Must never know: a single paper.
"""
