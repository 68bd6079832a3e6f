"""Steps on a page in a real browser: headless Chromium that records every network request."""

import importlib
import json
import os
import shutil
import time

import pytest

_REQUIRED = os.environ.get("FSCM_BENCH_BROWSER") == "required"

PHONE, DESKTOP = (390, 800), (1280, 900)
ARGUMENTS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage"),
)
#: Ends a test whose page is never drawn: a page takes about two seconds, and minutes on a machine that is very busy.
PATIENCE = 1800


def programs():
    """The browser and its driver; skips or fails where they are missing."""
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    driver = shutil.which("chromedriver")
    if browser and driver:
        return browser, driver
    reason = "Chromium or chromedriver is not installed (Debian: apt-get install chromium chromium-driver)"
    (pytest.fail if _REQUIRED else pytest.skip)(reason)


def package(name):
    """Import what only the tests need; skips or fails where it is missing."""
    return importlib.import_module(name) if _REQUIRED else pytest.importorskip(name)


def size(browser, width, height):
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)


def wait(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "the page is not ready"
        time.sleep(0.05)


def show(browser, path, width, height):
    """Open a page in a window of this size; the logs hold its messages alone."""
    browser.get("about:blank")
    for kind in ("browser", "performance"):
        browser.get_log(kind)
    size(browser, width, height)
    browser.get(path.as_uri())
    # A reader scrolls to a plot; a test draws them all.
    browser.execute_async_script("Promise.all([Plots.all(), Maps.ready]).then(() => arguments[0]())")


def settle(browser):
    """Wait until every table shows what was asked for."""
    wait(lambda: browser.execute_script("return Tables.settled()"))


def find(browser, selector):
    return browser.find_element("css selector", selector)


def click(browser, element):
    """Click on what is first brought into view: the boxes of tables scroll too."""
    browser.execute_script("arguments[0].scrollIntoView({ block: 'center', inline: 'center' })", element)
    element.click()


def cells(browser, table, column):
    """The exact numbers, or else the texts, of the rows of a column, all of which are asked for."""
    settle(browser)
    more = find(browser, f"#table-{table} .more")
    while not more.get_property("hidden"):
        browser.execute_script("arguments[0].click()", more)
        settle(browser)
    script = """
      const rows = Array.from(document.querySelectorAll(`#table-${arguments[0]} tbody tr`));
      const heads = Array.from(document.querySelectorAll(`#table-${arguments[0]} thead th`), (h) => h.innerText.trim());
      const at = heads.indexOf(arguments[1]);
      return rows.map((row) => row.cells[at].querySelector("data:not(.rank)")?.value ?? row.cells[at].textContent);
    """
    return browser.execute_script(script, table, column)


def unfold(browser, table):
    browser.execute_script("document.querySelector(arguments[0]).closest('details').open = true", f"#table-{table}")
    wait(
        lambda: browser.execute_script(
            "return document.querySelector(arguments[0]).rows.length > 0", f"#table-{table} tbody"
        )
    )
    settle(browser)


def head(browser, table, label):
    buttons = browser.find_elements("css selector", f"#table-{table} thead button")
    return next(button for button in buttons if button.text == label)


def ranges(browser, plot):
    return browser.execute_script("return Plots.range(arguments[0])", plot)


def messages(browser):
    """What the console has beyond information."""
    return [entry for entry in browser.get_log("browser") if entry["level"] not in {"INFO", "DEBUG"}]


def requests(browser):
    """The addresses of everything that the page has asked for, but for what it holds itself."""
    sent = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    urls = {message["params"]["request"]["url"] for message in sent if message["method"] == "Network.requestWillBeSent"}
    return {url for url in urls if not url.startswith("data:")}


def width(browser, selector="html"):
    """The width of what an element holds, and its own."""
    return browser.execute_script(
        "const e = document.querySelector(arguments[0]); return [e.scrollWidth, e.clientWidth]", selector
    )
