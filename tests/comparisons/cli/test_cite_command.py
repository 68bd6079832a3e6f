"""The command cite."""

import pytest

from comparisons import compare
from comparisons.cli.main import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("cite") / "comparison"
    compare(["jkr", "bradley"], n=[2], k=[0.0], mu=[1.0], reference="atlas", folder=path, jobs=1)
    return path


def test_a_comparison_is_cited_with_its_models_and_its_reference(folder, capsys):
    assert main(["cite", str(folder)]) == 0
    paragraph = capsys.readouterr().out.splitlines()[0]
    assert all(name in paragraph for name in ("bradley (version 1)", "jkr (version 1)", "atlas (version "))
    assert main(["cite", "--format", "bibtex", str(folder)]) == 0
    assert "@misc{model-jkr," in capsys.readouterr().out


@pytest.mark.parametrize("form", ["text", "bibtex"])
def test_without_a_folder_it_has_the_commit_that_the_version_has(form, capsys):
    assert main(["--version"]) == 0
    version = capsys.readouterr().out.strip().removeprefix("fscm-bench ")
    assert main(["cite", "--format", form]) == 0
    assert f"version {version}" in capsys.readouterr().out


def test_a_changed_table_is_refused(folder, refused):
    (folder / "results.csv").write_text("model\n")
    refused(["cite", folder], "results.csv")
