"""Verdicts on the statements of the paper: the committed ones, and their tests on made-up results."""

import re
import shlex
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli import main as cli
from comparisons.data.paper_statements import paper_statements, verdicts
from comparisons.paper.baseline import PAPER_BASELINE, SHIPPED_STATEMENTS, renew
from comparisons.paper.cache import CachedCall, CallCache, Results
from comparisons.paper.figures.fig08_jumps import QUANTITIES as JUMPS
from comparisons.paper.registry import paper_figures
from comparisons.paper.statements import registry
from comparisons.paper.statements.evidence import (
    FAILS,
    FALSE,
    IN_PART,
    REFERENCES,
    Number,
    clauses,
    evidence_of,
    verdict,
)
from comparisons.paper.statements.flips import flips, read_number, with_number
from comparisons.paper.statements.judgement import PAPER_STATEMENTS, evidence_for, judged
from comparisons.paper.statements.registry import TESTS, find_test

ROOT = Path(__file__).parents[4]
FOLDER = ROOT / PAPER_BASELINE
STATEMENTS = {statement.id: statement for statement in paper_statements()}
PARAMETER = re.compile(r"\b(n|k|mu) = ([0-9.]+)")
#: Tabor numbers of Fig. 5 between the two of which the paper speaks.
NOT_JUDGED = {("contact-fits", "mu"): {0.3, 0.5}, ("contact-radius", "mu"): {0.3, 0.5}}
by_id = pytest.mark.parametrize("statement", STATEMENTS.values(), ids=STATEMENTS)


@pytest.fixture(scope="module")
def committed():
    return pd.read_csv(FOLDER / "paper_statements.csv", keep_default_na=False)


@pytest.fixture(scope="module")
def evidence():
    table = pd.read_csv(FOLDER / "paper_statements_evidence.csv", keep_default_na=False)
    return {id: evidence_of(part) for id, part in table.groupby("statement")}


@by_id
def test_every_statement_has_a_test_with_the_same_tasks_every_time(statement):
    tasks = find_test(statement).tasks(statement)
    assert list(tasks) == list(find_test(statement).tasks(statement))


def test_every_test_is_used_and_no_group_hides_another():
    assert {statement.test for statement in STATEMENTS.values()} == set(TESTS)
    assert sum(len(group.TESTS) for group in registry._GROUPS) == len(TESTS)


def test_an_unknown_test_is_refused():
    with pytest.raises(ValueError, match="statement far-apart has no test 'trends'; there are trend, "):
        find_test(replace(STATEMENTS["far-apart"], test="trends"))


@by_id
def test_a_committed_verdict_follows_from_its_evidence(statement, committed, evidence):
    row = committed[committed["id"] == statement.id].iloc[0].to_dict()
    assert judged(statement, evidence[statement.id]) == row


@by_id
def test_other_evidence_gives_another_verdict(statement, evidence):
    """The value of every row that decides on the other side of its limit."""

    def mirrored(row):
        if before == FALSE and row.outcome != FAILS:
            return row
        value = 2.0 * row.limit.value - row.value.value
        return replace(row, value=Number(value, row.value.u, row.value.what))

    rows = [row for row in evidence[statement.id] if not row.beyond]
    # What only the finite elements or only fscm computes would be undecided: both references are given the same.
    both = [
        replace(row, model=model) for row in rows for model in (REFERENCES if row.model in REFERENCES else [row.model])
    ]
    before = judged(statement, both)["verdict"]
    after = judged(statement, [mirrored(row) for row in both])["verdict"]
    if before == IN_PART:
        assert judged(statement, [mirrored(row) for row in both])["fails_for"] != judged(statement, both)["fails_for"]
    else:
        assert after == {"true": FALSE, FALSE: "true"}[before]


