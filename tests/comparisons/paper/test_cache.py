"""Cache of finished calls: one computation each, and stored results."""

import os

import pytest

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.paper.cache import CachedCall, make_calls
from comparisons.runs.workers import LOST

MADE = []


def double(x):
    MADE.append(x)
    return {"value": 2 * x, "name": "double"}


def refuse(x):
    raise NotApplicable(f"{x} is refused")


def fail(x):
    raise ComputationFailed(f"{x} does not converge")


def process(x):
    return os.getpid()


def end(x):
    os._exit(1)


def defect(x):
    return x["key"]


def test_each_call_is_made_once_and_its_result_or_failure_is_read_again(tmp_path):
    MADE.clear()
    calls = [CachedCall.of(double, 1), CachedCall.of(double, 2.5), CachedCall.of(fail, 3), CachedCall.of(refuse, 4)]
    assert (make_calls([*calls, calls[0]], tmp_path).made, MADE) == (4, [1, 2.5])
    # A failure and a refusal are made again.
    made = make_calls([*calls, CachedCall.of(double, 2)], tmp_path)
    assert (made.made, MADE) == (3, [1, 2.5, 2])
    outcomes = [made.outcomes[call] for call in calls]
    assert outcomes[1].get() == {"value": 5.0, "name": "double"}
    for outcome, reason in ((outcomes[2], r"fail\(3\): 3 does not converge"), (outcomes[3], r"refuse\(4\): 4 is re")):
        with pytest.raises(ComputationFailed, match=reason):
            outcome.get()
    assert [outcome.failed for outcome in outcomes] == [False, False, True, True]


def test_a_call_apart_has_a_process_of_its_own_and_a_defect_costs_its_own_result(tmp_path):
    calls = [*(CachedCall.of(process, x) for x in range(2)), CachedCall.of(end, 3), CachedCall.of(defect, 4)]
    outcomes = make_calls(calls, tmp_path, apart=True).outcomes
    assert len({os.getpid(), *(outcomes[call].result for call in calls[:2])}) == 3
    assert outcomes[calls[2]].failure == LOST
    assert outcomes[calls[3]].failure.startswith("TypeError: ")
