"""Verdicts on the statements of the paper: the committed ones, their tests on made-up results, and the findings."""

import re
import shlex

import numpy as np
import pandas as pd
import pytest

import fscm
from comparisons.cli import main as cli
from comparisons.data.paper_statements import paper_statements
from comparisons.numerics.number_text import value_text
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.cache import Outcome
from comparisons.paper.paper_figure import FIGURES
from comparisons.paper.statements.judgement import FALSE, IN_PART, REFERENCES, decisive, judged
from comparisons.paper.statements.kinds import FAILS, Evidence, comparisons_of
from comparisons.paper.tasks import JUMPS
from tests.paths import ROOT

FOLDER = ROOT / PAPER_BASELINE
STATEMENTS = {statement.id: statement for statement in paper_statements()}
FINDINGS = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def table(committed):
    return committed("paper_statements", keep_default_na=False)


def test_a_committed_verdict_follows_from_its_evidence_and_not_from_other_evidence(table, committed):
    of_statements = committed("paper_statements_evidence", keep_default_na=False).groupby("statement")
    evidence = {id: [Evidence(*row[1:-1]) for row in rows.itertuples(index=False)] for id, rows in of_statements}
    for expected in table.to_dict("records"):
        statement, rows = STATEMENTS[expected["id"]], evidence[expected["id"]]
        assert judged(statement, rows) == expected
        wide = [row._replace(u_limit=1e9) for row in rows]
        assert judged(statement, wide)["verdict"] == "not decided"
        # The value of every row that decides on the other side of its limit, by all references.
        other = [
            row._replace(value=2.0 * row.limit - row.value, model="formula")
            for row in rows
            if expected["verdict"] != FALSE or row.outcome == FAILS
        ]
        assert judged(statement, other)["verdict"] != expected["verdict"] or expected["verdict"] == IN_PART
    for suffix, text in FIGURES["statements"].texts({"": table}).items():
        assert (FOLDER / f"paper_statements{suffix}").read_text(encoding="utf-8") == text


def test_the_commands_parse():
    for statement in STATEMENTS.values():
        for command in statement.command.split(" && "):
            _, *arguments = shlex.split(command)
            cli._parser(arguments).parse_args(arguments)


def outcome(call, formula):
    """A quantity by a formula, and the jumps by that of `fscm`."""
    if call.name == "jumps":
        values = {name: formula("fscm", name, *call.arguments) for name in JUMPS}
        return Outcome(call, values | {f"u_{name}": 1e-9 for name in JUMPS})
    value = formula(*call.arguments)
    status = "not-applicable" if value is None else "ok"
    return Outcome(call, {"value": value, "u_num": 1e-9, "status": status, "reason": ""})


def made_up(id, formula=None):
    statement = STATEMENTS[id]
    outcomes = {call: outcome(call, formula) for call in comparisons_of(statement).needed}
    return judged(statement, decisive(statement, comparisons_of(statement).given(outcomes)))


RISES = "pull-off-rises-with-mu"


def against(error):
    """The references give 1, every other model has an error."""
    return lambda model, name, n, k, mu: 1.0 if model in REFERENCES else 1.0 + error(mu)


@pytest.mark.parametrize(
    ("id", "formula", "expected"),
    [
        (RISES, lambda model, name, n, k, mu: 2.0 + mu, "true"),
        (RISES, lambda model, name, n, k, mu: 2.0 - mu / 100.0, "false"),
        (RISES, lambda model, name, n, k, mu: 2.0 + mu * (1.0 if n == 1.0 else -0.1), "true in part"),
        # A rise within the sum of the bounds decides nothing.
        (RISES, lambda model, name, n, k, mu: 2.0 + 1e-12 * mu, "not decided"),
        # A fall that the finite elements do not confirm decides nothing.
        (RISES, lambda model, name, n, k, mu: 2.0 + mu * (-0.1 if model == "fscm" else 1.0), "not decided"),
        ("ends-agree", against(lambda mu: 0.019), "true"),
        # No finite elements there.
        ("ends-agree", against(lambda mu: 0.021), "not decided"),
        ("jump-in-asymptote", against(lambda mu: 0.051), "false"),
        ("errors-vanish", against(lambda mu: 1.0 / mu), "true"),
        # Small, but not zero.
        ("errors-vanish", against(lambda mu: 0.003 + 1.0 / mu), "not decided"),
        # H_0 + delta is zero.
        ("jump-in-deformation", lambda model, name, *_: 1.0 if name.endswith("gap") else -1.0, "true"),
        ("mu-decides-hysteresis", lambda *_: 1.0, "true"),
        ("mu-decides-hysteresis", lambda *_: None, "true"),
    ],
)
def test_a_statement_is_judged_on_made_up_results(id, formula, expected):
    assert made_up(id, formula)["verdict"] == expected


