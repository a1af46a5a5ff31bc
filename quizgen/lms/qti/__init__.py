"""QTI 2.1 and 3.0: packages with an item for each question, and result reports of any engine.

In: items; result reports. Out: a zip with an item for each, a test for each language, their figures
and a manifest; attempts. Both versions have the same elements under other names (``dialect``). Must
never know: what one engine does beyond the standard.

Sources: 1EdTech, "QTI 2.1 Assessment Test, Section, and Item Information Model" and "QTI 3.0
Assessment, Section and Item Information Model".
"""
