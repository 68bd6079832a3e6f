"""The files of a page: the HTML, and a script beside it with the rows, points and plots that a reader opens later.

Everything that is text is escaped by Jinja2; what scripts read is JSON in which no character can end the
script.  A content security policy then forbids every connection, and every script but those written here.
"""

from __future__ import annotations

import base64
import gzip
import json
import re
from functools import cache
from hashlib import sha256
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from comparisons.output.latex import latex_parts
from comparisons.output.markup import badge, html_rows, html_table
from comparisons.output.report.page import TEXTS, Page
from comparisons.output.report.regime_map import STEPS, RegimeMap, View
from comparisons.output.report.regimes import Options
from comparisons.output.style import model_styles
from comparisons.output.table import Table
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import csv_text

#: Bokeh draws the plots: of the well-kept libraries that pip installs and that can draw a curve which turns
#: back, zoom it and read it off, it is the smallest (1.4 MB, plotly.js 4.8 MB), and needs no `eval`.
_BOKEH = ("server/static/js/bokeh.min.js", "server/static/js/bokeh-api.min.js")

_ASSETS = "comparisons.output.report"

#: Rows of a table that is not folded that the HTML itself has: a page of many cases stays below 10,000 elements.
_FIRST_ROWS = 50

#: JSON has no NaN and no infinity.
_JSON: dict[str, Any] = {"allow_nan": False, "separators": (",", ":")}

#: A record of a CSV text: a quoted line's end does not end it.
_RECORD = re.compile(r'(?:[^"\n]|"[^"]*")+')


class Rendered(NamedTuple):
    """The HTML of a page, and the script beside it with what the page opens later."""

    html: str
    rows: str


def write_page(page: Page, path: Path) -> None:
    """Write a page and the file of its rows beside it (`rows_path`).

    Parameters
    ----------
    page : Page
        As `comparisons.output.report.page.make_page` returns it.
    path : Path
    """
    html, rows = render(page, rows_path(path).name)
    # A page without its rows says so; rows without their page are of no use.
    write_file(rows_path(path), rows)
    write_file(path, html)


def rows_path(path: Path) -> Path:
    """Return the path of the rows of a page.

    Examples
    --------
    >>> rows_path(Path("mine/report.html")).name
    'report-rows.js'
    """
    return path.with_name(f"{path.stem}-rows.js")


def render(page: Page, file: str = "report-rows.js") -> Rendered:
    """Return the texts of a page and of its rows; the same page gives the same texts.

    Parameters
    ----------
    page : Page
    file : str
        Name of the file of the rows, beside the page.
    """
    later = {table.id: _json(_content(table)) for table in page.tables.values()}
    later |= {plot.id: _json(plot.data()) for plot in page.plots.values()}
    if page.plots:
        later["bokeh"] = "".join(_script("bokeh", name) for name in _BOKEH)
    packed = _json({name: _packed(text) for name, text in later.items()})
    digest = sha256(packed.encode()).hexdigest()
    styles = model_styles(name for plot in page.plots.values() for name in plot.models)
    names = ("rows.js", "theme.js", "tables.js", "files.js", *(["map.js"] if page.maps else []))
    scripts = [_script(_ASSETS, f"assets/{name}") for name in (*names, *(["plots.js"] if page.plots else []))]
    data = {
        "file": file,
        "digest": digest,
        # Only what the scripts of the page add has it: no text of the data is a script.
        "nonce": digest[:32],
        "model_styles": {
            name: [style.colour, style.on_dark, style.dashes, style.marker, style.broad]
            for name, style in styles.items()
        },
    }
    content = {"page": page, "texts": TEXTS, "model_styles": styles, "data": data, "first_rows": _FIRST_ROWS}
    policy = _policy(scripts, digest[:32])
    shell = {"style": Markup(_asset(_ASSETS, "assets/report.css")), "scripts": scripts, "policy": policy}
    html = _environment().get_template("page.html").render(content | shell) + "\n"
    return Rendered(html, f'fscmBenchRows("{digest}", {packed});\n')


@cache
def _environment() -> Environment:
    """The environment of the templates: everything that is text is escaped."""
    loader = PackageLoader(_ASSETS, "assets")
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    environment.trim_blocks = environment.lstrip_blocks = True
    environment.policies["json.dumps_kwargs"] = _JSON
    makers = {"badge": badge, "html_table": html_table, "map_view": _map_view, "map_views": _map_views}
    environment.globals |= makers | {"map_legend": _legend()}
    return environment


def _map_view(options: Options, view: View) -> Markup:
    quantity, reference, *others = options
    template = _environment().get_template("map.html")
    return Markup(template.render(chosen=[quantity, *others], reference=reference, view=view))


def _map_views(regimes: RegimeMap) -> str:
    """Return every choice of a map: its options, and the table."""
    return _packed(_json([[options, _map_view(options, view)] for options, view in regimes.views.items()]))


def _legend() -> list[str]:
    """Return the meaning of the colours of a map."""
    ends = [f"{100 * step:g}" for step in STEPS]
    between = [f"{low} to {high} %" for low, high in pairwise(ends)]
    return [f"below {ends[0]} %", *between, f"{ends[-1]} % and more"]


def _content(table: Table) -> dict[str, Any]:
    """Return what the scripts need of a table: its cells, its choices, and the rows of its files between two ends."""
    # The CSV files of a folder have no times.
    head, *rows = _RECORD.findall(csv_text(table.stored.drop(columns="seconds", errors="ignore")))
    groups = [table.group(row) for row in table.records] if table.group else None
    tex = latex_parts(table.on_paper, table.caption, table.id)
    return {"cells": html_rows(table), "groups": groups, "csv": [head, rows, ""], "tex": tex}


def _json(content: object) -> str:
    return json.dumps(content, **_JSON)


def _packed(text: str) -> str:
    """Return a text compressed, without the time at which that was done."""
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode()


def _asset(package: str, name: str) -> str:
    return files(package).joinpath(name).read_text(encoding="utf-8")


@cache
def _script(package: str, name: str) -> Markup:
    """A script as it stands in the page; a browser would fetch a link to a map of its source over the network."""
    # HTML reads a carriage return as a line's end, and the hash of the script would then be another.
    text = re.sub("(?m)^//# sourceMappingURL.*\n?", "", _asset(package, name).replace("\r", ""))
    return Markup(text.replace("</script", "<\\/script"))


def _policy(scripts: list[Markup], nonce: str) -> str:
    digests = (base64.b64encode(sha256(script.encode()).digest()).decode() for script in scripts)
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests)
    # Bokeh styles what it draws with style elements of its own; pictures are those that a reader saves.
    return (
        f"default-src 'none'; script-src {hashes} 'nonce-{nonce}'; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )
