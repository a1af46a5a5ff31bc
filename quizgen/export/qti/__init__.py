"""Questions as packages of QTI 2.1 and 3.0: an item for each question, played by any engine.

In: items. Out: a zip with an item for each, a test for each language, their figures and a manifest;
both versions say the same in other words (``dialect``). Must never know: what one engine does
beyond the standard.

Sources: 1EdTech, "QTI 2.1 Assessment Test, Section, and Item Information Model" and "QTI 3.0
Assessment, Section and Item Information Model".
"""
