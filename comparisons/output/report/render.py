"""One HTML file of a page, without any external resource.

Everything that is text is escaped by Jinja2; what scripts read is JSON in which no character can end the
script.  A content security policy then forbids every connection, and every script but those written here.
"""

from __future__ import annotations

import base64
import re
from functools import cache
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from comparisons.output.latex import latex_parts
from comparisons.output.markup import badge, html_table
from comparisons.output.report.page import TEXTS, Page
from comparisons.output.style import model_styles
from comparisons.output.table import Table
from comparisons.runs.csv_format import csv_text

#: Bokeh draws the plots: of the well-kept libraries that pip installs and that can draw a curve which turns
#: back, zoom it and read it off, it is the smallest (1.4 MB, plotly.js 4.8 MB), and needs no `eval`.
_BOKEH = ("server/static/js/bokeh.min.js", "server/static/js/bokeh-api.min.js")

_ASSETS = "comparisons.output.report"

#: A record of a CSV text: a quoted line's end does not end it.
_RECORD = re.compile(r'(?:[^"\n]|"[^"]*")+')


def render(page: Page) -> str:
    """Return the HTML of a page; the same page gives the same text.

    Parameters
    ----------
    page : Page
        As `comparisons.output.report.page.make_page` returns it.
    """
    styles = model_styles(name for plot in page.plots.values() for name in plot.models)
    scripts = [_script("bokeh", name) for name in _BOKEH] if page.plots else []
    names = ("tables.js", "files.js", "theme.js", *(["plots.js"] if page.plots else []))
    scripts += [_script(_ASSETS, f"assets/{name}") for name in names]
    data = {
        "tables": {table.id: _data(table) for table in page.tables.values()},
        "plots": [plot.data() for plot in page.plots.values()],
        "model_styles": {
            name: [style.colour, style.on_dark, style.dash, style.marker, style.broad] for name, style in styles.items()
        },
    }
    content = {"page": page, "texts": TEXTS, "model_styles": styles, "data": data}
    shell = {"style": Markup(_asset(_ASSETS, "assets/report.css")), "scripts": scripts, "policy": _policy(scripts)}
    return _environment().get_template("page.html").render(content | shell) + "\n"


@cache
def _environment() -> Environment:
    """The environment of the template: everything that is text is escaped."""
    loader = PackageLoader(_ASSETS, "assets")
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    environment.trim_blocks = environment.lstrip_blocks = True
    # JSON has no NaN and no infinity.
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    environment.globals |= {"badge": badge, "html_table": html_table}
    return environment


def _data(table: Table) -> dict[str, Any]:
    """Return what the scripts need of a table: its choices, and the rows that they save, between two ends."""
    # The CSV files of a folder have no times.
    head, *rows = _RECORD.findall(csv_text(table.stored.drop(columns="seconds", errors="ignore")))
    groups = [table.group(row) for row in table.records] if table.group else None
    tex = latex_parts(table.on_paper, table.caption, table.id)
    return {"groups": groups, "csv": [head, rows, ""], "tex": tex}


def _asset(package: str, name: str) -> str:
    return files(package).joinpath(name).read_text(encoding="utf-8")


@cache
def _script(package: str, name: str) -> Markup:
    """A script as it stands in the page; a browser would fetch a link to a map of its source over the network."""
    # HTML reads a carriage return as a line's end, and the hash of the script would then be another.
    text = re.sub("(?m)^//# sourceMappingURL.*\n?", "", _asset(package, name).replace("\r", ""))
    return Markup(text.replace("</script", "<\\/script"))


def _policy(scripts: list[Markup]) -> str:
    digests = (base64.b64encode(sha256(script.encode()).digest()).decode() for script in scripts)
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests)
    # Bokeh styles what it draws with style elements of its own; pictures are those that a reader saves.
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )
