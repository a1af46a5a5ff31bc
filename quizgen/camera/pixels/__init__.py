"""Arrays of pixels: files and codes, filters and kernels, noise, colours and tone curves.

In: arrays (H, W, C) of one precision, and numbers. Out: arrays of the same precision, or bytes of a
file. Must never know: layers, effects, plans.
"""
