"""Figures, numbers and statements of the paper, computed again.

A figure has tasks, tables made of their results, and the picture of the tables.  A cache on disk keeps the results of
finished tasks, so that figures share them and each is computed once.
"""
