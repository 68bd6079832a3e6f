"""Records that violate the model: a wrong value comes with a remark."""

import numpy as np
import pytest

from tests.marks import heavy

from .other_physics import FLAGS, KINDS, share, tilt
from .synthetic import wrong
from .test_fit import deviations, fitted

#: Share of the records of a kind that may be wrong by three standard uncertainties without a word.
SILENT = 0.2


def test_a_tilt_is_said_and_the_values_hold():
    problem, record = tilt(np.random.default_rng(7))
    result = fitted(problem, record, wrong(problem, 1.5))
    assert any(flag in remark for remark in result.remarks for flag in FLAGS)
    assert max(map(abs, deviations(problem, result))) < 4.0


@pytest.mark.parametrize("kind", heavy(*KINDS))
def test_what_is_wrong_is_said(kind):
    of_kind = share(kind, 20, fitted)
    assert of_kind.silent <= SILENT
    if kind == "the model itself":
        assert of_kind.holds > 0.8
        assert of_kind.flagged < 0.2
