"""The supplement of a paper: its tables, its data package, its LaTeX, and the folders that it takes."""

from __future__ import annotations

import json
import math
import re
import shutil
import subprocess
from hashlib import sha256

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.output.report.stored_run import read_folder
from comparisons.output.supplement.best_models import best_model_tables
from comparisons.output.supplement.document import document
from comparisons.output.supplement.write import supplement_tables


@pytest.fixture(scope="module")
def supplement(run_folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("paper") / "supplement"
    assert main(["supplement", str(run_folder), "--out", str(out)]) == 0
    return out


def test_it_has_ranking_regimes_regions_methods_and_references(supplement):
    assert {"ranking.tex", "regions.tex", "models.tex"} < {path.name for path in (supplement / "tables").iterdir()}
    text = (supplement / "supplement.tex").read_text(encoding="utf-8")
    inputs = re.findall(r"\\input\{(.*?)\}", text)
    assert inputs
    assert [name for name in inputs if not (supplement / name).is_file()] == []
    figures = re.findall(r"\\includegraphics\[.*?\]\{(.*?)\}", text)
    assert [name for name in figures if not (supplement / name).is_file()] == []
    assert "were computed with fscm-bench" in text
    assert "@article{zhu-adhesion," in (supplement / "used.bib").read_text(encoding="utf-8")


def test_the_ranking_has_a_rank_and_an_error(run_folder):
    ranking = next(table for table in supplement_tables(read_folder(run_folder)) if table.id == "ranking").texts
    assert sorted(set(ranking["rank"]) - {""}) == ["1", "2"]
    errors = [text for text in ranking["worst κ (%)"] if text]
    assert errors
    assert all(re.fullmatch(r"-?[\d.]+(\(\d+\))?", text) for text in errors)


def test_every_file_and_column_of_the_data_is_described(supplement):
    package = json.loads((supplement / "datapackage.json").read_text(encoding="utf-8"))
    paths = [resource["path"] for resource in package["resources"]]
    assert sorted(path.name for path in (supplement / "data").glob("*.csv")) == sorted(p.split("/")[1] for p in paths)
    for resource in package["resources"]:
        content = (supplement / resource["path"]).read_bytes()
        assert (len(content), f"sha256:{sha256(content).hexdigest()}") == (resource["bytes"], resource["hash"])
        fields = resource["schema"]["fields"]
        assert [field["name"] for field in fields] == content.decode().partition("\n")[0].strip().split(",")
        assert [field["name"] for field in fields if not field.get("description")] == []
    (kappa,) = (resource for resource in package["resources"] if resource["name"] == "kappa")
    types = {field["name"]: (field["type"], field.get("unit")) for field in kappa["schema"]["fields"]}
    assert types["mu"] == ("number", "1")
    assert types["model"] == ("string", None)


def evaluation(model, kappa, u=0.0, **changed):
    case = {"quantity": "pull_off_force", "reference": "fscm", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": math.nan}
    return case | {"model": model, "kappa": kappa, "u_kappa": u, "inside": True, "problem": ""} | changed


def test_the_nearest_model_is_that_within_its_range_and_shared_where_bounds_do_not_decide():
    rows = [
        evaluation("a", 0.02),
        evaluation("b", -0.01),
        evaluation("c", 1e-4, inside=False),
        evaluation("a", 0.02, 0.01, k=0.4),
        evaluation("b", -0.03, 0.01, k=0.4),
        evaluation("b", math.nan, k=0.8),
        evaluation("a", 0.5, k=0.8, mu=5.0),
        evaluation("a", 0.1, problem="pad.toml"),
    ]
    (table,) = best_model_tables(pd.DataFrame(rows))
    texts = table.texts
    assert list(texts) == ["μ", "k = 0", "k = 0.4", "k = 0.8"]
    assert texts.iloc[0].tolist() == ["1", "b (−1.00)", "a, b (+2.00)", ""]
    assert texts.iloc[1].tolist() == ["5", "", "", "a (+50.0)"]


@pytest.mark.skipif(shutil.which("pdflatex") is None or shutil.which("bibtex") is None, reason="no LaTeX here")
def test_it_compiles_with_every_citation_whatever_its_texts(supplement, tmp_path):
    folder = tmp_path / "typeset"
    shutil.copytree(supplement, folder)
    latex = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "supplement.tex"]
    for order in (latex, ["bibtex", "supplement"], latex, latex):
        done = subprocess.run(order, cwd=folder, capture_output=True, check=False, stdin=subprocess.DEVNULL)
        assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]
    log = (folder / "supplement.log").read_text(errors="replace")
    assert "undefined" not in log
    assert "Warning" not in (folder / "supplement.blg").read_text(errors="replace")


def test_braces_and_environments_are_closed(supplement):
    """What a machine without LaTeX can tell."""
    for path in [*supplement.glob("*.tex"), *(supplement / "tables").iterdir()]:
        text = path.read_text(encoding="utf-8")
        assert text.isascii()
        bare = re.sub(r"\\.", "", re.sub(r"(?<!\\)%.*", "", text))
        assert bare.count("{") == bare.count("}")
        assert sorted(re.findall(r"\\begin\{(\w+)\}", text)) == sorted(re.findall(r"\\end\{(\w+)\}", text))


def test_a_folder_with_files_is_left_alone(run_folder, tmp_path, refused):
    (tmp_path / "mine.tex").write_text("mine")
    refused(["supplement", run_folder, "--out", tmp_path], "not empty")
    assert [path.name for path in tmp_path.iterdir()] == ["mine.tex"]


def test_a_paragraph_keeps_its_signs_in_latex():
    assert r"50 \% of \$x\_1\$" in document("50 % of $x_1$", [], [])
