"""One HTML file of a page, without any external resource.

Everything that is text is escaped by Jinja2; what scripts read is JSON in which no character can end the
script.  A content security policy then forbids every connection, and every script but those written here.
"""

from __future__ import annotations

import base64
import json
from hashlib import sha256
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from comparisons.judging.decision import Verdict
from comparisons.output.report.page import Page
from comparisons.output.style import VERDICT_SYMBOLS, verdict_class

__all__ = ["render", "script_json"]

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
    environment = Environment(
        loader=PackageLoader(_ASSETS, "assets"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals |= {"symbols": {str(name): symbol for name, symbol in VERDICT_SYMBOLS.items()}}
    environment.filters |= {"verdict_class": verdict_class}
    scripts = [_script(files("bokeh").joinpath(name).read_text(encoding="utf-8")) for name in _BOKEH]
    scripts += [_script(_asset(name)) for name in ("tables.js", "plots.js")]
    return (
        environment.get_template("report.html").render(
            page=page,
            verdicts=list(map(str, Verdict)),
            style=Markup(_asset("report.css")),
            scripts=scripts,
            policy=_policy(scripts),
            data=script_json(
                {
                    "tables": {table.id: table.data() for table in page.tables.values() if table.long},
                    "plots": [plot.data() for plot in page.every_plot],
                    "model_styles": {
                        name: [style.colour, style.dash, style.marker, style.broad]
                        for name, style in page.model_styles.items()
                    },
                    "files": page.files,
                    "verdicts": {str(name): [VERDICT_SYMBOLS[name], verdict_class(name)] for name in Verdict},
                }
            ),
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
