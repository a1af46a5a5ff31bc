"""Settings of a camera: how each is read, what it may be, and those that effects share.

In: values as a scene file has them. Out: numbers in base units. Must never know: pixels.
"""
