"""The front door: practise and sit the exam in a browser.

In: requests of a browser. Out: pages. Must never know: how a question is drawn or marked.

Routes are thin; what they show is made in a few worker processes (``workers``), what a learner did
is kept in a database (``store``); every request passes ``guard``, then ``door``: who asks.
"""
