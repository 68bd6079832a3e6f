"""The mutants are changes of the present code."""

import pytest

from tests.mutation.score import ROOT, mutants


@pytest.mark.parametrize("path", sorted({mutant.path for mutant in mutants()}))
def test_a_mutant_changes_one_text_of_a_file_and_names_tests(path):
    for mutant in mutants():
        if mutant.path == path:
            text = mutant.text()
            assert text != (ROOT / path).read_text(encoding="utf-8")
            if path.endswith(".py"):
                compile(text, path, "exec")
            assert mutant.tests
            assert all((ROOT / test).exists() for test in mutant.tests)


def test_they_are_many_and_no_two_are_the_same():
    assert len(set(mutants())) == len(mutants()) >= 150
