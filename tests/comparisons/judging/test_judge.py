"""The judge on results made by hand: missing, doubled, lost or uncertain ones."""

import math

import numpy as np
import pandas as pd
import pytest

from comparisons.domain import Domain
from comparisons.judging.decision import roll_up
from comparisons.judging.gates import load_gates
from comparisons.judging.judge import judge
from comparisons.judging.selection import load_user_gates
from comparisons.judging.summary import summarise
from comparisons.runs.cases import load_grids
from tests.comparisons.conftest import GATES, GRID, with_entries

GRIDS = load_grids(
    with_entries(
        GRID,
        tags='["blue"]',
        reference="fscm",
        models='["jkr", "dmt"]',
        quantities='["pull_off_force", "jump_in_displacement", "force_curve"]',
        mu="[0.5, 1]",
    )
)
GATE = with_entries(
    GATES,
    candidate="jkr",
    reference="fscm",
    cases='{ tags = ["blue"] }',
    lower=-0.1,
    upper=0.1,
    max_reference_uncertainty=0.001,
)
RIVAL = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = 0.0") + 'rival = "dmt"\n'
EN = GATE.replace('"rel"', '"en"').replace("lower = -0.1", "lower = -1").replace("upper = 0.1", "upper = 1")
EN += "max_candidate_uncertainty = 0.01\n"
LEAVE_OUT = GATE + 'not_applicable = "leave-out"\n'


def results(u_num=(), status=(), **models):
    """Rows of the four cases; a value is a number or a function of (k, mu), a bound 1e-6 or that of the model."""
    row = {"quantity": "pull_off_force", "n": 2.0, "nu": math.nan, "status": "ok", "reason": ""}
    cases = [(model, value, k, mu) for model, value in models.items() for k in (0.0, 0.4) for mu in (0.5, 1.0)]
    numbers = [
        (value(k, mu) if callable(value) else value, dict(u_num).get(model, 1e-6)) for model, value, k, mu in cases
    ]
    table = pd.DataFrame(
        [
            row | {"model": model, "k": k, "mu": mu, "value": value, "u_num": u}
            for (model, _, k, mu), (value, u) in zip(cases, numbers, strict=True)
        ]
    )
    for model, (word, count) in dict(status).items():
        index = table.index[table["model"] == model][:count]
        table.loc[index, "status"], table.loc[index, "reason"] = word, "why not"
        table.loc[index, ["value", "u_num"]] = math.nan
    return table


RIGHT = results(fscm=2.0, jkr=2.0)


def verdict(rows, gate=GATE, grids=GRIDS, curves=None, models=None):
    table = judge(load_gates(gate), grids, rows, curves, models)
    return roll_up(table["verdict"]), table


def expect(expected, words, *arguments):
    """Every reason of that verdict has the words."""
    outcome, table = verdict(*arguments)
    assert outcome == expected
    assert table.loc[table["verdict"] == expected, "reason"].str.contains(words, regex=False).all()


@pytest.mark.parametrize(
    ("metric", "error"),
    [("rel", [0.1] * 4), ("abs", [0.2, 0.3, 0.2, 0.3]), ("range-relative", [0.2, 0.3, 0.2, 0.3])],
)
def test_metrics(metric, error):
    rows = results(fscm=lambda k, mu: -2.0 * (mu + 0.5), jkr=lambda k, mu: -2.0 * (mu + 0.5) * 0.9)
    _, table = verdict(rows, GATE.replace('"rel"', f'"{metric}"'))
    # Less negative is a positive error, whatever the metric; the range is 1.
    assert table["error"].tolist() == pytest.approx(error)
    # U of a relative error: the denominator moves too.
    share = 1.9 / np.array([2.0, 3.0, 2.0, 3.0]) if metric == "rel" else 2.0
    assert table["uncertainty"].tolist() == pytest.approx((1e-6 * share * np.ones(4)).tolist())


