"""Figures of the paper and of the findings on it, those of the same data in one module."""
