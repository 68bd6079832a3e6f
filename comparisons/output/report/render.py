"""One HTML file of a page, without any external resource.

Everything that is text is escaped by Jinja2; what scripts read is JSON in which no character can end the
script.  A content security policy then forbids every connection, and every script but those written here.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from comparisons.judging.decision import Verdict
from comparisons.output.report.page import Page
from comparisons.output.report.table import Table
from comparisons.output.style import VERDICT_SYMBOLS, verdict_class

__all__ = ["environment", "render", "render_table", "script_json"]

#: Bokeh draws the plots: of the well-kept libraries that pip installs and that can draw a curve which turns
#: back, zoom it and read it off, it is the smallest (1.4 MB, plotly.js 4.8 MB), and needs no `eval`.
_BOKEH = ("server/static/js/bokeh.min.js", "server/static/js/bokeh-api.min.js")

_ASSETS = "comparisons.output.report"

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
    styles = {name: [style.colour, style.dash, style.marker, style.broad] for name, style in page.model_styles.items()}
    plots = [plot.data() for plot in page.every_plot]
    bokeh = [_script(files("bokeh").joinpath(name).read_text(encoding="utf-8")) for name in _BOKEH]
    scripts = [*bokeh, *(_script(_asset(name)) for name in ("tables.js", "plots.js"))]
    content = {"plots": plots, "model_styles": styles}
    return _filled("report.html", page.tables.values(), page.files, scripts, content, page=page)


def render_table(template: str, table: Table, files: Mapping[str, str], **context: Any) -> str:
    """Return the HTML of a page with one table, which sorts and filters.

    Parameters
    ----------
    template : str
        Its name among the assets.
    table : Table
    files : mapping of str to str
        What can be downloaded.
    context
        What else the template shows.
    """
    return _filled(template, [table], files, [_script(_asset("tables.js"))], {}, table=table, **context)


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
    made.filters |= {"verdict_class": verdict_class}
    return made


def _filled(
    template: str,
    tables: Iterable[Table],
    files: Mapping[str, str],
    scripts: list[Markup],
    content: dict[str, Any],
    **context: Any,
) -> str:
    data = {
        "tables": {table.id: table.data() for table in tables if table.long},
        **content,
        "files": dict(files),
        "verdicts": {str(name): [VERDICT_SYMBOLS[name], verdict_class(name)] for name in Verdict},
    }
    page = environment().get_template(template)
    return (
        page.render(
            verdicts=list(map(str, Verdict)),
            style=Markup(_asset("report.css")),
            scripts=scripts,
            policy=_policy(scripts),
            data=script_json(data),
            **context,
        )
        + "\n"
    )


def _asset(name: str) -> str:
    return files(_ASSETS).joinpath("assets", name).read_text(encoding="utf-8")


def _script(text: str) -> Markup:
    """A script as it stands in the page; a browser would fetch a link to a map of its source over the network."""
    # HTML reads a carriage return as a line's end, and the hash of the script would then be another.
    lines = [line for line in text.replace("\r", "").split("\n") if not line.startswith("//# sourceMappingURL")]
    return Markup("\n".join(lines).replace("</script", "<\\/script"))


def _policy(scripts: list[Markup]) -> str:
    hashes = " ".join(f"'sha256-{base64.b64encode(sha256(s.encode()).digest()).decode()}'" for s in scripts)
    # Bokeh styles what it draws with style elements of its own; pictures are those that a reader saves.
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )
