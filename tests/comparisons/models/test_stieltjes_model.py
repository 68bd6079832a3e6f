"""The adapter of the Stieltjes scheme: its quantities are those of its path."""

import re

import pytest

from comparisons.models.stieltjes_model import CoarseStieltjesModel, StieltjesModel
from comparisons.problem import Problem


@pytest.mark.parametrize("model", [StieltjesModel, CoarseStieltjesModel])
def test_the_path_ends_where_the_domain_says(model):
    first, last = map(float, re.search(r"central gaps from (\S+) to (-?[0-9.]+)", model.domain).groups())
    central_gap = StieltjesModel(segments=60).curve(Problem.dimensionless(n=1, k=0.2, mu=0.1)).columns["central_gap"]
    assert (central_gap[0], central_gap[-1]) == (first, last)
    # A softer solid is in compression before that.
    curve = StieltjesModel(segments=60).curve(Problem.dimensionless(n=2, k=0.4, mu=0.5))
    assert curve.load[-1] > 0.0 >= curve.load[-2]
    assert curve.columns["central_gap"][-1] > last
