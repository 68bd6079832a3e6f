"""Statements of the paper, each with a verdict from computed evidence."""

# The measures register themselves.
from comparisons.paper.statements import formulas as formulas
from comparisons.paper.statements import paths as paths
from comparisons.paper.statements import surfaces as surfaces
