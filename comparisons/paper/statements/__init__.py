"""Statements of the paper, each with a verdict from computed evidence."""

# The measures register themselves.
from comparisons.paper.statements import equilibria as equilibria
from comparisons.paper.statements import formulas as formulas
