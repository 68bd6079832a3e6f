"""Closed forms, the judge, tables, figures and the command line.

The folders are layers, in the order of `LAYERS`: a module imports from its own layer and from those before it.
"""

#: Modules and folders, from the first layer to the last; `tests/test_independence.py` checks every import.
LAYERS = (
    ("model", "quantities", "console"),
    ("data", "numerics"),
    ("models", "external"),
    ("registry",),
    ("runs",),
    ("judging",),
    ("output",),
    ("paper",),
    ("baseline",),
    ("cli",),
    ("__main__",),
)
