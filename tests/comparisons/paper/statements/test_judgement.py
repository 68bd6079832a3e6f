"""Verdicts on the statements of the paper: the committed ones, and their tests on made-up results."""

import re
import shlex
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli import main as cli
from comparisons.data.paper_statements import paper_statements, verdicts
from comparisons.paper.baseline import PAPER_BASELINE, SHIPPED_STATEMENTS
from comparisons.paper.cache import CachedCall, CallCache, Results
from comparisons.paper.figures.fig08_jumps import QUANTITIES as JUMPS
from comparisons.paper.paper_figure import calls_of
from comparisons.paper.registry import paper_figures
from comparisons.paper.statements import registry
from comparisons.paper.statements.evidence import FAILS, FALSE, IN_PART, REFERENCES, TRUE, Evidence, Number
from comparisons.paper.statements.judgement import PAPER_STATEMENTS, evidence_for, judged
from comparisons.paper.statements.registry import TESTS, find_test

ROOT = Path(__file__).parents[4]
FOLDER = ROOT / PAPER_BASELINE
STATEMENTS = {statement.id: statement for statement in paper_statements()}
#: Tabor numbers of Fig. 5 between the two of which the paper speaks.
NOT_JUDGED = {("contact-fits", "mu"): {0.3, 0.5}, ("contact-radius", "mu"): {0.3, 0.5}}
by_id = pytest.mark.parametrize("statement", STATEMENTS.values(), ids=STATEMENTS)


@pytest.fixture(scope="module")
def committed():
    return pd.read_csv(FOLDER / "paper_statements.csv", keep_default_na=False)


def stored(row):
    value, limit = Number(row.value, row.u_value, row.what), Number(row.limit, row.u_limit, row.limit_what)
    return Evidence(row.clause, row.model, value, row.relation, limit, row.own_case, row.beyond_paper, row.comparisons)


@pytest.fixture(scope="module")
def evidence():
    table = pd.read_csv(FOLDER / "paper_statements_evidence.csv", keep_default_na=False)
    return {id: [stored(row) for row in part.itertuples()] for id, part in table.groupby("statement")}


def test_every_test_is_used_with_the_same_tasks_every_time_and_an_unknown_one_is_refused():
    assert {statement.test for statement in STATEMENTS.values()} == set(TESTS)
    assert sum(len(group.TESTS) for group in registry._GROUPS) == len(TESTS)
    for statement in STATEMENTS.values():
        assert calls_of(find_test(statement)(statement)) == calls_of(find_test(statement)(statement))
    with pytest.raises(ValueError, match="statement far-apart has no test 'trends'; there are trend, "):
        find_test(replace(STATEMENTS["far-apart"], test="trends"))


@by_id
def test_a_committed_verdict_follows_from_its_evidence(statement, committed, evidence):
    rows = evidence[statement.id]
    assert judged(statement, rows) == committed[committed["id"] == statement.id].iloc[0].to_dict()
    wide = [replace(row, limit=replace(row.limit, u=1e9)) for row in rows]
    assert judged(statement, wide)["verdict"] == "not decided"


@by_id
def test_other_evidence_gives_another_verdict(statement, evidence):
    """The value of every row that decides on the other side of its limit."""

    def mirrored(row):
        if before["verdict"] == FALSE and row.outcome != FAILS:
            return row
        return replace(row, value=replace(row.value, value=2.0 * row.limit.value - row.value.value))

    rows = [row for row in evidence[statement.id] if not row.beyond]
    # What only the finite elements or only fscm computes would be undecided: both references are given the same.
    both = [
        replace(row, model=model) for row in rows for model in (REFERENCES if row.model in REFERENCES else [row.model])
    ]
    before = judged(statement, both)
    after = judged(statement, [mirrored(row) for row in both])
    if before["verdict"] == IN_PART:
        assert after["fails_for"] != before["fails_for"]
    else:
        assert after["verdict"] == {TRUE: FALSE, FALSE: TRUE}[before["verdict"]]


@by_id
def test_the_cases_of_the_paper_are_among_those_judged(statement, evidence):
    """Every combination of the parameters that the paper shows or names, unless a clause is over all of one."""
    if statement.arguments.get("n") or statement.arguments.get("cases"):
        assert statement.own or statement.general
    parameter = re.compile(r"\b(n|k|mu) = ([0-9.]+)")
    own = [dict(parameter.findall(row.clause)) for row in evidence[statement.id] if row.own]
    for name, values in statement.own.items():
        of_clauses = {float(case[name]) for case in own if name in case}
        assert of_clauses <= set(values)
        assert not of_clauses or of_clauses >= set(values) - NOT_JUDGED.get((statement.id, name), set())
    assert bool(own) == bool(statement.own)
    assert not any(row.own and row.beyond for row in evidence[statement.id])


