"""Figures and numbers of the paper, computed again, and studies beyond it.

A figure has tasks, tables made of their results, and the picture of the tables.  A cache on disk keeps the results of
finished tasks, so that figures share them and each is computed once.
"""