@pytest.mark.parametrize(
    ("apart", "expected"), [(1.9e-6, "PASS"), (-1.9e-6, "PASS"), (2.1e-6, "FAIL"), (-2.1e-6, "FAIL")]
)
def test_en_is_the_error_in_units_of_the_sum_of_both_bounds(apart, expected):
    # Each bound is 1e-6.
    outcome, table = verdict(results(fscm=2.0, jkr=2.0 + apart), EN)
    assert outcome == expected
    assert table["error"].tolist() == pytest.approx([apart / 2e-6] * 4, rel=1e-6)


@pytest.mark.parametrize(
    ("metric", "u"), [("rel", 0.02), ("abs", 0.01), ("range-relative", 0.005), ("en", 0.02), ("reference", 2e-3)]
)
def test_a_limit_of_an_uncertainty_is_in_the_unit_of_the_metric(metric, u):
    gate = GATE.replace('"rel"', f'"{metric}"') + "max_candidate_uncertainty = 0.01\n"
    model = "fscm" if metric == "reference" else "jkr"
    gate = {"en": EN, "reference": GATE}.get(metric, gate)
    for factor, expected in ((0.99, "PASS"), (1.01, "INCONCLUSIVE")):
        both = 2.0 if metric in ("en", "reference") else lambda k, mu: 1.5 + mu
        assert verdict(results({model: factor * u}, fscm=both, jkr=both), gate)[0] == expected


@pytest.mark.parametrize(
    ("rows", "gate", "expected"),
    [
        # A failure stays a failure whatever the uncertainty.
        (results({"jkr": 0.1}, fscm=2.0, jkr=6.0), GATE + "max_candidate_uncertainty = 0.01\n", "FAIL"),
        # E_n has no scale.
        (results(fscm=0.0, jkr=2.0), EN, "ERROR"),
        (results({"jkr": 0.0, "fscm": 0.0}, fscm=2.0, jkr=2.0), EN, "ERROR"),
        # A reference of zero needs another metric.
        (results(fscm=0.0, jkr=0.0), GATE, "ERROR"),
        (results(fscm=0.0, jkr=0.0), GATE.replace('"rel"', '"abs"'), "PASS"),
        (RIGHT, GATE.replace('"rel"', '"range-relative"'), "ERROR"),
        # A number that belongs to a failed row is no result.
        (RIGHT.assign(status=["ok"] * 4 + ["failed"] * 4), GATE, "ERROR"),
        # The other bound is larger than the one below zero.
        *((results({model: -1e-7}, fscm=2.0, jkr=2.0), GATE, "ERROR") for model in ("jkr", "fscm")),
        *(
            (RIGHT.assign(**{column: bad}), GATE, "ERROR")
            for column in ("value", "u_num")
            for bad in (math.nan, math.inf)
        ),
        (results(fscm=0.5, jkr=1.7e308), GATE, "ERROR"),
        # A refusal is an error, also where enough cases are left, unless the gate leaves it out.
        *(
            (
                results({}, {"jkr": ("not-applicable", 1)}, fscm=2.0, jkr=2.0),
                gate.replace("min_cases = 4", "min_cases = 1"),
                outcome,
            )
            for gate, outcome in ((GATE, "ERROR"), (LEAVE_OUT, "PASS"))
        ),
        # Rows that are missing or there twice.
        *((RIGHT.drop(index=index), GATE, "ERROR") for index in (1, 5)),
        (pd.concat([RIGHT, RIGHT.iloc[-1:]]), GATE, "ERROR"),
        (RIGHT[:0], GATE, "ERROR"),
        # Too few cases, or none.
        (RIGHT, GATE.replace("min_cases = 4", "min_cases = 5"), "ERROR"),
        *(
            (RIGHT, GATE.replace('tags = ["blue"]', cases), "ERROR")
            for cases in ('tags = ["red"]', "mu = [3, 4]", "nu = [0, 0.4]", '"solid.kind" = "coating"')
        ),
        # Not applicable is an error unless it is left out, which leaves fewer cases.
        *(
            (results((), {model: ("not-applicable", 1)}, fscm=2.0, jkr=2.0), gate, expected)
            for model in ("jkr", "fscm")
            for gate, expected in ((GATE, "ERROR"), (LEAVE_OUT, "ERROR"), (LEAVE_OUT.replace("= 4", "= 3"), "PASS"))
        ),
        (results((), {"jkr": ("not-applicable", 4)}, fscm=2.0, jkr=2.0), LEAVE_OUT.replace("= 4", "= 1"), "ERROR"),
        (results((), {"jkr": ("failed", 1)}, fscm=2.0, jkr=2.0), LEAVE_OUT.replace("= 4", "= 1"), "ERROR"),
        # A rival is beaten by the size of the error.
        *(
            (results(fscm=2.0, jkr=1.9, dmt=rival), RIVAL, expected)
            for rival, expected in ((2.2, "PASS"), (1.8, "PASS"), (2.1, "INCONCLUSIVE"), (2.05, "FAIL"))
        ),
        # A reference elsewhere.
        (results(fscm=lambda k, mu: 2.0 + k, jkr=2.4), GATE + "reference_at = { k = 0.4 }\n", "PASS"),
    ],
)
def test_verdicts(rows, gate, expected):
    assert verdict(rows, gate)[0] == expected


@pytest.mark.parametrize(("role", "model"), [("candidate", "jkr"), ("reference", "fscm"), ("rival", "dmt")])
def test_an_inconclusive_verdict_says_whose_uncertainty_it_is(role, model):
    rows = results({model: 0.01}, fscm=2.0, jkr=2.1, dmt=2.101)
    expect("INCONCLUSIVE", f"mostly by u of the {role} {model}: 0.0", rows, RIVAL.replace("0.001", "0.1"))


CURVE = GATE.replace("pull_off_force", "force_curve").replace('"rel"', '"curve"').replace("= -0.1", "= -inf")


def curve(u, model="jkr", k=0.0, mu=1.0):
    t = np.linspace(0.0, 1.0, 21)
    case = {"model": model, "quantity": "force_curve", "n": 2.0, "k": k, "mu": mu, "nu": math.nan}
    return pd.DataFrame(case | {"x": t, "y": t, "u_distance": u, "status": "ok", "reason": ""})


def test_an_inconclusive_distance_of_curves_says_whose_uncertainty_it_is():
    cases = [(k, mu) for k in (0.0, 0.4) for mu in (0.5, 1.0)]
    curves = pd.concat([curve(u, model, *case) for model, u in (("jkr", 0.2), ("fscm", 1e-9)) for case in cases])
    expect("INCONCLUSIVE", "mostly by u of the candidate jkr: 0.2", RIGHT[:0], CURVE, GRIDS, curves)
    limited = CURVE.replace("upper = 0.1", "upper = 0.5") + "max_candidate_uncertainty = 0.1\n"
    expect("INCONCLUSIVE", "u of the candidate jkr is 0.2; the gate tolerates 0.1", RIGHT[:0], limited, GRIDS, curves)


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        ((1e-3, 2e-3), 2e-3),
        ((2e-3, 1e-3), 2e-3),
        ((math.nan, 1e-3), None),
        ((1e-3, math.nan), None),
        ((-1.0, -1.0), None),
    ],
)
def test_the_bound_of_a_curve_is_the_largest_of_its_points_and_each_has_one(ends, expected):
    u = np.where(np.arange(21) < 10, *ends)
    _, table = verdict(RIGHT[:0], CURVE, curves=pd.concat([curve(u), curve(1e-9, "fscm")]))
    (case,) = table[(table["k"] == 0.0) & (table["mu"] == 1.0)].to_dict("records")
    if expected is None:
        assert "states the uncertainty" in case["reason"]
    else:
        assert case["u_num"] == expected


def test_the_bound_against_a_rival_has_the_reference_once_for_each_of_the_two():
    rows = results({"fscm": 1e-4, "jkr": 1e-5, "dmt": 1e-6}, fscm=2.0, jkr=1.8, dmt=2.4)
    # Relative to the reference, whose own u counts abs(value / reference) times for each of the two.
    expected = (1e-5 + 1e-6 + (0.9 + 1.2) * 1e-4) / 2.0
    assert verdict(rows, RIVAL)[1]["uncertainty"].tolist() == pytest.approx([expected] * 4)


MEASURED = "worst_measured = 0.25\nmeasured_range = [0.24, 0.26]\n"
KNOWN = GATE + 'expected_failure = "known"\n' + MEASURED
WIDE = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -9\nupper = 9") + MEASURED


@pytest.mark.parametrize(("gate", "measured"), [(KNOWN, "XFAIL"), (WIDE, "PASS")])
def test_an_error_that_was_not_measured_fails_although_it_keeps_the_limits_or_is_declared_to_fail(gate, measured):
    assert verdict(results(fscm=2.0, jkr=2.5), gate)[0] == measured
    for value in (2.47, 2.53, 1.5, 19.0):
        expect("FAIL", "errors measured when the gate was made", results(fscm=2.0, jkr=value), gate)
    # An uncertainty does not hide a change.
    large = {"jkr": 2.0, "fscm": 2.0}
    assert verdict(results(large, fscm=2.0, jkr=2.6), gate.replace("0.001", "3.0"))[0] == "FAIL"
    # An expected failure is strict in every case.
    assert verdict(results(fscm=2.0, jkr=lambda k, mu: 2.0 if k else 2.5), KNOWN)[0] == "XPASS"


def test_gates_for_models_that_are_given(capsys):
    gate = GATE.replace('"jkr"', '"given"')
    rows = results(fscm=2.0, jkr=2.0, dmt=2.5)
    assert judge(load_gates(gate), GRIDS, rows).empty
    for models, messages in ((None, 1), (["jkr"], 0)):
        load_user_gates(gate, "mine.toml", "quick", GRIDS, models)
        assert capsys.readouterr().err.count("1 of 1 gates of mine.toml are left out") == messages
    _, table = verdict(rows, gate, models=["jkr", "dmt"])
    assert summarise(table).set_index("candidate")["verdict"].to_dict() == {"dmt": "FAIL", "jkr": "PASS"}
    # A model is not compared with itself, unless it is elsewhere; a gate of another model does not count.
    _, table = verdict(rows, gate, models=["fscm", "jkr"])
    assert set(table["candidate"]) == {"jkr"}
    _, table = verdict(rows, gate + "reference_at = { k = 0 }\n", models=["fscm", "jkr"])
    assert set(table["candidate"]) == {"fscm", "jkr"}
    assert judge(load_gates(GATE), GRIDS, rows, models=["dmt"]).empty
    assert roll_up(judge([], GRIDS, rows)["verdict"]) == "ERROR"


@pytest.mark.parametrize(("no_event", "refused", "failures"), [(0, 0, 0), (2, 0, 0), (0, 1, 1), (2, 1, 1)])
def test_a_case_without_an_event_is_covered_and_a_refused_one_is_not(no_event, refused, failures):
    """There is no event where the reference has no value either."""
    gate = LEAVE_OUT.replace("min_cases = 4", "min_cases = 1") + "min_coverage = 1\n"
    statuses = {"jkr": ("not-applicable", no_event + refused), "fscm": ("not-applicable", no_event)}
    rows = results((), statuses, jkr=1.0, fscm=1.0)
    table = judge(load_gates(gate), GRIDS, rows, taken={"jkr": Domain.of({"quantities": ["pull_off_force"]})})
    assert (table["status"] == "no-event").sum() == no_event
    # The gate as a whole, for its coverage.
    assert table["n"].isna().sum() == failures
    assert roll_up(table["verdict"]) == ("FAIL" if failures else "PASS")


def test_only_a_refused_case_is_outside_a_list_of_cases():
    rows = results((), {"jkr": ("not-applicable", 1)}, jkr=2.0, fscm=2.0)
    gate = LEAVE_OUT.replace("min_cases = 4", "min_cases = 3") + "min_coverage = 1\n"
    table = judge(load_gates(gate), GRIDS, rows, taken={"jkr": Domain(())})
    assert table["status"].tolist() == ["outside", "ok", "ok", "ok"]
    assert roll_up(table["verdict"]) == "PASS"
