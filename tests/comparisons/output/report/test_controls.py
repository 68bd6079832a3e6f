"""Every control of the page in a real browser, and an empty console afterwards."""

from functools import partial

import pytest

from comparisons.quantities import CURVES

from .browsing import DESKTOP, click, find, messages, package, show, tips, wait

# The choices of a plot are its selects; a series is drawn when its choice is first made.
CHOOSE = """
  const [id, values] = arguments;
  document.querySelectorAll(`#${id} select`).forEach((select, index) => {
    select.value = values[index];
    select.dispatchEvent(new Event("change"));
  });
"""
# A point of each series that is shown: its model, its hover value, and its pixel from the middle of the plot.
POINTS = """
  const [id, group] = arguments;
  const plot = DATA.plots.find((one) => one.id === id);
  const [x0, x1, y0, y1] = Plots.range(id);
  const [left, top, width, height] = Plots.inner(id);
  const box = document.querySelector(`#${id} .canvas`).getBoundingClientRect();
  const share = (v, a, b, scale) => (scale === "log" ? Math.log(v / a) / Math.log(b / a) : (v - a) / (b - a));
  return plot.series.filter((series) => series.group === group).map((series) => {
    const places = series.x.map((x, index) => ({
      label: series.label, hover: series.hover[index],
      across: share(x, x0, x1, plot.x_scale), up: share(series.y[index], y0, y1, plot.y_scale),
    })).filter(({ across, up }) => Math.min(across, up) > 0.02 && Math.max(across, up) < 0.98);
    const { label, hover, across, up } = places[Math.floor(places.length / 2)];
    const [right, down] = [left + width * across - box.width / 2, top + height * (1 - up) - box.height / 2];
    return [label, hover, Math.round(right), Math.round(down)];
  });
"""


def choices(browser, plot):
    """Every combination of the options of a plot's menus that has something to show."""
    return browser.execute_script(
        "return [...new Set(DATA.plots.find((one) => one.id === arguments[0]).series.map((one) => one.group))]", plot
    )


def plots(browser):
    return browser.execute_script("return DATA.plots.map((one) => one.id)")


def point(browser, plot, right, down):
    canvas = find(browser, f"#{plot} .canvas")
    browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
    actions = package("selenium.webdriver.common.action_chains").ActionChains(browser, duration=0)
    actions.move_to_element_with_offset(canvas, right + 3, down).move_by_offset(-3, 0).perform()


def shows(browser, label, hover):
    text = tips(browser)
    return label in text and hover in text


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.heavy)])
def test_values_are_read_off_after_every_choice(opened, whole):
    """Of every plot, after its first and its last choice, or after all of them."""
    assert {f"plot-{name.replace('_', '-')}" for name in CURVES} <= set(plots(opened))
    read_off = 0
    for plot in plots(opened):
        every = choices(opened, plot)
        chosen = every if whole else list(dict.fromkeys([every[0], every[-1]]))
        # The first again: a choice that is made again must be as good as the first time.
        again = len(chosen) > 1 and plot == "plot-kappa"
        for group in [*chosen, *every[: again or whole]]:
            opened.execute_script(CHOOSE, plot, group.split("|") if plot == "plot-kappa" else [group])
            for label, hover, right, down in opened.execute_script(POINTS, plot, group):
                point(opened, plot, right, down)
                wait(partial(shows, opened, label, hover))
                read_off += 1
    assert read_off >= ((4 * 2 + 2 + 1 + 2) + (2 + 2 + 1 + 2) if whole else 3 * 2 + 2 + 1 + 2)
    # A model that is switched off is not read off.
    click(opened, find(opened, "#plot-pull-off-gap .models input"))
    (_, again) = opened.execute_script(POINTS, "plot-pull-off-gap", "2|0.4|1")
    point(opened, "plot-pull-off-gap", *again[2:])
    wait(partial(shows, opened, *again[:2]))
    assert "fscm" not in tips(opened)
    assert messages(opened) == []


@pytest.mark.parametrize("every", [3, pytest.param(1, marks=pytest.mark.heavy)])
def test_every_model_of_a_standing_run_is_read_off(browser, standing, every):
    """Of the light test, every third and the last."""
    show(browser, standing, *DESKTOP)
    others = "#plot-kappa .models input:not(:checked)"
    browser.execute_script("document.querySelectorAll(arguments[0]).forEach((box) => box.click())", others)
    points = browser.execute_script(POINTS, "plot-kappa", choices(browser, "plot-kappa")[0])
    assert len(points) >= 8
    for label, hover, right, down in points[::-every]:
        point(browser, "plot-kappa", right, down)
        wait(partial(shows, browser, label, hover))
    assert messages(browser) == []


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
    for plot in plots(opened):
        for right, down in ((-40, 0), (0, 30), (40, -30)):
            point(opened, plot, right, down)
    # One by one, and a few: the browser refuses many files that a page saves without a pause.
    for button in opened.find_elements("css selector", "[data-save]")[: 8 if fewest == 50 else 2]:
        table = opened.execute_script("return arguments[0].closest('.table').dataset.table", button)
        click(opened, button)
        wait((tmp_path / f"{table}.{button.get_attribute('data-save')}").exists)
    opened.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
    assert messages(opened) == []
