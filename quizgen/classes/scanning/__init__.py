"""Answer sheets that come back as pictures: found, straightened and read.

In: files of a scanner or a phone. Out: what was read of each part, and its picture; what is not
certain is asked. Must never know: what is right.
"""
