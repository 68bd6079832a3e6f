"""Every control of the page in a real browser, and an empty console afterwards."""

from functools import partial

from comparisons.quantities import CURVES

from .browsing import click, find, package, tips, wait

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


def messages(browser):
    return [entry for entry in browser.get_log("browser") if entry["level"] not in {"INFO", "DEBUG"}]


def test_every_curve_that_is_stored_is_drawn(opened):
    assert {f"plot-{name.replace('_', '-')}" for name in CURVES} <= set(plots(opened))


def test_values_are_read_off_after_every_choice(opened):
    read_off = 0
    for plot in plots(opened):
        every = choices(opened, plot)
        # The first again: a choice that is made again must be as good as the first time.
        for group in [*every, every[0]]:
            opened.execute_script(CHOOSE, plot, group.split("|") if plot == "plot-kappa" else [group])
            for label, hover, right, down in opened.execute_script(POINTS, plot, group):
                point(opened, plot, right, down)
                wait(partial(shows, opened, label, hover))
                read_off += 1
    assert read_off >= (4 * 2 + 2 + 1 + 2) + (2 + 2 + 1 + 2)
    assert messages(opened) == []


def test_a_model_that_is_switched_off_is_not_read_off(opened):
    (one, other) = opened.execute_script(POINTS, "plot-pull-off-gap", "2|0.4|1")
    for label, hover, right, down in (one, other):
        point(opened, "plot-pull-off-gap", right, down)
        wait(partial(shows, opened, label, hover))
    click(opened, find(opened, "#plot-pull-off-gap .models input"))
    (_, again) = opened.execute_script(POINTS, "plot-pull-off-gap", "2|0.4|1")
    point(opened, "plot-pull-off-gap", *again[2:])
    wait(partial(shows, opened, *again[:2]))
    assert "fscm" not in tips(opened)
    assert messages(opened) == []


def test_every_control_leaves_the_console_empty(opened, tmp_path):
    opened.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    opened.execute_script("for (const fold of document.querySelectorAll('details')) fold.open = true")
    # Twice, because a fault may show only on the second use.
    for _ in range(2):
        used = opened.execute_script("""
          const every = (selector) => Array.from(document.querySelectorAll(selector));
          const tell = (element, name) => element.dispatchEvent(new Event(name, { bubbles: true }));
          for (const select of every("select")) {
            for (const option of select.options) { select.value = option.value; tell(select, "change"); }
          }
          for (const box of every("input[type=checkbox]")) { box.click(); box.click(); }
          for (const filter of every("input.filter")) {
            for (const words of ["jkr", "", "no such thing", ""]) { filter.value = words; tell(filter, "input"); }
          }
          const buttons = every("button:not([data-file])");
          for (const button of buttons) button.click();
          for (const link of every("nav a, a.skip")) link.click();
          return [every("select").length, every("input[type=checkbox]").length, buttons.length];
        """)
        assert min(used) >= 8
        for plot in plots(opened):
            for right, down in ((-40, 0), (0, 30), (40, -30)):
                point(opened, plot, right, down)
    # One by one and each once: the browser refuses many files that a page saves without a pause.
    for name in opened.execute_script("return Object.keys(DATA.files)"):
        click(opened, find(opened, f"[data-file='{name}']"))
        wait((tmp_path / name).exists)
    opened.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
    assert messages(opened) == []
