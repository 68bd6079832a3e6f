"""The command cite."""

import pytest

from comparisons import compare
from comparisons.cli.main import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("cite") / "comparison"
    compare(["jkr", "bradley"], n=[2], k=[0.0], mu=[1.0], reference="atlas", folder=path, jobs=1)
    return path


def test_the_text_of_a_comparison(folder, capsys):
    assert main(["cite", str(folder)]) == 0
    paragraph, empty, *references = capsys.readouterr().out.splitlines()
    assert paragraph.startswith("The errors of bradley (version 1) and jkr (version 1) were computed with fscm-bench ")
    assert "The reference is atlas (version " in paragraph
    assert empty == ""
    assert len(references) == 7


def test_bibtex(folder, capsys):
    assert main(["cite", "--format", "bibtex", str(folder)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("@misc{fscm-bench,\n")
    assert out.isascii()
    assert "@misc{model-jkr," in out


def test_without_a_folder(capsys):
    assert main(["cite"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2


@pytest.mark.parametrize("form", ["text", "bibtex"])
def test_without_a_folder_it_has_the_commit_that_the_version_has(form, capsys):
    assert main(["--version"]) == 0
    version = capsys.readouterr().out.strip().removeprefix("fscm-bench ")
    assert main(["cite", "--format", form]) == 0
    assert f"version {version}" in capsys.readouterr().out


def test_a_folder_without_a_run_is_one_sentence(tmp_path, capsys):
    assert main(["cite", str(tmp_path)]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "is not the folder of a finished run" in err


def test_a_changed_folder_is_refused(folder, capsys):
    table = folder / "results.csv"
    text = table.read_text(encoding="utf-8")
    table.write_text(text.replace("1.5", "1.6"), encoding="utf-8")
    assert main(["cite", str(folder)]) == 2
    assert "was changed after it was written" in capsys.readouterr().err
    table.write_text(text, encoding="utf-8")
