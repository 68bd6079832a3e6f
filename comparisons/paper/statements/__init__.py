"""Statements of the paper, each with a verdict from computed evidence."""

# The measures register themselves.
from comparisons.paper.statements import formula_measures as formula_measures
from comparisons.paper.statements import path_measures as path_measures
from comparisons.paper.statements import surface_measures as surface_measures
