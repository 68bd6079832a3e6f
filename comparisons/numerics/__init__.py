"""Bounds, grid convergence and distances of curves."""
