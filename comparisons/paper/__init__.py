"""The paper computed again: every figure, every published number, and what it could not say.

A plate is one figure or table: the calls it needs, the tables made of their answers, and the picture of the
tables.  The workshop makes all calls of the chosen plates, each once, and keeps the answers on disk.
"""
