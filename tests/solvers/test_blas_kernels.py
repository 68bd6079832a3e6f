"""Values do not depend on the kernel of the BLAS, to the rounding parts of their bounds."""

from functools import cache
from itertools import combinations

import pytest

from tests.blas.kernels import KERNELS, refusal
from tests.marks import heavy
from tests.solvers.under_kernel import PROBLEMS, values_under

_refusal = cache(refusal)


def _agreeing(pair, names):
    for kernel in pair:
        if reason := _refusal(kernel):
            pytest.skip(f"kernel {kernel}: {reason}")
    one, other = (values_under(kernel, names) for kernel in pair)
    assert one.keys() == other.keys() != set()
    apart = {
        key: (abs(one[key][0] - other[key][0]), one[key][1] + other[key][1])
        for key in one
        if not abs(one[key][0] - other[key][0]) <= one[key][1] + other[key][1]
    }
    assert not apart


@pytest.mark.parametrize("pair", [("Haswell", "Nehalem")], ids="-".join)
def test_values_agree_under_two_kernels(pair):
    _agreeing(pair, ("graded",))


@pytest.mark.parametrize("pair", heavy(*((pair,) for pair in combinations(KERNELS, 2))), ids="-".join)
def test_values_agree_under_every_kernel(pair):
    _agreeing(pair, tuple(PROBLEMS))
