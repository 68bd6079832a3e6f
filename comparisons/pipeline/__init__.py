"""Whole computations: a run, a run judged again, and the figures of the paper, each one function."""
