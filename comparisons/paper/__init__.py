"""The paper computed again: every figure, every published number, and what it could not say.

A figure is one figure or table: the tasks it needs, the tables made of their answers, and the picture of the
tables.  The cache makes all tasks of the chosen paper_figures, each once, and keeps the answers on disk.
"""
