"""Pages of a run folder and of a sweep over a problem file: their content in order, escaped texts, refused folders."""

import base64
import gzip
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.output.report.page import make_page
from comparisons.output.report.render import render, write_page
from comparisons.output.report.stored_run import read_folder
from comparisons.output.style import model_styles
from comparisons.registry import MODELS
from comparisons.runs.csv_format import read_table, write_table
from tests.paths import PAD

from .hostile_run import SCRIPT, seal, write_run


@pytest.fixture(scope="module")
def stored(run_folder):
    return read_folder(run_folder)


@pytest.fixture(scope="module")
def laid_out(stored):
    return make_page(stored)


def texts(table, label):
    return table.texts[label].tolist()


def test_the_first_lines_are_the_nearest_model_and_the_verdict_in_words(laid_out, stored):
    largest = stored.kappa["kappa"].abs().groupby(stored.kappa["model"]).max().sort_values()
    summary = laid_out.tables["summary"]
    assert texts(summary, "rank") == ["1", "2", ""]
    assert texts(summary, "model") == [*largest.index, "jkr"]
    assert texts(summary, "coverage") == ["88 of 88", "88 of 88", "0 of 4 (4 failed, 84 outside)"]
    assert texts(summary, "worst κ (%)")[1] == "50.0(4)"
    # A page sorts by the size of an error, whatever its sign.
    (by,) = (column.number for column in summary.columns if column.heading == "worst κ (%)")
    assert summary.stored[by].tolist()[:2] == largest.tolist()
    near = (stored.kappa["kappa"].abs() + stored.kappa["u_kappa"] <= 0.05).groupby(stored.kappa["model"]).sum()
    assert laid_out.headline.startswith(near.idxmax())
    assert f"in {near.max()} of 88 cases of the pull-off force" in laid_out.headline
    assert laid_out.verdict == "ERROR"
    assert laid_out.lines[0].startswith("3 of 3 gates did not come out as expected: ")


def test_a_model_that_verifies_a_reference_is_no_row_of_the_errors(stored):
    verifying = stored.results[stored.results["model"] == "fscm"].assign(model="fem")
    evaluations = replace(stored, results=pd.concat([stored.results, verifying])).evaluations()
    assert set(evaluations["model"]) == {*stored.kappa["model"], "jkr"}


def shown_text(page):
    """What a reader can see: without styles, scripts and the data behind them."""
    html, rows = render(page)
    packed = json.loads(rows.partition(", ")[2].rstrip(");\n"))
    tables = (json.loads(unpacked(packed[name]))["cells"] for name in page.tables)
    text = re.sub("<(style|script).*?</\\1>", "", html, flags=re.DOTALL)
    views = [view for _, view in json.loads(unpacked(re.findall('plain">(.*?)<', html)[0]))]
    return re.sub(
        "<[^>]*>", " ", " ".join([text, *views, *(cell for table in tables for row in table for cell in row)])
    )


def unpacked(text):
    return gzip.decompress(base64.b64decode(text)).decode()


def test_cases_that_no_model_declares_have_a_page_that_says_so(stored):
    of_jkr = stored.results[stored.results["mu"] < 1].replace({"model": {SCRIPT: "jkr"}, "status": {"failed": "ok"}})
    of_jkr = of_jkr[of_jkr["model"].isin(["jkr", "fscm"])].drop_duplicates(["model", "quantity", "n", "k", "mu"])
    kappa = stored.kappa[(stored.kappa["model"] == SCRIPT) & (stored.kappa["mu"] < 1)].assign(model="jkr")
    page = make_page(replace(stored, results=of_jkr, kappa=kappa))
    assert page.headline.startswith("No case is within the range that its model declares")
    (regimes,) = page.maps
    assert {cell.step for regime in regimes.views[regimes.first].regimes for cell in regime.cells} == {None}


