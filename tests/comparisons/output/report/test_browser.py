"""The page in a real browser: headless Chromium that records every network request.

Skipped where there is no Chromium with its driver, unless FSCM_BENCH_BROWSER=required makes them necessary.
"""

import re
import shutil

import pandas as pd
import pytest

from comparisons.output.latex import latex
from comparisons.output.report.page import make_page
from comparisons.output.report.render import rows_path
from comparisons.output.report.stored_run import read_folder
from comparisons.runs.csv_format import csv_text, read_table

from . import browsing
from .browsing import DESKTOP, PHONE, cells, click, find, head, messages, ranges, size, unfold, width
from .hostile_run import SCRIPT


def test_it_opens_without_an_error_and_without_the_network_and_admits_no_other_script(browser, page):
    browsing.show(browser, page, *DESKTOP)
    assert messages(browser) == []
    assert browsing.requests(browser) == {page.as_uri(), rows_path(page).as_uri()}
    assert browser.title.startswith("fscm-bench report: ")
    assert browser.execute_script("return window.hostile") is None
    assert SCRIPT in find(browser, "#plot-kappa .models").text
    browser.execute_script("const s = document.createElement('script'); s.textContent = 'window.hostile = 1';"
                           "document.body.append(s)")  # fmt: skip
    assert browser.execute_script("return window.hostile") is None
    assert any("Content Security Policy" in entry["message"] for entry in browser.get_log("browser"))


def test_a_hostile_name_does_nothing_even_without_the_policy(browser, page, tmp_path):
    bare = tmp_path / "bare.html"
    policy = r'<meta http-equiv="Content-Security-Policy"[^>]*>'
    bare.write_text(re.sub(policy, "", page.read_text(encoding="utf-8")), encoding="utf-8")
    shutil.copy(rows_path(page), bare.with_name(rows_path(page).name))
    browsing.show(browser, bare, *DESKTOP)
    unfold(browser, "results")
    assert browser.execute_script("return [window.hostile ?? null, document.images.length]") == [None, 0]


def test_rows_are_loaded_when_a_table_is_opened(browser, page):
    browser.get("about:blank")
    browser.get_log("performance")
    size(browser, *DESKTOP)
    browser.get(page.as_uri())
    browsing.wait(lambda: browser.execute_script("return document.readyState === 'complete'"))
    assert browsing.requests(browser) == {page.as_uri()}
    assert browser.execute_script("return document.querySelectorAll('*').length") < 10_000
    unfold(browser, "results")
    assert browsing.requests(browser) == {rows_path(page).as_uri()}
    shown = browser.execute_script("return document.querySelectorAll('#table-results tbody tr').length")
    assert shown == 50
    assert len(cells(browser, "results", "model")) == 354


def test_a_page_without_its_rows_says_what_is_missing(browser, page, tmp_path):
    alone = shutil.copy(page, tmp_path / "alone.html")
    for rows in (None, 'fscmBenchRows("of another page", {});'):
        if rows:
            (tmp_path / rows_path(page).name).write_text(rows)
        browser.get(alone.as_uri())
        browser.execute_script("document.querySelector('#table-results').closest('details').open = true")
        browsing.wait(lambda: browser.find_elements("css selector", "#table-results .missing"))
        assert rows_path(page).name in browser.execute_script(
            "return document.querySelector('#table-results .missing').textContent"
        )


def test_a_click_shows_the_map_of_that_choice(opened, run_folder):
    (regimes,) = make_page(read_folder(run_folder)).maps

    def shown():
        script = "return Array.from(document.querySelectorAll('.map tbody tr'), (row) => row.cells[1].innerText)"
        return [text.split("\n") for text in opened.execute_script(script)]

    def expected(*options):
        view = regimes.views["pull-off force", "fscm", *options]
        return [[text for text in (regime.use, regime.nearness) if text] for regime in view.regimes]

    assert shown() == expected("homogeneous", "n = 2", "k = 0")
    for option, options in (
        ("n = 1", ("homogeneous", "n = 1", "k = 0")),
        ("graded, E ~ z^k", ("graded, E ~ z^k", "n = 1", "k = 0.4")),
        ("every solid", ("every solid", "n = 1", "every k")),
    ):
        click(opened, find(opened, f".regimes input[value='{option}'] + span"))
        assert shown() == expected(*options)
    # The gradient has one option left, and is not asked for.
    assert not find(opened, ".regimes input[value='k = 0.4']").is_displayed()
    assert messages(opened) == []