@by_id
def test_a_factor_changes_the_verdict_and_no_smaller_one_does(statement, evidence):
    rows = [row for row in evidence[statement.id] if not row.beyond]
    number = read_number(rows)

    def verdict_at(factor):
        return verdict(clauses(with_number(rows, factor * number)).values())

    factors = flips(rows)
    for other, factor in factors.items():
        outward = 1.0 + 1e-6 * (1 if factor > 1.0 else -1)
        assert verdict_at(factor * outward) == other
        assert verdict_at(factor / outward) != other
    if number is not None:
        nearest = [factor for factor in factors.values() if factor > 1.0], [f for f in factors.values() if f < 1.0]
        assert verdict_at(0.5 * (1.0 + min(nearest[0], default=2.0))) not in factors
        assert verdict_at(0.5 * (1.0 + max(nearest[1], default=0.999))) not in factors


@by_id
def test_the_cases_of_the_paper_are_among_those_judged(statement, evidence):
    """Every combination of the parameters that the paper shows or names, unless a clause is over all of one."""
    if statement.arguments.get("n") or statement.arguments.get("cases"):
        assert statement.own or statement.general
    own = [dict(PARAMETER.findall(row.clause)) for row in evidence[statement.id] if row.own]
    for name, values in statement.own.items():
        of_clauses = {float(case[name]) for case in own if name in case}
        assert of_clauses <= set(values)
        assert not of_clauses or of_clauses >= set(values) - NOT_JUDGED.get((statement.id, name), set())
    assert bool(own) == bool(statement.own)
    assert not any(row.own and row.beyond for row in evidence[statement.id])


@by_id
def test_wide_bounds_decide_nothing(statement, evidence):
    rows = [replace(row, limit=replace(row.limit, u=1e9)) for row in evidence[statement.id]]
    assert judged(statement, rows)["verdict"] == "not decided"


def test_what_fails_by_one_reference_fails_by_the_other(evidence):
    for id, rows in evidence.items():
        failed = {(row.clause, row.model) for row in rows if row.outcome == FAILS and not row.beyond}
        for clause, model in failed:
            if model in REFERENCES:
                assert {(clause, name) for name in REFERENCES} <= failed, (id, clause)


def test_the_committed_texts_are_those_of_the_committed_table(committed):
    for suffix, text in PAPER_STATEMENTS.texts({"": committed}).items():
        assert (FOLDER / f"paper_statements{suffix}").read_text(encoding="utf-8") == text


def test_the_shipped_verdicts_are_the_committed_ones(committed):
    assert (ROOT / SHIPPED_STATEMENTS).read_bytes() == (FOLDER / "paper_statements.csv").read_bytes()
    assert verdicts() == committed.astype(str).to_dict("records")


@by_id
def test_a_command_parses(statement):
    for command in statement.command.split(" && "):
        program, *arguments = shlex.split(command)
        assert program == "fscm-bench"
        cli._parser(arguments).parse_args(cli._keep_negative_numbers(arguments))
    if "paper" in statement.command:
        assert paper_figures(shlex.split(statement.command)[3:])


@pytest.mark.heavy
@by_id
def test_a_command_runs(statement, tmp_path, capsys):
    for command in statement.command.split(" && "):
        _, *arguments = shlex.split(command)
        if arguments[0] != "paper":  # the figures have their own tests
            assert cli.main(arguments) == 0
            assert capsys.readouterr().out


class MadeUp(Results):
    """Results of `quantity` by a formula, and of the jumps by that of `fscm`."""

    def __init__(self, formula):
        super().__init__()
        self.formula = formula

    def __getitem__(self, call: CachedCall):
        if call.function.endswith(":jumps"):
            found = {name: self.formula("fscm", name, *call.arguments) for name in JUMPS}
            return found | {f"u_{name}": 1e-9 for name in JUMPS}
        value = self.formula(*call.arguments)
        return {"value": value, "u_num": 1e-9, "status": "ok", "reason": ""}


