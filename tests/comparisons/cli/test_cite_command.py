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
    text = capsys.readouterr().out
    for name in ("bradley (version 1)", "jkr (version 1)", "atlas (version "):
        assert name in text.splitlines()[0]
    assert main(["cite", "--format", "bibtex", str(folder)]) == 0
    entries = capsys.readouterr().out
    assert entries.isascii()
    assert "@misc{fscm-bench," in entries
    assert "@misc{model-jkr," in entries


@pytest.mark.parametrize("form", ["text", "bibtex"])
def test_without_a_folder_it_has_the_commit_that_the_version_has(form, capsys):
    assert main(["--version"]) == 0
    version = capsys.readouterr().out.strip().removeprefix("fscm-bench ")
    assert main(["cite", "--format", form]) == 0
    assert f"version {version}" in capsys.readouterr().out


def test_a_folder_without_a_run_or_with_a_changed_table_is_refused(folder, tmp_path, capsys):
    assert main(["cite", str(tmp_path)]) == 2
    table = folder / "results.csv"
    text = table.read_text(encoding="utf-8")
    table.write_text(text.replace("1.5", "1.6"), encoding="utf-8")
    assert main(["cite", str(folder)]) == 2
    table.write_text(text, encoding="utf-8")
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 2)
    assert str(tmp_path) in err
    assert "results.csv" in err
