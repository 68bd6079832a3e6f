"""Work on every core: each item once, in processes of one thread."""

import os
import signal
from concurrent.futures import BrokenExecutor, Future
from pathlib import Path

import pytest
import threadpoolctl

from comparisons.runs import workers
from comparisons.runs.workers import Processes, each, processes


def threads(_):
    """The process, and the threads of its linear algebra libraries."""
    import scipy.linalg  # noqa: F401

    return os.getpid(), [library["num_threads"] for library in threadpoolctl.threadpool_info()]


def fail(item):
    raise ValueError(f"{item} is refused")


def test_the_linear_algebra_of_a_worker_has_one_thread():
    for process, numbers in each(threads, [1, 2], 2, lost=str):
        assert process != os.getpid()
        assert numbers
        assert set(numbers) == {1}


def test_one_job_works_in_this_process():
    assert [process for process, _ in each(threads, [1, 2], 1, lost=str)] == [os.getpid()] * 2


def test_an_exception_of_the_function_is_raised():
    with pytest.raises(ValueError, match="is refused"):
        list(each(fail, [1, 2], 2, lost=str))


def end(item):
    """End this process as the system does when there is no memory: always, or the first time for a path."""
    path = Path(item)
    if item == "always" or (path.is_absolute() and not path.exists()):
        path.is_absolute() and path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return f"finished {item}"


def test_an_item_whose_process_ends_is_tried_once_more_and_the_others_go_on(tmp_path, capsys):
    once = str(tmp_path / "once")
    outputs = list(each(end, ["a", "always", once, "b", "c"], 2, lost=lambda item: f"lost {item}"))
    assert sorted(outputs) == sorted(["finished a", "lost always", f"finished {once}", "finished b", "finished c"])
    assert "what they worked on (2) is tried once more" in capsys.readouterr().err


def test_a_single_item_that_ends_its_process_does_not_end_this_one():
    assert list(each(end, ["always"], 2, lost=str.upper)) == ["ALWAYS"]


def test_what_is_tried_again_can_be_parts_of_an_item():
    tried = []

    def backend(function, items, jobs):
        tried.append(list(items))
        yield from ((item, None if len(item) > 1 or item == "x" else item) for item in items)

    assert list(each(str, ["ax", "b"], 2, lost=lambda item: f"lost {item}", split=list, backend=backend)) == [
        *("b", "a", "lost x"),
    ]
    assert tried == [["ax", "b"], ["a", "x"]]


def test_processes_that_cannot_work_are_given_up(monkeypatch):
    monkeypatch.setattr(workers, "_DEATHS_IN_SEQUENCE", 2)
    with pytest.raises(BrokenExecutor, match="3 worker processes one after the other ended early"):
        list(each(end, ["always"] * 5, 2, lost=str))


def test_a_process_that_ended_between_two_items_is_replaced(monkeypatch):
    class Ended:
        def submit(self, *_):
            raise BrokenExecutor

    class Sound:
        def submit(self, function, item):
            future = Future()
            future.set_result(function(item))
            return future

        def shutdown(self, **_):
            pass

    pools = iter([Ended(), Sound(), Sound()])
    monkeypatch.setattr(workers, "_pool", lambda: next(pools))
    assert sorted(output for _, output in processes(str, [1, 2, 3], 2)) == ["1", "2", "3"]


class InThisProcess:
    """An executor without a process, which counts how many were started and ended."""

    started, ended = 0, 0

    def __init__(self):
        InThisProcess.started += 1

    def submit(self, function, item):
        future = Future()
        try:
            future.set_result(function(item))
        except ValueError as error:
            future.set_exception(error)
        return future

    def shutdown(self, wait=True, **_):
        InThisProcess.ended += wait


@pytest.fixture
def counted(monkeypatch):
    monkeypatch.setattr(workers, "_pool", InThisProcess)
    monkeypatch.setattr(InThisProcess, "started", 0)
    monkeypatch.setattr(InThisProcess, "ended", 0)
    return InThisProcess


def test_one_call_after_the_other_works_on_the_same_processes(counted):
    with Processes() as backend:
        assert len(list(backend(str, [1, 2, 3], 2))) == 3
        assert list(backend(str, [4], 2)) == [(4, "4")]
        assert counted.started == 2
        assert len(list(backend(str, [1, 2, 3], 3))) == 3
        assert (counted.started, counted.ended) == (3, 0)
    assert (counted.started, counted.ended) == (3, 3)


def test_processes_that_may_still_be_at_work_are_not_kept(counted):
    with Processes() as backend:
        with pytest.raises(ValueError, match="is refused"):
            list(backend(fail, [1, 2], 2))
        assert (counted.started, counted.ended) == (2, 2)
        assert len(list(backend(str, [1, 2], 2))) == 2
        outputs = backend(str, [1, 2, 3], 2)
        next(outputs)
        outputs.close()
        assert (counted.started, counted.ended) == (4, 4)


def test_without_a_block_processes_end_with_each_call(counted):
    for calls in (1, 2):
        assert len(list(processes(str, [1, 2], 2))) == 2
        assert (counted.started, counted.ended) == (2 * calls, 2 * calls)


def test_processes_are_the_same_and_end_with_the_block():
    with Processes() as backend:
        first, second = ({process for _, (process, _) in backend(threads, [1, 2], 2)} for _ in range(2))
    assert first == second
    for process in first:
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)


def test_a_process_works_on_items_that_are_alike(monkeypatch):
    """In the plain order each of the two would work on both kinds."""
    taken = {}

    class Numbered(InThisProcess):
        def submit(self, function, item):
            taken.setdefault(id(self), []).append(item)
            return super().submit(function, item)

    monkeypatch.setattr(workers, "_pool", Numbered)
    items = ["a1", "b1", "b2", "a2", "a3", "b3"]
    assert sorted(each(str, items, 2, lost=str, alike=lambda item: item[0])) == sorted(items)
    assert sorted(map(sorted, taken.values())) == [["a1", "a2", "a3"], ["b1", "b2", "b3"]]
