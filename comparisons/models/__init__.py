"""Closed forms, one module a model, and adapters to the two solvers.

A new closed form is one new module with a subclass of `comparisons.models.closed_form.ClosedForm`, or with any class
that keeps the contract of `comparisons.model.Model`, and one row in `comparisons.registry.MODELS`.
"""
