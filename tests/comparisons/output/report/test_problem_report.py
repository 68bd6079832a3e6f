"""The page of a sweep over a problem file: values over the varied keys, errors, failures and the file."""

import math
import re
import shutil
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.output.report.page import make_page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import read_folder
from comparisons.runs.frames import read_table

from .browsing import (
    DESKTOP,
    PHONE,
    cells,
    find,
    messages,
    requests,
    show,
    unfold,
    width,
)

PAD = Path(__file__).parents[4] / "docs" / "examples" / "problems" / "graded_pad.toml"
RADII, WORKS = [1e-7, 1e-6, 5e-6], [0.02, 0.06]
HOSTILE = "# </script><script>window.hostile = 1</script> <img src=x onerror=\"window.hostile='image'\">\n"


def report(folder):
    return render(make_page(read_folder(folder)))


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Closed forms alone, and the atlas; never written to by a test."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "pad.toml").write_text(HOSTILE + PAD.read_text())
    options = ["--model", "bradley", "jkr", "atlas", "--quantity", "pull_off_force", "jump_out_displacement", "--quiet"]
    vary = ["--vary", "punch.R=0.1, 1, 5 um", "--vary", "law.work_of_adhesion=20, 60 mJ/m^2"]
    out = folder / "out"
    assert main(["sweep", "--problem", str(folder / "pad.toml"), *vary, *options, "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def laid_out(swept):
    return make_page(read_folder(swept))


@pytest.fixture(scope="module")
def page_of_sweep(swept):
    path = swept.parent / "report.html"
    assert main(["report", str(swept), "--out", str(path)]) == 0
    return path


def test_the_headline_is_the_largest_error_or_the_range_of_the_values(laid_out, tmp_path):
    assert laid_out.headline.startswith("Of 2 models bradley differs most from atlas: by 17.36")
    options = ["--vary", "punch.R=1, 2 um", "--model", "bradley", "--quiet", "--out", str(tmp_path)]
    assert main(["sweep", "--problem", str(PAD), *options]) == 0
    headline = make_page(read_folder(tmp_path)).headline
    form = r"The pull-off force of bradley is between (\S+) nN \(.*=1 um\) and (\S+) nN \(.*=2 um\)\."
    found = re.fullmatch(form, headline)
    assert [float(text.partition("(")[0]) for text in found.groups()] == pytest.approx([100 * math.pi, 200 * math.pi])


def test_every_choice_of_a_plot_shows_the_stored_numbers(laid_out, swept):
    stored = pd.read_csv(swept / "results.csv").set_index(
        ["quantity", "model", "punch.R [m]", "law.work_of_adhesion [J/m^2]"]
    )
    over_radius, over_work = laid_out.plots["plot-1"], laid_out.plots["plot-2"]
    assert (over_radius.x_label, over_radius.x_scale) == ("punch.R (µm)", "log")
    assert (over_work.x_label, over_work.x_scale) == ("law.work_of_adhesion (mJ/m^2)", "linear")
    seen = 0
    scale = {"N": 1.0, "nN": 1e-9, "µN": 1e-6, "nm": 1e-9, "pm": 1e-12}
    for plot, power in ((over_radius, 1e-6), (over_work, 1e-3)):
        for series in plot.data()["series"]:
            quantity, other = series["group"].split("|")
            factor = scale[plot.y_labels[series["group"]].rpartition("(")[2].removesuffix(")")]
            for x, y, low, high in zip(*(series[name] for name in ("x", "y", "low", "high")), strict=True):
                key = (round(x * power, 12), float(other)) if plot is over_radius else (float(other), x * power)
                row = stored.loc[(quantity, series["model"])]
                distance = [math.dist(key, one) / max(one) for one in row.index]
                row = row.iloc[distance.index(min(distance))]
                assert y * factor == pytest.approx(row["value"], rel=1e-9)
                assert (high - low) / 2 * factor == pytest.approx(row["u_num"], rel=1e-3, abs=1e-9 * abs(row["value"]))
                seen += 1
    # Bradley has no jump.
    assert seen == 2 * 30
    numbers = laid_out.tables["plot-1-numbers"]
    assert set(map(numbers.group, numbers.records)) == set(over_radius.points["group"])


def test_the_same_folder_gives_the_same_page_and_a_changed_one_none(swept, tmp_path, capsys):
    assert report(swept) == report(swept)
    folder = tmp_path / "changed"
    shutil.copytree(swept, folder)
    (folder / "inputs" / "pad.toml").write_text("# other")
    assert main(["report", str(folder)]) == 2
    error = capsys.readouterr().err
    assert "pad.toml was changed after it was written" in error
    assert error.count("\n") == 1
    assert not (folder / "report.html").exists()


def test_the_page_in_a_browser(browser, page_of_sweep, swept):
    show(browser, page_of_sweep, *DESKTOP)
    assert messages(browser) == []
    assert {url for url in requests(browser) if not url.startswith("data:")} == {page_of_sweep.as_uri()}
    assert browser.execute_script("return [window.hostile ?? null, document.images.length]") == [None, 0]
    assert HOSTILE.strip() in find(browser, "pre.file[aria-label='inputs/pad.toml']").text
    # A choice shows its numbers and its unit.
    unfold(browser, "plot-1-numbers")
    stored = read_table(swept / "results.parquet").query("quantity == 'pull_off_force' and status == 'ok'")
    chosen = stored[stored["law.work_of_adhesion [J/m^2]"] == WORKS[0]]
    assert [float(text) for text in cells(browser, "plot-1-numbers", "value")] == chosen["value"].tolist()
    assert label(browser) == "pull-off force (nN)"


def label(browser):
    script = "return Bokeh.documents.flatMap((one) => one.roots())[0].yaxes[0].axis_label"
    return browser.execute_script(script)


def test_the_page_fits_a_phone(browser, page_of_sweep):
    show(browser, page_of_sweep, *PHONE)
    whole, window = width(browser)
    assert whole <= window
    boxes = browser.execute_script("""
      return Array.from(document.querySelectorAll("#plot-1 select"), (one) => {
        const { left, right, top, bottom } = one.getBoundingClientRect();
        return [left, right, top, bottom];
      });
    """)
    for place, one in enumerate(boxes):
        assert one[1] <= PHONE[0]
        for other in boxes[:place]:
            assert one[0] >= other[1] or one[2] >= other[3] or other[0] >= one[1]
