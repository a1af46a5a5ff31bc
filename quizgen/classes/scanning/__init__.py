"""Answer sheets that come back as pictures: found, straightened and read.

Comes in: files of a scanner or a phone. Goes out: what was read of each part, and its picture; what
is not certain is asked.
"""
