"""Things become layers of pixels: drawn, moved and blurred where they are not even.

In: a view in px. Out: layers, and layers made of them. Must never know: effects, plans.
"""
