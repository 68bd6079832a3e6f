"""Content of a page: the stored results in the right order, and the refusal of a broken folder."""

import shutil

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.output.latex import latex
from comparisons.output.report.page import make_page
from comparisons.output.report.stored_run import read_folder
from comparisons.output.style import model_styles
from comparisons.registry import MODELS


@pytest.fixture(scope="module")
def stored(run_folder):
    return read_folder(run_folder)


@pytest.fixture(scope="module")
def page(stored):
    return make_page(stored)


def texts(table, label):
    return table.texts[label].tolist()


def test_the_first_lines_are_the_errors_of_the_models(page, stored):
    largest = stored.kappa["kappa"].abs().groupby(stored.kappa["model"]).max().sort_values(ascending=False)
    assert [model for model, _ in page.facts] == largest.index.tolist()
    for (_, text), kappa in zip(page.facts, largest, strict=True):
        assert abs(float(text.partition("(")[0])) == pytest.approx(100 * kappa, rel=1e-2)
    assert page.headline.endswith(f"{page.facts[0][1]}.")


def test_the_sentence_on_the_gates_is_the_roll_up_of_the_stored_verdicts(page):
    assert page.lines[0] == "0 of 3 gates pass, 0 fail as declared, 3 unexpected: 1 ERROR, 1 FAIL, 1 INCONCLUSIVE."
    assert page.verdict == "ERROR"
    assert page.counts == [("ERROR", 1), ("FAIL", 2), ("INCONCLUSIVE", 1), ("PASS", 3), ("NOT-APPLICABLE", 1)]
    assert "3 gates were judged in 8 cases" in page.lines[-1]


def test_the_matrix_is_worst_first_with_requirements(page):
    table = page.tables["matrix"]
    assert texts(table, "verdict") == ["ERROR", "FAIL", "INCONCLUSIVE"]
    assert texts(table, "cases")[1] == "2 FAIL, 3 PASS"
    assert texts(table, "limits") == ["-0.1 to inf", "-0.1 to 0.1", "-0.1 to 0.1"]
    # What the gates required is stored beside the verdicts.
    (gate,) = (column for column in table.columns if column.heading == "gate")
    assert gate.small(table.records[1]).startswith("At mu = 5 the pull-off force is that of JKR")


def test_the_worst_cases_come_first_with_commands_that_find_the_model(page, hostile):
    table = page.tables["offenders"]
    assert texts(table, "verdict") == ["ERROR", "FAIL", "FAIL", "INCONCLUSIVE", "PASS", "PASS", "PASS"]
    assert table.stored["error"].tolist()[1:3] == [0.2, 0.123456789]
    commands = texts(table, "computed again by")
    assert commands[1] == "fscm-bench solve --model plain.py:Model --quantity pull_off_force --n 2 --k 0.4 --mu 3"
    assert """--model 'my models/it'"'"'s.py:Model' --quantity""" in commands[3]
    assert not any(hostile.image in command or hostile.script in command for command in commands)


def series(plot):
    return plot.data()["series"]


def test_plots_have_the_stored_points(page, stored):
    for one in series(page.plots["plot-kappa"]):
        quantity, reference, n, k = one["group"].split("|")
        rows = stored.kappa[
            (stored.kappa["model"] == one["model"]) & (stored.kappa["n"] == float(n)) & (stored.kappa["k"] == float(k))
        ].sort_values("mu")
        assert (quantity, reference) == ("pull_off_force", "fscm")
        assert one["x"] == rows["mu"].tolist()
        assert one["y"] == (100 * rows["kappa"]).tolist()
        assert one["high"] == (100 * rows["kappa"] + 100 * rows["u_kappa"]).tolist()
    force, gap = series(page.plots["plot-force-curve"]), series(page.plots["plot-pull-off-gap"])
    assert [len(one["x"]) for one in force] == [41, 41]
    # In the order of the path, which turns back: not sorted.
    assert force[0]["x"] != sorted(force[0]["x"])
    assert [one["y"] for one in gap] == [[0.2, 1.0, 3.0], [0.25, 1.05, 3.05]]


def test_every_table_compiles_as_latex_whatever_the_texts(page, run_folder, typeset):
    texts = [latex(table.on_paper.head(30), table.caption, table.id) for table in page.tables.values()]
    # A command has no room on paper.
    assert not any("solve -{}-model" in text for text in texts)
    assert all(text.isascii() for text in texts)
    typeset(*texts, (run_folder / "verdicts.tex").read_text(encoding="utf-8"), fits=False)


def test_all_models_and_external_ones_differ_by_colour_and_marker_and_as_lines_by_colour_and_dashes():
    styles = model_styles([*MODELS, *(f"mine-{number}" for number in range(12))])
    assert len({(style.colour, style.marker) for style in styles.values()}) == len(styles)
    assert len({(style.colour, style.sign) for style in styles.values()}) == len(styles)
    assert len({(style.colour, style.dash) for style in styles.values()}) == len(styles)


