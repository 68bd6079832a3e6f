"""A run folder, its page, and a browser that shows it."""

import pytest

from comparisons.cli.main import main

from .browsing import ARGUMENTS, DESKTOP, PATIENCE, package, programs, show
from .hostile_run import write_run


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    """Never written to by a test."""
    return write_run(tmp_path_factory.mktemp("report") / "run")


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """A fresh browser, started once."""
    chromium, driver = programs()
    webdriver = package("selenium.webdriver")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in (*ARGUMENTS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(executable_path=driver)
    # Only connections that are made later have another time limit than the first one.
    started = webdriver.Chrome(options=options, service=service, keep_alive=False)
    started.command_executor.client_config.timeout = PATIENCE
    started.set_script_timeout(PATIENCE)
    yield started
    started.quit()


@pytest.fixture(scope="session")
def page(run_folder, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    assert main(["report", str(run_folder), "--out", str(path)]) == 0
    return path


@pytest.fixture
def opened(browser, page):
    """The page on a desktop."""
    show(browser, page, *DESKTOP)
    return browser
