"""Figures of the statements that do not hold, with both references."""
