"""Citation of fscm-bench and of a run, as text and as BibTeX."""

import json
import re
from importlib.resources import files

import yaml

from comparisons.data.toml_text import shipped
from comparisons.output import citation
from comparisons.output.citation import Work, as_bibtex, methods, works
from comparisons.registry import MODELS
from tests.comparisons.records import record_of_run
from tests.paths import ROOT

RECORD = record_of_run() | {
    "package": {"version": "0.1.0", "commit": "0123456789abcdef", "dirty": False, "code_sha256": "f" * 64},
    "models": {
        "fscm": {"version": "1", "citation": "Zhu, Zheng, Huang & Yu, Eqs. 24-33"},
        "my_model": {"version": "2 (ab)", "citation": "Someone, 50 % wrong"},
    },
    "dependencies": {"numpy": "2.4.6", "scipy": "1.17.1", "scikit-fem": "12.0.2", "pyamg": "5.4.1"},
}


def entries(text):
    """Key -> fields of every entry, read as BibTeX does: by its braces."""
    cited = {}
    for key, body in re.findall(r"^@\w+\{([^,]+),\n(.*?)^\}$", text, re.M | re.S):
        cited[key] = dict(re.findall(r"^  (\w+) = \{(.*)\},$", body, re.M))
        assert all(value.count("{") == value.count("}") for value in cited[key].values())
        assert len(cited[key]) == len(body.splitlines())
    return cited


def test_the_data_are_those_of_the_citation_file():
    """Renew them by: json.dumps(yaml.safe_load(...), indent=2, ensure_ascii=False, default=str)."""
    stored = json.loads(files("comparisons.data").joinpath("citation.json").read_text(encoding="utf-8"))
    cff = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert stored == json.loads(json.dumps(cff, default=str))


def test_without_a_run_it_names_fscm_bench_and_the_paper():
    cited = entries(as_bibtex(works("1.2.3")))
    assert list(cited) == ["fscm-bench", "zhu-adhesion"]
    assert cited["fscm-bench"]["author"] == "{The fscm-bench developers}"
    assert re.fullmatch("20[0-9]{2}", cited["fscm-bench"]["year"])
    assert cited["fscm-bench"]["note"] == "version 1.2.3"
    assert cited["zhu-adhesion"]["author"].startswith("Zhu, Yudong and ")
    work = Work("a", {"author": "A, B. and others", "title": "T", "journal": "J", "year": "2022", "doi": "10.1/x_y"})
    assert work.text() == "A, B. et al. T. J (2022). doi:10.1/x_y."
    assert "doi = {10.1/x_y}" in work.bibtex()


def test_the_doi_and_the_address_of_a_release_are_cited(monkeypatch):
    released = citation._shipped("citation.json") | {"doi": "10.5281/zenodo.1", "repository-code": "https://a/b"}
    monkeypatch.setattr(citation, "_shipped", lambda name: released)
    entry = entries(as_bibtex(works("1.2.3")))["fscm-bench"]
    assert (entry["doi"], entry["url"]) == ("10.5281/zenodo.1", "https://a/b")


def test_a_run_names_its_versions_and_models():
    cited = entries(as_bibtex(works("not this one", RECORD)))
    assert cited["fscm-bench"]["note"] == "version 0.1.0 (commit 0123456789ab)"
    assert cited["model-my-model"]["title"] == r"{Model my\_model, version 2 (ab)}"
    assert cited["model-my-model"]["author"] == r"{{[}author of my\_model, to be filled in]}"
    assert cited["model-my-model"]["note"] == r"Someone, 50 \% wrong"
    assert cited["numpy"]["note"] == "version 2.4.6"
    assert "scikit-fem" not in cited


def test_every_model_of_the_package_is_cited_by_an_article_with_a_doi():
    for name in MODELS:
        cited = works("1", RECORD | {"models": {name: {"version": "1", "citation": "none"}}})
        of_model = [work for work in cited if work.key not in ("fscm-bench", "numpy", "scipy", "scikit-fem", "pyamg")]
        assert any("journal" in work.filled and "doi" in work.filled for work in of_model), name
        assert not [work.key for work in of_model if work.key.startswith("model-")]


def test_a_work_of_two_models_is_named_once_and_every_work_has_a_model():
    models = {name: {"version": "1", "citation": "none"} for name in MODELS}
    text = as_bibtex(works("1", RECORD | {"models": models}))
    cited = entries(text)
    assert text.count("@") == len(cited)
    listed = shipped("model_references.toml")
    assert set(listed["works"]) <= set(cited)
    assert set(listed["models"]) == set(MODELS)
    assert all(re.fullmatch(r"10\.\d{4,5}/\S+", work["doi"]) for work in listed["works"].values() if "doi" in work)
    assert text.count("@book{popov-2019,") == 1
    assert text.isascii()


def test_the_paragraph_states_model_reference_bound_and_versions():
    text = methods(RECORD, {"fscm": 4.2e-10})
    facts = ("my_model (version 2 (ab))", "fscm (version 1)", "at most 4e-10", "2 results", "PASS", "NumPy 2.4.6")
    assert [fact for fact in facts if fact not in text] == []
    assert "PyAMG" not in text
