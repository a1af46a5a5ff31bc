"""One module per command; the only place that knows a terminal.

In: what was typed in a shell. Out: files, lines, an exit code. Must never know: what
another command does. Nothing imports a command.
"""
