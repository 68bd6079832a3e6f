"""Cache of finished tasks: one computation each, stored results, continuation after an interruption."""

import json
import math
import os
import signal
from pathlib import Path

import pytest

from comparisons.model import ComputationFailed, NotApplicable
from comparisons.paper.cache import CachedCall, CallCache

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
    cache = CallCache(path, fingerprint)
    made = list(cache.work(tasks, jobs))
    return cache.results, made


@pytest.fixture(autouse=True)
def nothing_made():
    MADE.clear()


def test_each_call_is_made_once(tmp_path):
    tasks = [CachedCall.of(double, 1), CachedCall.of(double, 2.5), CachedCall.of(double, 1)]
    results, made = work(tmp_path / "j", tasks)
    assert made == tasks[:2]
    assert MADE == [1, 2.5]
    assert results[CachedCall.of(double, 2.5)] == {"value": 5.0, "name": "double"}


def test_results_are_read_again(tmp_path):
    work(tmp_path / "j", [CachedCall.of(double, 1), CachedCall.of(fail, 3)])
    results, made = work(tmp_path / "j", [CachedCall.of(double, 1), CachedCall.of(double, 2), CachedCall.of(fail, 3)])
    assert made == [CachedCall.of(double, 2)]
    assert results[CachedCall.of(double, 1)] == {"value": 2, "name": "double"}
    with pytest.raises(ComputationFailed, match="3 does not converge"):
        results[CachedCall.of(fail, 3)]


def test_a_torn_line_is_computed_again(tmp_path):
    path = tmp_path / "j"
    work(path, [CachedCall.of(double, 1), CachedCall.of(double, 2)])
    text = path.read_text()
    path.write_text(text[:-7])
    _, made = work(path, [CachedCall.of(double, 1), CachedCall.of(double, 2)])
    assert made == [CachedCall.of(double, 2)]
    # The same entries; only the seconds of the last one are others.
    lines, before = path.read_text().splitlines(), text.splitlines()
    assert lines[:-1] == before[:-1]
    assert json.loads(lines[-1])["entry"]["item"] == json.loads(before[-1])["entry"]["item"]


@pytest.mark.parametrize("function", [refuse, fail])
def test_a_failure_is_a_result_that_raises(tmp_path, function):
    results, _ = work(tmp_path / "j", [CachedCall.of(function, 3), CachedCall.of(double, 1)])
    assert results[CachedCall.of(double, 1)]["value"] == 2
    with pytest.raises(ComputationFailed, match=rf"{function.__name__}\(3\): 3 "):
        results[CachedCall.of(function, 3)]


def test_nan_is_refused(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        work(tmp_path / "j", [CachedCall.of(not_a_number, 1)])


@pytest.mark.parametrize("text", ["no json\n", "[1]\n", json.dumps({"fingerprint": "a"}) + "\n{}\n"])
def test_what_is_no_journal_is_refused(tmp_path, text):
    (tmp_path / "j").write_text(text)
    with pytest.raises(ValueError, match="not a journal"):
        CallCache(tmp_path / "j", "a")


def test_results_of_other_code_are_refused(tmp_path):
    work(tmp_path / "j", [])
    with pytest.raises(ValueError, match="another version"):
        CallCache(tmp_path / "j", "b")


def test_calls_on_two_processes(tmp_path):
    tasks = [CachedCall("math:hypot", (3.0 * i, 4.0 * i)) for i in range(1, 5)]
    results, made = work(tmp_path / "j", tasks, jobs=2)
    assert set(made) == set(tasks)
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
    assert CallCache(path, "a").missing([once, always]) == [always]