def test_a_run_without_verdicts_errors_or_curves_has_a_page(run_folder, tmp_path, hostile):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    for name in ("verdicts", "summary", "kappa", "largest_kappa", "curves"):
        pd.read_parquet(folder / f"{name}.parquet").head(0).to_parquet(folder / f"{name}.parquet")
    hostile.seal(folder)
    page = make_page(read_folder(folder))
    assert page.verdict == "ERROR"
    assert page.headline == "No gate was evaluated."
    assert main(["report", str(folder)]) == 0


def test_a_sweep_has_a_page_without_verdicts(run_folder, tmp_path, hostile):
    folder = shutil.copytree(run_folder, tmp_path / "sweep")
    for name in ("verdicts", "summary", "gates"):
        for suffix in ("csv", "parquet"):
            (folder / f"{name}.{suffix}").unlink()
    hostile.seal(folder)
    page = make_page(read_folder(folder))
    assert (page.verdict, page.counts) == ("", [])
    assert page.lines[0].startswith("Nothing was judged")
    assert not {"matrix", "offenders", "verdicts"} & set(page.tables)
    assert not {"verdicts.csv", "summary.csv"} & set(page.files)
    assert texts(page.tables["kappa"], "value") == texts(make_page(read_folder(run_folder)).tables["kappa"], "value")
    assert main(["report", str(folder)]) == 0
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert page.headline.startswith("Of 2 models ")
    assert " differs most from fscm: by " in page.headline
    assert 'id="gates"' not in text


def test_a_comparison_has_a_page_with_its_tables(tmp_path, capsys):
    cases = ["--n", "2", "--k", "0", "0.4", "--mu", "0.5", "1", "--reference", "atlas", "--jobs", "1"]
    assert main(["compare", "jkr", "bradley", *cases, "--out", str(tmp_path / "run"), "--quiet"]) == 0
    assert main(["report", str(tmp_path / "run")]) == 0
    page = make_page(read_folder(tmp_path / "run"))
    assert page.headline.startswith("Of 2 models bradley differs most from atlas: by ")
    summary, cases = page.blocks["compared"]
    assert texts(summary, "model") == ["jkr", "bradley"]
    assert texts(summary, "a value in") == ["4 of 4"] * 2
    table = pd.read_csv(tmp_path / "run" / "comparison.csv")
    # The parser of older versions of pandas is wrong in the last digit.
    stored = table.loc[table["model"] == "jkr", "kappa"].tolist()
    assert cases.stored["kappa jkr"].tolist() == pytest.approx(stored, rel=1e-14)
    # A row of cases is made of a stored row of each model.
    assert {tuple(table["model"].iloc[places]) for places in cases.stored["lines"]} == {("jkr", "bradley")}
    assert page.files[cases.source] == (tmp_path / "run" / "comparison.csv").read_text()
    text = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    assert text.index('id="compared"') < text.index('id="errors"')


def test_the_command_writes_the_page_where_it_is_asked_to(run_folder, tmp_path, capsys):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    assert main(["report", str(folder)]) == 0
    assert main(["report", str(folder), "--out", str(tmp_path / "other.html")]) == 0
    assert (folder / "report.html").read_bytes() == (tmp_path / "other.html").read_bytes()
    assert "report.html" in capsys.readouterr().err
    assert main(["report", str(folder), "--out", str(tmp_path / "none" / "x.html")]) == 2
    assert "cannot be written" in capsys.readouterr().err


@pytest.mark.parametrize(
    "lost",
    ["run.json", *(f"{n}.parquet" for n in ("results", "curves", "verdicts", "summary", "kappa", "largest_kappa"))],
)
@pytest.mark.parametrize("how", ["missing", "broken"])
def test_a_folder_that_is_no_whole_run_is_wrong_input(run_folder, tmp_path, capsys, lost, how):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    (folder / lost).unlink()
    if how == "broken":
        (folder / lost).write_text("nonsense")
    assert main(["report", str(folder)]) == 2
    message = capsys.readouterr().err
    assert lost in message
    assert len(message.splitlines()) == 1
    assert not (folder / "report.html").exists()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda table: table.drop(columns="upper"), "has no column upper"),
        (lambda table: table.assign(error="much"), "column error is not numeric"),
        (lambda table: table.assign(verdict="FINE"), "unknown verdict 'FINE'"),
    ],
)
def test_a_table_that_was_tampered_with_is_wrong_input(run_folder, tmp_path, capsys, hostile, change, message):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    change(pd.read_parquet(folder / "verdicts.parquet")).to_parquet(folder / "verdicts.parquet")
    assert main(["report", str(folder)]) == 2
    assert "verdicts.parquet was changed after it was written" in capsys.readouterr().err
    hostile.seal(folder)
    assert main(["report", str(folder)]) == 2
    assert message in capsys.readouterr().err


def test_a_folder_that_is_not_there(tmp_path, capsys):
    assert main(["report", str(tmp_path / "none")]) == 2
    assert "not the folder of a finished run" in capsys.readouterr().err