def test_no_page_has_the_name_of_a_declared_verdict(stored):
    declared = {"FAIL": "XFAIL", "INCONCLUSIVE": "XPASS"}
    tables = {name: getattr(stored, name) for name in ("verdicts", "summary")}
    tables = {name: table.assign(verdict=table["verdict"].replace(declared)) for name, table in tables.items()}
    shown = shown_text(make_page(replace(stored, **tables)))
    assert "XFAIL" not in shown
    assert "XPASS" not in shown
    assert "UNEXPECTED PASS" in shown


def many_rows(stored, count):
    """The run with so many rows of every table that is long in practice."""
    times = range(count // len(stored.kappa) + 1)
    kappa = pd.concat([stored.kappa.assign(mu=stored.kappa["mu"] * (1 + 0.001 * i)) for i in times])
    return replace(
        stored,
        results=pd.concat([stored.results.assign(mu=stored.results["mu"] * (1 + 0.001 * i)) for i in times]),
        kappa=kappa,
        comparison=kappa.assign(status="ok", reason=""),
        verdicts=pd.concat([stored.verdicts] * (count // len(stored.verdicts))),
    )


def test_a_page_of_many_rows_opens_as_small_as_that_of_few(stored):
    page = make_page(many_rows(stored, 900))
    sizes = {name: len(page.tables[name].stored) for name in ("results", "verdicts", "cases-pull_off_force-fscm")}
    assert min(sizes.values()) > 400
    html, rows = render(page)
    cases = html.partition('id="table-cases-pull_off_force-fscm"')[2].partition("</table>")[0]
    assert cases.count("<tr>") == 1 + 50
    # What is first read, and the elements it makes.
    assert len(html.encode()) < 1_000_000
    assert len(re.findall("<[a-z]", re.sub("<script.*?</script>", "", html, flags=re.DOTALL))) < 10_000
    content = json.loads(unpacked(json.loads(rows.partition(", ")[2].rstrip(");\n"))["results"]))
    assert len(content["cells"]) == sizes["results"]


def test_the_rows_stand_beside_the_page_and_are_its_own(laid_out, tmp_path):
    write_page(laid_out, tmp_path / "mine.html")
    html, rows = ((tmp_path / name).read_text() for name in ("mine.html", "mine-rows.js"))
    digest = re.match('fscmBenchRows\\("([0-9a-f]{64})", ', rows)[1]
    assert f'"digest":"{digest}"' in html
    assert '"file":"mine-rows.js"' in html


def test_the_gates_are_worst_first_with_their_requirements(laid_out):
    table = laid_out.tables["matrix"]
    assert texts(table, "verdict") == ["ERROR", "FAIL", "INCONCLUSIVE"]
    assert texts(table, "cases")[1] == "2 FAIL, 3 PASS"
    # What the gates required is stored beside the verdicts.
    (gate,) = (column for column in table.columns if column.heading == "gate")
    assert gate.small(table.records[1]).startswith("At mu = 5 the pull-off force is that of JKR")


def test_the_worst_cases_come_first_with_commands_that_find_the_model(laid_out):
    table = laid_out.tables["offenders"]
    assert texts(table, "verdict") == ["ERROR", "FAIL", "FAIL", "INCONCLUSIVE", "PASS", "PASS", "PASS"]
    assert table.stored["error"].tolist()[1:3] == [0.2, 0.123456789]
    assert "Cases that pass are here too" in table.note
    commands = texts(table, "computed again by")
    assert commands[1] == "fscm-bench solve --model plain.py:Model --quantity pull_off_force --n 2 --k 0.4 --mu 3"
    assert """--model 'my models/it'"'"'s.py:Model' --quantity""" in commands[3]


def test_plots_have_the_stored_points(laid_out, stored):
    for series in laid_out.plots["plot-kappa"].data()["series"]:
        *_, n, k = series["group"].split("|")
        rows = stored.kappa.query(f"n == {n} and k == {k}").query("model == @series['model']").sort_values("mu")
        assert series["x"] == rows["mu"].tolist()
        assert series["y"] == (100 * rows["kappa"]).tolist()
        assert series["high"] == (100 * rows["kappa"] + 100 * rows["u_kappa"]).tolist()
    force, gap = (laid_out.plots[f"plot-{name}"].data()["series"] for name in ("force-curve", "pull-off-gap"))
    # In the order of the path, which turns back: not sorted.
    assert [len(series["x"]) for series in force] == [41, 41]
    assert force[0]["x"] != sorted(force[0]["x"])
    assert [series["y"] for series in gap] == [[0.2, 1.0, 3.0], [0.2 + 0.01, 1.01, 3.01]]


def test_models_of_ours_and_external_ones_differ_by_colour_and_shape():
    styles = model_styles([*MODELS, *(f"mine-{number}" for number in range(300))]).values()
    for shape in ("marker", "sign", "dashes"):
        assert len({(style.colour, getattr(style, shape)) for style in styles}) == len(styles)
    # Beside whatever models of ours, an external one has a colour.
    for number in range(len(MODELS)):
        assert model_styles([*list(MODELS)[:number], "mine"])["mine"].colour not in ("#666666", "#000000")
    # While a colour is left, it is that of no model of ours.
    beside = model_styles(["jkr", "dmt", "md-improved", "mine"])
    assert len({style.colour for style in beside.values()}) == len(beside)


def test_the_legend_of_a_page_shows_the_dashes_of_a_line():
    styles = model_styles(MODELS).values()
    assert len({style.background for style in styles}) == len({style.dashes for style in styles}) > 4
    for style in styles:
        marks = re.findall(r"currentColor (\d+)px (\d+)px", style.background)
        assert [int(end) - int(start) for start, end in marks] == list(style.dashes[::2])


def test_a_run_without_verdicts_errors_or_curves_has_a_page(run_folder, tmp_path):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    for name in ("verdicts", "summary", "kappa", "largest_kappa", "curves"):
        write_table(read_table(folder / f"{name}.csv").head(0), folder / name)
    seal(folder)
    page = make_page(read_folder(folder))
    assert (page.verdict, page.headline) == ("ERROR", "No gate was evaluated.")
    assert not {"errors", "map", "predicted"} & page.sections.keys()
    assert 'id="errors"' not in render(page).html


@pytest.mark.parametrize("lost", ["run.json", "results.csv", "verdicts.csv"])
def test_a_folder_that_is_no_whole_run_is_wrong_input(run_folder, tmp_path, lost, refused):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    (folder / lost).unlink()
    refused(["report", folder], lost)
    assert not (folder / "report.html").exists()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda table: table.drop(columns="upper"), "has no column upper"),
        (lambda table: table.assign(error="much"), "column error is not numeric"),
        (lambda table: table.assign(verdict="FINE"), "unknown verdict 'FINE'"),
    ],
)
def test_a_table_that_was_tampered_with_is_wrong_input(run_folder, tmp_path, change, message, refused):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    write_table(change(read_table(folder / "verdicts.csv")), folder / "verdicts")
    refused(["report", folder], "verdicts.csv was changed after it was written")
    seal(folder)
    refused(["report", folder], message)


