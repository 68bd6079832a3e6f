"""Journal of the rows of a folder."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from comparisons.runs.environment import fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.part_journal import PartJournal
from comparisons.runs.rows import Row

__all__ = ["RowJournal"]


def _read(line: dict[str, Any]) -> Row:
    return Row(**line)


class RowJournal(PartJournal[Row]):
    """Rows that are stored in a folder, each with the part of the run that computed it.

    Parameters
    ----------
    folder : Path
        Of the run.

    Raises
    ------
    ValueError
        As `comparisons.runs.journal.Journal`.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(RunFolder(folder).journal, fingerprint(), _read, asdict)

    def parts_of(self, rows: Iterable[Row]) -> list[dict[str, Any]]:
        """Return the parts that computed rows, in order, as the record of a run holds them."""
        used = {(row.key, row.model_version) for row in rows}
        return self.parts(lambda row: (row.key, row.model_version) in used)
