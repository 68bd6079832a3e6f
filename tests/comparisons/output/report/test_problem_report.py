"""The page of a sweep over a problem file: values over the varied keys, errors, failures and the file."""

from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.output.report.page import make_page
from comparisons.output.report.stored_run import read_folder
from comparisons.runs.csv_format import read_table

from .browsing import DESKTOP, cells, find, messages, show, unfold

PAD = Path(__file__).parents[4] / "docs" / "examples" / "problems" / "graded_pad.toml"
RADIUS, WORK = "punch.R [m]", "law.work_of_adhesion [J/m^2]"
HOSTILE = "# </script><script>window.hostile = 1</script> <img src=x onerror=\"window.hostile='image'\">\n"
SCALE = {"N": 1.0, "nN": 1e-9, "µN": 1e-6, "nm": 1e-9, "pm": 1e-12}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Closed forms alone, and the atlas; never written to by a test."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "pad.toml").write_text(HOSTILE + PAD.read_text())
    options = ["--model", "bradley", "jkr", "atlas", "--quantity", "pull_off_force", "jump_out_displacement", "--quiet"]
    vary = ["--vary", "punch.R=0.1, 1, 5 um", "--vary", "law.work_of_adhesion=20, 60 mJ/m^2"]
    out = folder / "out"
    assert main(["sweep", "--problem", str(folder / "pad.toml"), *vary, *options, "--out", str(out)]) == 0
    assert main(["report", str(out)]) == 0
    return out


def test_every_choice_of_a_plot_shows_the_stored_numbers(swept):
    page = make_page(read_folder(swept))
    assert page.headline.startswith("bradley differs most from atlas: by 17.36")
    # The errors are drawn over the cases.
    assert set(page.plots["plot-kappa"].points["x"]) == {1, 2, 3, 4, 5, 6}
    stored = read_table(swept / "results.csv").query("status == 'ok'")
    over_radius, over_work = page.plots["plot-1"], page.plots["plot-2"]
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


def test_a_changed_copy_of_the_file_is_wrong_input(swept, capsys):
    file = swept / "inputs" / "pad.toml"
    text = file.read_text()
    file.write_text("# other")
    assert main(["report", str(swept), "--out", str(swept.parent / "other.html")]) == 2
    file.write_text(text)
    assert "pad.toml was changed after it was written" in capsys.readouterr().err
    assert not (swept.parent / "other.html").exists()


def test_the_page_in_a_browser(browser, swept):
    show(browser, swept / "report.html", *DESKTOP)
    assert messages(browser) == []
    assert browser.execute_script("return [window.hostile ?? null, document.images.length]") == [None, 0]
    assert HOSTILE.strip() in find(browser, "pre.file[aria-label='inputs/pad.toml']").text
    # A choice shows its numbers and its unit.
    unfold(browser, "plot-1-numbers")
    stored = read_table(swept / "results.csv").query("quantity == 'pull_off_force' and status == 'ok'")
    of_work = stored[stored[WORK] == 0.02]
    assert [float(text) for text in cells(browser, "plot-1-numbers", "value")] == of_work["value"].tolist()
    label = "return Bokeh.documents.flatMap((one) => one.roots())[0].yaxes[0].axis_label"
    assert browser.execute_script(label) == "pull-off force (nN)"
