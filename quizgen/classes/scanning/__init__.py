"""Answer sheets that come back as pictures: found, straightened, read; what is not certain is asked.

Comes in: files of a scanner or a phone. Goes out: what was read of each part, and its picture.
"""
