"""The mutants are changes of the present code."""

import subprocess
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from tests.mutation import score
from tests.mutation.score import ROOT, main, mutants, noticed_by

MUTANTS = mutants()


@pytest.mark.parametrize("path", sorted({mutant.path for mutant in MUTANTS}))
def test_a_mutant_changes_one_text_of_a_file_and_names_tests(path):
    for mutant in MUTANTS:
        if mutant.path == path:
            text = mutant.text()
            assert text != (ROOT / path).read_text(encoding="utf-8")
            if path.endswith(".py"):
                compile(text, path, "exec")
            assert mutant.tests
            assert all((ROOT / test).exists() for test in mutant.tests)


def test_they_are_many_and_no_two_are_the_same():
    assert len(set(MUTANTS)) == len(MUTANTS) >= 150


#: A file of the table with few mutants.
FILE = "comparisons/models/dmt.py"
OF_FILE = [mutant for mutant in MUTANTS if mutant.path == FILE]


@pytest.mark.parametrize(("outcomes", "status"), [("all", 0), ("one missed", 1), ("one error", 1)])
def test_the_status_is_0_only_if_every_mutant_is_noticed(outcomes, status, monkeypatch, capsys):
    def is_noticed(mutant, copy):
        if mutant == OF_FILE[0] and outcomes == "one error":
            raise RuntimeError("the test fails without a mutant, too")
        return "" if mutant == OF_FILE[0] and outcomes == "one missed" else "tests/a.py::test"

    monkeypatch.setattr(score, "is_noticed", is_noticed)
    if outcomes != "all":
        # The copy takes seconds, and what stands for the tests does not read it.
        monkeypatch.setattr(score, "copy_of_the_repository", lambda: nullcontext(ROOT))
    assert main(["--only", FILE]) == status
    *lines, last = capsys.readouterr().out.splitlines()
    # An error does not end the run: the others have their outcome.
    assert len(lines) == len(OF_FILE) > 1
    assert last.startswith(f"{len(OF_FILE) - status} of {len(OF_FILE)} ")


@pytest.mark.parametrize(("returncode", "noticed"), [(0, False), (1, True), (2, True), (-11, True)])
def test_tests_that_fail_or_are_ended_by_a_signal_notice_a_mutant(returncode, noticed, monkeypatch, tmp_path):
    run = SimpleNamespace(returncode=returncode, stdout="1 failed\nFAILED tests/a.py::test[1] - assert\n", stderr="")
    monkeypatch.setattr(subprocess, "run", lambda *args, **options: run)
    assert bool(noticed_by(("tests/a.py",), tmp_path)) == noticed


@pytest.mark.parametrize("printed", ["", "RecursionError: while a folder of another run was removed"])
def test_a_failure_without_the_name_of_a_test_notices_nothing(printed, monkeypatch, tmp_path):
    run = SimpleNamespace(returncode=1, stdout=printed, stderr="")
    monkeypatch.setattr(subprocess, "run", lambda *args, **options: run)
    with pytest.raises(RuntimeError, match="names no test that fails"):
        noticed_by(("tests/a.py",), tmp_path)


def test_tests_that_cannot_be_run_are_an_error(monkeypatch, tmp_path):
    run = SimpleNamespace(returncode=4, stdout="file or directory not found")
    monkeypatch.setattr(subprocess, "run", lambda *args, **options: run)
    with pytest.raises(RuntimeError, match="status 4"):
        noticed_by(("tests/absent.py",), tmp_path)
