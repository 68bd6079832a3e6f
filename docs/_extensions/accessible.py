"""What a screen reader and a keyboard need of a page, and the theme leaves out."""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

#: Captions of the table of contents stand below the title of a page.
_LEVEL = 2
#: The theme fills the context at the default priority, 500.
_AFTER_THEME = 900


def with_levels(html: str) -> str:
    """Captions that are headings, with the level that the role requires.

    Examples
    --------
    >>> with_levels('<p class="caption" role="heading">Begin</p>')
    '<p class="caption" role="heading" aria-level="2">Begin</p>'
    """
    return html.replace(' role="heading">', f' role="heading" aria-level="{_LEVEL}">')


def _state_levels(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    for name in ("furo_navigation_tree", "body"):
        if name in context:
            context[name] = with_levels(context[name])


def setup(app: Sphinx) -> dict[str, bool]:
    """Change each page before it is written; a script lets the keyboard scroll what scrolls."""
    app.connect("html-page-context", _state_levels, priority=_AFTER_THEME)
    app.add_js_file("scrollable.js", loading_method="defer")
    return {"parallel_read_safe": True, "parallel_write_safe": True}
