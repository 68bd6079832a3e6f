"""Cache of finished calls: one computation each, stored results, continuation after an interruption."""

import math
import os
import signal

import pytest

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.paper.cache import CachedCall, make_calls

MADE = []


def double(x):
    MADE.append(x)
    return {"value": 2 * x, "name": "double"}


def refuse(x):
    raise NotApplicable(f"{x} is refused")


def fail(x):
    raise ComputationFailed(f"{x} does not converge")


def not_a_number(x):
    return math.nan


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


def test_nan_and_results_of_other_code_are_refused(tmp_path, monkeypatch):
    with pytest.raises(ValueError, match="JSON"):
        make_calls([CachedCall.of(not_a_number, 1)], tmp_path)
    make_calls([CachedCall.of(double, 1)], tmp_path)
    monkeypatch.setattr("comparisons.runs.store.fingerprint", lambda: "code 1, NumPy 2, SciPy 3")
    with pytest.raises(ValueError, match="another version"):
        make_calls([], tmp_path)


def killed(_):
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_call_whose_process_ends_is_made_again_by_the_next_command(tmp_path):
    call = CachedCall.of(killed, 1)
    with pytest.raises(ComputationFailed, match="its worker process ended twice"):
        make_calls([call], tmp_path, jobs=2).outcomes[call].get()
    assert make_calls([call], tmp_path, jobs=2).made == 1
