"""Tables of random problems: the rows of a CSV file, and the computation of those that it lacks."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple


class RandomTable(NamedTuple):
    """One file; the problem of a row is known by the column `number`."""

    path: Path
    columns: tuple[str, ...]

    def rows(self) -> list[dict[str, str]]:
        """Return all rows."""
        with self.path.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def complete(self, numbers: Iterable[int], rows_of: Callable[[int], Iterable[dict[str, object]]]) -> None:
        """Append the rows of the problems that the file lacks, each problem as soon as it is computed."""
        known = {row["number"] for row in self.rows()} if self.path.exists() else None
        with self.path.open("a", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, self.columns, lineterminator="\n")
            if known is None:
                writer.writeheader()
            for number in numbers:
                if str(number) not in (known or ()):
                    writer.writerows(rows_of(number))
                    file.flush()
