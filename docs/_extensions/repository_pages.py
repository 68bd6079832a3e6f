"""Pages from files outside the folder of the documents: the committed tables, CONTRIBUTING and CHANGELOG."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

#: Folder of the pages, relative to the documents.
FOLDER = "_generated"

ROOT = Path(__file__).resolve().parents[2]

#: Files at the top of the repository that are pages.
TOP = ("CONTRIBUTING.md", "CHANGELOG.md")


@cache
def pages() -> dict[str, str]:
    """Name and text of every page, with its links as they are from there."""
    top = {name: (ROOT / name).read_text(encoding="utf-8").replace("](docs/", "](../") for name in TOP}
    tables = {path.name: path.read_text(encoding="utf-8") for path in (ROOT / "results" / "baseline").rglob("*.md")}
    # The headings of a table are those of a part of a page.
    return top | {name: re.sub(r"^##", "#", text, flags=re.MULTILINE) for name, text in tables.items()}


def led_to_pages(text: str) -> str:
    """A document whose links to these files lead to the pages.

    Examples
    --------
    >>> led_to_pages("[values](../results/baseline/paper/paper_values.md), [rules](../CONTRIBUTING.md)")
    '[values](_generated/paper_values.md), [rules](_generated/CONTRIBUTING.md)'
    """
    names = "|".join(map(re.escape, pages()))
    return re.sub(rf"\]\(\.\./(?:results/baseline/(?:[\w-]+/)*)?({names})", rf"]({FOLDER}/\1", text)


def _write(app: Sphinx) -> None:
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        if not (folder / name).exists() or (folder / name).read_text(encoding="utf-8") != text:
            (folder / name).write_text(text, encoding="utf-8")


def _lead(app: Sphinx, name: str, source: list[str]) -> None:
    # The pages here have their links already.
    if not name.startswith(FOLDER):
        source[0] = led_to_pages(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before the documents are read, and lead links there."""
    app.connect("builder-inited", _write)
    app.connect("source-read", _lead)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
