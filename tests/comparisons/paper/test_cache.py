"""Cache of finished tasks: one computation each, stored results, continuation after an interruption."""

import math
import os
import signal
from pathlib import Path

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


def work(path, tasks, fingerprint="a", jobs=1):
    path.mkdir(exist_ok=True)
    made = make_calls(tasks, path, jobs, code=fingerprint)
    return made.results, made.made


@pytest.fixture(autouse=True)
def nothing_made():
    MADE.clear()


def test_each_call_is_made_once_and_its_result_or_failure_is_read_again(tmp_path):
    calls = [CachedCall.of(double, 1), CachedCall.of(double, 2.5), CachedCall.of(fail, 3), CachedCall.of(refuse, 4)]
    _, made = work(tmp_path / "j", [*calls, calls[0]])
    assert (made, MADE) == (4, [1, 2.5])
    results, made = work(tmp_path / "j", [*calls, CachedCall.of(double, 2)])
    assert (made, MADE) == (1, [1, 2.5, 2])
    assert results[calls[1]] == {"value": 5.0, "name": "double"}
    for call, reason in ((calls[2], r"fail\(3\): 3 does not converge"), (calls[3], r"refuse\(4\): 4 is refused")):
        with pytest.raises(ComputationFailed, match=reason):
            results[call]
    assert [results.failed(call) for call in calls] == [False, False, True, False]


def test_nan_is_refused(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        work(tmp_path / "j", [CachedCall.of(not_a_number, 1)])


def test_results_of_other_code_are_refused(tmp_path):
    work(tmp_path / "j", [CachedCall.of(double, 1)])
    with pytest.raises(ValueError, match="another version"):
        work(tmp_path / "j", [], "b")


def test_calls_on_two_processes(tmp_path):
    tasks = [CachedCall("math:hypot", (3.0 * i, 4.0 * i)) for i in range(1, 5)]
    results, made = work(tmp_path / "j", tasks, jobs=2)
    assert made == len(tasks)
    assert [results[call] for call in tasks] == [5.0, 10.0, 15.0, 20.0]


def killed_once(path):
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0


def killed(_):
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_call_whose_process_ends_is_made_once_more_and_again_by_the_next_command(tmp_path):
    once, always = CachedCall.of(killed_once, str(tmp_path / "once")), CachedCall.of(killed, 1)
    path = tmp_path / "calls"
    results, _ = work(path, [once, always], jobs=2)
    assert results[once] == 1.0
    with pytest.raises(ComputationFailed, match="its worker process ended twice"):
        results[always]
    assert work(path, [once, always], jobs=2)[1] == 1


def test_stored_failures_are_used_and_made_again_on_request(tmp_path, capsys):
    calls = [CachedCall.of(fail, 1), CachedCall.of(refuse, 2), CachedCall.of(abs, -2)]
    assert make_calls(calls, tmp_path).failed(calls) == calls[:1]
    assert make_calls(calls, tmp_path).made == 0
    assert "1 stored failures of fail are used" in capsys.readouterr().err
    assert make_calls(calls, tmp_path, retry_failed=True).made == 1
