"""The mutants are changes of the present code, and the committed score is theirs."""

import pytest

from tests.mutation.score import NOTICED, ROOT, mutants, stored

#: Least share of the mutants that the tests must notice, and least number of mutants.
LEAST_SCORE, FEWEST = 0.95, 120
#: Least number of mutants with an outcome; the others have not been run since they were written.
FEWEST_RUN = 75


@pytest.mark.parametrize("mutant", mutants(), ids=lambda mutant: f"{mutant.path}: {mutant.old[:40]}")
def test_a_mutant_changes_one_place_of_a_file_and_names_tests(mutant):
    text = mutant.text()
    assert text != (ROOT / mutant.path).read_text(encoding="utf-8")
    if mutant.path.endswith(".py"):
        compile(text, mutant.path, "exec")
    assert mutant.tests
    assert all((ROOT / test).exists() for test in mutant.tests)


def test_nearly_all_mutants_that_were_run_are_noticed():
    every, rows = mutants(), stored()
    assert len({mutant.key for mutant in every}) == len(every) >= FEWEST
    assert rows.keys() <= {mutant.key for mutant in every}
    assert len(rows) >= FEWEST_RUN
    assert sum(row["outcome"] == NOTICED for row in rows.values()) >= LEAST_SCORE * len(rows)
