"""A class: a paper for each student of a roster, in one folder that marking goes on with.

In: a roster, a bank, a blueprint. Out: a folder with papers, solutions, keys and a secret. Must
never know: a shell, a browser.
"""
