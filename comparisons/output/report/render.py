"""One HTML file of a page, without any external resource.

Everything that is text is escaped by Jinja2; what scripts read is JSON in which no character can end the
script.  A content security policy then forbids every connection, and every script but those written here.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from functools import cache
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from comparisons.judging.decision import Verdict
from comparisons.output.latex import latex_table
from comparisons.output.report.page import Page
from comparisons.output.style import VERDICT_SYMBOLS, verdict_class
from comparisons.output.table import Table

__all__ = ["dark_colour", "environment", "filled", "records", "render", "script_json"]

#: Bokeh draws the plots: of the well-kept libraries that pip installs and that can draw a curve which turns
#: back, zoom it and read it off, it is the smallest (1.4 MB, plotly.js 4.8 MB), and needs no `eval`.
_BOKEH = ("server/static/js/bokeh.min.js", "server/static/js/bokeh-api.min.js")

_ASSETS = "comparisons.output.report"

#: Rows up to which the table of the largest errors is open; what is open is printed.
_MOST_OPEN = 40

#: Scripts of every page, in this order.
_SCRIPTS = ("tables.js", "files.js", "theme.js")

#: Colours that a dark page has in place of those that are too dark for it; the others are used on both.
_ON_DARK = {"#000000": "#f2f4f6", "#0072b2": "#3f9fe0", "#d55e00": "#f07a24", "#666666": "#a8afb7"}

#: Characters that could end a script, begin a comment in it, or that JavaScript once took for a line's end.
_UNSAFE = {character: f"\\u{ord(character):04x}" for character in "<>&'\u2028\u2029"}


def script_json(content: Any) -> Markup:
    r"""Return JSON that can stand inside a script element.

    Raises
    ------
    ValueError
        If there is a NaN or an infinity in it, which JSON does not have.

    Examples
    --------
    >>> print(script_json({"name": "</script>"}))
    {"name":"\u003c/script\u003e"}
    """
    text = json.dumps(content, allow_nan=False, separators=(",", ":"), ensure_ascii=False)
    for character, escape in _UNSAFE.items():
        text = text.replace(character, escape)
    # What is only half a character, from a text that was cut, is not UTF-8.
    return Markup(text.encode("utf-8", "replace").decode("utf-8"))


def render(page: Page) -> str:
    """Return the HTML of a page; the same page gives the same text.

    Parameters
    ----------
    page : Page
        As `comparisons.output.report.page.make_page` returns it.
    """
    styles = {
        name: [style.colour, dark_colour(style.colour), style.dash, style.marker, style.broad]
        for name, style in page.model_styles.items()
    }
    drawn = {"plots": [plot.data() for plot in page.every_plot], "model_styles": styles}
    return filled("report.html", page.tables.values(), page.files, drawn, page=page, most_open=_MOST_OPEN)


def dark_colour(colour: str) -> str:
    """Return the colour of a model on a dark page.

    Examples
    --------
    >>> dark_colour("#000000"), dark_colour("#009e73")
    ('#f2f4f6', '#009e73')
    """
    return _ON_DARK.get(colour, colour)


def records(text: str) -> list[str]:
    r"""Return the records of a CSV text, the first one being the names; a quoted line's end does not end a record.

    Examples
    --------
    >>> records('a,b\n1,"x\ny"\n2,z\n')
    ['a,b', '1,"x\ny"', '2,z']
    """
    found: list[str] = []
    whole = True
    for line in text.removesuffix("\n").split("\n"):
        if whole:
            found.append(line)
        else:
            found[-1] += "\n" + line
        whole = found[-1].count('"') % 2 == 0
    return found


@cache
def environment() -> Environment:
    """Return the environment of all templates: everything that is text is escaped."""
    made = Environment(
        loader=PackageLoader(_ASSETS, "assets"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals |= {"symbols": {str(name): symbol for name, symbol in VERDICT_SYMBOLS.items()}}
    made.filters |= {"verdict_class": verdict_class, "dark_colour": dark_colour}
    return made


def filled(
    template: str,
    tables: Iterable[Table],
    files: Mapping[str, str],
    drawn: Mapping[str, Any] | None = None,
    **context: Any,
) -> str:
    """Return the HTML of a page whose tables sort and filter.

    Parameters
    ----------
    template : str
        Its name among the assets.
    tables : iterable of Table
    files : mapping of str to str
        What can be downloaded.
    drawn : mapping, optional
        Plots and the styles of their models, for a page that has some.
    context
        What else the template shows.
    """
    scripts = [_script(_ASSETS, f"assets/{name}") for name in _SCRIPTS]
    if drawn:
        bokeh = [_script("bokeh", name) for name in _BOKEH]
        scripts = [*bokeh, *scripts, _script(_ASSETS, "assets/plots.js")]
    data = {
        "tables": {table.id: _data(table) for table in tables},
        **(drawn or {}),
        "files": {name: records(text) for name, text in files.items()},
    }
    context |= {
        "verdicts": list(map(str, Verdict)),
        "style": Markup(_asset("report.css")),
        "scripts": scripts,
        "policy": _policy(scripts),
        "data": script_json(data),
    }
    return environment().get_template(template).render(context) + "\n"


def _data(table: Table) -> dict[str, Any]:
    """Return what the scripts need of a table to save the rows that are shown."""
    latex = latex_table(table.on_paper(), table.caption, table.id)
    return {"source": table.source, "lines": table.lines, "latex": [latex.before, latex.rows, latex.after]}


def _asset(name: str) -> str:
    return files(_ASSETS).joinpath("assets", name).read_text(encoding="utf-8")


@cache
def _script(package: str, name: str) -> Markup:
    """A script as it stands in the page; a browser would fetch a link to a map of its source over the network."""
    text = files(package).joinpath(name).read_text(encoding="utf-8")
    # HTML reads a carriage return as a line's end, and the hash of the script would then be another.
    lines = [line for line in text.replace("\r", "").split("\n") if not line.startswith("//# sourceMappingURL")]
    return Markup("\n".join(lines).replace("</script", "<\\/script"))


@cache
def _digest(script: Markup) -> str:
    return base64.b64encode(sha256(script.encode()).digest()).decode()


def _policy(scripts: list[Markup]) -> str:
    hashes = " ".join(f"'sha256-{_digest(script)}'" for script in scripts)
    # Bokeh styles what it draws with style elements of its own; pictures are those that a reader saves.
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )
