"""The standing of the models of a run: which cases count, and the worst verdict."""

import math
from dataclasses import replace

import pandas as pd
import pytest

from comparisons.output.report.board_page import Entry, standing
from comparisons.output.report.stored_run import Stored


def entry(kappa, results, planned):
    columns = ["quantity", "model", "n", "k", "mu", "nu", "reference", "kappa", "u_kappa"]
    empty = pd.DataFrame(
        columns=["gate", "candidate", "quantity", "n", "k", "mu", "nu", "verdict", "value", "reference_value"]
    )
    return Entry(Stored({}, results, empty, pd.DataFrame(kappa, columns=columns), *[empty] * 5), planned)


CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "nu": math.nan, "status": "ok", "model_version": "1"}


def test_cases_of_the_verification_and_fresh_ones_do_not_count():
    results = pd.DataFrame([CASE | {"model": model, "mu": mu} for model in ("a", "exact") for mu in (0.1, 0.2, 7.0)])
    kappa = [
        ("pull_off_force", "a", 2.0, 0.0, mu, math.nan, "exact", x, u)
        for mu, x, u in ((0.1, -0.3, 1e-9), (0.2, 0.4, 0.0))
    ]
    planned = {(("a", "pull_off_force", 2.0, 0.0, mu, None, ""), "exact") for mu in (0.1, 0.2)}
    (row,) = standing(entry(kappa, results, planned)).to_dict("records")
    assert (row["asked"], row["answered"], row["cases"], row["mu"], row["largest"]) == (2, 2, 2, 0.2, 0.4)
    assert (row["rms"], row["u"]) == (pytest.approx(math.sqrt(0.125)), 1e-9)


def test_a_verdict_on_the_whole_model_counts_for_every_quantity():
    results = pd.DataFrame([CASE | {"model": model, "mu": 1.0} for model in ("a", "exact")])
    kappa = [("pull_off_force", "a", 2.0, 0.0, 1.0, math.nan, "exact", 0.0, 0.0)]
    run_entry = entry(kappa, results, {(("a", "pull_off_force", 2.0, 0.0, 1.0, None, ""), "exact")})
    rows = [("A", "a", "jump_in_gap", "ERROR"), ("A", "b", "pull_off_force", "FAIL")]
    passed = ("A", "a", "pull_off_force", "PASS")
    changing = {"repeated": {"cause": "a clock", "cases": [{"first": 1.0, "again": 2.0, "allowed": 0.0}]}}
    columns = ["gate", "candidate", "quantity", "verdict"]
    for more, cards, expected in (
        ([passed], {}, "PASS"),
        ([passed], {"a": changing}, "FAIL"),
        ([], {"a": changing}, ""),
    ):
        case = {name: CASE[name] for name in ("n", "k", "nu")}
        verdicts = pd.DataFrame([*rows, *more], columns=columns).assign(
            **case, mu=1.0, value=None, reference_value=None
        )
        stored = replace(run_entry.stored, verdicts=verdicts, record={"cards": cards})
        (row,) = standing(replace(run_entry, stored=stored)).to_dict("records")
        assert row["verdict"] == expected


def jkr_beside(*cases):
    """The run of JKR in cases of mu, its error and a verdict."""
    results = pd.DataFrame([CASE | {"model": name, "mu": mu} for name in ("jkr", "exact") for mu, *_ in cases])
    kappa = [("pull_off_force", "jkr", 2.0, 0.0, mu, math.nan, "exact", error, 0.0) for mu, error, _ in cases]
    planned = {(("jkr", "pull_off_force", 2.0, 0.0, mu, None, ""), "exact") for mu, *_ in cases}
    of_run = entry(kappa, results, planned)
    rows = [
        {"gate": "A", "candidate": "jkr", "quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": mu, "nu": math.nan}
        | {"verdict": verdict, "value": None, "reference_value": None}
        for mu, _, verdict in cases
    ]
    return replace(of_run, stored=replace(of_run.stored, verdicts=pd.DataFrame(rows)))


def test_a_model_is_judged_within_the_range_that_it_declares():
    """JKR is not meant for mu = 0.01."""
    (row,) = standing(jkr_beside((0.01, 11.3, "FAIL"), (5.0, -0.02, "PASS"))).to_dict("records")
    assert (row["largest"], row["mean"], row["verdict"], row["range"]) == (-0.02, -0.02, "PASS", "μ ≥ 5")
    assert (row["asked"], row["answered"], row["outside"]) == (1, 1, 1)
    (row,) = standing(jkr_beside((0.01, 11.3, "PASS"), (5.0, -0.02, "FAIL"))).to_dict("records")
    assert row["verdict"] == "FAIL"
