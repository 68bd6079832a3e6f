"""The list of the slow tests: it is complete where all tests are collected, and a measurement renews it."""

import subprocess
from types import SimpleNamespace

import pytest

from tests import slow_tests
from tests.slow_tests import ABSENT, ALWAYS, SLOW, Measurement, listed, main, mark, renewed

#: Three tests, of which two share a fixture that takes a tenth of a second of CPU.
SHARED = """
import time
import pytest

@pytest.fixture(scope="module")
def shared():
    end = time.process_time() + 0.1
    while time.process_time() < end:
        pass

def test_the_first(shared): pass
def test_the_second(shared): pass
def test_another(): pass
"""


def test_every_test_of_the_list_exists(pytestconfig):
    """Also none of it is heavy."""
    whole = pytestconfig.args_source is pytestconfig.ArgsSource.TESTPATHS and not pytestconfig.getoption("lf", False)
    if not whole:
        pytest.skip("not all tests are collected")
    assert pytestconfig.stash[ABSENT] == set()


def test_the_list_is_sorted_without_those_that_are_never_slow():
    names = slow_tests.PATH.read_text(encoding="utf-8").splitlines()
    assert names == renewed(names, (), {})


def test_a_cost_decides_and_what_was_not_measured_stays_unless_it_is_absent():
    before = {"a::faster now", "b::absent", "c::not measured"}
    costs = {"a::faster now": 0.9 * SLOW, "d::slow": SLOW, "e::fast": 0.0, ALWAYS[0]: 10.0 * SLOW}
    assert renewed(before, {"b::absent"}, costs) == ["c::not measured", "d::slow"]


def test_what_is_listed_is_slow_unless_it_is_heavy(request, monkeypatch):
    names = {"a", "b", *ALWAYS}
    monkeypatch.setattr(slow_tests, "listed", lambda: names)
    marks = {"a": [], "b": ["heavy"], "c": []}

    def item(name):
        of_item = [SimpleNamespace(name=mark) for mark in marks[name]]
        return SimpleNamespace(nodeid=name, iter_markers=lambda: of_item, add_marker=marks[name].append)

    assert mark([item(name) for name in marks]) == {"b", *ALWAYS}
    assert marks == {"a": ["slow"], "b": ["heavy"], "c": []}


def test_a_fixture_counts_for_each_test_that_shares_it(tmp_path, monkeypatch):
    path = tmp_path / "slow_tests.txt"
    path.write_text("test_shared.py::test_another\n")
    (tmp_path / "test_shared.py").write_text(SHARED)
    monkeypatch.setattr(slow_tests, "PATH", path)
    monkeypatch.setattr(slow_tests, "SLOW", 0.06)
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = -q -p no:cacheprovider --import-mode=importlib\n")
    options = ["-c", str(tmp_path / "pytest.ini"), "--rootdir", str(tmp_path)]
    assert pytest.main([*options, str(tmp_path)], plugins=[Measurement()]) == 0
    assert listed() == {"test_shared.py::test_the_first", "test_shared.py::test_the_second"}


def test_fast_tests_are_measured_until_none_of_them_is_slow(tmp_path, monkeypatch):
    """A test that is not run leaves what it would have computed to another."""
    path = tmp_path / "slow_tests.txt"
    path.write_text("")
    monkeypatch.setattr(slow_tests, "PATH", path)
    lists, selections = iter(["a", "a\nb", "a\nb"]), []

    def run(command, **options):
        selections.append(command[-1])
        path.write_text(next(lists))
        return SimpleNamespace(returncode=0)

    monkeypatch.setattr(subprocess, "run", run)
    assert main() == 0
    assert ["not slow" in selection for selection in selections] == [False, True, True]


def test_tests_that_fail_end_the_measurement(monkeypatch):
    monkeypatch.setattr(subprocess, "run", lambda command, **options: SimpleNamespace(returncode=1))
    assert main() == 1
