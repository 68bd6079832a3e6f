"""The page in a real browser: headless Chromium that records every network request.

Skipped where there is no Chromium with its driver, unless FSCM_BENCH_BROWSER=required makes them necessary.
"""

import re

import pandas as pd
import pytest

from comparisons.output.latex import latex
from comparisons.output.report.page import make_page
from comparisons.output.report.stored_run import read_folder

from .browsing import (
    DESKTOP,
    PHONE,
    cells,
    click,
    dark,
    find,
    head,
    messages,
    package,
    ranges,
    requests,
    show,
    size,
    sorting,
    text_of,
    unfold,
    wait,
    width,
)


def test_it_opens_without_an_error_and_without_the_network_and_admits_no_other_script(browser, page, hostile):
    show(browser, page, *DESKTOP)
    assert messages(browser) == []
    assert {url for url in requests(browser) if not url.startswith("data:")} == {page.as_uri()}
    assert browser.title.startswith("fscm-bench report: Of 2 models ")
    assert browser.execute_script("return window.hostile") is None
    assert hostile.script in find(browser, "#plot-kappa .models").text
    browser.execute_script("const s = document.createElement('script'); s.textContent = 'window.hostile = 1';"
                           "document.body.append(s)")  # fmt: skip
    assert browser.execute_script("return window.hostile") is None
    assert any("Content Security Policy" in entry["message"] for entry in browser.get_log("browser"))


def test_a_hostile_name_does_nothing_even_without_the_policy(browser, page, tmp_path):
    bare = tmp_path / "bare.html"
    policy = r'<meta http-equiv="Content-Security-Policy"[^>]*>'
    bare.write_text(re.sub(policy, "", page.read_text(encoding="utf-8")), encoding="utf-8")
    show(browser, bare, *DESKTOP)
    unfold(browser, "results")
    assert browser.execute_script("return [window.hostile ?? null, document.images.length]") == [None, 0]


def test_tables_sort_and_filter(opened, run_folder):
    stored = pd.read_parquet(run_folder / "verdicts.parquet")
    unfold(opened, "verdicts")
    for direction, rising in (("ascending", True), ("descending", False)):
        click(opened, head(opened, "verdicts", "E(U)"))
        assert sorting(opened, "verdicts", "E(U)") == direction
        shown = cells(opened, "verdicts", "E(U)")
        # What has no number comes last either way.
        numbers = [float(text) for text in shown if text]
        assert shown[len(numbers) :] == ["", ""]
        assert numbers == sorted(stored["error"].dropna(), reverse=not rising)
    entry = find(opened, "#table-offenders .filter")
    entry.send_keys("fail jkr-limit")
    assert cells(opened, "offenders", "gate") == ["JKR-LIMIT-PULL-OFF"] * 2
    assert find(opened, "#table-offenders .count").text == "2 of 7 rows"


def test_files_hold_the_rows_that_are_shown_in_their_order(opened, run_folder, tmp_path):
    laid_out = make_page(read_folder(run_folder))
    for name, table in laid_out.tables.items():
        opened.execute_script("Tables.choose(arguments[0], null)", name)
        stored = laid_out.files[table.source or f"{name}.csv"]
        of_page = text_of(opened, name, "csv")
        assert set(of_page.split("\n")) <= set(stored.split("\n"))
        if name in ("results", "verdicts", "kappa"):
            assert of_page == stored
        assert text_of(opened, name, "tex") == latex(table.on_paper, table.caption, table.id)
    find(opened, "#table-offenders .filter").send_keys("limit")
    click(opened, head(opened, "offenders", "E(U)"))
    shown = [float(text) for text in cells(opened, "offenders", "E(U)")]
    assert len(shown) == 6
    behaviour = {"behavior": "allow", "downloadPath": str(tmp_path)}
    opened.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
    for kind in ("csv", "tex"):
        click(opened, find(opened, f"#table-offenders [data-save='{kind}']"))
        wait((tmp_path / f"offenders.{kind}").exists)
    # As texts: the parser of older versions of pandas rounds some numbers in their last place.
    saved = pd.read_csv(tmp_path / "offenders.csv", dtype=str)
    assert [float(text) for text in saved["error"]] == shown == sorted(shown)
    assert list(saved) == list(pd.read_csv(run_folder / "verdicts.csv"))
    rows = [line for line in (tmp_path / "offenders.tex").read_text().split("\n") if "LIMIT" in line]
    assert len(rows) == len(shown)
    assert all(f" {error:.5f}" in row for error, row in zip(shown[:2], rows[:2], strict=True))


def test_a_plot_zooms(opened):
    before = ranges(opened, "plot-force-curve")
    find(opened, "#plot-force-curve [data-zoom=in]").send_keys("\ue007")
    after = ranges(opened, "plot-force-curve")
    assert before[0] < after[0] < after[1] < before[1]
    assert (after[1] - after[0]) / (before[1] - before[0]) == pytest.approx(0.7)
    click(opened, find(opened, "#plot-force-curve [data-zoom=right]"))
    assert ranges(opened, "plot-force-curve")[0] > after[0]
    click(opened, find(opened, "#plot-force-curve [data-zoom=reset]"))
    assert ranges(opened, "plot-force-curve") == before
    click(opened, find(opened, "#plot-force-curve [data-zoom=all]"))
    assert ranges(opened, "plot-force-curve")[3] > 2.3 > before[3]
    click(opened, find(opened, "#plot-force-curve [data-zoom=reset]"))