def test_a_case_that_fails_leaves_the_others():
    row = made_up("jump-in-asymptote", lambda model, name, n, k, mu: 1.1 if model == "semi-rigid" and mu == 3 else 1.0)
    assert (row["verdict"], row["holds_in"], row["own_cases"]) == (IN_PART, "4 of 5", "4 of 5")
    assert row["fails_for"] == "n = 2, k = 0.4, mu = 3"
    assert (row["number"], row["flips"]) == ("0.05", "true above x 2.01; false below x 4e-08")


def test_gradient_exponents_of_which_some_jump_are_not_alike():
    row = made_up("mu-decides-hysteresis", lambda model, name, n, k, mu: None if k else 1.0)
    assert row["verdict"] == FALSE
    assert "no jump at k = 0." in row["evidence"]


@pytest.mark.parametrize("id", ["kernel-continuous", "psi-bounded", "eta", "insensitive-ranges"])
def test_formulas_give_the_committed_verdict(id, table):
    assert made_up(id)["verdict"] == table.set_index("id")["verdict"][id]


@pytest.mark.heavy
def test_the_verdicts_are_those_committed(made_of, table):
    columns = ["id", "verdict", "holds_in", "own_cases", "fails_for", "beyond_paper"]
    computed = made_of(FIGURES["statements"].plan)[""]
    assert computed[columns].to_dict("records") == table[columns].to_dict("records")


#: Tables of the numbers that the findings quote: of the statements, and of finite strain in percent and in 1e-5.
_EVIDENCE = ("paper_statements_evidence", "finite_strain", "finite_strain_cancel", "what_jkr_neglects")


def test_every_statement_that_does_not_hold_is_a_finding_and_every_number_with_a_bound_is_in_the_evidence(
    table, committed
):
    lines = re.findall(r"^Statements: (.*)\.$", FINDINGS, re.MULTILINE)
    listed = [id for line in lines for id in re.findall("`(.+?)`", line)]
    assert sorted(listed) == sorted(table["id"][table["verdict"] != "true"])
    evidence, strain, zero, neglected = (committed(name) for name in _EVIDENCE)
    pairs = [evidence[[name, f"u_{name}"]] for name in ("value", "limit")]
    pairs += [100.0 * strain[["kappa", "u_kappa"]].abs(), 100.0 * neglected[["total", "u_total"]].abs()]
    ends = zero[["lowest", "highest"]] * 1e5
    pairs += [pd.concat([ends.mean(axis=1), (ends["highest"] - ends["lowest"]) / 2.0], axis=1)]
    texts = {value_text(*row) for pair in pairs for row in pair.dropna().to_numpy()}
    quoted = re.findall(r"\d+\.\d+\(\d+\)", FINDINGS)
    assert len(quoted) > 25
    assert [text for text in quoted if text not in texts] == []


def test_each_finding_has_the_answer_of_the_authors():
    """One before each list of statements, and so in each section that has one."""
    sections = [text for text in re.split("^## ", FINDINGS, flags=re.MULTILINE) if "\nStatements: " in text]
    assert len(sections) > 5
    assert [
        len(re.findall(r"^The authors could answer: .+?\n\nStatements: ", text, re.M | re.S)) for text in sections
    ] == [1] * len(sections)


def test_the_surfaces_inside_the_contact_hang_on_the_central_gap():
    """The difference of the two mean distances is a third of a thousandth of z0 in the gap of the pull-off state."""
    path = fscm.trace(fscm.Problem(2, 0.4, 1.0)).to_frame()
    slope = np.gradient(path["displacement"], path["central_gap"])[path["load"].argmin()]
    (text,) = re.findall(r"smaller for the original model, by (\d\.\d+) z0", FINDINGS)
    apart = table_of_distances()
    assert abs(apart - float(text)) < 5e-5
    assert 2e-4 < apart / abs(slope) < 3.5e-4


def table_of_distances():
    """By how much the mean distance of the improved model exceeds that of the original one, by the FSCM."""
    evidence = pd.read_csv(ROOT / "results" / "baseline" / "paper" / "paper_statements_evidence.csv")
    inside = evidence[(evidence["statement"] == "surface-nearer") & evidence["clause"].str.startswith("inside")]
    (row,) = inside[inside["model"] == "fscm"].to_dict("records")
    return row["value"] - row["limit"]
