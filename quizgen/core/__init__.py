"""The ground: errors, files, untrusted bytes, caches, and values read from tables.

In: bytes, tables, jobs from outside. Out: checked values, files written whole, cached bytes.
Must never know: that there are questions.
"""
