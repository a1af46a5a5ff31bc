"""The ground every room stands on: files, untrusted bytes, caches, errors and diagnostics.

In: bytes, tables, jobs from outside. Out: checked values, files written whole, cached bytes, and
where something is wrong. Must never know: that there are questions; the table of codes has words
about them, and no code does.
"""
