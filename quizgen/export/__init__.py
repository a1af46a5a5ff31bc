"""Questions for other systems: one module per format over one model of what is asked.

In: composed questions with their keys. Out: the bytes of a file that a system for courses imports.
Must never know: how a question was drawn or how typed answers are read.
"""
