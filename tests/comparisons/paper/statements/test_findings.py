"""Document of the findings: its statements and its numbers are those of the committed tables."""

import math
import re
from pathlib import Path

import pandas as pd
import pytest

from comparisons.numerics.number_text import value_text
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.registry import paper_figures

ROOT = Path(__file__).parents[4]
TEXT = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def table():
    return pd.read_csv(ROOT / PAPER_BASELINE / "paper_statements.csv", keep_default_na=False)


@pytest.fixture(scope="module")
def evidence():
    return pd.read_csv(ROOT / PAPER_BASELINE / "paper_statements_evidence.csv", keep_default_na=False)


def test_every_statement_that_does_not_hold_is_a_finding(table):
    listed = [
        id for line in re.findall(r"^Statements: (.*)\.$", TEXT, re.MULTILINE) for id in re.findall("`(.+?)`", line)
    ]
    assert sorted(listed) == sorted(table["id"][table["verdict"] != "true"])
    counts = table["verdict"].value_counts()
    assert f"judges {len(table)} of its\nstatements" in TEXT
    assert (
        f"{counts['true']} statements are true, {counts['true in part']} true in part and {counts['false']} false"
        in TEXT
    )


def test_every_finding_has_a_title_a_figure_and_a_command():
    sections = [part for part in re.split(r"^## ", TEXT, flags=re.MULTILINE)[1:] if "Statements: " in part]
    sections = [part for part in sections if not part.startswith("Where a number decides")]
    assert len(sections) == 8
    for section in sections:
        (stem,) = re.findall(r"baseline/paper/(\w+)\.png", section)
        (name,) = re.findall(r"fscm-bench paper --only (\S+)", section)
        assert [figure.stem for figure in paper_figures([name])] == [stem]


def test_every_number_with_a_bound_is_in_the_evidence(evidence):
    stored = {
        value_text(number, u)
        for value, bound in (("value", "u_value"), ("limit", "u_limit"))
        for number, u in zip(evidence[value], evidence[bound], strict=True)
    }
    # The studies beyond the paper.
    for stem, columns in (("graded_solids", ("fscm", "fem")), ("layered_adhesion", ("found",))):
        rows = pd.read_csv(ROOT / PAPER_BASELINE / f"{stem}.csv")
        for column in columns:
            known = rows.dropna(subset=column)
            stored |= {value_text(*pair) for pair in zip(known[column], known[f"u_{column}"], strict=True)}
    quoted = re.findall(r"\d+\.\d+\(\d+\)", TEXT)
    assert len(quoted) > 25
    assert [text for text in quoted if text not in stored] == []


def test_the_verdicts_that_hang_on_a_number_are_those_of_the_table(table):
    def nearest(flips):
        factors = [float(text) for text in re.findall(r"x ([\d.e-]+)", flips)]
        return min((max(factor, 1.0 / factor) for factor in factors), default=math.inf)

    expected = [
        f"| `{row.id}` | {row.number} | {row.holds_in} | {row.verdict} | {row.flips} |"
        for row in table.astype(str).itertuples()
        if nearest(row.flips) < 2.5
    ]
    assert re.findall(r"^\| `[\w-]+` \|.*\|$", TEXT, re.MULTILINE) == expected


def test_the_turning_points_are_those_of_the_evidence(evidence):
    stored = " ".join(evidence["what"][evidence["statement"] == "one-fold-pair"])
    for rise in re.findall(r"\| (?:4|6) \| (\S+, bound \S+) \|", TEXT):
        assert f"rises again by at least {rise.replace(', bound', ' (bound')})" in stored


def test_the_errors_of_simpler_solids_are_those_of_the_table():
    """Percentages of the section on solids that are no power law: the largest in size, over each kind."""
    rows = pd.read_csv(ROOT / PAPER_BASELINE / "graded_solids.csv")
    names = {
        "modulus of the surface": "surface",
        "solid of great depth": "depth",
        "equivalent power law": "power_law",
    }
    quantities = {
        "pull-off force": "pull_off_force",
        "jump-out displacement": "jump_out_displacement",
        "hysteresis energy": "hysteresis_energy",
    }
    lines = re.findall(r"^\| ([\w -]+): ([\w -]+) \| (.+) % \| (.+) % \| (.+) % \|$", TEXT, re.MULTILINE)
    assert len(lines) == 5
    for quantity, other, *printed in lines:
        for kind, text in zip(("offset power law", "exponential", "coating"), printed, strict=True):
            part = rows[(rows["solid"] == kind) & (rows["quantity"] == quantities[quantity])]
            errors = 100.0 * part[f"{names[other]}_error"]
            worst = errors.loc[errors.abs().idxmax()]
            assert float(f"{worst:.2g}") == float(text)
