"""The mutants are changes of the present code, and the committed score is theirs."""

import pytest

from tests.mutation.score import NOT_NOTICED, NOTICED, ROOT, mutants, stored

#: Least share of the mutants that the tests must notice, and least number of mutants.
LEAST_SCORE, FEWEST = 0.95, 150


@pytest.mark.parametrize("mutant", mutants(), ids=lambda mutant: f"{mutant.path}: {mutant.old[:40]}")
def test_a_mutant_changes_one_place_of_a_file_and_names_tests(mutant):
    text = mutant.text()
    assert text != (ROOT / mutant.path).read_text(encoding="utf-8")
    if mutant.path.endswith(".py"):
        compile(text, mutant.path, "exec")
    assert mutant.tests
    assert all((ROOT / test).exists() for test in mutant.tests)


def test_every_mutant_was_run_and_nearly_all_are_noticed():
    """After a change of the table: `python -m tests.mutation.score`."""
    every, rows = mutants(), stored()
    assert len({mutant.key for mutant in every}) == len(every) >= FEWEST
    assert rows.keys() == {mutant.key for mutant in every}
    assert {row["outcome"] for row in rows.values()} <= {NOTICED, NOT_NOTICED}
    assert sum(row["outcome"] == NOTICED for row in rows.values()) >= LEAST_SCORE * len(rows)


def test_what_noticed_a_mutant_is_still_there_and_one_of_its_tests():
    rows = stored()
    for mutant in mutants():
        by = rows[mutant.key]["by"]
        path, _, name = by.removesuffix(": did not end").partition("::")
        if by:
            assert any(path == test or path.startswith(f"{test}/") for test in mutant.tests), by
            assert f"def {name}(" in (ROOT / path).read_text(encoding="utf-8") or not name, by
