"""One module per command; the only place that knows a terminal.

In: what was typed in a shell. Out: files, lines, an exit code. Nothing imports a command.
"""
