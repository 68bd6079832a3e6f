"""Tables of random problems: CSV files whose column `number` tells the problem of a row."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from pathlib import Path


def stored(table: Path) -> list[dict[str, str]]:
    """Return all rows."""
    with table.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def complete(table: Path, numbers: Iterable[int], rows_of: Callable[[int], Iterable[dict[str, object]]]) -> None:
    """Append the rows of the problems that the file lacks, each as soon as it is computed; the file has a header."""
    known = {row["number"] for row in stored(table)}
    with table.open("r+", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, next(csv.reader([file.readline()])), lineterminator="\n")
        file.seek(0, 2)
        for number in numbers:
            if str(number) not in known:
                writer.writerows(rows_of(number))
                file.flush()