def test_the_choices_choose(opened, run_folder):
    kappa = pd.read_parquet(run_folder / "kappa.parquet")
    unfold(opened, "kappa")
    for n, k in ((2, 0), (1, 0.4)):
        for index, text in ((2, f"{n}"), (3, f"{k}")):
            select = opened.find_elements("css selector", "#plot-kappa select")[index]
            click(opened, next(o for o in select.find_elements("css selector", "option") if o.text == text))
        chosen = kappa[(kappa["n"] == n) & (kappa["k"] == k)]
        assert [float(text) for text in cells(opened, "kappa", "κ (%)")] == chosen["kappa"].tolist()
    before = ranges(opened, "plot-kappa")
    click(opened, find(opened, "#plot-kappa .models input"))
    # Without the model that is off by most, the picture is another.
    assert ranges(opened, "plot-kappa") != before
    # Without any model it stays empty, until another choice is made.
    for box in opened.find_elements("css selector", "#plot-kappa .models input:checked"):
        click(opened, box)
    assert opened.find_elements("css selector", "#plot-kappa .models input:checked") == []
    select = opened.find_elements("css selector", "#plot-kappa select")[2]
    click(opened, next(o for o in select.find_elements("css selector", "option") if o.text == "2"))
    assert len(opened.find_elements("css selector", "#plot-kappa .models input:checked")) == 2


def test_the_page_fits_a_desktop_and_a_phone(opened):
    for measures in (DESKTOP, PHONE):
        size(opened, *measures)
        assert width(opened)[0] <= measures[0]
        for table in ("verdicts", "kappa", "convergence", "results"):
            unfold(opened, table)
        assert width(opened)[0] <= measures[0]
    # The wide tables scroll in their own boxes.
    own, room = width(opened, "#table-offenders .scroll")
    assert own > room


#: The colours alone, which differ between light and dark: the other rules are those of the heavy test.
COLOURS = {"runOnly": {"type": "rule", "values": ["color-contrast"]}}


@pytest.mark.parametrize("rules", [COLOURS, pytest.param(None, marks=pytest.mark.heavy)], ids=["colours", "all"])
def test_it_is_accessible_and_legible_in_light_and_dark_and_on_paper(opened, rules):
    axe = package("axe_core_python.selenium").Axe()
    # Their rows are as those of the tables that are open.
    for table in ("verdicts", "convergence") if rules is None else ():
        unfold(opened, table)
    for measures, chosen in ((DESKTOP, False), (PHONE, True)):
        size(opened, *measures)
        if chosen:
            click(opened, find(opened, "#theme"))
        assert set(dark(opened)) == {chosen}
        found = axe.run(opened, options=rules)
        assert [(one["id"], [node["html"] for node in one["nodes"]][:3]) for one in found["violations"]] == []
        assert len(found["passes"]) >= (21 if rules is None else 1)


def plots(browser):
    return browser.execute_script("return DATA.plots.map((one) => one.id)")


@pytest.mark.parametrize(
    ("rounds", "fewest"), [(2, 20), pytest.param(5, 50, marks=pytest.mark.heavy)], ids=["twenty", "fifty"]
)
def test_interactions_in_every_plot_leave_the_console_empty(opened, tmp_path, rounds, fewest):
    opened.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    opened.execute_script("for (const fold of document.querySelectorAll('details')) fold.open = true")
    # More than once, because a fault may show only on the second use.
    script = """
      const every = (selector, inside = document) => Array.from(inside.querySelectorAll(selector));
      const tell = (element, name) => element.dispatchEvent(new Event(name, { bubbles: true }));
      const used = {};
      for (let round = 0; round < arguments[0]; round++) {
        for (const plot of every("figure.plot")) {
          used[plot.id] ??= 0;
          for (const select of every("select", plot)) {
            for (const { value } of select.options) { select.value = value; tell(select, "change"); used[plot.id]++; }
          }
          for (const box of every("input[type=checkbox]", plot)) { box.click(); box.click(); used[plot.id] += 2; }
          for (const button of every("button", plot)) { button.click(); used[plot.id]++; }
        }
      }
      for (const filter of every("input.filter")) {
        for (const words of ["jkr", "", "no such thing", ""]) { filter.value = words; tell(filter, "input"); }
      }
      for (const button of every("button:not([data-save], figure button)")) { button.click(); button.click(); }
      for (const link of every("nav a, a.skip")) link.click();
      return used;
    """
    used = opened.execute_script(script, rounds)
    assert set(used) == set(plots(opened))
    assert min(used.values()) >= fewest
    # One by one, and a few: the browser refuses many files that a page saves without a pause.
    for button in opened.find_elements("css selector", "[data-save]")[: 8 if fewest == 50 else 2]:
        table = opened.execute_script("return arguments[0].closest('.table').dataset.table", button)
        click(opened, button)
        wait((tmp_path / f"{table}.{button.get_attribute('data-save')}").exists)
    opened.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
    assert messages(opened) == []
