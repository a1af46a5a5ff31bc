"""Plain values before any pixel: the scene, the settings of a camera, and one view of both.

In: values as a scene file has them. Out: numbers in base units, a view of everything in px. Must
never know: how a picture is made.
"""