def test_what_fails_by_one_reference_fails_by_the_other(evidence):
    for id, rows in evidence.items():
        failed = {(row.clause, row.model) for row in rows if row.outcome == FAILS and not row.beyond}
        for clause, model in failed:
            if model in REFERENCES:
                assert {(clause, name) for name in REFERENCES} <= failed, (id, clause)


def test_the_number_of_a_statement_is_in_its_text(committed):
    read = committed[committed["number"] != ""]
    assert set(read["id"]) == {id for id, one in STATEMENTS.items() if "within" in one.arguments}
    for row in read.itertuples():
        assert float(row.number) == float(STATEMENTS[row.id].arguments["within"])
        # As a plain number, or in percent.
        texts = re.findall(r"(?<!\.)\b(\d+(?:\.\d+)?(?:e-\d+)?)( %)?(?!\d)", row.test)
        stated = [float(text) * (0.01 if percent else 1.0) for text, percent in texts]
        assert any(value == pytest.approx(float(row.number), rel=1e-12) for value in stated), row.test
        assert row.flips


def test_the_committed_texts_and_the_shipped_verdicts_are_those_of_the_committed_table(committed):
    for suffix, text in PAPER_STATEMENTS.texts({"": committed}).items():
        assert (FOLDER / f"paper_statements{suffix}").read_text(encoding="utf-8") == text
    assert (ROOT / SHIPPED_STATEMENTS).read_bytes() == (FOLDER / "paper_statements.csv").read_bytes()
    assert verdicts() == committed.astype(str).to_dict("records")


def test_the_commands_parse():
    for statement in STATEMENTS.values():
        for command in statement.command.split(" && "):
            program, *arguments = shlex.split(command)
            assert program == "fscm-bench"
            cli._parser(arguments).parse_args(arguments)
        if "paper" in statement.command:
            assert paper_figures(shlex.split(statement.command)[3:])


@pytest.mark.heavy
@by_id
def test_a_command_runs(statement, capsys):
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
        return {"value": value, "u_num": 1e-9, "status": "ok" if value is not None else "not-applicable", "reason": ""}


def made_up(id, formula):
    statement = STATEMENTS[id]
    return judged(statement, evidence_for(statement, MadeUp(formula)))


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
    assert made_up("pull-off-rises-with-mu", formula)["verdict"] == expected


@pytest.mark.parametrize(
    ("id", "error", "expected"),
    [
        ("ends-agree", lambda mu: 0.019, "true"),
        # No finite elements there.
        ("ends-agree", lambda mu: 0.021, "not decided"),
        ("jump-in-asymptote", lambda mu: 0.051, "false"),
        ("errors-vanish", lambda mu: 1.0 / mu, "true"),
        # Small, but not zero.
        ("errors-vanish", lambda mu: 0.003 + 1.0 / mu, "not decided"),
    ],
)
def test_an_error_is_judged(id, error, expected):
    found = made_up(id, lambda model, name, n, k, mu: 1.0 if model in REFERENCES else 1.0 + error(mu))
    assert found["verdict"] == expected


def test_a_case_that_fails_leaves_the_others():
    row = made_up(
        "jump-in-asymptote", lambda model, name, n, k, mu: 1.0 + 0.1 * (model not in REFERENCES and mu == 3.0)
    )
    assert (row["verdict"], row["holds_in"], row["own_cases"]) == (IN_PART, "4 of 5", "4 of 5")
    assert row["fails_for"] == "n = 2, k = 0.4, mu = 3"
    assert (row["number"], row["flips"]) == ("0.05", "true above x 2.01; false below x 4e-08")


def test_gradient_exponents_of_which_some_jump_are_not_alike():
    (id,) = [id for id, one in STATEMENTS.items() if one.test == "hysteresis_alike"]
    assert made_up(id, lambda model, name, n, k, mu: 1.0)["verdict"] == TRUE
    assert made_up(id, lambda model, name, n, k, mu: None)["verdict"] == TRUE
    row = made_up(id, lambda model, name, n, k, mu: None if k else 1.0)
    assert row["verdict"] == FALSE
    assert "no jump at k = " in row["evidence"]
    assert "no jump at k = 0" not in row["evidence"].replace("no jump at k = 0.", "")


@pytest.mark.parametrize("id", ["kernel-continuous", "psi-bounded", "eta", "insensitive-ranges"])
def test_formulas_give_the_committed_verdict(id, committed):
    found = judged(STATEMENTS[id], evidence_for(STATEMENTS[id], Results()))
    assert found["verdict"] == committed.set_index("id")["verdict"][id]


@pytest.mark.heavy
def test_the_verdicts_are_those_committed(tmp_path, committed):
    cache = CallCache(tmp_path / "calls.jsonl", "test")
    list(cache.work(PAPER_STATEMENTS.tasks(), 1))
    table = PAPER_STATEMENTS.tables(cache.results)[""]
    columns = ["id", "verdict", "holds_in", "own_cases", "fails_for", "beyond_paper"]
    assert table[columns].to_dict("records") == committed[columns].to_dict("records")
