"""Rows of a CSV text: each has a cell for every column of the heading, or the text is refused."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator


def csv_rows(text: str, source: str, *, by_hand: bool = False, delimiter: str = ",") -> Iterator[tuple[str, list[str]]]:
    r"""Yield the location and the cells of each row, the heading first; blank lines are left out.

    Parameters
    ----------
    text : str
        With ``\n`` at the end of each line, as `comparisons.data.input_files.utf8_text` returns it.
    source : str
        What the text is of, for the location: source and line.
    by_hand : bool
        Whether people write such a file: lines that begin with ``#`` are comments, blanks before a cell are left out,
        and so is an empty cell after the last column.
    delimiter : str
        Between cells.

    Raises
    ------
    ValueError
        One sentence with the location, if a row has another number of cells than the heading or is no CSV.

    Examples
    --------
    >>> list(csv_rows("a,b\n1,2\n", "table.csv"))
    [('table.csv, line 1', ['a', 'b']), ('table.csv, line 2', ['1', '2'])]
    >>> list(csv_rows("a,b\n1,2,\n", "table.csv"))
    Traceback (most recent call last):
    ValueError: table.csv, line 2: 3 values for 2 columns; write one for each column, and no comma after the last
    """
    number = 0

    def lines() -> Iterator[str]:
        nonlocal number
        for line in io.StringIO(text):
            number += 1
            is_comment = by_hand and (not line.strip() or line.lstrip()[0] == "#")
            if not is_comment:
                yield line

    rows = csv.reader(lines(), strict=True, skipinitialspace=by_hand and delimiter == ",", delimiter=delimiter)
    count = 0
    try:
        for cells in filter(None, rows):
            count = count or len(cells)
            if by_hand and len(cells) == count + 1 and not cells[-1].strip():
                del cells[-1]
            if len(cells) != count:
                raise ValueError(
                    f"{source}, line {number}: {len(cells)} values for {count} columns; "
                    f"write one for each column{_remedy(cells, count, delimiter)}"
                )
            yield f"{source}, line {number}", cells
    except csv.Error as error:
        raise ValueError(
            f"{source}, line {number}: it is no row of CSV ({error}); write one row a line, with commas between cells"
        ) from None


def _remedy(cells: list[str], count: int, delimiter: str) -> str:
    if len(cells) < count or delimiter != ",":
        return ""
    if cells[-1].strip():
        return " (a decimal comma separates two, too: export with semicolons between the columns)"
    return ", and no comma after the last"