def test_tables_sort_and_filter(opened, run_folder):
    stored = read_table(run_folder / "verdicts.csv")
    unfold(opened, "verdicts")
    for direction, rising in (("ascending", True), ("descending", False)):
        heading = head(opened, "verdicts", "E(U)")
        click(opened, heading)
        assert heading.find_element("xpath", "..").get_attribute("aria-sort") == direction
        texts = cells(opened, "verdicts", "E(U)")
        # What has no number comes last either way.
        numbers = [float(text) for text in texts if text]
        assert texts[len(numbers) :] == ["", ""]
        assert numbers == sorted(stored["error"].dropna(), reverse=not rising)
    find(opened, "#table-offenders .filter").send_keys("fail jkr-limit")
    assert cells(opened, "offenders", "gate") == ["JKR-LIMIT-PULL-OFF"] * 2
    assert find(opened, "#table-offenders .count").text == "2 of 7 rows"


def text_of(opened, table, kind):
    return opened.execute_async_script("Files.text(arguments[0], arguments[1]).then(arguments[2])", table, kind)


def test_files_hold_the_rows_that_are_shown_in_their_order(opened, run_folder, tmp_path, typeset):
    for name, table in make_page(read_folder(run_folder)).tables.items():
        opened.execute_script("Tables.choose(arguments[0], null)", name)
        csv, tex = (text_of(opened, name, kind) for kind in ("csv", "tex"))
        assert csv == csv_text(table.stored.drop(columns="seconds", errors="ignore"))
        assert tex == latex(table.on_paper, table.caption, table.id)
        # A command has no room on paper.
        assert "solve -{}-model" not in tex
        if name in ("results", "verdicts", "kappa"):
            assert csv == (run_folder / f"{name}.csv").read_text(encoding="utf-8")
    offenders = text_of(opened, "offenders", "tex")
    typeset(offenders, (run_folder / "verdicts.tex").read_text(encoding="utf-8"), fits=False)
    find(opened, "#table-offenders .filter").send_keys("limit")
    click(opened, head(opened, "offenders", "E(U)"))
    shown = [float(text) for text in cells(opened, "offenders", "E(U)")]
    opened.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    for kind in ("csv", "tex"):
        click(opened, find(opened, f"#table-offenders [data-save='{kind}']"))
        browsing.wait((tmp_path / f"offenders.{kind}").exists)
    # As texts: the parser of older versions of pandas rounds some numbers in their last place.
    saved = pd.read_csv(tmp_path / "offenders.csv", dtype=str)
    assert [float(text) for text in saved["error"]] == shown == sorted(shown)
    rows = [line for line in (tmp_path / "offenders.tex").read_text().split("\n") if "LIMIT" in line]
    assert len(rows) == len(shown) == 6
    assert all(f" {error:.5f}" in row for error, row in zip(shown[:2], rows[:2], strict=True))


def zoom_and_back(opened):
    before = ranges(opened, "plot-force-curve")
    find(opened, "#plot-force-curve [data-zoom=in]").send_keys("\ue007")
    after = ranges(opened, "plot-force-curve")
    assert before[0] < after[0] < after[1] < before[1]
    click(opened, find(opened, "#plot-force-curve [data-zoom=reset]"))
    assert ranges(opened, "plot-force-curve") == before
    click(opened, find(opened, "#plot-force-curve [data-zoom=all]"))
    assert ranges(opened, "plot-force-curve")[3] > 2.3 > before[3]


def choose(browser, index, text):
    select = browser.find_elements("css selector", "#plot-kappa select")[index]
    click(browser, next(o for o in select.find_elements("css selector", "option") if o.text == text))


