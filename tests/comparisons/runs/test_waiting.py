"""Order in which processes get the items that wait."""

from comparisons.bench.two_workers import _EXPONENTS as EXPONENTS
from comparisons.bench.two_workers import _exponent as exponent
from comparisons.bench.two_workers import _sweep as sweep
from comparisons.runs import waiting as waiting_module
from comparisons.runs.waiting import Waiting


def shared(items, alike, processes):
    """The items of each process, when all take turns."""
    waiting, taken = Waiting(items, alike), [[] for _ in range(processes)]
    while waiting:
        for process in range(processes):
            if waiting:
                taken[process].append(waiting.take(process))
    return taken


def test_every_item_is_taken_once():
    whole = sweep("fscm", 200)
    taken = shared(whole, exponent, 3)
    assert sorted(id(task) for tasks in taken for task in tasks) == sorted(map(id, whole))


def test_two_processes_share_at_most_one_solid():
    """In the plain order each process works on every exponent: ten first tasks in place of six."""
    first, second = ({exponent(task) for task in tasks} for tasks in shared(sweep("fscm", 200), exponent, 2))
    assert first | second == set(EXPONENTS)
    assert len(first) + len(second) <= len(EXPONENTS) + 1


def test_the_order_is_kept_where_all_are_alike():
    assert shared(range(6), lambda item: None, 1) == [list(range(6))]
    assert shared(range(6), lambda item: None, 2) == [[0, 2, 4], [1, 3, 5]]


def test_the_longest_do_not_wait_for_the_end(monkeypatch):
    """Only the next few items are preferred."""
    monkeypatch.setattr(waiting_module, "AHEAD", 3)
    waiting = Waiting(["a1", "b1", "b2", "b3", "a2"], alike=lambda item: item[0])
    assert [waiting.take(0) for _ in range(5)] == ["a1", "b1", "b2", "b3", "a2"]
    waiting = Waiting(["a1", "b1", "b2", "a2", "b3"], alike=lambda item: item[0])
    assert [waiting.take(0) for _ in range(5)] == ["a1", "a2", "b1", "b2", "b3"]


def test_a_new_process_has_worked_on_nothing():
    waiting = Waiting(["a", "b", "a", "b", "a"], alike=str)
    assert [waiting.take(0), waiting.take(1)] == ["a", "b"]
    waiting.forget(0)
    assert [waiting.take(1), waiting.take(0)] == ["b", "a"]
