"""Large libraries are loaded by one thread at a time.

The parts of matplotlib import each other. Python hands a thread a part that another one has only
begun to load, as it asks no lock for the package above it, and so two threads that draw the first
figures of a process together would find names missing.
"""

from __future__ import annotations

from threading import RLock

LOCK = RLock()
"""Held while a bank's Python or matplotlib is imported."""