def made_up_verdict(id, formula):
    statement = STATEMENTS[id]
    return judged(statement, evidence_for(statement, MadeUp(formula)))["verdict"]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (lambda model, name, n, k, mu: 2.0 + mu, "true"),
        (lambda model, name, n, k, mu: 2.0 - mu / 100.0, "false"),
        (lambda model, name, n, k, mu: 2.0 + mu * (1.0 if n == 1.0 else -0.1), "true in part"),
        # A rise within the sum of the bounds decides nothing.
        (lambda model, name, n, k, mu: 2.0 + 1e-12 * mu, "not decided"),
        # A fall that the finite elements do not confirm decides nothing.
        (lambda model, name, n, k, mu: 2.0 + mu * (-0.1 if model == "fscm" else 1.0), "not decided"),
    ],
)
def test_a_trend_is_judged(formula, expected):
    assert made_up_verdict("pull-off-rises-with-mu", formula) == expected


def test_a_model_is_near_or_not():
    def formula(error):
        return lambda model, name, n, k, mu: 1.0 if model in REFERENCES else 1.0 + error

    assert made_up_verdict("ends-agree", formula(0.019)) == "true"
    assert made_up_verdict("ends-agree", formula(0.021)) == "not decided"  # no finite elements there
    assert made_up_verdict("jump-in-asymptote", formula(0.051)) == "false"


def test_an_error_that_stays_does_not_vanish():
    def formula(error):
        return lambda model, name, n, k, mu: 1.0 if model in REFERENCES else 1.0 + error(mu)

    assert made_up_verdict("errors-vanish", formula(lambda mu: 1.0 / mu)) == "true"
    # Small, but not zero; without the finite elements a failure is not decided.
    assert made_up_verdict("errors-vanish", formula(lambda mu: 0.003 + 1.0 / mu)) == "not decided"


def test_a_case_that_fails_leaves_the_others():
    def formula(model, name, n, k, mu):
        return 1.0 if model in REFERENCES else 1.0 + 0.1 * (mu == 3.0)

    statement = STATEMENTS["jump-in-asymptote"]
    row = judged(statement, evidence_for(statement, MadeUp(formula)))
    assert (row["verdict"], row["holds_in"], row["own_cases"]) == (IN_PART, "4 of 5", "4 of 5")
    assert row["fails_for"] == "n = 2, k = 0.4, mu = 3"
    assert (row["number"], row["flips"]) == ("0.05", "true above x 2.01; false below x 4e-08")


@pytest.mark.parametrize("id", ["kernel-continuous", "psi-bounded", "eta", "insensitive-ranges"])
def test_formulas_give_the_committed_verdict(id, committed):
    statement = STATEMENTS[id]
    found = judged(statement, evidence_for(statement, Results()))
    assert found["verdict"] == committed.set_index("id")["verdict"][id]


@pytest.mark.heavy
def test_the_verdicts_are_those_committed(tmp_path, committed):
    cache = CallCache(tmp_path / "calls.jsonl", "test")
    list(cache.work(PAPER_STATEMENTS.tasks(), 1))
    table = PAPER_STATEMENTS.tables(cache.results)[""]
    columns = ["id", "verdict", "holds_in", "own_cases", "fails_for", "beyond_paper"]
    assert table[columns].to_dict("records") == committed[columns].to_dict("records")


def test_a_renewed_baseline_ships_the_verdicts(tmp_path, monkeypatch):
    made = tmp_path / "made"
    made.mkdir()
    (tmp_path / SHIPPED_STATEMENTS.parent).mkdir(parents=True)
    for figure in paper_figures():
        (made / f"{figure.stem}.csv").write_text(figure.name)
    monkeypatch.chdir(tmp_path)
    assert SHIPPED_STATEMENTS in renew(made)
    assert SHIPPED_STATEMENTS.read_text() == (PAPER_BASELINE / "paper_statements.csv").read_text() == "statements"
    # Another target is not the baseline: nothing is shipped.
    SHIPPED_STATEMENTS.unlink()
    renew(made, tmp_path / "elsewhere")
    assert not SHIPPED_STATEMENTS.exists()
