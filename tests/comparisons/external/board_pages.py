"""The board of the submissions of a test, and the tables of its first page."""

import re

from comparisons.cli.main import main

#: A model that is ten percent off.
BODY = "return Result(2.2, 1e-9)"


def board(tmp_path):
    """The exit status of the command, and the text of the first page."""
    site = tmp_path / "site"
    status = main(["board", str(tmp_path / "submissions"), "--out", str(site), "--jobs", "1"])
    return status, (site / "index.html").read_text(encoding="utf-8")


def rows_of(page, table):
    """The rows of a table: the texts of their cells."""
    body = page.partition(f'id="table-{table}"')[2].partition("<tbody>")[2].partition("</tbody>")[0]
    rows = re.findall(r"<tr>(.*?)</tr>", body, flags=re.DOTALL)
    return [[re.sub("<[^>]*>", "", cell).strip() for cell in re.findall(r"<td>(.*?)</td>", row, re.S)] for row in rows]
