"""Verdicts in the forms people paste: one module a format."""
