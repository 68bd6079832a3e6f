"""Paper about the software: the sections that its journal asks for, its references, and the numbers that it states."""

import re
import tomllib

import pandas as pd
import pytest
import yaml

import fscm
from tests.docs.test_documents import DOCS
from tests.paths import ROOT

FOLDER = ROOT / ".github" / "joss"
_, HEAD, TEXT = (FOLDER / "paper.md").read_text(encoding="utf-8").split("---\n", 2)
#: A line of text may end anywhere.
LINE = " ".join(TEXT.split())
BASELINE = ROOT / "results" / "baseline"

#: Sections that the Journal of Open Source Software requires, in its order (its page "JOSS Paper Format", 2026).
SECTIONS = [
    "Summary",
    "Statement of need",
    "State of the field",
    "Software design",
    "Research impact statement",
    "AI usage disclosure",
    "Acknowledgements",
    "References",
]
#: Fewest and most words that the same page admits.
WORDS = (750, 1750)


def stated(pattern):
    """The numbers of the one place of the text that has a pattern."""
    (match,) = re.finditer(pattern, LINE)
    return match.groups()


def test_it_has_the_sections_and_the_length_that_the_journal_asks_for():
    assert re.findall(r"^# (.*)$", TEXT, flags=re.MULTILINE) == SECTIONS
    assert WORDS[0] <= len(TEXT.split()) <= WORDS[1]


def test_the_citation_file_has_its_title():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["title"] == yaml.safe_load(HEAD)["title"]


def test_its_references_are_those_that_it_cites_and_an_article_has_a_doi():
    entries = re.findall(r"^@(\w+)\{(\w+), (.*)\}$", (FOLDER / "paper.bib").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(key for _, key, _ in entries) == sorted(set(re.findall(r"@(\w+)", TEXT)))
    assert [key for kind, key, facts in entries if kind == "article" and not re.search(r"doi = \{10\.", facts)] == []


def test_its_figures_exist_and_are_referred_to():
    figures = re.findall(r"!\[[^\]]*\\label\{([\w:]+)\}\]\(([^)]+)\)", TEXT)
    assert figures
    assert [file for _, file in figures if not (FOLDER / file).is_file()] == []
    assert sorted(label for label, _ in figures) == sorted(re.findall(r"\\autoref\{([\w:]+)\}", TEXT))


def test_its_forces_are_those_of_the_references_and_of_the_proof():
    homogeneous = fscm.Problem(n=2, k=0, mu=1)
    force = fscm.solve(homogeneous, "pull_off_force")
    for text in (*stated(r"force is ([\d.]+) in units"), *stated(r"`fscm` gives ([\d.]+) ")):
        assert text == f"{force.value:.{len(text) - 2}f}"
    proofs = (DOCS / "certified_value.md").read_text(encoding="utf-8")
    certified = re.search(r"^\| \$\\mu = 1\$ .*? (1\.\d+) ", proofs, re.MULTILINE)
    assert stated(r"Tabor number 1 it is ([\d.]+),") == certified.groups()
    quick = pd.read_csv(BASELINE / "quick.csv").query("quantity == 'pull_off_force' and n == 2 and k == 0 and mu == 1")
    values, bounds = quick.set_index("model")["value"], quick.set_index("model")["u_num"]
    (by_elements,) = stated(r"finite elements give (\d+\.\d+)\.")
    assert abs(float(by_elements) - values["fem"]) <= bounds["fem"]
    percent = stated(
        r"JKR is ([\d.]+) % below this value, DMT ([\d.]+) % above it, and Maugis-Dugdale ([\d.]+) % below"
    )
    for text, sign, model in zip(percent, (-1, 1, -1), ("jkr", "dmt", "md-original"), strict=True):
        assert f"{sign * 100 * (values[model] / force.value - 1):.1f}" == text


def test_its_counts_are_those_of_the_committed_results():
    agreement = pd.read_csv(BASELINE / "references_agreement.csv")
    count, share = stated(r"in (\d+) values of nine quantities. Their largest difference is ([\d.]+) of the sum")
    assert (int(count), float(share)) == (len(agreement), pytest.approx(agreement["en"].abs().max(), abs=5e-3))
    assert agreement["quantity"].nunique() == 9
    verdicts = pd.read_csv(BASELINE / "paper" / "paper_statements.csv")["verdict"].value_counts()
    every, *each = map(
        int, stated(r"The (\d+) statements .*?: (\d+) are true, (\d+) are true in part and (\d+) are false")
    )
    assert (every, each) == (verdicts.sum(), [verdicts["true"], verdicts["true in part"], verdicts["false"]])
    (random,) = stated(r"no bound was exceeded in (\d+) random problems")
    assert int(random) == len(pd.read_csv(BASELINE / "atlas" / "verification.csv"))
    mutants = tomllib.loads((ROOT / "tests" / "mutation" / "mutants.toml").read_text(encoding="utf-8"))
    (errors,) = stated(r"introduces more than (\d+) small errors")
    assert int(errors) < sum(len(file["mutants"]) for file in mutants["file"])
