"""Tables of the kinds of a problem file, in place of the comments ``<!-- kinds of solid -->`` of a page."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from comparisons.problem.kinds import kind_rows

if TYPE_CHECKING:
    from sphinx.application import Sphinx


def with_tables(text: str) -> str:
    """A page with the tables.

    Examples
    --------
    >>> with_tables("<!-- kinds of law -->").splitlines()[2].split(" | ")[2].strip(" |")
    '`work_of_adhesion [J/m^2], z0 [m]`'
    """
    return re.sub(r"<!-- kinds of (\w+) -->", lambda match: _table(match[1]), text)


def _table(section: str) -> str:
    lines = ["| kind | formula | keys |", "|---|---|---|"]
    for row in kind_rows():
        if row["section"] == section:
            columns = f"; columns `{row['columns']}`" if row["columns"] else ""
            lines.append(f"| `{row['kind']}` | {row['formula']} | `{row['keys']}`{columns} |")
    return "\n".join(lines)


def _replace(app: Sphinx, name: str, source: list[str]) -> None:
    source[0] = with_tables(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Replace the comments when a page is read."""
    app.connect("source-read", _replace)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
