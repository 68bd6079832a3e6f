"""Closed forms, one module a model, and adapters to the two solvers."""
