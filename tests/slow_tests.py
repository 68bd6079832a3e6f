"""The slow tests: their list, and the command that renews it.

``python -m tests.slow_tests`` measures all tests and writes the names of the slow ones to ``slow_tests.txt``, in about
half an hour on an idle machine.  ``tests/conftest.py`` marks them.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

import pytest

from tests.marks import LIGHT
from tests.paths import ROOT

PATH = Path(__file__).with_suffix(".txt")

#: CPU seconds from which a test is slow: the others take less than two minutes on two cores.
SLOW = 0.25

#: Tests that are never slow: they show that an installation computes right, or prepare what many quick tests need.
ALWAYS = (
    # Both references within their bounds: a homogeneous solid and power laws, a measured punch, a coating.
    "tests/solvers/test_many_problems.py::test_forces_of_a_batch_are_those_of_the_finite_elements[problems0]",
    "tests/solvers/test_agreement.py::test_forces_of_other_punches_and_laws[measured]",
    "tests/solvers/test_random_coatings.py::test_both_references_agree_and_are_near_jkr_where_the_range_is_short[8]",
    # The first lines of Python that a user copies.
    "tests/docs/test_documents.py::test_the_python_of_a_first_page_prints_its_comments[README.md]",
    # The limit of each reference on a soft solid, and what is beyond both: large strain, the board of submissions.
    "tests/comparisons/models/test_jkr.py::test_it_is_the_limit_of_the_fscm",
    "tests/fem_reference/test_edge_path.py::test_the_load_in_the_limit_of_a_short_range_is_that_of_jkr",
    "tests/fem_reference/test_large_strain.py::test_a_sphere_pulls_off_as_the_first_trial_did",
    "tests/comparisons/external/test_board.py::test_every_submission_has_a_verdict_or_the_reason_why_not",
    # The imports of all modules.
    "tests/test_independence.py::test_packages_import_only_what_they_may",
)

#: Names of the list, and of those that are never slow, that no light test has.
ABSENT = pytest.StashKey[set[str]]()


def listed() -> set[str]:
    """Return the names of the slow tests."""
    return set(PATH.read_text(encoding="utf-8").splitlines())


def renewed(before: Collection[str], absent: Collection[str], costs: Mapping[str, float]) -> list[str]:
    """Return the new list: by its cost where a test was measured, else as before, without tests that do not exist."""
    kept = {*before} - {*absent} - costs.keys()
    return sorted((kept | {test for test, cost in costs.items() if cost >= SLOW}) - {*ALWAYS})


def mark(items: Iterable[pytest.Item]) -> set[str]:
    """Mark the slow tests among those collected; return what is absent."""
    slow = listed()
    others = {"heavy", "lint"}
    light = {item.nodeid: item for item in items if others.isdisjoint(marker.name for marker in item.iter_markers())}
    for name in slow & light.keys():
        light[name].add_marker("slow")
    return (slow | {*ALWAYS}) - light.keys()


def _cpu() -> float:
    """Return the CPU seconds of this process and of its processes that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Measurement:
    """CPU seconds of each test as if it were run alone: a fixture that several tests share counts for each of them."""

    def __init__(self) -> None:
        self._own: Counter[str] = Counter()
        self._shared: dict[tuple[str, str], float] = {}
        self._of_others = 0.0

    def _measure(self, item: pytest.Item):
        """Measure a phase of a test without the fixtures that it shares."""
        self._of_others, before = 0.0, _cpu()
        try:
            return (yield)
        finally:
            self._own[item.nodeid] += _cpu() - before - self._of_others

    # The last user of a fixture ends what others have started: that phase is not measured.
    pytest_runtest_setup = pytest_runtest_call = pytest.hookimpl(wrapper=True, tryfirst=True)(_measure)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        """Measure a fixture that tests share."""
        before = _cpu()
        try:
            return (yield)
        finally:
            if fixturedef.scope != "function":
                cost = _cpu() - before
                self._of_others += cost
                self._shared[fixturedef.baseid, fixturedef.argname] = cost

    def _cost(self, item: pytest.Function) -> float:
        keys = ((node.nodeid, name) for node in item.listchain() for name in item.fixturenames)
        return self._own[item.nodeid] + sum(self._shared.get(key, 0.0) for key in keys)

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write the list."""
        costs = {item.nodeid: self._cost(item) for item in session.items if item.nodeid in self._own}
        before = listed()
        after = renewed(before, session.config.stash.get(ABSENT, ()), costs)
        PATH.write_text("".join(f"{test}\n" for test in after), encoding="utf-8", newline="\n")
        print(f"\n{len(after)} slow tests, {len({*after} - before)} of them new; {len(before - {*after})} are no more")


def pytest_configure(config: pytest.Config) -> None:
    """Measure the tests of a process that has this module as a plugin."""
    config.pluginmanager.register(Measurement())


def main() -> int:
    """Measure all light tests, then the fast ones until none of them is slow: the first user of a cache fills it."""
    selection = LIGHT
    while True:
        before = listed()
        command = [sys.executable, "-m", "pytest", "-q", "-p", "tests.slow_tests", "-m", selection]
        if status := subprocess.run(command, cwd=ROOT, check=False).returncode:
            return status
        if selection != LIGHT and listed() <= before:
            return 0
        selection = f"{LIGHT} and not slow"


if __name__ == "__main__":
    sys.exit(main())