def test_a_plot_zooms_a_choice_shows_its_rows_and_models_are_switched_on_and_off(opened, run_folder):
    zoom_and_back(opened)
    kappa = read_table(run_folder / "kappa.csv")
    unfold(opened, "kappa")
    for n, k in ((2, 0), (1, 0.4)):
        choose(opened, 1, f"{n}")
        choose(opened, 2, f"{k}")
        rows = kappa[(kappa["n"] == n) & (kappa["k"] == k)]
        assert [float(text) for text in cells(opened, "kappa", "κ (%)")] == rows["kappa"].tolist()
    before = ranges(opened, "plot-kappa")
    click(opened, find(opened, "#plot-kappa .models input"))
    # Without the model that is off by most, the picture is another.
    assert ranges(opened, "plot-kappa") != before
    # Without any model it stays empty, until another choice is made.
    for box in opened.find_elements("css selector", "#plot-kappa .models input:checked"):
        click(opened, box)
    assert opened.find_elements("css selector", "#plot-kappa .models input:checked") == []
    choose(opened, 1, "2")
    assert len(opened.find_elements("css selector", "#plot-kappa .models input:checked")) == 2


def test_the_page_fits_a_desktop_and_a_phone_and_interactions_in_every_plot_leave_the_console_empty(opened):
    for table in ("verdicts", "kappa", "convergence", "results"):
        unfold(opened, table)
    for measures in (DESKTOP, PHONE):
        size(opened, *measures)
        assert width(opened)[0] <= measures[0]
    # The wide tables scroll in their own boxes.
    content, box = width(opened, "#table-offenders .scroll")
    assert content > box
    assert not is_dark(opened)
    click(opened, find(opened, "#theme"))
    assert is_dark(opened)
    use_everything(opened)


DARK = """
  const page = getComputedStyle(document.body).backgroundColor === "rgb(20, 24, 29)";
  const plots = Bokeh.documents.flatMap((one) => one.roots()).map((one) => one.xaxes[0].axis_label_text_color);
  return [page, ...plots.map((colour) => colour !== "#1b1f24")];
"""


def is_dark(opened):
    (dark,) = set(opened.execute_script(DARK))
    return dark


@pytest.mark.heavy
def test_it_is_accessible_and_legible_in_light_and_dark(opened):
    axe = browsing.package("axe_core_python.selenium").Axe()
    for measures, dark in ((DESKTOP, False), (PHONE, True)):
        size(opened, *measures)
        if dark:
            click(opened, find(opened, "#theme"))
        assert is_dark(opened) == dark
        result = axe.run(opened)
        assert [(rule["id"], [node["html"] for node in rule["nodes"]][:3]) for rule in result["violations"]] == []
        assert len(result["passes"]) >= 20


def use_everything(opened):
    """Use every choice, switch and button of the page."""
    # More than once, because a fault may show only on the second use.
    script = """
      const every = (selector, inside = document) => Array.from(inside.querySelectorAll(selector));
      const tell = (element, name) => element.dispatchEvent(new Event(name, { bubbles: true }));
      const used = {};
      every("details").forEach((fold) => { fold.open = true; });
      for (const plot of [...every("figure.plot"), ...every("figure.plot")]) {
        used[plot.id] ??= 0;
        for (const select of every("select", plot)) {
          for (const { value } of select.options) { select.value = value; tell(select, "change"); used[plot.id]++; }
        }
        for (const box of every("input[type=checkbox]", plot)) { box.click(); box.click(); used[plot.id] += 2; }
        for (const button of every("button", plot)) { button.click(); used[plot.id]++; }
      }
      for (const button of every("button:not([data-save], figure button)")) { button.click(); button.click(); }
      return used;
    """
    used = opened.execute_script(script)
    assert set(used) == set(
        opened.execute_script("return Array.from(document.querySelectorAll('figure.plot'), (plot) => plot.id)")
    )
    assert min(used.values()) >= 20
    opened.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
    assert messages(opened) == []
