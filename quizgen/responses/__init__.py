"""Responses that a system for courses collected, marked with the keys that an export left behind.

In: the keys of an export and a report of its responses. Out: marks with their verdicts, for each
attempt. Must never know: how a question is drawn, composed or exported.
"""

SUFFIX = ".keys.jsonl"
"""What the name of an export's keys ends with."""
