"""Benchmark of the solvers: time, memory and error, measured on one machine in one run, and their ratios."""
