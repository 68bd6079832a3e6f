"""Statements of the paper, each with a verdict from computed evidence."""
