"""The page as text: one file, always the same, with every external text escaped."""

import json
import os
import re
import subprocess
from html.parser import HTMLParser
from itertools import pairwise

import pytest

from comparisons.output.report.page import make_page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import read_folder


@pytest.fixture(scope="module")
def text(run_folder):
    return render(make_page(read_folder(run_folder)))


class Elements(HTMLParser):
    """Every element with its attributes, and the text of the scripts."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.found, self.scripts, self.headings, self._in = [], [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        self._in = tag
        if tag == "script":
            self.scripts.append("")

    def handle_data(self, data):
        if self._in == "script":
            self.scripts[-1] += data

    def handle_endtag(self, tag):
        self._in = None


@pytest.fixture(scope="module")
def elements(text):
    return Elements(text)


def test_the_same_folder_gives_the_same_bytes(run_folder, text, hostile, tmp_path):
    again = hostile.write_run(tmp_path / "again")
    assert render(make_page(read_folder(again))) == text
    # And in another process, where sets have another order.
    out = tmp_path / "other.html"
    arguments = ["report", str(run_folder), "--out", str(out)]
    program = f"import sys; from comparisons.cli.main import main; sys.exit(main({arguments!r}))"
    seed = "1" if os.environ.get("PYTHONHASHSEED") != "1" else "2"
    subprocess.run([hostile.python, "-c", program], check=True, env={**os.environ, "PYTHONHASHSEED": seed})
    assert out.read_text(encoding="utf-8") == text


def test_no_external_text_is_an_element(elements):
    tags = {tag for tag, _ in elements.found}
    assert "img" not in tags
    assert "b" not in {tag for tag, attributes in elements.found if attributes}
    assert not any(name.startswith("on") for _, attributes in elements.found for name in attributes)
    # The data, twice Bokeh, tables, files, colours and plots.
    assert len(elements.scripts) == 7


def test_the_data_are_json_whatever_the_names(elements, hostile):
    data = json.loads(elements.scripts[0])
    models = {series["model"] for plot in data["plots"] for series in plot["series"]}
    assert {hostile.image, hostile.script, "fscm"} == models
    assert hostile.line in "\n".join(data["files"]["verdicts.csv"]).replace('""', '"')


def test_headings_and_tables_are_in_order(elements):
    levels = [int(tag[1]) for tag, _ in elements.found if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))
    tables = sum(tag == "table" for tag, _ in elements.found)
    assert tables == sum(tag == "caption" for tag, _ in elements.found) > 5
    assert all(attributes.get("scope") == "col" for tag, attributes in elements.found if tag == "th")
    identifiers = [attributes["id"] for _, attributes in elements.found if "id" in attributes]
    assert len(identifiers) == len(set(identifiers))