def test_a_number_that_json_does_not_have_is_on_no_page(laid_out):
    plot = laid_out.plots["plot-kappa"]
    page = replace(laid_out, blocks={"errors": [replace(plot, points=plot.points.assign(x=np.nan))]})
    with pytest.raises(ValueError, match="JSON"):
        render(page)


def test_the_same_folder_gives_the_same_bytes(laid_out, tmp_path):
    """In another process, where sets have another order."""
    write_run(tmp_path / "run")
    seed = "1" if os.environ.get("PYTHONHASHSEED") != "1" else "2"
    order = [sys.executable, "-m", "comparisons", "report", str(tmp_path / "run"), "--out", str(tmp_path / "page.html")]
    subprocess.run(order, check=True, env={**os.environ, "PYTHONHASHSEED": seed})
    written = (tmp_path / "page.html", tmp_path / "page-rows.js")
    assert tuple(path.read_text(encoding="utf-8") for path in written) == render(laid_out, "page-rows.js")


RADIUS, WORK = "punch.R [m]", "law.work_of_adhesion [J/m^2]"
HOSTILE = "# </script><script>window.hostile = 1</script> <img src=x onerror=\"window.hostile='image'\">\n"
SCALE = {"N": 1.0, "nN": 1e-9, "µN": 1e-6, "nm": 1e-9, "pm": 1e-12}


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """Closed forms beside the atlas in cases of a problem file; never written to by a test."""
    folder = tmp_path_factory.mktemp("compared")
    (folder / "pad.toml").write_text(HOSTILE + PAD.read_text())
    vary = ["--vary", "punch.R=0.1, 1, 5 um", "--vary", "law.work_of_adhesion=20, 60 mJ/m^2", "--jobs", "1", "--quiet"]
    quantities = ["--quantity", "pull_off_force", "jump_out_displacement", "--reference", "atlas"]
    cases = ["--problem", str(folder / "pad.toml"), *vary, *quantities, "--out", str(folder / "out")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("comparisons.pipeline.compare.save", lambda figure, *paths: None)
        assert main(["compare", "bradley", "jkr", *cases]) == 0
    assert main(["report", str(folder / "out")]) == 0
    return folder / "out"


@pytest.fixture(scope="module")
def page_of_files(compared):
    return make_page(read_folder(compared))


def test_a_comparison_has_a_page_with_its_tables_and_without_verdicts(compared, page_of_files):
    assert (page_of_files.verdict, page_of_files.sections.keys() & {"gates", "worst"}) == ("", set())
    assert page_of_files.lines[0].startswith("Nothing was judged")
    summary, *cases = page_of_files.blocks["compared"]
    assert set(texts(summary, "coverage")) == {"6 of 6", "0 of 6 (6 n/a)"}
    table = pd.read_csv(compared / "comparison.csv").query("quantity == 'pull_off_force'").set_index("model")
    for model in ("jkr", "bradley"):
        # The parser of older versions of pandas is wrong in the last digit.
        stored = table.loc[model, "kappa"].tolist()
        assert cases[0].stored[f"kappa {model}"].tolist() == pytest.approx(stored, rel=1e-14)


def test_every_choice_of_a_plot_shows_the_stored_numbers(compared, page_of_files):
    page = page_of_files
    assert page.headline.startswith("jkr is certainly within 5 % of atlas in 6 of 6 cases")
    assert "<script>window.hostile" not in (compared / "report.html").read_text(encoding="utf-8")
    # The errors are drawn over the key with most values, and the other key is a choice.
    points = page.plots["plot-kappa"].points
    assert set(points["x"]) == {0.1, 1.0, 5.0}
    assert {text for options in points["options"] for text in options[1:]} == {"20 mJ/m^2", "60 mJ/m^2"}
    stored = read_table(compared / "results.csv").query("status == 'ok'")
    over_radius, over_work = page.plots["plot-1"], page.plots["plot-2"]
    assert over_radius.controls[0] == ("quantity", ["pull-off force", "jump-out displacement"])
    assert (over_radius.x_label, over_radius.x_scale) == ("punch.R (µm)", "log")
    assert (over_work.x_label, over_work.x_scale) == ("law.work_of_adhesion (mJ/m^2)", "linear")
    for plot, key, power in ((over_radius, RADIUS, 1e-6), (over_work, WORK, 1e-3)):
        assert plot.points.index.sort_values().tolist() == stored.index.tolist()
        rows = stored.loc[plot.points.index]
        units = [plot.y_labels[group].rpartition("(")[2].removesuffix(")") for group in plot.points["group"]]
        scale = [SCALE[unit] for unit in units]
        assert (plot.points["x"] * power).tolist() == pytest.approx(rows[key].tolist())
        assert (plot.points["y"] * scale).tolist() == pytest.approx(rows["value"].tolist())
        bands = (plot.points["high"] - plot.points["y"]) * scale
        assert bands.tolist() == pytest.approx(rows["u_num"].tolist(), rel=1e-3, abs=1e-21)
    numbers = page.tables["plot-1-numbers"]
    assert set(map(numbers.group, numbers.records)) == set(over_radius.points["group"])
